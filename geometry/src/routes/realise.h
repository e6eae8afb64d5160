// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// From a way through portals to a route: a polyline of which every piece is proven, in exact arithmetic, to keep its
/// clearance. It follows the taut string round circles about the vertices passed; arcs are circumscribed by short
/// pieces. A tight gate is crossed straight through its exact middle, which is rational.

#include <optional>
#include <vector>

#include "routes/search.h"

namespace exactvo::geometry::routing {

/// From s to t inclusive. REQUIRES: both ends clear; radius > 0. Nothing where no polyline could be proven.
std::optional<std::vector<Point>> realised(const ClearancePlan& plan, Vec2 s, Vec2 t, const Way& way);

}  // namespace exactvo::geometry::routing
