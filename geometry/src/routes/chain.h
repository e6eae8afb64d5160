// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The proof that two places are separated: a closed chain of obstacles and of gaps that the disc does not fit through.

#include "exactvo/geometry/routes.h"
#include "routes/plan.h"

namespace exactvo::geometry::routing {

/// REQUIRES: s and t are free and lie in cells of different components. A short chain, not the shortest.
Separated separating_chain(const ClearancePlan& plan, const Point& s, const Point& t);

ExactPoint shown(const Point& p);

}  // namespace exactvo::geometry::routing
