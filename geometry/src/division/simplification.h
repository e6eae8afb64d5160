// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Vertex decimation that keeps chains from crossing themselves and each other (CGAL Polyline_simplification_2).

#include <vector>

#include "rings/ring_contacts.h"

namespace exactvo::geometry::detail {

/// For each chain, which vertices stay so that (up to CGAL's rounding) every dropped vertex lies within `tolerance` of
/// the edge that replaces it. Ends of open chains and the first vertex of closed ones stay. REQUIRES: no contact among
/// the chains (`find_contact`), tolerance > 0.
std::vector<std::vector<bool>> kept_vertices(const std::vector<Chain>& chains, double tolerance);

}  // namespace exactvo::geometry::detail
