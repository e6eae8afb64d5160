// SPDX-License-Identifier: GPL-3.0-or-later
// How long does the Minkowski sum of two convex polygons take, certified, beside CGAL's minkowski_sum_2?
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/minkowski_sum_2.h>

#include <algorithm>

#include "clouds.h"
#include "exactvo/geometry/minkowski.h"
#include "side_by_side.h"

namespace exactvo::bench {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Polygon = CGAL::Polygon_2<Kernel>;

Polygon to_cgal(const std::vector<geometry::Vec2>& ring) {
  Polygon out;
  for (const geometry::Vec2 p : ring) out.push_back(Kernel::Point_2(p.x, p.y));
  return out;
}

bool lies_near_one_of(const geometry::Vec2 p, const Polygon& polygon, double error) {
  return std::any_of(polygon.vertices_begin(), polygon.vertices_end(), [&](const Kernel::Point_2& q) {
    return CGAL::squared_distance(q, Kernel::Point_2(p.x, p.y)) <= Kernel::FT(error) * error;
  });
}

bool same_answer(const geometry::ConvexSum& ours, const Polygon& theirs) {
  const auto& v = ours.polygon.vertices;
  return v.size() == theirs.size() &&
         std::all_of(v.begin(), v.end(), [&](auto p) { return lies_near_one_of(p, theirs, ours.error); });
}

void merge_against_cgal(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const geometry::ConvexPolygon a = {convex_ring(n, 1)};
  const geometry::ConvexPolygon b = {convex_ring(n, 2)};
  const Polygon exact_a = to_cgal(a.vertices);
  const Polygon exact_b = to_cgal(b.vertices);
  const auto ours = [&] { return geometry::minkowski_sum(a, b); };
  const auto theirs = [&] { return CGAL::minkowski_sum_2(exact_a, exact_b); };
  if (!same_answer(ours(), theirs().outer_boundary())) {
    state.SkipWithError("the sums differ");
    return;
  }
  compare(state, ours, theirs);
}
BENCHMARK(merge_against_cgal)->Name("convex_sum/merge_vs_minkowski_sum_2")->Arg(4)->Arg(8)->Arg(16)->Arg(64);

}  // namespace
}  // namespace exactvo::bench
