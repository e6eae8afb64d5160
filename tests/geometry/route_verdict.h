// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A second opinion on certificates of routes, in rationals, by other means than `geometry::check` takes: distances by
/// cutting a piece to the strip beside an edge, the inside by rays upward, numbers by a grammar of their own. Slow.
/// Exact, but for lengths, which are compared with 256 bits.

#include <vector>

#include "exactvo/geometry/route_certificate.h"

namespace exactvo::test {

enum class RouteVerdict { wrong, proven };

RouteVerdict verdict_on(const std::vector<geometry::Obstacle>& obstacles, const geometry::RouteQuestion& question,
                        const geometry::RouteAnswer& answer);

}  // namespace exactvo::test
