// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The same half-planes by the same algorithm in plain doubles: the best direction as it is rounded, its offset as it
/// is rounded, nothing proven. Inputs are checked as the library checks them.

#include <optional>

#include "exactvo/geometry/half_plane.h"
#include "exactvo/geometry/support.h"

namespace exactvo::bench {

std::optional<geometry::HalfPlane> plain_half_plane(const geometry::GrownShape& s, double time_horizon,
                                                    geometry::Vec2 v);

}  // namespace exactvo::bench
