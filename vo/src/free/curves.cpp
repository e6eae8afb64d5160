// SPDX-License-Identifier: GPL-3.0-or-later
#include "free/curves.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace exactvo::vo::detail {
namespace {

/// What no filter accepts.
const CORE::filteredFp kUnfiltered(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                                   1);

/// The logarithm of a double that is not 0 is more.
constexpr long kLeastLogarithm = -1100;

CORE::Expr expression(const Rational& x) {
  const double rounded = x.get_d();
  if (Rational(rounded) == x) return CORE::Expr(rounded);
  return CORE::Expr(CORE::BigRat(x.get_mpq_t()));
}

}  // namespace

Number::Number(const Rational& x) : value_(expression(x)) {}

Rational Number::approximate(int bits) const {
  value_.approx(CORE::extLong::getPosInfty(), CORE::extLong(bits));
  return Rational(value_.BigRatValue().get_mp());
}

// The true value lies within |v| of v, and so within 2 |v|: such a filter decides nothing here, and is right about what
// is computed from it.
Number Number::filtered(const CORE::Expr& value) {
  Number out;
  out.value_ = value;
  CORE::filteredFp& filter = out.value_.Rep()->ffVal;
  const double v = std::fabs(filter.getValue());
  if (v > 0.0 && filter.isOK() && filter.lMSB() < CORE::extLong(kLeastLogarithm))
    filter = CORE::filteredFp(filter.getValue(), 2.0 * v / CORE_EPS, 1);
  return out;
}

Number quotient(const Number& a, const Number& b) {
  CORE::filteredFp& filter = b.value_.Rep()->ffVal;
  if (filter.getValue() == 0.0) filter = kUnfiltered;
  return Number::filtered(a.value_ / b.value_);
}

Number root_of(const Number& x) {
  CORE::filteredFp& filter = x.value_.Rep()->ffVal;
  if (filter.getValue() < 0.0) filter = kUnfiltered;
  return Number::filtered(sqrt(x.value_));
}

