// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// From an ellipse that should hold its points to one that does.

#include <optional>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry::detail {

/// Inflates until predicate E holds for every point: the ellipse was rounded, the answer may not be. Nothing of one that
/// is a segment to rounding.
std::optional<Ellipse> inflate_to_contain(Ellipse e, const std::vector<Vec2>& points);

}  // namespace exactvo::geometry::detail
