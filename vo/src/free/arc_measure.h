// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Certified numbers of walks: boxes round their points, brackets of their areas. MPFR does the arcs.

#include "free/arrangement.h"

namespace exactvo::vo::detail {

/// Each side at most 2^-48 max_speed, or as narrow as doubles are there.
PointBracket bracket_of(const Point& x, double max_speed);

/// Of what the walk goes round. At most 2^-48 max_speed^2 wide, or as narrow as doubles are there.
geometry::Bracket area_of(const Arrangement& arrangement, const std::vector<Stretch>& walk, double max_speed);

}  // namespace exactvo::vo::detail
