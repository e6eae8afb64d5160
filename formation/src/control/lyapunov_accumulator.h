// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The Lyapunov functions of a run as it is made (lyapunov.h).

#include <memory>
#include <optional>

#include "control/consensus.h"
#include "exactvo/formation/lyapunov.h"
#include "motion/integrators.h"

namespace exactvo::formation::detail {

/// What is left over a step of a velocity's distance from what it tracks, and of the square of that.
struct Decays {
  Decay of_step, twice_as_fast;
};

/// Takes the rows of a run one after the other, and keeps the last.
class LyapunovAccumulator {
 public:
  /// Reads of `run` what is known before the first row. Both must outlive the accumulator; the scenario has a
  /// formation.
  LyapunovAccumulator(const Scenario& scenario, const Recording& run);

  /// The values at the row before, whose rates are known now; nothing for the first row.
  std::optional<LyapunovRow> add(std::shared_ptr<const Step> row);
  /// The values at the last row, without rates.
  const LyapunovRow& last() const { return values_; }
  LyapunovSummary summary() const { return {paper_.course, sound_.course}; }

 private:
  struct Course {
    void add(double value, bool steady);
    LyapunovCourse course;

   private:
    bool begun_ = false;
  };

  const FormationSpec& spec_;
  const Recording& run_;
  Decays decays_;
  std::shared_ptr<const Step> row_;
  RelativeState state_;  ///< of the last row
  LyapunovRow values_;   ///< of the last row
  double integral_ = 0.0;
  Course paper_, sound_;
};

}  // namespace exactvo::formation::detail
