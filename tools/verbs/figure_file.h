// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One figure for a verb: FILE.svg as the user names it, with FILE.pdf, FILE.png, FILE.dat and FILE.gp beside it.

#include <filesystem>
#include <string>

#include "figures/figure.h"

namespace exactvo::tools {

/// Throws UsageError unless the name ends in .svg, is printable, and no folder has the name of a file that would be
/// written; an empty name passes. `option` is where the name was given. To be asked before the work.
void check_figure_name(const std::string& option, const std::string& name);

/// Draws in a folder of its own under a plain name (figures/figure.h) and moves the files into place together: the
/// pictures under exactly the name that was asked for, data and script under the plain one, which is the same of
/// ordinary names. The figure's own name does not matter.
void write_figure(Figure figure, const std::filesystem::path& out);

}  // namespace exactvo::tools
