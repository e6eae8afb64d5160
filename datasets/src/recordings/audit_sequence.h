// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Point (6) of an audit: rows follow from one another.
///
/// A robot's step is, whatever the integrator, x1 = x0 + T w + Q (v0 - w), v1 = w + P (v0 - w), w what it tracks:
///     exact           P = e^-kT                                Q = (1 - P) / k
///     explicit Euler  P = 1 - kT                               Q = T
///     rk4             P = 1 - z + z^2/2 - z^3/6 + z^4/24       Q = T (1 - z/2 + z^2/6 - z^3/24), z = kT
/// (the adaptive ones solve the law to their tolerance, which is no proof). A kinematic robot goes x + T v, bit for
/// bit.

#include <optional>
#include <vector>

#include "recordings/audit_rows.h"
#include "recordings/audit_tally.h"
#include "recordings/exact_motion.h"

namespace exactvo::datasets {

class SequenceAudit {
 public:
  /// `ways` of the moving obstacles, `law` where motion is exponential. Keeps references.
  SequenceAudit(const RecordingFile& file, const std::vector<exact::ExactWay>& ways, const exact::ExponentialLaw* law,
                AuditTally& tally);

  /// A row by itself: its time, where leader and moving obstacles are, and where half-planes are built.
  void check_row(const RowInRun& at);
  /// The next row. REQUIRES: there is one.
  void check_step(const RowInRun& at);

 private:
  struct Law {
    exact::Interval remains;  ///< P
    exact::Interval reach;    ///< Q, s
    exact::Rational z;
  };

  void ask(bool holds, std::size_t row, const std::string& what);
  bool is_on_way(const exact::ExactWay& way, const formation::Leader& motion, double time, geometry::Vec2 displacement,
                 geometry::Vec2 velocity) const;
  bool has_its_anchor(const RowInRun& at, std::size_t robot) const;
  bool tracks_its_choice() const;
  bool follows(const formation::RobotStep& from, const formation::RobotStep& to) const;
  bool follows_tracking(const formation::RobotStep& from, const formation::RobotStep& to) const;
  bool follows_something(const formation::RobotStep& from, const formation::RobotStep& to) const;
  exact::Rational rounding(const exact::Rational& position, const exact::Rational& speeds) const;

  const RecordingFile& file_;
  const std::vector<exact::ExactWay>& ways_;
  std::optional<exact::ExactWay> leader_;
  std::optional<Law> law_;  ///< of a formation
  bool is_adaptive_ = false;
  exact::Rational duration_;
  AuditTally& tally_;
};

}  // namespace exactvo::datasets
