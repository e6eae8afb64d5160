// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The unrounded free velocities of `exactvo vo --free`, as JSON and in words; and why there are none to show where an
/// ellipse takes part, where the curves are too many, and in contact.

#include <optional>
#include <string>
#include <vector>

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

}  // namespace exactvo::tools
