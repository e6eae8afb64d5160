// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The unrounded answers of `exactvo vo`, as JSON and in words: free velocities (--free), and why there are none to
/// show where an ellipse takes part, where the curves are too many, and in contact; the algebraic legs (--exact-legs).

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/vo/algebraic_direction.h"
#include "exactvo/vo/free_arrangement.h"
#include "verbs/vo/question.h"

namespace exactvo::tools {

struct ExactFree {
  std::optional<vo::FreeArrangement> free;
  std::optional<bool> region_inside;  ///< whether all that the half-planes keep is free; without half-planes nothing
  std::string why_not;                ///< where `free` is nothing
};

/// The cones are those of the question's encounters. `half_planes` is null where a cone has none.
ExactFree exact_free_of(const std::vector<vo::ShiftedCone>& cones, const VoQuestion& question,
                        const std::vector<geometry::HalfPlane>* half_planes);

/// `exact`, an object or null, and `why_not_exact`, null or words.
std::string exact_free_json(const ExactFree& exact, const VoQuestion& question);

/// One line or two.
std::string exact_free_words(const ExactFree& exact);

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
