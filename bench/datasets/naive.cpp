// SPDX-License-Identifier: GPL-3.0-or-later
#include "naive.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Gmpq.h>
#include <CGAL/Min_ellipse_2.h>
#include <CGAL/Min_ellipse_2_traits_2.h>
#include <CGAL/Partition_traits_2.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/convex_hull_2.h>
#include <CGAL/partition_2.h>

#include <cmath>
#include <iterator>
#include <list>

#include "exactvo/geometry/enclosure.h"
#include "exactvo/geometry/pi.h"

namespace exactvo::bench {
namespace {

using geometry::Ellipse;
using geometry::Vec2;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Rational = CGAL::Gmpq;
using RationalKernel = CGAL::Simple_cartesian<Rational>;
using MinEllipse = CGAL::Min_ellipse_2<CGAL::Min_ellipse_2_traits_2<RationalKernel>>;
using geometry::kPi;

std::vector<Exact::Point_2> exact_points(const geometry::Ring& ring) {
  std::vector<Exact::Point_2> points;
  for (const Vec2 p : ring) points.emplace_back(p.x, p.y);
  return points;
}

std::size_t pieces_of(const std::vector<Exact::Point_2>& points) {
  using Traits = CGAL::Partition_traits_2<Exact>;
  std::list<Traits::Polygon_2> pieces;
  CGAL::approx_convex_partition_2(points.begin(), points.end(), std::back_inserter(pieces), Traits());
  return pieces.size();
}

/// Rounded once, from the exact conic.
double area_of(const MinEllipse& ellipse) {
  double r = 0.0, s = 0.0, t = 0.0, u = 0.0, v = 0.0, w = 0.0;
  ellipse.ellipse().double_coefficients(r, s, t, u, v, w);
  const double det = 4 * r * s - t * t;
  const double x = (t * v - 2 * s * u) / det;
  const double y = (t * u - 2 * r * v) / det;
  return 2 * kPi * std::fabs(r * x * x + s * y * y + t * x * y - w) / std::sqrt(det);
}

bool contains_exactly(const Ellipse& e, Vec2 x) {
  const Rational ux = Rational(x.x) - Rational(e.center.x);
  const Rational uy = Rational(x.y) - Rational(e.center.y);
  const Rational a = Rational(e.l22) * ux;
  const Rational b = Rational(e.l11) * uy - Rational(e.l21) * ux;
  const Rational d = Rational(e.l11) * Rational(e.l22);
  return a * a + b * b <= d * d;
}

}  // namespace

NaiveShapes naive_shapes(const geometry::Polygon& polygon) {
  NaiveShapes shapes;
  const geometry::Ring& ring = polygon.outer;
  const std::vector<Exact::Point_2> points = exact_points(ring);
  std::vector<Exact::Point_2> hull;
  CGAL::convex_hull_2(points.begin(), points.end(), std::back_inserter(hull));
  for (const Exact::Point_2& p : hull) shapes.hull.push_back({CGAL::to_double(p.x()), CGAL::to_double(p.y())});
  shapes.pieces = pieces_of(points);
  std::vector<RationalKernel::Point_2> rational;
  // Seen from the first corner, so that the area rounds well; exact all the same.
  const Rational x(ring.front().x);
  const Rational y(ring.front().y);
  for (const Vec2 p : ring) rational.emplace_back(Rational(p.x) - x, Rational(p.y) - y);
  shapes.ellipse_area = area_of(MinEllipse(rational.begin(), rational.end(), true));
  shapes.facade_ellipses_contain = true;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 a = ring[i];
    const Vec2 b = ring[(i + 1) % ring.size()];
    const Ellipse e = geometry::facade_ellipse({a, b});
    shapes.facade_ellipses_contain = shapes.facade_ellipses_contain && contains_exactly(e, a) && contains_exactly(e, b);
  }
  return shapes;
}

}  // namespace exactvo::bench
