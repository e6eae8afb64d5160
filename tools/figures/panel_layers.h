// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The layers of one panel of a paths figure: data sets and the plot items that draw them, each over the one before.
/// scene_layers.cpp has what stands and moves in the plane, robot_layers.cpp what the robots did in it.

#include <cstddef>
#include <string>
#include <vector>

#include "exactvo/datasets/recording_file.h"
#include "figures/figure.h"
#include "figures/local_origin.h"
#include "figures/outlines.h"

namespace exactvo::tools {

/// Characters of a name in a legend or before a title.
inline constexpr std::size_t kLegendName = 32;

struct PanelLayers {
  PanelLayers(const datasets::RecordingFile& run, const Box& view, DataFile& data, bool detailed);

  /// `text` where the panel has a legend of its own.
  std::string key(const std::string& text) const { return detailed ? text : ""; }
  /// Draws a data set whose first two columns are x and y; `how` is what gnuplot has after them.
  void draw(int index, const std::string& how, const std::string& title = "") {
    plot.data(index, origin.using_columns() + " " + how, title);
  }
  /// Whether it lies no farther beyond the view than gnuplot can bear.
  bool is_drawable(Vec2 p) const;

  const datasets::RecordingFile& run;
  DataFile& data;
  bool detailed;  ///< with a legend, enclosures, routes and times
  Box view;
  LocalOrigin origin;
  PlotCommand plot;
  bool has_collisions = false;
};

/// Obstacles, moving ones at the time marks, and with details enclosures, routes and where there is no room to pass.
void add_scene(PanelLayers& to);

/// The leader, paths, the robots to scale where they were when, goals, collisions.
void add_robots(PanelLayers& to);

/// px a metre of the plane in the SVG.
double scale_of(const Box& view);
/// A few rows, evenly over the time in which robots move.
std::vector<const formation::Step*> time_marks(const datasets::RecordingFile& run);
Points vertices_at(const formation::MovingObstacle& obstacle, double time);
Vec2 middle_at(const formation::MovingObstacle& obstacle, double time);
/// Ellipses only: a facade that stands for itself would be drawn over the obstacle.
void add_ellipses(const datasets::RecordingFile& run, const formation::GoalBodies& of_goal, std::vector<Points>& rings);

}  // namespace exactvo::tools
