// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The results of a run of robots with goals, whatever decided (simulation.h, crowd_run.h).

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace exactvo::formation {

/// Why a robot does not come to its goal.
struct RobotNotThere {
  std::size_t robot = 0;  ///< in the order of the scenario
  std::string why;        ///< in words, for people
};

/// What is counted over all decisions of a run on a crowd (crowd_run.h), and how it ended.
struct CrowdMetrics {
  std::size_t cut_short = 0;       ///< that did not get their wish, since another robot would be met in the step
  std::size_t reserved = 0;        ///< of robots that drive to a reserved place, or stand there
  std::size_t stopped = 0;         ///< to stay, for lack of anything else that edges, bodies at rest and wheels allow
  std::size_t overlapping = 0;     ///< of robots that overlapped another: 0 after a legal start
  std::size_t touching = 0;        ///< of robots that touched another
  std::size_t widened = 0;         ///< with more than 10 neighbours
  std::size_t against_robots = 0;  ///< half-planes
  std::size_t against_edges = 0;   ///< half-planes against edges of obstacles
  std::size_t against_bodies = 0;  ///< half-planes against bodies: discs at rest and moving obstacles
  bool stands_still = false;       ///< it ended early: no step changes anything any more (exact)
  std::uint64_t digest = 0;        ///< Crowd::digest at the end
};

/// The results of a run. Times in s, lengths in m. The crowd counts are 0 in a run without a crowd.
struct RunReport : CrowdMetrics {
  std::string outcome;      ///< how it ended, in words, for people
  std::size_t robots = 0;   ///< robots of the scenario
  std::size_t arrived = 0;  ///< robots within the arrival tolerance of their last goals at the end
  /// Robots without a route to a goal, in the order of the scenario: each stays, or goes as near as it can
  /// (`Scenario::unreachable`).
  std::vector<RobotNotThere> without_route;
  /// Other robots that did not arrive. Each stays beside its goal or was on its way there: another robot is at the
  /// goal, or at a goal so near that the two cannot both arrive.
  std::vector<RobotNotThere> goal_taken;
  /// Other robots that did not arrive: a moving obstacle stands on the route of each, and none leads round it.
  std::vector<RobotNotThere> route_cut;
  std::size_t steps = 0;     ///< time steps that were taken
  double time = 0.0;         ///< simulated
  double path_length = 0.0;  ///< sum over all robots
  std::size_t relaxed = 0;   ///< in a crowd: decisions in which half-planes against others are relaxed
  bool interrupted = false;  ///< `SimulationOptions::progress` stopped it
  double wall_time = 0.0;    ///< s, of the whole call
};

}  // namespace exactvo::formation
