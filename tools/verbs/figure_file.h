// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One figure for a verb's --figure: FILE.svg, with FILE.png, FILE.dat and FILE.gp beside it.

#include <filesystem>
#include <string>

#include "figures/figure.h"

namespace exactvo::tools {

/// Throws UsageError unless the name ends in .svg; an empty one passes. To be asked before the work.
void check_figure_name(const std::string& name);

/// Draws in a folder of its own and moves the files into place.
void write_figure(const Figure& figure, const std::filesystem::path& out);

}  // namespace exactvo::tools
