// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// `fit_trap_free` for whoever fits many.

#include <memory>
#include <optional>
#include <vector>

#include "exactvo/geometry/enclosure.h"

namespace exactvo::geometry::detail {

/// Keeps its memory from one fit to the next, and nothing else.
struct FitMemory;
class TrapFreeFit {
 public:
  TrapFreeFit();
  ~TrapFreeFit();
  /// As `fit_trap_free`. REQUIRES: the corners of a convex hull, as `convex_hull` gives them.
  std::optional<FittedEllipse> operator()(const std::vector<Vec2>& hull, double robot_radius, Vec2 start, Vec2 goal,
                                          const EnclosureOptions& options);

 private:
  std::unique_ptr<FitMemory> memory_;
};

}  // namespace exactvo::geometry::detail
