// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Point (7) of an audit: no two swept motions meet.

#include <optional>
#include <string>
#include <vector>

#include "recordings/audit_rows.h"
#include "recordings/audit_scene.h"
#include "recordings/audit_tally.h"

namespace exactvo::datasets {

class MotionAudit {
 public:
  /// `law` where the motion is exponential. Keeps references.
  MotionAudit(const RecordingFile& file, const std::vector<RationalObstacle>& obstacles,
              const std::vector<exact::ExactWay>& ways, const exact::ExponentialLaw* law, AuditTally& tally);

  /// From this row to the next. REQUIRES: there is one, and times rise.
  void check(const RowInRun& at);

 private:
  /// A row's time step as one robot drives it.
  struct Driven {
    exact::StepMotion motion;
    geometry::Box box;
  };
  /// Of one robot and step: whom it meets, and from whom it cannot be told apart; empty where there is nobody.
  struct Answer {
    std::string met, open;
    void take(exact::Verdict verdict, const char* kind, const std::string& id);
  };
  /// What moving obstacles do between two rows.
  struct Moved {
    exact::Rational start, passed;  ///< s
    std::vector<std::vector<exact::ExactWay::TimedChord>> ways;
  };

  Moved displacements(const formation::Step& from, const formation::Step& to) const;
  void meet_obstacles(const Driven& d, std::size_t i, Answer& answer);
  void meet_moving(const Driven& d, std::size_t i, const Moved& moved, Answer& answer);
  void meet_robots(const std::vector<Driven>& driven, std::size_t i, Answer& answer);

  const RecordingFile& file_;
  const std::vector<RationalObstacle>& obstacles_;
  std::vector<RationalObstacle> moving_;
  const std::vector<exact::ExactWay>& ways_;
  const exact::ExponentialLaw* law_;
  exact::Rational duration_;
  AuditTally& tally_;
};

}  // namespace exactvo::datasets
