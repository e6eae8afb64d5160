// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/discs.h"

#include <cmath>

#include "exactvo/geometry/pi.h"

namespace exactvo::datasets {
namespace {

using geometry::kPi;
constexpr int kCorners = 16;
/// The corners' radius is rounded up by this part, far more than the few roundings of each corner (1e-15 or so).
constexpr double kOutward = 1e-12;

}  // namespace

geometry::Ring polygon_round(geometry::Vec2 center, double radius) {
  geometry::Ring ring;
  const double reach = radius / std::cos(kPi / kCorners) * (1.0 + kOutward);
  for (int k = 0; k <= kCorners; ++k) {
    const double angle = 2.0 * kPi * (k % kCorners) / kCorners;
    ring.push_back(center + reach * geometry::Vec2{std::cos(angle), std::sin(angle)});
  }
  return ring;
}

}  // namespace exactvo::datasets
