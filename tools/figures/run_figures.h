// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The figures of one run (paper, Figs. 5, 6 and 8), from its recording alone: all of them, those of what changes over
/// time, both Lyapunov functions term by term (formation/lyapunov.h), and the plane (paths_figure.cpp): obstacles,
/// enclosures, the robots' paths and where they were when.

#include <cstddef>
#include <string>
#include <vector>

#include "exactvo/datasets/recording_file.h"
#include "figures/figure.h"
#include "figures/outlines.h"

namespace exactvo::tools {

/// Those that apply, in this order: `paths`; `obstacle_distance` (with obstacles); `robot_distance` (with two robots or
/// more); `velocity`; `wheels` (with robots on wheels); `formation_error` and `lyapunov` (with a formation).
std::vector<Figure> run_figures(const datasets::RecordingFile& run);

/// `lyapunov`: the paper's (18) and its derivative above, the function that holds and its derivative below.
/// REQUIRES: a formation's run with its rows of `lyapunov`.
Figure lyapunov_figure(const datasets::RecordingFile& run);

/// "A2, method ivo" or "B3, method ivo, default controller".
std::string run_title(const datasets::RecordingFile& run);

/// `paths`: one run, with a legend, enclosures dashed in their robot's colour and each robot drawn to scale at a few
/// times and where it ended; a red cross where it was deepest in an obstacle or another robot.
Figure paths_figure(const datasets::RecordingFile& run);

struct PathsPanel {
  std::string title;
  const datasets::RecordingFile* run = nullptr;
};

/// Many runs side by side on one sheet, each in a panel with its letter, all at one scale, with one legend below: for
/// comparing. REQUIRES: a panel.
Figure paths_sheet(const std::string& name, const std::string& title, const std::vector<PathsPanel>& panels,
                   int columns);

/// When the robot came to rest for good, s; the end of the run where it never did.
double end_of_motion(const datasets::RecordingFile& run, std::size_t robot);
/// When the last robot came to rest for good, s; the end of the run where one never did.
double end_of_motion(const datasets::RecordingFile& run);

/// What a paths figure shows of the plane: every start, goal, leader and obstacle, and the ways as far as they stay
/// within a few times that (a run that diverges must not shrink the rest to a dot). Obstacles more than four times as
/// wide as the robots' own business are shown in part. `runaway`: how far beyond, of the diagonal, a path is followed.
Box view_of(const datasets::RecordingFile& run, double runaway = 1.5);

}  // namespace exactvo::tools
