// SPDX-License-Identifier: GPL-3.0-or-later
// The numbered properties of algebraic_direction.h, and legs that are known.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exactvo/vo/family.h"
#include "vo/half_plane_audit.h"

namespace exactvo::test {
namespace {

using geometry::ConvexPolygon;
using geometry::Disc;
using geometry::Ellipse;
using geometry::GrownShape;
using geometry::Segment;
using geometry::Sign;
using geometry::Vec2;
using vo::AlgebraicDirection;
using vo::ExactLegs;
using vo::VelocityObstacle;
using Rational = mpq_class;

ExactLegs legs_of(const geometry::ConvexShape& shape, Vec2 at = {}, double radius = 0.0) {
  return *VelocityObstacle(shape, at, radius, 1.0).exact_legs();
}

GrownShape scaled_by(GrownShape s, double f) {
  if (auto* d = std::get_if<Disc>(&s.shape)) *d = {f * d->center, f * d->radius};
  if (auto* w = std::get_if<Segment>(&s.shape)) *w = {f * w->a, f * w->b};
  if (auto* e = std::get_if<Ellipse>(&s.shape)) *e = {f * e->center, f * e->l11, f * e->l21, f * e->l22};
  if (auto* p = std::get_if<ConvexPolygon>(&s.shape))
    for (Vec2& v : p->vertices) v = f * v;
  return {s.shape, f * s.origin, f * s.radius};
}

int sign_at(const AlgebraicDirection& a, const std::string& x) {
  const Rational t(x);
  Rational value = 0;
  const std::vector<std::string> f = a.polynomial();
  for (std::size_t i = f.size(); i-- > 0;) value = value * t + Rational(f[i]);
  return sgn(value);
}

std::vector<AlgebraicDirection> random_legs(SeededRandom& random, int scenes) {
  std::vector<AlgebraicDirection> out;
  for (int i = 0; i < scenes; ++i) {
    const GrownShape s = random_scene(random, kKinds[i % 4]).s;
    const auto legs = velocity_obstacle(s, 1.0).exact_legs();
    if (legs) out.insert(out.end(), {legs->left, legs->right});
  }
  return out;
}

TEST(ExactLegs, ADiscOfKnownSlopes) {
  // Radius 1 at distance 2: slopes +-1/sqrt(3), roots of 3 t^2 - 1.
  const ExactLegs legs = legs_of(Disc{{2.0, 0.0}, 0.75}, {}, 0.25);
  EXPECT_EQ(legs.left.polynomial(), (std::vector<std::string>{"-1", "0", "3"}));
  EXPECT_EQ(legs.right.polynomial(), legs.left.polynomial());
  EXPECT_EQ(legs.left.quarter_turns(), 0);
  EXPECT_NE(legs.left.low(), legs.left.high());
  EXPECT_NEAR(legs.left.rounded().y, 0.5, 1e-15);
  EXPECT_NEAR(legs.right.rounded().y, -0.5, 1e-15);
  EXPECT_EQ(compare(legs.right, legs.left), Sign::negative);
}

TEST(ExactLegs, ARationalRootIsKnown) {
  // Radius 3 at distance 5: slopes +-3/4.
  const ExactLegs legs = legs_of(Disc{{5.0, 0.0}, 3.0});
  EXPECT_EQ(legs.left.low(), legs.left.high());
  EXPECT_EQ(legs.left.low(), "3/4");
  EXPECT_EQ(legs.right.high(), "-3/4");
  EXPECT_EQ(legs.right.polynomial(), (std::vector<std::string>{"3", "4"}));
}

TEST(ExactLegs, CornersOfAPolygon) {
  const ConvexPolygon square{{{2.0, -1.0}, {4.0, -1.0}, {4.0, 1.0}, {2.0, 1.0}}};
  const ExactLegs legs = legs_of(square);
  EXPECT_EQ(compare(legs.left, AlgebraicDirection(Vec2{2.0, 1.0})), Sign::zero);
  EXPECT_EQ(compare(legs.right, AlgebraicDirection(Vec2{2.0, -1.0})), Sign::zero);
  const VelocityObstacle seen_by_a_square(square, {}, ConvexPolygon{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}}, 1.0);
  EXPECT_EQ(compare(seen_by_a_square.exact_legs()->left, AlgebraicDirection(Vec2{1.0, 2.0})), Sign::zero);
}

TEST(ExactLegs, EveryAxisAndDiagonal) {
  // A leg along each axis, of a disc that touches it, and along each diagonal, of a point: the ends of the quarters.
  for (int k = 0; k < 8; ++k) {
    Vec2 d = k % 2 == 0 ? Vec2{1.0, 0.0} : Vec2{1.0, 1.0};
    for (int q = 0; q < k / 2; ++q) d = perp(d);
    const AlgebraicDirection expected(d);
    const double r = k % 2 == 0 ? 1.0 : 0.0;
    const Vec2 centre = 5.0 * d - r * perp(d);
    EXPECT_EQ(compare(legs_of(Disc{centre, r}).left, expected), Sign::zero) << k;
    EXPECT_EQ(compare(legs_of(Ellipse{centre, 0.5 * r, 0.0, -0.5 * r}, {}, 0.5 * r).left, expected), Sign::zero) << k;
    EXPECT_EQ(expected.quarter_turns(), (k / 2) % 4);
    EXPECT_EQ(turn(expected, d), Sign::zero);
    EXPECT_EQ(along(expected, d), Sign::positive);
  }
}

TEST(ExactLegs, AnEllipseBesideAnAxis) {
  // Half axes 3 and 1 (+) disc 1, its top on the axis: a root of degree 4 that is 0.
  const ExactLegs legs = legs_of(Ellipse{{8.0, -2.0}, 3.0, 0.0, 1.0}, {}, 1.0);
  EXPECT_EQ(compare(legs.left, AlgebraicDirection(Vec2{1.0, 0.0})), Sign::zero);
  EXPECT_EQ(turn(legs.left, Vec2{4.0, 0.0}), Sign::zero);
  EXPECT_EQ(along(legs.left, Vec2{0.0, 1.0}), Sign::zero);
  EXPECT_EQ(legs.right.polynomial().size(), 5u);
}

TEST(ExactLegs, Property1_ThePolynomialChangesItsSign) {
    SeededRandom random(seed_of_run(701));
  int irrational = 0;
  for (const AlgebraicDirection& a : random_legs(random, 60)) {
    for (const AlgebraicDirection& b : {a, a.refined(0x1p-80)}) {
      if (b.low() == b.high()) {
        EXPECT_EQ(sign_at(b, b.low()), 0);
      } else {
                EXPECT_EQ(sign_at(b, b.low()) * sign_at(b, b.high()), -1);
        ++irrational;
      }
      EXPECT_LE(b.polynomial().size(), 5u);
    }
  }
  EXPECT_GT(irrational, 60);
}

/// What `rounded` promises of each coordinate: 4 ulps of 1.
constexpr double kCoordinate = 4.0 * 0x1p-52;

TEST(ExactLegs, Property2_TheOrderIsThatOfTheAngles) {
  SeededRandom random(seed_of_run(702));
  std::vector<AlgebraicDirection> all = random_legs(random, 40);
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return compare(a, b) == Sign::negative; });
  // -0 becomes 0, so that (-1, 0) is at pi.
  const auto angle = [](const AlgebraicDirection& a) { return std::atan2(a.rounded().y + 0.0, a.rounded().x); };
  // Two angles: each is off by the way of its unit vector, sqrt(2) coordinates, and by an ulp of atan2, 2^-51 near pi.
  constexpr double kRounded = 2.0 * (1.415 * kCoordinate + 0x1p-51);
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    EXPECT_LE(angle(all[i]), angle(all[i + 1]) + kRounded);
    EXPECT_EQ(compare(all[i], all[i]), Sign::zero);
  }
  const AlgebraicDirection behind(Vec2{-1.0, 0.0}), below(Vec2{-1.0, -0x1p-60});
  EXPECT_EQ(compare(below, behind), Sign::negative) << "pi is the last angle";
}

