// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest enclosing ellipse against CGAL's Min_ellipse_2 in rationals.
#include <CGAL/Gmpq.h>
#include <CGAL/Min_ellipse_2.h>
#include <CGAL/Min_ellipse_2_traits_2.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "vo/differential/tally.h"

namespace exactvo::test {
namespace {

using Kernel = CGAL::Simple_cartesian<CGAL::Gmpq>;
using MinEllipse = CGAL::Min_ellipse_2<CGAL::Min_ellipse_2_traits_2<Kernel>>;
using geometry::Ellipse;
using geometry::Vec2;

/// Area of the ellipse round a triangle of its three support points: 4 pi / (3 sqrt 3) of the triangle's (Steiner).
double area_round_triangle(const MinEllipse& ellipse) {
  const auto p = ellipse.support_points_begin();
  const double twice = std::fabs(CGAL::to_double(CGAL::determinant(p[1] - p[0], p[2] - p[0])));
  return 2.0 * geometry::kPi / (3.0 * std::sqrt(3.0)) * twice;
}

double area_of(const MinEllipse& ellipse) {
  if (ellipse.number_of_support_points() == 3) return area_round_triangle(ellipse);
  double r, s, t, u, v, w;
  ellipse.ellipse().double_coefficients(r, s, t, u, v, w);
  const double det = 4 * r * s - t * t;  // r x^2 + s y^2 + t x y + u x + v y + w = 0
  const double x = (t * v - 2 * s * u) / det, y = (t * u - 2 * r * v) / det;
  return 2 * geometry::kPi * std::fabs(r * x * x + s * y * y + t * x * y - w) / std::sqrt(det);
}

/// Ours holds every point, exactly, and has the area of the exact one.
bool agrees(const std::vector<Vec2>& points, Tally& tally) {
  std::vector<Kernel::Point_2> input;
  for (const Vec2 p : points) input.emplace_back(CGAL::Gmpq(p.x), CGAL::Gmpq(p.y));
  const MinEllipse exact(input.begin(), input.end(), true);
  const geometry::FastEllipse dual = geometry::fast_smallest_ellipse(points);
  const Ellipse ours = dual.ellipse;
  const bool hold = std::all_of(points.begin(), points.end(), [&](Vec2 p) { return contains(ours, p); });
  if (exact.is_degenerate()) {  // a point or a segment
    tally.at_a_contact();
    constexpr double kSliver = 1e-6;  // of coordinates up to 64: ours may be a sliver of width 2^-36 of them
    return hold && area(ours) < kSliver;
  }
  // The oracle rounds its conic's coefficients: 4 r s - t^2 then loses (a/b)^2 ulps; ours round the centre (hull.h).
  const geometry::EllipseAxes axes = axes_of(ours);
  const double flatness = axes.a / axes.b;
  const double tolerance = 1e-9 + 256.0 * 0x1p-53 * flatness * flatness;
  // Four support points far from general: the oracle's rounding exceeds even that, and the dual bound proves ours.
  const bool proven = area(ours) < dual.least_area * (1 + 1e-9);
  const double expected = exact.number_of_support_points() == 4 && proven ? dual.least_area : area_of(exact);
  return hold && std::fabs(area(ours) / expected - 1) < tolerance;
}

std::string text_of(const std::vector<Vec2>& points) {
  return "points " + geometry::to_string(points);
}

}  // namespace

Tally compare_ellipses(const Asked& asked) {
  Tally tally;
  SeededRandom random(asked.seed);
  for (long i = 0; i < asked.random; ++i) {
    std::vector<Vec2> points;
    const int count = random.integer(3, 8);
    for (int k = 0; k < count; ++k) {  // on a fine grid: short numbers for the oracle, nothing special for us
      const Vec2 p = i % 2 == 0 ? random.in_box(1.0) : random.direction();
      points.push_back({std::round(p.x * 65536.0) / 65536.0, std::round(p.y * 65536.0) / 65536.0});
    }
    tally.random(agrees(points, tally), text_of(points));
  }
  for (long i = 0; i < asked.constructed; ++i) {  // lattices: repeated, collinear and co-elliptic points
    std::vector<Vec2> points;
    const int count = random.integer(1, 8), reach = i % 2 == 0 ? 2 : 3;
    for (int k = 0; k < count; ++k)
      points.push_back({1.0 * random.integer(-reach, reach), 1.0 * random.integer(-reach, reach)});
    tally.constructed(agrees(points, tally), text_of(points));
  }
  return tally;
}

}  // namespace exactvo::test
