// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Two robots that have no room to pass each other, and whose goals would need it: a proof that no motion of the
/// robots brings both there (docs/guide/liveness.md, lemma 6).
///
/// Squares of a grid cover the places of each robot's centre: a square is left out only where all of it is nearer than
/// the radius to one edge of an obstacle. Pairs of squares cover the places of both: a pair is left out only where all
/// of it is nearer than the sum of the radii. Any motion of the two goes from pair to neighbouring pair:
///
///     +---+---+---+---+          a in one square, b in another; next, a or b in a square
///     | a |   |   | b |   ...    that shares a side or a corner with the one before
///     +---+---+---+---+
///
/// If no such chain leads from where they start to their goals, no motion does. Where the squares lie in a straight
/// strip between two walls, too narrow for the two side by side, their order along it never changes, and no pair has to
/// be looked at. Certified: rounding only leaves more squares and pairs in. An answer without a pair says nothing:
/// proofs are looked for only where robots have little room and overlap nothing at the start, and with a limited number
/// of pairs. Nor is anything said of a robot whose goal is out of reach for it alone, or of two whose goals are too
/// near to each other: then room to pass is not what they lack.

#include <cstddef>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::formation {

/// A proof about two robots.
struct NoPassing {
  std::size_t first = 0;      ///< robot, in the order of the scenario
  std::size_t second = 0;     ///< the other one, > first
  double side = 0.0;          ///< m, of the squares
  std::vector<Vec2> squares;  ///< m, lower left corners of the squares that cover the places of the first robot
  std::size_t pairs = 0;      ///< pairs of squares that the two robots can reach; 0 if they are in a strip
  double strip = 0.0;         ///< m, width of the strip, rounded up; 0 without one
  double side_by_side = 0.0;  ///< m, width that the two take side by side in it
  bool with_gaps = false;     ///< true: they lack room only because plans leave gaps to walls and between robots
};

/// Pairs of robots that are proven not to be able to be at their goals together, though neither goal is proven out of
/// reach by itself, in order. Only robots with one goal are judged, and only by the static obstacles. Deterministic;
/// takes a few tenths of a second at most, and if it proves something, also builds the map of all obstacles
/// (geometry/routes.h).
/// REQUIRES: a valid scenario.
std::vector<NoPassing> robots_without_passing(const Scenario& scenario);

/// Pairs in a straight strip that is wide enough for the two side by side, but not with the gaps that joint plans leave
/// to walls and between robots: they could pass, and no plan finds it. Otherwise the same.
std::vector<NoPassing> robots_without_gaps_to_pass(const Scenario& scenario);

/// "R1 and R2 cannot both reach their goals: they have no room to pass each other (proven: none of 8206 pairs of
/// squares of 0.125 m leads there)"; "R1 and R2 have room to pass each other, but not with the gaps of plans (they are
/// in a strip 2.05 m wide, and side by side they take 2.06 m)".
std::string words_of(const Scenario& scenario, const NoPassing& proof);

}  // namespace exactvo::formation
