// SPDX-License-Identifier: GPL-3.0-or-later
#include "enclosure/least_area.h"

#include <algorithm>
#include <cmath>

#include "exact/exact_number.h"
#include "exact/exact_vector.h"
#include "exact/running_error.h"
#include "exactvo/geometry/pi.h"

namespace exactvo::geometry::detail {
namespace {

template <typename Number>
Number doubled_area(Vec2 a, Vec2 b, Vec2 c) {
  const auto at = [](Vec2 p) { return Vector<Number>{Number(p.x), Number(p.y)}; };
  return cross(at(b) - at(a), at(c) - at(a));
}

}  // namespace

double doubled_area_below(Vec2 a, Vec2 b, Vec2 c) {
  constexpr double kPrecise = 0x1p-48, kLeast = 0x1p-1000;
  const RunningError filtered = doubled_area<RunningError>(a, b, c);
  const double size = std::fabs(filtered.value);
  // The rest of 2^-48 pays for the bound's own rounding (running_error.h), and for this subtraction.
  if (std::isfinite(size) && filtered.error < kPrecise * size && size > kLeast)
    return (size - filtered.error) * (1.0 - 0x1p-50);
  const double exact = std::fabs(CGAL::to_double(doubled_area<Exact>(a, b, c)));
  if (!(exact > kLeast) || !std::isfinite(exact)) return 0.0;
  return exact * (1.0 - 0x1p-50);  // it is rounded by one unit in the last place at most
}

double certified_least_area(const std::vector<WeightedPoint>& support) {
  const std::size_t n = support.size();
  std::vector<double> areas;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k)
        areas.push_back(doubled_area_below(support[i].point, support[j].point, support[k].point));
  const double largest = areas.empty() ? 0.0 : *std::max_element(areas.begin(), areas.end());
  if (!(largest > 0.0)) return 0.0;
  double total = 0.0, sum = 0.0;  // det C / largest^2: what underflows in it only makes it less
  for (const WeightedPoint& p : support) total += p.weight;
  std::size_t next = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      for (std::size_t k = j + 1; k < n; ++k) {
        const double share = areas[next++] / largest;
        sum += (support[i].weight / total) * (support[j].weight / total) * (support[k].weight / total) * share * share;
      }
    }
  }
  // At most seven points: 35 terms of less than a dozen roundings, a root and three products stay within 2^-46.
  constexpr double kRounding = 1.0 - 0x1p-46;
  const double bound = kRounding * 2.0 * kPi * std::sqrt(sum) * largest;
  return std::isfinite(bound) ? bound : 0.0;
}

}  // namespace exactvo::geometry::detail
