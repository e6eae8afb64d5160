// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Runs gnuplot on scripts that stand beside their data.

#include <filesystem>
#include <string>
#include <vector>

namespace exactvo::tools {

/// A gnuplot string of exactly these bytes, each by its octal number: a folder may be called anything, and gnuplot runs
/// what stands between backticks.
std::string exact_string(const std::string& bytes);

/// Draws every script, each from within its own folder, in every format that this gnuplot has, in a gnuplot process per
/// processor, four at most. The pictures do not depend on how many there are. Says on a terminal that it does: "drawing
/// figures of `what`"; a message where gnuplot or one of its terminals is absent. Throws std::runtime_error where it
/// fails; then no picture of these scripts is left. Characters that no font has are squares in PNG and PDF, and named.
void draw(const std::vector<std::filesystem::path>& scripts, const std::string& what = "");

}  // namespace exactvo::tools
