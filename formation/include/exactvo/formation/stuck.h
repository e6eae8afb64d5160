// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Why a robot did not arrive, from what its run recorded: whether it stood or moved at the end, for how long, what
/// blocked it, and, where that is one static shape, the equilibrium it rests at (trap.h). Rounded.

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/trap.h"

namespace exactvo::formation {

/// A robot slower than this share of its max_speed counts as at rest. (In a flat trap or a corner the tie-break leaves
/// it a creeping speed, a thousandth.)
inline constexpr double kAtRestShare = 1.0 / 300.0;

/// A multiplier below this share of the push |chosen - preferred| is rounding. (Multipliers round by far less. A share
/// of 5e-4 decides where the tie-break turns a robot that would slide off against another boundary.)
inline constexpr double kLeastShare = 1e-6;

/// A half-plane that is active in the last decision.
struct BindingConstraint {
  DecisionConstraint constraint;   ///< as it was recorded
  Vec2 normal;                     ///< unit, out of the shape at the point nearest the robot
  double clearance = 0.0;          ///< m, rim to shape
  double radius_of_curvature = 0;  ///< m, of the shape grown by the robot, at that normal; infinite on a flat edge
  /// Whether it pushes the robot off its preferred velocity: its recorded multiplier (balance.h) is positive and at
  /// least `kLeastShare` of the push. One that is active without pushing blocks nothing. True of all where the decision
  /// was not `optimal`: its multipliers say nothing of the preferred velocity.
  bool pressing = false;
};

/// Why one robot is not at its goal.
struct StuckReport {
  std::size_t robot = 0;                   ///< in the order of the scenario
  Vec2 position;                           ///< m, where it ended
  double goal_distance = 0.0;              ///< m, D
  double speed = 0.0;                      ///< m/s, in the last row
  std::vector<BindingConstraint> binding;  ///< the active ones of the last decision
  /// Where one static shape presses, the goal lies straight behind it and the robot is at its boundary: position, rho,
  /// D, stability. Nothing against robots and moving obstacles: what moves has no boundary to slide along.
  std::optional<Equilibrium> equilibrium;
  std::string text;  ///< all of it in a sentence or two
  double rest_time =
      0.0;  ///< s, for how long it had been slower than kAtRestShare says when the run ended; 0 while it moves
};

/// A report for every robot that is not at its goal or slot in the last row; none of a formation that diverged or whose
/// leader is still under way. REQUIRES: a recording of this scenario.
std::vector<StuckReport> explain_stuck(const Scenario& scenario, const Recording& recording);

/// The same for rows that come one after the other. It keeps the last two rows: where the run ended, and the last
/// decisions.
class StuckWatch {
 public:
  /// `scenario` must outlive the watch.
  explicit StuckWatch(const Scenario& scenario) : scenario_(scenario), robots_(scenario.robots.size()) {}
  /// The next row of the run.
  void add(std::shared_ptr<const Step> row);
  /// As if the run had ended with the last row added. `run` has everything of the recording but its rows. REQUIRES: a
  /// row.
  std::vector<StuckReport> reports(const Recording& run) const;
  /// Robots that stand in the last row, none of them at its goal or slot, and of which each waits for the next
  /// (waiting.h); empty where there are none. `run`: as for `reports`.
  std::vector<std::size_t> deadlock(const Recording& run) const;

 private:
  struct OfRobot {
    std::optional<double> at_rest_since;                       ///< s
    double nearest = std::numeric_limits<double>::infinity();  ///< m, the least distance from its last goal
    double nearest_at = 0.0;                                   ///< s; of kinematic robots: a slot moves
  };

  const Scenario& scenario_;
  std::vector<OfRobot> robots_;
  std::shared_ptr<const Step> decided_, last_;
};

}  // namespace exactvo::formation
