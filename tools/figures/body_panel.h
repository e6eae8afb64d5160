// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A panel that shows bodies on a map, for the figures of `check` and `monitor`.

#include <string>
#include <vector>

#include "exactvo/geometry/motions.h"
#include "figures/local_origin.h"

namespace exactvo::tools {

/// A square round the box; half its side is `share` of the longer side of the box.
Box square_view(const Box& box, double share);

/// "with lines ..."; `dash` is gnuplot's.
std::string line_style(double width, const std::string& colour, const std::string& dash = "");
/// Filled with this opacity, with a border.
std::string filled_style(const char* colour, double opacity);
/// The same in a legend.
std::string filled_key(const char* colour, double opacity);

/// The convex parts of a body at a pose.
std::vector<Points> outlines_of(const geometry::RigidBody& body, const geometry::Pose& pose);

/// Data sets, and the command that draws them in the order in which they are added.
class BodyPanel {
 public:
  BodyPanel(const Box& view, DataFile& data) : view_(view), origin_(view), data_(data) { origin_.prepare(data); }

  void rings(const std::string& title, const std::vector<Points>& rings, const std::string& style) {
    add(title, rings, style, true);
  }
  void curves(const std::string& title, const std::vector<Points>& curves, const std::string& style) {
    add(title, curves, style, false);
  }
  void points(const std::string& title, const Points& points, const std::string& style);
  /// Straight lines between points. gnuplot draws none between two points that are out of view.
  void way(const std::string& title, const Points& way, const std::string& style);
  void map(const std::vector<geometry::Obstacle>& obstacles);
  SheetPanel done(const std::string& title) const;

 private:
  void add(const std::string& title, const std::vector<Points>& curves, const std::string& style, bool closed);
  void add_seen(const Points& way, std::vector<Points>& pieces) const;

  Box view_;
  LocalOrigin origin_;
  DataFile& data_;
  PlotCommand plot_;
};

}  // namespace exactvo::tools
