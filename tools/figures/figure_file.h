// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One figure for a verb: FILE.svg, FILE.png and FILE.pdf, whichever the user names, with FILE.dat and FILE.gp.

#include <filesystem>
#include <string>
#include <vector>

#include "figures/figure.h"

namespace exactvo::tools {

/// What the help of an option says of the file it names.
inline constexpr const char* kFigureFileHelp =
    "FILE.svg, FILE.png or FILE.pdf: all three are written, with FILE.dat and FILE.gp (gnuplot)";

/// Throws UsageError unless the name ends in .svg, .png or .pdf, is printable, and none of the files that would be
/// written is a folder or one of `others`, the files that the command reads and writes besides. An empty name passes.
/// `option` is where the name was given. To be called before the work.
void check_figure_name(const std::string& option, const std::string& name,
                       const std::vector<std::filesystem::path>& others);

/// Draws in a folder of its own under a plain name (figures/figure.h) and moves the files into place together: the
/// pictures under exactly the name that was asked for, data and script under the plain one, which is the same for
/// ordinary names. A picture that could not be drawn is removed if an earlier figure left one of its name, that is, if
/// the figure's script was there before. The figure's own name does not matter.
void write_figure(Figure figure, const std::filesystem::path& out);

}  // namespace exactvo::tools
