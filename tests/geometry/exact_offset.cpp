// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/exact_offset.h"

#include <CGAL/Arr_conic_traits_2.h>
#include <CGAL/CORE_algebraic_number_traits.h>
#include <CGAL/Cartesian.h>
#include <CGAL/General_polygon_set_2.h>
#include <CGAL/Gps_traits_2.h>
#include <CGAL/Polygon_with_holes_2.h>
#include <CGAL/offset_polygon_2.h>

#include <cmath>
#include <utility>

#include "cgal_guard.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/validity.h"

namespace exactvo::test {
namespace {

using geometry::excerpt;
using geometry::hex_text;
namespace detail = geometry::detail;

using Numbers = CGAL::CORE_algebraic_number_traits;
using RationalKernel = CGAL::Cartesian<Numbers::Rational>;
using AlgebraicKernel = CGAL::Cartesian<Numbers::Algebraic>;
using Conics = CGAL::Arr_conic_traits_2<RationalKernel, AlgebraicKernel, Numbers>;
using SetTraits = CGAL::Gps_traits_2<Conics>;
using ConicRing = SetTraits::Polygon_2;
using ConicPolygon = SetTraits::Polygon_with_holes_2;
using ConicCurve = Conics::X_monotone_curve_2;

/// The polygon with its rings the right way round. Throws std::logic_error if it is not valid.
Polygon checked_polygon(const Polygon& polygon) {
  std::vector<geometry::Ring> rings = {polygon.outer};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  geometry::NormalizedPolygon normalized = geometry::normalize(rings);
  EXACTVO_REQUIRE(normalized.ok(),
                  "outer ring " + excerpt(polygon.outer) + " and " + std::to_string(polygon.holes.size()) + " holes");
  return std::move(normalized.polygon);
}

CGAL::Polygon_2<RationalKernel> to_cgal(const geometry::Ring& ring) {
  CGAL::Polygon_2<RationalKernel> out;
  for (const Vec2 p : ring) out.push_back({Numbers::Rational(p.x), Numbers::Rational(p.y)});
  return out;
}

CGAL::Polygon_with_holes_2<RationalKernel> to_cgal(const Polygon& polygon) {
  CGAL::Polygon_with_holes_2<RationalKernel> out(to_cgal(polygon.outer));
  for (const geometry::Ring& hole : polygon.holes) out.add_hole(to_cgal(hole));
  return out;
}

Vec2 rounded(const Conics::Point_2& p) {
  return {CGAL::to_double(p.x()), CGAL::to_double(p.y())};
}

// A circle is x^2 + y^2 + u x + v y + w = 0 up to a factor r.
Vec2 center_of(const ConicCurve& curve) {
  const Numbers::Rational twice(Numbers::Integer(2) * curve.r());
  return {CGAL::to_double(Numbers::Rational(-curve.u()) / twice),
          CGAL::to_double(Numbers::Rational(-curve.v()) / twice)};
}

OffsetCurve rounded(const ConicCurve& curve) {
  OffsetCurve out = {rounded(curve.source()), rounded(curve.target()), curve.orientation() != CGAL::COLLINEAR, {}};
  if (out.is_arc) out.center = center_of(curve);
  return out;
}

std::vector<OffsetCurve> rounded(const ConicRing& ring) {
  std::vector<OffsetCurve> out;
  for (auto curve = ring.curves_begin(); curve != ring.curves_end(); ++curve) out.push_back(rounded(*curve));
  return out;
}

std::vector<std::vector<OffsetCurve>> rounded(const ConicPolygon& polygon) {
  std::vector<std::vector<OffsetCurve>> out = {rounded(polygon.outer_boundary())};
  for (auto hole = polygon.holes_begin(); hole != polygon.holes_end(); ++hole) out.push_back(rounded(*hole));
  return out;
}

// Green's theorem: the triangles with the origin, and the segments between arcs and their chords.
double doubled_area(const OffsetCurve& c) {
  const double triangle = cross(c.from, c.to);
  if (!c.is_arc) return triangle;
  const Vec2 a = c.from - c.center;
  const Vec2 b = c.to - c.center;
  const double angle = std::atan2(cross(a, b), dot(a, b));
  return triangle + norm(a) * norm(b) * (angle - std::sin(angle));
}

Place place_of(CGAL::Oriented_side side) {
  switch (side) {
    case CGAL::ON_POSITIVE_SIDE:
      return Place::inside;
    case CGAL::ON_NEGATIVE_SIDE:
      return Place::outside;
    case CGAL::ON_ORIENTED_BOUNDARY:
      break;
  }
  return Place::boundary;
}

}  // namespace

struct ExactOffset::Parts {
  CGAL::General_polygon_set_2<SetTraits> set;
  std::vector<std::vector<OffsetCurve>> boundary;
};

ExactOffset::ExactOffset(const Polygon& polygon, double radius) {
  EXACTVO_REQUIRE(std::isfinite(radius) && radius > 0.0, hex_text(radius));
  const Polygon checked = checked_polygon(polygon);
  const auto values = [&] { return excerpt(polygon.outer) + " (+) disc of radius " + hex_text(radius); };
  parts_ = detail::without_cgal_failures("ExactOffset", values, [&] {
    const Conics traits;
    const auto exact = to_cgal(checked);
    const ConicPolygon offset = CGAL::offset_polygon_2(exact, Numbers::Rational(radius), traits);
    auto parts = std::make_shared<Parts>();
    parts->set.insert(offset);
    parts->boundary = rounded(offset);
    return std::shared_ptr<const Parts>(std::move(parts));
  });
}

Place ExactOffset::locate(Vec2 x) const {
  EXACTVO_REQUIRE(is_finite(x), hex_text(x.x) + " " + hex_text(x.y));
  const auto values = [&] { return hex_text(x.x) + " " + hex_text(x.y); };
  return detail::without_cgal_failures("ExactOffset::locate", values, [&] {
    const Conics::Point_2 point{Numbers::Algebraic(x.x), Numbers::Algebraic(x.y)};
    return place_of(parts_->set.oriented_side(point));
  });
}

const std::vector<std::vector<OffsetCurve>>& ExactOffset::boundary() const {
  return parts_->boundary;
}

double ExactOffset::area() const {
  double twice = 0.0;
  for (const auto& ring : parts_->boundary) {
    for (const OffsetCurve& curve : ring) twice += doubled_area(curve);
  }
  return 0.5 * twice;
}

}  // namespace exactvo::test
