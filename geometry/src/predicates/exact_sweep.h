// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The exact stages of motion questions: segments and polygons over exact numbers. No filters.

#include <vector>

#include "exact/exact_vector.h"
#include "exactvo/geometry/predicates.h"

namespace exactvo::geometry::detail {

/// The sign of dist(q, [a, b]) - r, r >= 0.
Sign distance_sign(const Vector<Exact>& q, const Vector<Exact>& a, const Vector<Exact>& b, const Exact& r);

/// Whether [0, end] comes within r of the hull of the vertices, which are counter-clockwise.
bool hull_meets(const std::vector<Vector<Exact>>& vertices, const Exact& r, const Vector<Exact>& end);

/// Whether [0, t d] meets S. Valid shapes only.
bool segment_meets_exactly(const GrownShape& s, const Vector<Exact>& d, const Exact& t);

/// A power of two t so large that t d lies beyond every point within `extent` of the origin (each coordinate).
/// REQUIRES: d is not zero.
Exact beyond(const Vector<Exact>& d, double extent);

}  // namespace exactvo::geometry::detail
