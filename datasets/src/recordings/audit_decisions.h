// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Points (3), (4) and (5) of an audit: nothing is missing in a row, its half-planes are true, its choices satisfy
/// them and are optimal.
///
/// That nothing is missing is asked of the scene itself, not of the bodies: for every edge of an obstacle that the
/// robot could reach within the step some hard half-plane of its row excludes the edge's velocity obstacle. Of a
/// polygon only the edges that face the robot are asked: a disc that goes straight from outside and meets the others
/// first does not exist. (At the first contact with a point inside such an edge the disc's centre is on the edge's
/// outer side, having come from the inner one; it was nearer to the edge's line just before, so it overlapped already.
/// At a vertex between two of them its way leads away from the vertex.)

#include <vector>

#include "exactvo/vo/lp/certificate.h"
#include "recordings/audit_rows.h"
#include "recordings/audit_scene.h"
#include "recordings/audit_tally.h"

namespace exactvo::datasets {

class DecisionAudit {
 public:
  /// Keeps references.
  DecisionAudit(const RecordingFile& file, const std::vector<RationalObstacle>& obstacles, AuditTally& tally);

  /// REQUIRES: not the last row, which does not decide.
  void check(const RowInRun& at);

 private:
  using Constraints = std::vector<formation::RecordedConstraint>;

  /// A robot of the row, and how far it can get within the step.
  struct Seen {
    std::size_t row, robot;
    const formation::Step* step;
    const formation::RobotStep* state;
    exact::Point at;
    exact::Rational radius, reach;
    double near;  ///< no less than their sum
  };

  Seen seen(const RowInRun& at, std::size_t robot) const;
  void place_moving(const formation::Step& step);
  const std::string& id(const Seen& s) const { return file_.scenario.robots[s.robot].id; }

  // Point (3).
  void nothing_is_missing(const Seen& s);
  exact::Verdict against_edges(const Seen& s, const RationalObstacle& obstacle, bool& in_reach) const;
  bool is_excluded(const Seen& s, const geometry::Segment& edge) const;
  exact::Verdict against_moving(const Seen& s, std::size_t k, bool& in_reach) const;
  bool can_meet(const Seen& a, const Seen& b) const;
  exact::Verdict against_robot(const Seen& a, const Seen& b) const;
  void answer(exact::Verdict verdict, const Seen& s, const std::string& whom);

  // Point (4).
  void half_planes_hold(const Seen& s);
  std::string misnamed(const Seen& s, const formation::RecordedConstraint& c) const;
  bool is_clear_of(const Seen& s, const formation::RecordedConstraint& c) const;
  bool holds(const Seen& s, const formation::RecordedConstraint& c) const;
  bool takes_its_share(const Seen& s, const formation::RecordedConstraint& c) const;
  bool adds_up(const Seen& s, const formation::RecordedConstraint& c) const;

  // Point (5).
  void choice_is_best(const Seen& s);
  /// m/s
  struct Violations {
    exact::Rational forbidden, given;
  };
  Violations violations(const Seen& s) const;
  std::string misstated(const Seen& s, const Violations& most) const;
  std::string stated(const Seen& s, lp::Problem& problem, lp::Solution& solution) const;
  double fastest(std::size_t robot) const;

  const RecordingFile& file_;
  const std::vector<RationalObstacle>& obstacles_;
  exact::Rational duration_;
  bool literal_horizons_;                     ///< the controller's horizons may be shorter than a step
  std::vector<geometry::ConvexShape> moved_;  ///< moving obstacles in the present row
  AuditTally& tally_;
};

}  // namespace exactvo::datasets
