// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Several plots side by side on one sheet, each with a letter, and one legend below all of them. Axis labels stand at
/// the left and below only: all panels of a sheet have the same quantities on their axes.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "figures/figure.h"

namespace exactvo::tools {

/// "(a)", ..., "(z)", "(27)", ...
std::string letter_of(std::size_t panel);

struct SheetPanel {
  std::string title;     ///< a gnuplot string (quoted, markup), with its letter
  std::string settings;  ///< the ranges, and whatever else is the panel's own
  std::string plot;      ///< its plot command
};

struct Sheet {
  std::string title;             ///< a gnuplot string
  std::string x_label, y_label;  ///< the same
  int columns = 1;
  double panel_width = 250.0;   ///< px of what the axes enclose
  double panel_height = 250.0;  ///< px; a plane is to scale where the panels' ranges have the same ratio
  double gap = 40.0;            ///< px between columns, for the numbers at the axes
  std::vector<SheetPanel> panels;
  /// Of the legend: what gnuplot draws ("keyentry with ..."), and its words.
  std::vector<std::pair<std::string, std::string>> legend;
};

/// REQUIRES: a panel, a plain name.
Figure sheet_figure(const std::string& name, const std::string& data, const std::string& shows, const Sheet& sheet);

}  // namespace exactvo::tools
