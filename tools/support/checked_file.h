// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a check was asked, for the words, the page and the proofs that are made of its answer.

#include <string>
#include <vector>

#include "exactvo/datasets/trajectory_survey.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/motion_check.h"

namespace exactvo::tools {

/// The names of geometry::Between, in its order.
inline const std::vector<std::string>& between_names() {
  static const std::vector<std::string> kNames{"straight", "hold", "cubic", "none"};
  return kNames;
}

struct CheckedFile {
  const datasets::TrajectoryFile& file;
  const datasets::TrajectorySurvey& survey;
  std::string map;                                         ///< its file; empty without one
  const std::vector<formation::SceneObstacle>& obstacles;  ///< of the map
  geometry::Between between = geometry::Between::straight;
  bool has_curves = false;   ///< the file says how agents move between rows
  std::string bodies;        ///< in words: "discs of radius 0.3 m"
  double near = 0.0;         ///< m
  double jump_speed = 0.0;   ///< m/s, may be infinite
  double longest_gap = 0.0;  ///< s, may be infinite
  std::size_t samples = 0;   ///< of each move; 0: not asked
  bool has_rims = true;      ///< bodies have a radius, from whose rim depth counts; false: polygons without one
  bool on_arcs = false;      ///< where the heading changes between rows, bodies go on the arc of a constant twist

  /// Whether the depth of an overlap is measured.
  bool has_depth(const geometry::MotionEvent& e) const {
    return has_rims || (e.with_obstacle && obstacles[e.other].disc);
  }
};

}  // namespace exactvo::tools
