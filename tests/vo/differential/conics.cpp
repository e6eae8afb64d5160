// SPDX-License-Identifier: GPL-3.0-or-later
// Points against ellipse (+) disc: `locate` against the crossings of the ellipse with the disc's circle, which CGAL's
// conic traits compute.
#include <CGAL/Arr_conic_traits_2.h>
#include <CGAL/CORE_algebraic_number_traits.h>
#include <CGAL/Cartesian.h>
#include <CGAL/exceptions.h>

#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "geometry/random_grown.h"
#include "vo/differential/tally.h"

namespace exactvo::test {
namespace {

using Numbers = CGAL::CORE_algebraic_number_traits;
using Rational = Numbers::Rational;
using Conics = CGAL::Arr_conic_traits_2<CGAL::Cartesian<Rational>, CGAL::Cartesian<Numbers::Algebraic>, Numbers>;
using Arc = Conics::X_monotone_curve_2;
using geometry::Ellipse;
using geometry::GrownShape;
using geometry::Place;
using geometry::Vec2;

/// The level set of f(x) = |adj(L) (x - c)|^2 - det^2, negative inside: a quadratic form's coefficients.
struct Conic {
  Rational r, s, t, u, v, w;  ///< r x^2 + s y^2 + t x y + u x + v y + w

  Rational at(const Rational& x, const Rational& y) const {
    return r * x * x + s * y * y + t * x * y + u * x + v * y + w;
  }
};

/// a (x - cx)^2 + b (x - cx)(y - cy) + c (y - cy)^2 - d.
Conic centred(const Rational& a, const Rational& b, const Rational& c, const Rational& d, const Rational& cx,
              const Rational& cy) {
  return {a,
          c,
          b,
          Rational(-2) * a * cx - b * cy,
          Rational(-2) * c * cy - b * cx,
          a * cx * cx + b * cx * cy + c * cy * cy - d};
}

Conic conic_of(const Ellipse& e) {
  const Rational l11(e.l11), l21(e.l21), l22(e.l22), two(2);
  const Rational det = l11 * l22;
  return centred(l22 * l22 + l21 * l21, Rational(-2) * l11 * l21, l11 * l11, det * det, Rational(e.center.x),
                 Rational(e.center.y));
}

Conic circle_of(const Rational& x, const Rational& y, const Rational& radius) {
  return centred(Rational(1), Rational(0), Rational(1), radius * radius, x, y);
}

std::vector<Arc> arcs_of(const Conic& c, const Conics& traits) {
  const Conics::Curve_2 curve(c.r, c.s, c.t, c.u, c.v, c.w);
  std::vector<CGAL::Object> pieces;
  traits.make_x_monotone_2_object()(curve, std::back_inserter(pieces));
  std::vector<Arc> arcs;
  for (const CGAL::Object& piece : pieces) {
    Arc arc;
    if (CGAL::assign(arc, piece)) arcs.push_back(arc);
  }
  return arcs;
}

struct Crossings {
  int proper = 0;
  int touching = 0;
};

Crossings crossings_of(const Conic& a, const Conic& b) {
  const Conics traits;
  Crossings found;
  using Crossing = std::pair<Conics::Point_2, Conics::Multiplicity>;
  for (const Arc& p : arcs_of(a, traits)) {
    for (const Arc& q : arcs_of(b, traits)) {
      std::vector<CGAL::Object> meets;
      traits.intersect_2_object()(p, q, std::back_inserter(meets));
      for (const CGAL::Object& meet : meets) {
        Crossing at;
        if (CGAL::assign(at, meet)) (at.second % 2 == 0 && at.second > 0 ? found.touching : found.proper) += 1;
      }
    }
  }
  return found;
}

/// Where q lies with respect to ellipse (+) D(0, r), r > 0: the disc round q against the ellipse.
Place expected_place(const GrownShape& s, Vec2 q) {
  const auto& e = std::get<Ellipse>(s.shape);
  const Rational x = Rational(q.x) + Rational(s.origin.x), y = Rational(q.y) + Rational(s.origin.y);
  const Conic ellipse = conic_of(e), circle = circle_of(x, y, Rational(s.radius));
  const bool holds_point = CGAL::sign(ellipse.at(x, y)) != CGAL::POSITIVE;
  const bool holds_centre = CGAL::sign(circle.at(Rational(e.center.x), Rational(e.center.y))) != CGAL::POSITIVE;
  if (holds_point || holds_centre) return Place::inside;
  const Crossings found = crossings_of(ellipse, circle);
  if (found.proper > 0) return Place::inside;
  return found.touching > 0 ? Place::boundary : Place::outside;
}

/// Nothing where CORE's root isolation breaks its own assertion (Sturm.h, evalExactSign: some one case in thousands).
std::optional<Place> place_by_cgal(const GrownShape& s, Vec2 q, Tally& tally) {
  try {
    return expected_place(s, q);
  } catch (const CGAL::Failure_exception&) {
    tally.oracle_gave_up();
    return std::nullopt;
  }
}

std::string text_of(const GrownShape& s, Vec2 q) {
  using geometry::hex_text;
  return to_string(s.shape) + "  origin " + hex_text(s.origin.x) + " " + hex_text(s.origin.y) + "  radius " +
         hex_text(s.radius) + "  point " + hex_text(q.x) + " " + hex_text(q.y);
}

/// Small whole numbers, so that the kernel's numbers stay short.
GrownShape random_integer_ellipse(SeededRandom& random) {
  const auto whole = [&](int low, int high) { return 1.0 * random.integer(low, high); };
  return {Ellipse{{whole(-50, 50), whole(-50, 50)}, whole(1, 40), whole(-40, 40), whole(1, 40)}, {}, whole(1, 30)};
}

}  // namespace

Tally compare_conics(const Asked& asked) {
  Tally tally;
  SeededRandom random(asked.seed);
  while (tally.random_cases() < asked.random) {
    const GrownShape s = random_integer_ellipse(random);
    const Vec2 near = support_point(s, random.direction());  // rounded to a grid: beside the boundary, on both sides
    const Vec2 q{std::round(near.x * 16.0) / 16.0, std::round(near.y * 16.0) / 16.0};
    const std::optional<Place> place = place_by_cgal(s, q, tally);
    if (place) tally.random(*place == locate(s, q), text_of(s, q));
  }
  while (tally.constructed_cases() < asked.constructed) {
    TangentCase c = random_tangent_ellipse(random);
    const auto& e = std::get<Ellipse>(c.s.shape);
    if (e.l11 == 0.0 || e.l22 == 0.0 || c.s.radius == 0.0) continue;
    Vec2 q = c.touch;
    if (random.integer(0, 2) == 0) q.x = std::nextafter(q.x, random.integer(0, 1) == 0 ? -1e300 : 1e300);
    const std::optional<Place> place = place_by_cgal(c.s, q, tally);
    if (!place) continue;
    if (*place == Place::boundary) tally.at_a_contact();
    tally.constructed(*place == locate(c.s, q), text_of(c.s, q));
  }
  return tally;
}

}  // namespace exactvo::test
