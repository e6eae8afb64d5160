// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The speed bound of a problem, and by how much answers in double are moved inward.

#include "exactvo/vo/lp/problem.h"

namespace exactvo::lp {

/// u, the unit roundoff of double.
inline constexpr double kUnitRoundoff = 0x1p-53;

/// Slacks tried in turn, in units of that of the searches (lanes/layout.h): sharp vertices need more of it.
inline constexpr double kSlacks[] = {1.0, 8.0, 64.0, 512.0};

/// Normals of | |normal| - 1 | up to this are taken as they are (solve.h, batch.h).
inline constexpr double kUnitLength = 0x1p-10;

/// Whether a disc, or both sides of the box, bound the speed.
bool bound_is_finite(const SpeedBound& bound);

/// A side of the box as a unit half-plane n.v >= -width. REQUIRES: a side of the box.
HalfPlane side_of_box(const SpeedBound& bound, BindingKind side);

/// The largest speed that can matter, m/s: the bound's where there is one, else that of the data.
double largest_speed(const Problem& problem);

}  // namespace exactvo::lp
