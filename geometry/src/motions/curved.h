// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A polynomial way against grown hulls: the filter (Bernstein control points with halving, in doubles with a running
/// error) and the exact stage (signs of polynomials, roots isolated).

#include <optional>
#include <vector>

#include "exactvo/geometry/motions.h"
#include "motions/path.h"
#include "motions/straight.h"

namespace exactvo::geometry::motions {

/// Whether the way, given by control points, is clear of the hull or overlaps it; none where that is not certain.
///
/// A Bezier curve of degree d is within the largest |b_i - (b_0 + i/d (b_d - b_0))| of the uniform motion along its
/// chord. So it is clear where the chord is clear of the hull grown by as much, and overlaps where an end does or the
/// chord overlaps the hull shrunk by as much. Halving makes the deviation four times smaller.
std::optional<Encounter> curved_by_filter(const std::vector<Vector<RunningError>>& control_points,
                                          const GrownHull<RunningError>& hull);

/// The same question decided exactly; `path` in powers of s. `contact` where the closed sets meet and no more.
Encounter curved_exactly(const std::vector<Vector<mpq_class>>& path, const GrownHull<mpq_class>& hull);

}  // namespace exactvo::geometry::motions