TEST(ExactLegs, Property3_TurnsAreSignsOfCrossProducts) {
  SeededRandom random(seed_of_run(703));
  const std::vector<AlgebraicDirection> all = random_legs(random, 24);
  // Two unit vectors, each off by sqrt(2) coordinates; two products and a difference round by less than 2^-51.
  constexpr double kCross = 2.0 * 1.415 * kCoordinate + 0x1p-51;
    int decided = 0;
  for (const AlgebraicDirection& a : all) {
    for (const AlgebraicDirection& b : all) {
      EXPECT_EQ(static_cast<int>(turn(a, b)), -static_cast<int>(turn(b, a)));
      const double rounded = cross(a.rounded(), b.rounded());
      if (std::fabs(rounded) > kCross) {
        EXPECT_EQ(turn(a, b), rounded > 0 ? Sign::positive : Sign::negative);
        ++decided;
      }
    }
    const Vec2 v = random.direction();
    EXPECT_EQ(turn(a, v), turn(a, AlgebraicDirection(v)));
        EXPECT_EQ(along(a, v), turn(a, perp(v))) << "a.v is the cross product of a and v turned by a quarter";
  }
  EXPECT_GT(decided, 400);
}

TEST(ExactLegs, Property4_TheCertifiedBracketHoldsThem) {
  SeededRandom random(seed_of_run(704));
  int seen = 0;
  for (int i = 0; i < 400; ++i) {
    const GrownShape s = random_scene(random, kKinds[i % 4]).s;
    const VelocityObstacle cone = velocity_obstacle(s, 1.0);
    const auto rounded = cone.legs();
    const auto exact = cone.exact_legs();
    if (!rounded || !exact) continue;
    ++seen;
    // The normal's end of the safe side lies on or beyond the leg's own, the other one within: a left leg's direction
    // is its normal turned by -90 degrees.
    EXPECT_NE(turn(exact->left, -perp(rounded->left.normal)), Sign::negative) << text_of(s, 1.0, {});
    EXPECT_EQ(turn(exact->left, -perp(rounded->left.normal_outside)), Sign::negative) << text_of(s, 1.0, {});
    EXPECT_NE(turn(exact->right, perp(rounded->right.normal)), Sign::positive) << text_of(s, 1.0, {});
    EXPECT_EQ(turn(exact->right, perp(rounded->right.normal_outside)), Sign::positive) << text_of(s, 1.0, {});
    EXPECT_EQ(turn(exact->right, exact->left), Sign::positive);
  }
  EXPECT_GT(seen, 350);
}

