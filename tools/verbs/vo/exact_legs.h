// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The algebraic legs of `exactvo vo --exact-legs`, as JSON and in words.

#include <cstddef>
#include <string>
#include <vector>

#include "exactvo/vo/algebraic_direction.h"

namespace exactvo::tools {

struct LegsOfCone {
  std::size_t obstacle = 0;
  std::size_t cone = 0;  ///< of the obstacle
  const vo::ExactLegs* legs = nullptr;
};

/// Two objects with `side`, `polynomial`, `slope`, `quarter_turns`, `direction`.
std::string exact_legs_json(const vo::ExactLegs& legs);

/// All of them counter-clockwise from just after (-1, 0) on, which is itself the last; groups of equal ones: which
/// cones share a leg.
std::string legs_by_angle_json(const std::vector<LegsOfCone>& legs);

std::string exact_legs_words(const vo::ExactLegs& legs);

}  // namespace exactvo::tools
