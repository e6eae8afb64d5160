// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The figures of one run (paper, Figs. 5, 6 and 8), from its recording alone.
///
/// Neighbours: paths_figure.h draws the plane, series_figures.h what changes over time.

#include <vector>

#include "exactvo/datasets/recording_file.h"
#include "figures/figure.h"

namespace exactvo::tools {

/// Those that apply, in this order: `paths`; `obstacle_distance` (with obstacles); `robot_distance` (with two robots or
/// more); `velocity`; `formation_error` and `lyapunov` (with a formation).
std::vector<Figure> run_figures(const datasets::RecordingFile& run);

}  // namespace exactvo::tools
