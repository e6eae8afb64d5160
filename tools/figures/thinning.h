// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Curves without the points that make no difference to the eye. Long runs of many robots have hundreds of thousands of
/// points a figure, which gnuplot reads and writes once for each format.
///
/// See also: trajectory.csv of a run has every row.

#include <cstddef>
#include <vector>

#include "figures/outlines.h"

namespace exactvo::tools {

/// A figure of fewer points has all of them: its data file is read by people too.
inline constexpr std::size_t kMostWholePoints = 20'000;

/// px of the SVG: how far a thinned curve may lie from a point that it leaves out.
inline constexpr double kThinning = 0.1;

/// Which points of a curve are drawn, ascending: the first, the last, and so many that every point lies within
/// kThinning of the stretch that stands for it (Douglas and Peucker 1973). `curve` in px, all finite.
std::vector<std::size_t> drawn_points(const Points& curve);

/// All of them: 0, ..., count - 1.
std::vector<std::size_t> all_points(std::size_t count);

}  // namespace exactvo::tools