namespace {

Rational square(const Rational& x) {
  return x * x;
}

Curve line_through(ArcKind kind, const Point& anchor, const Point& direction) {
  Curve line;
  line.kind = kind;
  line.anchor = anchor;
  line.direction = direction;
  return line;
}

Curve arc(ArcKind kind, const Circle& circle, const Point& from, const Point& to, bool is_counter_clockwise) {
  Curve out = line_through(kind, from, to - from);
  out.is_arc = true;
  out.is_counter_clockwise = is_counter_clockwise;
  out.circle = circle;
  out.from = from;
  out.to = to;
  return out;
}

Curve segment(ArcKind kind, const Point& from, const Point& to, const RationalVector& direction) {
  Curve out = line_through(kind, from, point(direction));
  out.from = from;
  out.to = to;
  return out;
}

// --- A cone ---

/// The counter-clockwise hull, corners only.
std::vector<RationalVector> hull_of(std::vector<RationalVector> points) {
  const auto before = [](const RationalVector& a, const RationalVector& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  };
  const auto same = [](const RationalVector& a, const RationalVector& b) { return a.x == b.x && a.y == b.y; };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  if (points.size() < 3) return points;
  std::vector<RationalVector> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t first = hull.size();
    for (const RationalVector& p : points) {
      while (hull.size() >= first + 2 && sgn(cross(hull.back() - hull[hull.size() - 2], p - hull.back())) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

RationalVector outward_normal(const RationalVector& from, const RationalVector& to) {
  return {to.y - from.y, from.x - to.x};
}

/// The corners whose discs the front runs over, from the left leg's to the right leg's. Between them are the edges
/// that face the robot: h(N) < 0. Without such the front is part of one disc, that of the corner nearest the robot.
std::vector<RationalVector> front_of(const std::vector<RationalVector>& hull, const Rational& radius) {
  const std::size_t n = hull.size();
  const auto corner = [&](std::size_t i) -> const RationalVector& { return hull[i % n]; };
  const auto faces = [&](std::size_t i) {
    const RationalVector normal = outward_normal(corner(i), corner(i + 1));
    return n > 1 && sign_with_roots(dot(normal, corner(i)), 0, square(radius) * dot(normal, normal)) < 0;
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (!faces(i) || faces(i + n - 1)) continue;
    std::vector<RationalVector> front{corner(i)};
    for (std::size_t k = i; faces(k); ++k) front.push_back(corner(k + 1));
    return front;
  }
  return {
      *std::min_element(hull.begin(), hull.end(), [](const auto& a, const auto& b) { return dot(a, a) < dot(b, b); })};
}

/// The exact root of a polynomial of degree 1 or 2: of the two the one in the interval.
Number number_of(const Root& given) {
  const Root root = settled(given);
  if (root.is_settled()) return Number(root.low);
  const Rational c(root.f[0]), b(root.f[1]), a(root.f[2]);  // a > 0, so that the sign at the upper end tells which
  const Number half(Rational(b / (2 * a))), rest = root_of(Number(Rational(square(b / (2 * a)) - c / a)));
  return sign_at(root.f, root.high) > 0 ? rest - half : -rest - half;
}

Point vector_of(const AlgebraicDirection& d) {
  const Number t = number_of(value_of(d).slope);
  const Number one(1.0);
  const Point all[] = {{one, t}, {-t, one}, {-one, -t}, {t, -one}};
  return all[d.quarter_turns()];
}

/// What of a cone is needed: in velocities, relative to the apex.
class ConeCurves {
 public:
  ConeCurves(const ShiftedCone& cone, const ExactSum& body)
      : apex_(apex_of(cone)),
        scale_(std::isfinite(cone.cone.time_horizon()) ? Rational(1 / Rational(cone.cone.time_horizon()))
                                                       : Rational(0)),
        radius_(body.body.radius),
        front_(front_of(hull_of(body.centres), radius_)) {}

  std::vector<Curve> all(const ExactLegs& legs) const {
    const Point left = vector_of(legs.left), right = vector_of(legs.right);
    std::vector<Point> stops{touch(left, front_.front())};
    for (std::size_t i = 0; i + 1 < front_.size(); ++i) {
      stops.push_back(offset(front_[i], front_[i], front_[i + 1]));
      stops.push_back(offset(front_[i + 1], front_[i], front_[i + 1]));
    }
    stops.push_back(touch(right, front_.back()));
    std::vector<Curve> out{leg(Number(-1) * right, stops.back(), true)};
    if (sgn(scale_) != 0) add_front(stops, out);
    out.push_back(leg(left, stops.front(), false));
    return out;
  }

 private:
  static RationalVector apex_of(const ShiftedCone& cone) {
    RationalVector apex{0, 0};
    for (const Vec2 m : cone.minus_apex.terms) apex = apex - RationalVector{Rational(m.x), Rational(m.y)};
    return apex;
  }
  /// Where the leg touches the disc round a corner: the corner's foot on it.
  Point touch(const Point& direction, const RationalVector& corner) const {
    const Point v = point(corner);
    return point(apex_) + quotient(Number(scale_) * dot(v, direction), dot(direction, direction)) * direction;
  }
  /// The corner, moved out along the normal of an edge.
  Point offset(const RationalVector& corner, const RationalVector& from, const RationalVector& to) const {
    const RationalVector normal = outward_normal(from, to);
    const Point centre = point(apex_ + scale_ * corner);
    if (sgn(radius_) == 0) return centre;
    return centre + quotient(Number(Rational(scale_ * radius_)), root_of(Number(dot(normal, normal)))) * point(normal);
  }
  Curve leg(const Point& direction, const Point& touch, bool inward) const {
    Curve out = line_through(ArcKind::leg, point(apex_), direction);
    (inward ? out.has_from : out.has_to) = false;
    (inward ? out.to : out.from) = touch;
    return out;
  }
  /// From right to left: an arc round each corner, an edge between two.
  void add_front(const std::vector<Point>& stops, std::vector<Curve>& out) const {
    for (std::size_t i = front_.size(); i-- > 0;) {
      const Circle circle{apex_ + scale_ * front_[i], scale_ * radius_};
      if (sgn(radius_) != 0) out.push_back(arc(ArcKind::cut_off_arc, circle, stops[2 * i + 1], stops[2 * i], false));
      if (i > 0)
        out.push_back(segment(ArcKind::offset_edge, stops[2 * i], stops[2 * i - 1], front_[i - 1] - front_[i]));
    }
  }

  RationalVector apex_;
  Rational scale_, radius_;
  std::vector<RationalVector> front_;
};

// --- Common points ---

bool are_parallel(const Curve& a, const Curve& b) {
  return cross(a.direction, b.direction).sign() == 0;
}

std::vector<Point> of_circles(const Circle& a, const Circle& b) {
  const RationalVector between = b.centre - a.centre;
  const Rational d2 = dot(between, between);
  if (sgn(d2) == 0) return {};
  const Rational along = (d2 + square(a.radius) - square(b.radius)) / (2 * d2);
  const Rational height2 = square(a.radius) / d2 - square(along);  // both of |between|
  if (sgn(height2) < 0) return {};
  const Point foot = point(a.centre + along * between);
  if (sgn(height2) == 0) return {foot};
  const Point across = root_of(Number(height2)) * perp(point(between));
  return {foot - across, foot + across};
}

std::vector<Point> of_line_and_circle(const Curve& line, const Circle& circle) {
  const Point to_line = line.anchor - point(circle.centre);
  const Number a = dot(line.direction, line.direction), b = dot(to_line, line.direction);
  const Number rest = b * b - a * (dot(to_line, to_line) - Number(square(circle.radius)));
  const int sign = rest.sign();
  if (sign < 0) return {};
  if (sign == 0) return {line.anchor + quotient(-b, a) * line.direction};
  const Number root = root_of(rest);
  return {line.anchor + quotient(-b - root, a) * line.direction, line.anchor + quotient(root - b, a) * line.direction};
}

}  // namespace

Point point(const RationalVector& v) {
  return {Number(v.x), Number(v.y)};
}

bool Curve::reaches(const Point& x) const {
  if (is_arc) return is_counter_clockwise ? side(x) <= 0 : side(x) >= 0;
  if (has_from && position(x) < position(from)) return false;
  return !has_to || position(x) <= position(to);
}

Rational Curve::curvature() const {
  if (!is_arc) return 0;
  return Rational(is_counter_clockwise ? 1 : -1) / circle.radius;
}

bool Owner::allows(const Point& x) const {
  const auto within = [&x](const Circle& circle) {
    const Point from_centre = x - point(circle.centre);
    return (dot(from_centre, from_centre) - Number(square(circle.radius))).sign() < 0;
  };
  if (kind == Kind::disc) return within(disc);
  if (kind == Kind::half_plane) return curves.front().side(x) > 0;
  if (kind == Kind::ray) return true;
  // A cone is what lies on the right of all its lines and chords, and the discs beyond the chords.
  return std::any_of(curves.begin(), curves.end(),
                     [&](const Curve& c) { return c.side(x) > 0 && !(c.is_arc && within(c.circle)); });
}

Owner speed_disc(double max_speed) {
  const Rational v(max_speed);
  const Circle circle{{0, 0}, v};
  const Point right = point({v, 0}), left = point({-v, 0});
  return {
      Owner::Kind::disc,
      circle,
      {arc(ArcKind::speed_circle, circle, right, left, true), arc(ArcKind::speed_circle, circle, left, right, true)}};
}

Owner allowed_by(const HalfPlane& h) {
  const RationalVector n{Rational(h.normal.x), Rational(h.normal.y)};
  const Rational away = Rational(h.offset) / dot(n, n);
  Curve line = line_through(ArcKind::leg, point({away * n.x, away * n.y}), point({n.y, -n.x}));
  line.has_from = line.has_to = false;
  return {Owner::Kind::half_plane, {}, {line}};
}

Owner outside_of(const ShiftedCone& cone) {
  const ExactSum body = exact_sum(cone.cone);
  const ExactLegs legs = legs_of(body);
  const bool is_ray = compare(legs.left, legs.right) == geometry::Sign::zero;
  return {is_ray ? Owner::Kind::ray : Owner::Kind::cone, {}, ConeCurves(cone, body).all(legs)};
}

bool coincide(const Curve& a, const Curve& b) {
  if (a.is_arc != b.is_arc) return false;
  if (a.is_arc)
    return a.circle.radius == b.circle.radius && a.circle.centre.x == b.circle.centre.x &&
           a.circle.centre.y == b.circle.centre.y;
  return are_parallel(a, b) && a.side(b.anchor) == 0;
}

std::vector<Point> common_points(const Curve& a, const Curve& b) {
  if (a.is_arc && b.is_arc) return of_circles(a.circle, b.circle);
  if (a.is_arc) return of_line_and_circle(b, a.circle);
  if (b.is_arc) return of_line_and_circle(a, b.circle);
  if (are_parallel(a, b)) return {};
  const Number along = quotient(cross(b.anchor - a.anchor, b.direction), cross(a.direction, b.direction));
  return {a.anchor + along * a.direction};
}

}  // namespace exactvo::vo::detail
