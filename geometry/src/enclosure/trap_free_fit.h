// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// `fit_trap_free` for whoever fits many.

#include <optional>
#include <vector>

#include "enclosure/candidate_search.h"
#include "exactvo/geometry/enclosure.h"

namespace exactvo::geometry::detail {

/// What a fit leaves to the next: memory.
struct FitMemory {
  std::vector<Vec2> points;    ///< the hull's corners from the first of them
  std::vector<double> angles;  ///< of the coarse search
  std::vector<Orientation> orientations;
  // One for each candidate: orientation x semi-minor axis x offset across.
  std::vector<Known::State> state;
  std::vector<MajorFit> major;  ///< read where the state says so
  Orientation here, aside;      ///< of the pattern search
  std::vector<double> width;
};

/// As `fit_trap_free` of enclosure.h. REQUIRES: the corners of a convex hull, as `convex_hull` gives them.
std::optional<FittedEllipse> fit_trap_free(FitMemory& memory, const std::vector<Vec2>& hull, double robot_radius,
                                           Vec2 start, Vec2 goal, const EnclosureOptions& options);

}  // namespace exactvo::geometry::detail