TEST(ExactLegs, Property4_AlsoWithinUlpsOfContact) {
  const GrownShape s{Disc{{2.0, 0.0}, 1.0}, {}, std::nextafter(1.0, 0.0)};
  const auto legs = velocity_obstacle(s, 1.0).exact_legs();
  ASSERT_TRUE(legs);
  EXPECT_EQ(turn(legs->right, legs->left), Sign::positive);
  EXPECT_EQ(legs->left.quarter_turns(), 1);
  EXPECT_EQ(along(legs->left, Vec2{1.0, 0.0}), Sign::positive) << "less than a quarter turn off the axis, by 2^-26";
  EXPECT_FALSE(velocity_obstacle({Disc{{2.0, 0.0}, 1.0}, {}, 1.0}, 1.0).exact_legs()) << "contact has no cone";
}

TEST(ExactLegs, Property5_RefinedIsTheSame) {
  SeededRandom random(seed_of_run(705));
  for (const AlgebraicDirection& a : random_legs(random, 24)) {
    const AlgebraicDirection b = a.refined(0x1p-200);
    EXPECT_EQ(compare(a, b), Sign::zero);
    const Rational width = Rational(b.high()) - Rational(b.low());
    EXPECT_LE(width, Rational(0x1p-200));
    EXPECT_GE(Rational(b.low()), Rational(-1));
  }
}

TEST(ExactLegs, Property6_ScalesByPowersOfTwo) {
    SeededRandom random(seed_of_run(706));
  int judged = 0;
  for (int i = 0; i < 40; ++i) {
    const GrownShape s = random_scene(random, kKinds[i % 4]).s;
    const auto legs = velocity_obstacle(s, 1.0).exact_legs();
    const auto scaled = velocity_obstacle(scaled_by(s, 0x1p-20), 1.0).exact_legs();
    ASSERT_EQ(legs.has_value(), scaled.has_value());
    if (!legs) continue;
    EXPECT_EQ(compare(legs->left, scaled->left), Sign::zero);
        EXPECT_EQ(compare(legs->right, scaled->right), Sign::zero);
    ++judged;
  }
  EXPECT_GT(judged, 20);
}

TEST(ExactLegs, TwoConesThatShareALegKnowIt) {
  // Discs along one line through the robot that touch it from either side, and from the same side.
  SeededRandom random(seed_of_run(707));
  for (int i = 0; i < 60; ++i) {
    const Pythagorean n = random_pythagorean(random);
    const Vec2 along{-n.q, n.p}, normal{n.p, n.q};
    const double near = random.integer(1, 6), far = random.integer(7, 20);
    const auto disc = [&](double distance, double radius) {
      return Disc{distance * along + radius * normal, std::fabs(radius) * n.h};
    };
    const double r1 = 0.25 * random.integer(1, 3), r2 = 0.25 * random.integer(1, 9);
    const ExactLegs one = legs_of(disc(near, r1)), other = legs_of(disc(far, -r2)), same = legs_of(disc(far, r2));
    // The first disc lies on the line's side of `normal`, which is to its right.
    EXPECT_EQ(compare(one.left, other.right), Sign::zero) << i;
    EXPECT_EQ(compare(one.left, same.left), Sign::zero) << i;
    EXPECT_EQ(turn(one.left, along), Sign::zero) << i;
    const Disc beside{disc(far, r2).center, std::nextafter(disc(far, r2).radius, 0.0)};
    EXPECT_EQ(turn(one.left, legs_of(beside).left), Sign::negative) << "one ulp less";
  }
}

