// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whether [0, t_max v] meets S, by the same algorithm twice: in plain doubles, believing every sign, and in rationals
/// (GMP) without any filter but with the same short cuts. Discs, ellipses with an area, and convex polygons.

#include "exactvo/geometry/support.h"

namespace exactvo::bench {

bool plain_meets(const geometry::GrownShape& s, geometry::Vec2 v, double t_max);
bool rational_meets(const geometry::GrownShape& s, geometry::Vec2 v, double t_max);
/// The same in rationals as the formulas stand, without looking at one sign to spare the next.
bool naive_meets(const geometry::GrownShape& s, geometry::Vec2 v, double t_max);

}  // namespace exactvo::bench
