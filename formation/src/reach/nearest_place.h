// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where a disc gets nearest to a goal that it cannot reach. The free places that it can reach are bounded by edges
/// moved out by its radius and by circles about vertices. The nearest place lies in the foot of the goal on one of
/// these, or where two of them meet: all are tried, the nearest first. That the place can be reached is exact
/// (geometry/routes.h); that none is nearer holds up to the rounding of these points, and no more is proven than
/// `at_least`.

#include <optional>
#include <vector>

#include "exactvo/geometry/routes.h"
#include "reach/reachability.h"

namespace exactvo::formation::detail {

struct NearestPlace {
  Vec2 place;             ///< m; can be reached
  double distance = 0.0;  ///< m, from the goal
  double at_least = 0.0;  ///< m, >= 0: no place that can be reached is nearer to the goal; proven up to rounding
};

/// "0.732 m from it (no place nearer than 0.731 m can be reached)".
std::string words_of(const NearestPlace& nearest);

class NearestPlaces {
 public:
  /// It must outlive this.
  explicit NearestPlaces(Reachability& reach) : reach_(reach) {}

  /// The nearest place that leaves a disc of `radius` room to stand in besides `room`. Nothing where it can reach
  /// none. REQUIRES: the goal cannot be reached; radius and room no more than `reach` has its map for.
  std::optional<NearestPlace> nearest(double radius, double room, Vec2 from, Vec2 goal);

  /// A place within reach of the destination that can be reached, with room as above; the nearest of those tried.
  /// REQUIRES: as above.
  std::optional<Vec2> within_reach(double radius, double room, Vec2 from, const Destination& to);

 private:
  struct Candidate {
    double distance;  ///< m, from the goal
    Vec2 place;       ///< m
  };
  std::optional<Candidate> first_reachable(std::vector<Candidate> all, double radius, Vec2 from);
  bool is_map_for(double radius, Vec2 from, Vec2 goal);
  std::vector<Candidate> feet(double offset, Vec2 goal, double nearer_than) const;
  std::vector<Candidate> crossings(double offset, Vec2 goal, double nearer_than) const;

  Reachability& reach_;
};

}  // namespace exactvo::formation::detail
