// SPDX-License-Identifier: GPL-3.0-or-later
#include "sums/polygon_sum.h"
#include "exact/cgal_rounding.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_vertical_decomposition_2.h>
#include <CGAL/minkowski_sum_2.h>

#include <algorithm>
#include <cmath>

#include "cgal_guard.h"
#include "exactvo/geometry/minkowski.h"

namespace exactvo::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactRing = CGAL::Polygon_2<Kernel>;
using ExactPolygon = CGAL::Polygon_with_holes_2<Kernel>;

ExactPolygon by_convolution(const ExactPolygon& a, const ExactPolygon& b) {
  return CGAL::minkowski_sum_by_reduced_convolution_2(a, b);
}

ExactPolygon by_decomposition(const ExactPolygon& a, const ExactPolygon& b) {
  const CGAL::Polygon_vertical_decomposition_2<Kernel> decompose;
  return CGAL::minkowski_sum_2(a, b, decompose);
}

Ring rounded_ring(const ExactRing& ring, double& error) {
  Ring out;
  out.reserve(ring.size());
  for (auto v = ring.vertices_begin(); v != ring.vertices_end(); ++v) {
    const Vec2 p = {CGAL::to_double(v->x()), CGAL::to_double(v->y())};
    error = std::max(
        error, (detail::rounding_of(v->x(), p.x) + detail::rounding_of(v->y(), p.y)) * (1.0 + 4.0 * kUnitRoundoff));
    if (out.empty() || out.back() != p) out.push_back(p);
  }
  return out;
}

PolygonSum rounded_sum(const ExactPolygon& polygon) {
  PolygonSum out;
  out.polygon.outer = rounded_ring(polygon.outer_boundary(), out.error);
  for (auto hole = polygon.holes_begin(); hole != polygon.holes_end(); ++hole) {
    Ring ring = rounded_ring(*hole, out.error);
    if (ring.size() >= 3) out.polygon.holes.push_back(std::move(ring));  // smaller than rounding: gone within `error`
  }
  return out;
}

}  // namespace

PolygonSum minkowski_sum(const Polygon& a, const Polygon& b, SumMethod method) {
  const auto values = [&] { return excerpt(a.outer) + " (+) " + excerpt(b.outer); };
  return detail::without_cgal_failures("minkowski_sum", values, [&] {
    const auto exact_a = detail::to_cgal<Kernel>(detail::checked_polygon(a));
    const auto exact_b = detail::to_cgal<Kernel>(detail::checked_polygon(b));
    return rounded_sum(method == SumMethod::convolution ? by_convolution(exact_a, exact_b)
                                                        : by_decomposition(exact_a, exact_b));
  });
}

}  // namespace exactvo::geometry
