// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What holds a decision's velocity where it is: the multipliers of the Karush-Kuhn-Tucker conditions, as recorded.
/// Rounded: they are the solver's, not certified. (How two robots share an avoidance is vo/reciprocal.h.)

#include <cstddef>
#include <optional>
#include <vector>

#include "exactvo/formation/recording.h"

namespace exactvo::formation {

/// chosen - preferred = sum of factor * normal, with every factor > 0: no allowed velocity lies nearer to the preferred
/// one. Without forces where chosen = preferred; a decision that is not `optimal` has no balance.
struct Balance {
  /// What one half-plane, or the speed bound, contributes.
  struct Force {
    std::optional<std::size_t> constraint;  ///< index into RobotStep::constraints; none for the speed bound
    Vec2 normal;                            ///< unit, into the allowed side
    double factor = 0.0;                    ///< m/s
  };
  std::vector<Force> forces;  ///< of constraints in their order, then of the speed bound
  double remainder = 0.0;     ///< m/s: what the sum leaves over; about 0 where the balance explains the choice

  /// m/s; 0 where the constraint does not push.
  double factor_of(std::size_t constraint) const;
};

/// The balance of a recorded decision. Rounded.
Balance balance_of(const RobotStep& decision);

}  // namespace exactvo::formation
