// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Points and segments against ellipse (+) disc (predicates B1 and B2): in doubles with static bounds, and exactly.

#include "exact/exact_vector.h"
#include "exactvo/geometry/predicates.h"
#include "predicates/segment_disc_filter.h"

namespace exactvo::geometry::detail {

/// u = centre - point, rounded, in error by at most 2 u of `size` a coordinate. False where a sign is in doubt.
bool locate_rounded(const Ellipse& e, Vec2 u, Vec2 size, double radius, Place& place);

/// The point q is seen from s.origin; `e` is the shape of s.
Place locate_exactly(const Ellipse& e, const GrownShape& s, const Vector<Exact>& q);

/// Whether [0, t_max v] meets S. REQUIRES: t_max >= 0; of the second, v is not zero.
FilterAnswer segment_ellipse_filter(const Ellipse& e, const GrownShape& s, Vec2 v, double t_max);
bool segment_meets_exactly(const Ellipse& e, const GrownShape& s, const Vector<Exact>& v, const Exact& t_max);

}  // namespace exactvo::geometry::detail
