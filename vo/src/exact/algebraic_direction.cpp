// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/algebraic_direction.h"

#include <cmath>
#include <utility>

#include "exact/algebraic_value.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::vo {
namespace detail {
namespace {

/// The sign of alpha + beta t.
int linear_sign(const Root& t, const Rational& alpha, const Rational& beta) {
  if (sgn(beta) == 0) return sgn(alpha);
  return sgn(beta) * compare(t, Rational(-alpha / beta));
}

/// The quarters in the order of angles in (-pi, pi]: the third is cut in two by the angle pi.
int place_in_turn(const AlgebraicValue& a) {
  if (a.quarter_turns == 3) return -1;
  if (a.quarter_turns == 2 && compare(a.slope, Rational(0)) > 0) return -2;
  return a.quarter_turns;
}

}  // namespace

RationalVector turned(const RationalVector& v, int k) {
  const int turns = ((k % 4) + 4) % 4;
  if (turns == 1) return {-v.y, v.x};
  if (turns == 2) return {-v.x, -v.y};
  return turns == 3 ? RationalVector{v.y, -v.x} : v;
}

AlgebraicDirection direction_of(Root slope, int quarter_turns) {
  return AlgebraicAccess::direction({std::move(slope), quarter_turns % 4});
}

AlgebraicDirection direction_of(const RationalVector& v) {
  int k = 0;
  RationalVector w = v;
  while (!(sgn(w.x) > 0 && -w.x < w.y && w.y <= w.x)) w = turned(v, -++k);
  return direction_of(rational_root(w.y / w.x), k);
}

}  // namespace detail

using detail::value_of;
using geometry::Sign;
using geometry::Vec2;

namespace {

detail::RationalVector checked(Vec2 v) {
  EXACTVO_REQUIRE(geometry::is_finite(v), geometry::hex_text(v.x) + " " + geometry::hex_text(v.y));
  return {detail::Rational(v.x), detail::Rational(v.y)};
}

detail::RationalVector checked_direction(Vec2 v) {
  EXACTVO_REQUIRE(v != Vec2{}, "a direction of the zero vector");
  return checked(v);
}

}  // namespace

AlgebraicDirection::AlgebraicDirection(std::shared_ptr<const detail::AlgebraicValue> value)
    : value_(std::move(value)) {}

AlgebraicDirection::AlgebraicDirection(Vec2 v) : AlgebraicDirection(detail::direction_of(checked_direction(v))) {}

std::vector<std::string> AlgebraicDirection::polynomial() const {
  std::vector<std::string> out;
  for (const detail::Integer& c : value_->slope.f) out.push_back(c.get_str());
  return out;
}

std::string AlgebraicDirection::low() const {
  return value_->slope.low.get_str();
}
std::string AlgebraicDirection::high() const {
  return value_->slope.high.get_str();
}
int AlgebraicDirection::quarter_turns() const {
  return value_->quarter_turns;
}

AlgebraicDirection AlgebraicDirection::refined(double width) const {
  EXACTVO_REQUIRE(width > 0.0 && std::isfinite(width), geometry::hex_text(width));
  detail::Root slope = value_->slope;
  while (!slope.is_settled() && slope.high - slope.low > detail::Rational(width)) detail::halve(slope);
  return detail::direction_of(std::move(slope), value_->quarter_turns);
}

Vec2 AlgebraicDirection::rounded() const {
  constexpr double kBelowAnUlp = 0x1p-56;  // of 1: the slope's part in the coordinates
  const double t = refined(kBelowAnUlp).value_->slope.high.get_d();
  const double length = std::sqrt(1.0 + t * t);
  const Vec2 v{1.0 / length, t / length};
  const Vec2 all[] = {v, perp(v), -v, -perp(v)};
  return all[value_->quarter_turns];
}

Sign compare(const AlgebraicDirection& a, const AlgebraicDirection& b) {
  const int quarter_a = detail::place_in_turn(value_of(a)), quarter_b = detail::place_in_turn(value_of(b));
  if (quarter_a != quarter_b) return quarter_a < quarter_b ? Sign::negative : Sign::positive;
  return static_cast<Sign>(compare(value_of(a).slope, value_of(b).slope));
}

// A quarter reaches over an eighth of a turn to both sides, its upper end included: from anywhere in one, all of the
// next quarter lies less than half a turn ahead, all of the one before less than half a turn behind.
Sign turn(const AlgebraicDirection& a, const AlgebraicDirection& b) {
  const int ahead = (b.quarter_turns() - a.quarter_turns() + 4) % 4;
  if (ahead == 1) return Sign::positive;
  if (ahead == 3) return Sign::negative;
  const int by_slope = compare(value_of(b).slope, value_of(a).slope);
  return static_cast<Sign>(ahead == 0 ? by_slope : -by_slope);
}

Sign turn(const AlgebraicDirection& a, Vec2 v) {
  const detail::RationalVector w = detail::turned(checked(v), -a.quarter_turns());
  return static_cast<Sign>(detail::linear_sign(value_of(a).slope, w.y, -w.x));
}

Sign along(const AlgebraicDirection& a, Vec2 v) {
  const detail::RationalVector w = detail::turned(checked(v), -a.quarter_turns());
  return static_cast<Sign>(detail::linear_sign(value_of(a).slope, w.x, w.y));
}

}  // namespace exactvo::vo
