// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The figures of one run (paper, Figs. 5, 6 and 8), from its recording alone: all of them, and those of what changes
/// over time.
///
/// Neighbours: paths_figure.h draws the plane, lyapunov_figure.h the Lyapunov functions.

#include <vector>

#include "exactvo/datasets/recording_file.h"
#include "figures/figure.h"

namespace exactvo::tools {

/// Those that apply, in this order: `paths`; `obstacle_distance` (with obstacles); `robot_distance` (with two robots or
/// more); `velocity`; `formation_error` and `lyapunov` (with a formation).
std::vector<Figure> run_figures(const datasets::RecordingFile& run);

/// `obstacle_distance`: from each robot's rim to the nearest obstacle (paper, Figs. 5(b), 6(b)). REQUIRES obstacles.
Figure obstacle_distance_figure(const datasets::RecordingFile& run);

/// `robot_distance`: between the rims of each pair of up to four robots; with more robots, from each to the
/// nearest other (paper, Figs. 6(c), 8(d)). REQUIRES two robots.
Figure robot_distance_figure(const datasets::RecordingFile& run);

/// `velocity`: both components of each robot and of the leader (paper, Fig. 8(c)).
Figure velocity_figure(const datasets::RecordingFile& run);

/// `formation_error`: |x_i - x_L - Delta_i|, logarithmic. REQUIRES a formation.
Figure formation_error_figure(const datasets::RecordingFile& run);

}  // namespace exactvo::tools
