// SPDX-License-Identifier: GPL-3.0-or-later
// How long does the smallest enclosing ellipse take, certified, beside CGAL's exact one?
#include <CGAL/Gmpq.h>
#include <CGAL/Min_ellipse_2.h>
#include <CGAL/Min_ellipse_2_traits_2.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>

#include "clouds.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "side_by_side.h"

namespace exactvo::bench {
namespace {

using Kernel = CGAL::Simple_cartesian<CGAL::Gmpq>;
using MinEllipse = CGAL::Min_ellipse_2<CGAL::Min_ellipse_2_traits_2<Kernel>>;

std::vector<Kernel::Point_2> to_cgal(const std::vector<geometry::Vec2>& points) {
  std::vector<Kernel::Point_2> out;
  for (const geometry::Vec2 p : points) out.emplace_back(CGAL::Gmpq(p.x), CGAL::Gmpq(p.y));
  return out;
}

double area_of(const MinEllipse& ellipse) {
  double r, s, t, u, v, w;
  ellipse.ellipse().double_coefficients(r, s, t, u, v, w);
  const double det = 4 * r * s - t * t;
  const double x = (t * v - 2 * s * u) / det, y = (t * u - 2 * r * v) / det;
  return 2 * geometry::kPi * std::fabs(r * x * x + s * y * y + t * x * y - w) / std::sqrt(det);
}

bool same_answer(const std::vector<geometry::Vec2>& points, const geometry::Ellipse& ours, double exact_area) {
  const bool all_inside = std::all_of(points.begin(), points.end(), [&](auto p) { return contains(ours, p); });
  return all_inside && std::fabs(area(ours) / exact_area - 1.0) < 1e-9;
}

void fast_against_exact(benchmark::State& state) {
  const auto points = square_cloud(static_cast<int>(state.range(0)), 7);
  const auto input = to_cgal(points);
  const auto ours = [&] { return geometry::fast_smallest_ellipse(points); };
  const auto theirs = [&] { return MinEllipse(input.begin(), input.end(), true); };
  if (!same_answer(points, ours().ellipse, area_of(theirs()))) {
    state.SkipWithError("the ellipses differ");
    return;
  }
  compare(state, ours, theirs);
}
BENCHMARK(fast_against_exact)->Name("smallest_ellipse/newton_vs_Min_ellipse_2")->Arg(10)->Arg(100)->Arg(1000);

}  // namespace
}  // namespace exactvo::bench
