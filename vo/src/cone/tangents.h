// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The two tangents from the robot to S: h_S(n) = 0. Rounded; certification is in separation.h.

#include <optional>

#include "exactvo/geometry/support.h"

namespace exactvo::vo::detail {

using geometry::GrownShape;
using geometry::Vec2;

struct Tangent {
  Vec2 normal;  ///< outward, of length 1
  Vec2 touch;   ///< m, where it touches S
};

struct Tangents {
  Tangent left;  ///< seen from the robot
  Tangent right;
};

/// Nothing where the robot lies in S or so near it that doubles cannot tell.
std::optional<Tangents> tangents(const GrownShape& s);

}  // namespace exactvo::vo::detail