TEST(ExactLegs, IrrationalLegsAreSharedToo) {
  // The same tangents: of a disc, of one twice as far and as large, and of its mirror image as an ellipse and a disc.
  const ExactLegs one = legs_of(Disc{{3.0, 1.0}, 1.5}), twice = legs_of(Disc{{6.0, 2.0}, 2.5}, {}, 0.5);
  EXPECT_EQ(compare(one.left, twice.left), Sign::zero);
  EXPECT_EQ(compare(one.right, twice.right), Sign::zero);
  const ExactLegs mirrored = legs_of(Ellipse{{-3.0, -1.0}, 1.0, 0.0, 1.0}, {}, 0.5);
  EXPECT_EQ(turn(one.left, mirrored.left), Sign::zero);
  EXPECT_NE(compare(one.left, mirrored.left), Sign::zero);
  // The tangents of slope 1/sqrt(3) again, as roots of 3 t^2 - 1 and of a polynomial of degree 4.
  const ExactLegs round = legs_of(Disc{{2.0, 0.0}, 1.0}), flat = legs_of(Ellipse{{8.0, 0.0}, 1.0, 0.0, 4.0}, {}, 0.5);
  EXPECT_EQ(flat.left.polynomial().size(), 5u);
  EXPECT_EQ(compare(round.left, flat.left), Sign::zero);
  EXPECT_EQ(compare(round.right, flat.right), Sign::zero);
  EXPECT_EQ(turn(round.left, legs_of(Ellipse{{8.0, 0.0}, 1.0, 0.0, 4.0}, {}, std::nextafter(0.5, 1.0)).left),
            Sign::positive);
}

TEST(ExactLegs, NearlyDoubleRootsAreToldApart) {
  // A needle seen end on: the quartic's four roots lie within its width.
  for (const double width : {0x1p-10, 0x1p-30, 0x1p-100}) {
    for (const double radius : {0.0, 0x1p-60, 0x1p-120}) {
      const ExactLegs legs = legs_of(Ellipse{{4.0, 0.0}, 1.0, 0.0, width}, {}, radius);
      EXPECT_EQ(turn(legs.right, legs.left), Sign::positive);
      EXPECT_EQ(turn(legs.left, Vec2{1.0, 0.0}), Sign::negative);
      EXPECT_EQ(turn(legs.right, Vec2{1.0, 0.0}), Sign::positive);
    }
  }
}

TEST(ExactLegs, SegmentsAsFlatEllipses) {
  // A capsule as an ellipse of no width, along both axes, and as the segment that it is.
  const ExactLegs segment = legs_of(Segment{{2.0, -1.0}, {4.0, 3.0}}, {}, 0.5);
  const ExactLegs flat = legs_of(Ellipse{{3.0, 1.0}, 1.0, 2.0, 0.0}, {}, 0.5);
  EXPECT_EQ(compare(segment.left, flat.left), Sign::zero);
  EXPECT_EQ(compare(segment.right, flat.right), Sign::zero);
  const ExactLegs upright = legs_of(Segment{{3.0, -4.0}, {3.0, 6.0}}, {}, 0.5);
  const ExactLegs narrow = legs_of(Ellipse{{3.0, 1.0}, 0.0, 3.0, 4.0}, {}, 0.5);
  EXPECT_EQ(compare(upright.left, narrow.left), Sign::zero);
  EXPECT_EQ(compare(upright.right, narrow.right), Sign::zero);
}

TEST(ExactLegs, MistakesAreNamed) {
  EXPECT_THROW(AlgebraicDirection(Vec2{}), std::logic_error);
  EXPECT_THROW(AlgebraicDirection(Vec2{std::nan(""), 1.0}), std::logic_error);
  EXPECT_THROW(AlgebraicDirection(Vec2{1.0, 1.0}).refined(0.0), std::logic_error);
}

}  // namespace
}  // namespace exactvo::test
