// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::formation::detail {

/// What two robots keep between their rims where they end, m.
struct RoomAtEnds {
  double margin = 0.0;
  double tolerated = 1e-6;  ///< so much of radii and margin may be missing; half-planes come no nearer to the margin
};
/// The scenario's margin.
RoomAtEnds room_at_ends(const Scenario& scenario);

/// Where robots are to stand in the end, m: their last goals, or where these are nearer to each other than radii and
/// margin take, places within their tolerance that are farther apart. Heuristic: what is too near to each other after
/// some rounds stays so. REQUIRES: robots with goals.
std::vector<Vec2> last_places(const Scenario& scenario, const RoomAtEnds& room);

/// Whether two robots that stand so far apart, m, leave each other less than radii and margin take.
bool leave_no_room(const Scenario& scenario, std::size_t i, std::size_t j, double apart, const RoomAtEnds& room);
inline bool leave_no_room(const Scenario& scenario, std::size_t i, std::size_t j, double apart) {
  return leave_no_room(scenario, i, j, apart, room_at_ends(scenario));
}

/// A place of a robot, m.
struct RobotPlace {
  std::size_t robot = 0;
  Vec2 place;
};
/// Whether any two of these do that are of different robots.
bool any_leave_no_room(const Scenario& scenario, const std::vector<RobotPlace>& places, const RoomAtEnds& room);

}  // namespace exactvo::formation::detail
