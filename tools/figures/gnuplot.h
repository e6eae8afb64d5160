// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Runs gnuplot on scripts that stand beside their data.

#include <filesystem>
#include <string>
#include <vector>

namespace exactvo::tools {

enum class Rendering {
  done,
  no_gnuplot,  ///< the program is not installed: the scripts and data stand, the pictures do not
  failed
};

struct RenderResult {
  Rendering outcome = Rendering::done;
  std::string message;  ///< what gnuplot said, where it failed
  /// The formats that this gnuplot was built without, each with its terminal.
  std::vector<std::string> missing;
};

/// Draws every script in one gnuplot process, each from within its own folder, in every format that this gnuplot has.
/// Where it fails, no picture of these scripts is left.
RenderResult render(const std::vector<std::filesystem::path>& scripts);

}  // namespace exactvo::tools
