// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whether a disc plainly gets from one place to another among the static obstacles: a search over a lattice as coarse
/// as the disc's radius. Where it finds a way the exact answer (reachability.h) would be that there is one, and the map
/// of all routes, which takes longer than many a run, need not be made.
///
/// Certified: where the answer is yes there is a way on which the disc's centre stays at least its radius away from
/// every edge, all roundings taken off. Heuristic otherwise: no way was found.

#include <vector>

#include "exactvo/formation/scenario.h"
#include "scene/edges_by_place.h"

namespace exactvo::formation::detail {

class OpenWay {
 public:
  explicit OpenWay(const std::vector<SceneObstacle>& obstacles) : edges_(obstacles) {}

  /// For a disc of `radius` m, between places that lie in no polygon. Looks at a few thousand places at most, at more
  /// the farther the two are apart, and at fewer where there are few edges.
  bool is_found(Vec2 start, Vec2 goal, double radius) const;

 private:
  enum class Answer;
  class Search;

  std::size_t most_places(double steps) const;
  /// m, no more than the distance from x to any edge; `enough` where all are beyond that.
  double clearance_below(Vec2 x, double enough) const;

  EdgesByPlace edges_;
};

}  // namespace exactvo::formation::detail
