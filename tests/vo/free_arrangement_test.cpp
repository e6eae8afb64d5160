// SPDX-License-Identifier: GPL-3.0-or-later
// The numbered properties of free_arrangement.h, areas that are known, and what touches.
#include "exactvo/vo/free_arrangement.h"
#include "exactvo/geometry/infinity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/vo/free_velocities.h"
#include "vo/half_plane_audit.h"

namespace exactvo::test {
namespace {

using geometry::Disc;
using geometry::kPi;
using geometry::Segment;
using geometry::Vec2;
using vo::ArcKind;
using vo::Encounter;
using vo::FreeArrangement;
using vo::FreeVelocities;
using vo::Inside;
using vo::ShiftedCone;
using vo::VelocityObstacle;

using geometry::kInfinity;
/// Rounding of an area of a few (m/s)^2 whose expected value takes some ten rounded operations.
constexpr double kRounded = 1e-14;

ShiftedCone cone_of(const geometry::ConvexShape& shape, double radius, double tau, Vec2 apex = {}) {
  return {VelocityObstacle(shape, {}, radius, tau), {{-apex}}, apex};
}

std::vector<ShiftedCone> random_cones(SeededRandom& random, int count, int first) {
  std::vector<ShiftedCone> cones;
  for (int i = first; static_cast<int>(cones.size()) < count; ++i) {
    Encounter e;
    e.radius = i % 4 == 0 ? 0.0 : random.uniform(0.1, 0.4);
    e.obstacle = random_shape(random, kKinds[i % 3], random.uniform(1.6, 4.0) * random.direction(), 1.0);
    e.obstacle_velocity = i % 3 == 0 ? random.in_box(0.7) : Vec2{};
    e.time_horizon = i % 5 == 0 ? kInfinity : random.uniform(0.5, 4.0);
    if (i % 7 == 0) e.robot = random_convex_polygon(random, {}, 0.3, 5);
    const auto cone = vo::family_member(vo::Variant::vo, e).cone;
    if (cone) cones.push_back(*cone);
  }
  return cones;
}

int count(const FreeArrangement& free, ArcKind kind) {
  int n = 0;
  for (const vo::FreePiece& piece : free.pieces())
    for (const vo::FreeArc& arc : piece.boundary) n += arc.kind == kind ? 1 : 0;
  return n;
}

void expect_area(const FreeArrangement& free, double expected) {
  EXPECT_LE(free.area().low, expected + kRounded);
  EXPECT_GE(free.area().high, expected - kRounded);
  EXPECT_LT(free.area().high - free.area().low, kRounded);
}

TEST(FreeArrangement, NothingForbidsTheDisc) {
  const FreeArrangement free({}, 2.0);
  ASSERT_EQ(free.pieces().size(), 1u);
  expect_area(free, 4.0 * kPi);
  EXPECT_TRUE(free.contains({2.0, 0.0}));
  EXPECT_FALSE(free.contains({2.0, 0x1p-30}));
}

TEST(FreeArrangement, AWedgeAndACutOffOfKnownArea) {
  const FreeArrangement wedge({cone_of(Disc{{2.0, 0.0}, 0.75}, 0.25, kInfinity)}, 1.0);
  expect_area(wedge, kPi * 5.0 / 6.0);
  EXPECT_EQ(wedge.pieces().front().boundary.size(), 3u) << "an arc and two legs";
  const double r = 0.25, leg = std::sqrt(0.25 - r * r);
  const FreeArrangement truncated({cone_of(Disc{{2.0, 0.0}, 1.0}, 0.0, 4.0)}, 1.0);
  expect_area(truncated, kPi * 5.0 / 6.0 + leg * r - r * r * kPi / 3.0);
  EXPECT_EQ(count(truncated, ArcKind::cut_off_arc), 1);
}

TEST(FreeArrangement, AWallHasAnOffsetEdgeAndTwoArcs) {
  const FreeArrangement free({cone_of(Segment{{2.0, -1.0}, {2.0, 1.0}}, 0.5, 2.0)}, 2.0);
  EXPECT_EQ(count(free, ArcKind::offset_edge), 1);
  EXPECT_EQ(count(free, ArcKind::cut_off_arc), 2);
  EXPECT_EQ(count(free, ArcKind::leg), 2);
  EXPECT_EQ(count(free, ArcKind::speed_circle), 1);
  EXPECT_EQ(free.pieces().size(), 1u);
}

TEST(FreeArrangement, Properties12And3_WithinTheBounds) {
  SeededRandom random(seed_of_run(721));
  for (int i = 0; i < 16; ++i) {
    const std::vector<ShiftedCone> cones = random_cones(random, 1 + i % 6, i);
    const FreeArrangement free(cones, 1.5);
    const FreeVelocities bounds(cones, {1.5, 1e-3});
    EXPECT_LE(bounds.area().low, free.area().low) << i;
    EXPECT_GE(bounds.area().high, free.area().high) << i;
    EXPECT_GE(free.pieces().size(), bounds.least_components()) << i;
    const FreeArrangement fewer({cones.begin() + 1, cones.end()}, 1.5);
    EXPECT_LE(free.area().low, fewer.area().high) << i;
    for (int k = 0; k < 20; ++k) {
      const Vec2 v = random.in_box(1.5);
      EXPECT_EQ(free.contains(v), bounds.contains(v));
    }
  }
}

TEST(FreeArrangement, Property4_ArcsJoin) {
  SeededRandom random(seed_of_run(722));
  for (int i = 0; i < 12; ++i) {
    const FreeArrangement free(random_cones(random, 4, i), 1.5);
    for (const vo::FreePiece& piece : free.pieces()) {
      for (std::size_t k = 0; k < piece.boundary.size(); ++k) {
        const vo::PointBracket &end = piece.boundary[k].to,
                               &begin = piece.boundary[(k + 1) % piece.boundary.size()].from;
        EXPECT_EQ(end.x.low, begin.x.low);
        EXPECT_EQ(end.y.high, begin.y.high);
        EXPECT_LE(end.x.high - end.x.low, 1.5 * 0x1p-48);
      }
    }
  }
}

TEST(FreeArrangement, Property5_HalfPlanesAreJudgedAlike) {
  SeededRandom random(seed_of_run(723));
  int yes = 0, no = 0;
  for (int i = 0; i < 16; ++i) {
    const std::vector<ShiftedCone> cones = random_cones(random, 2, i);
    const FreeArrangement free(cones, 1.5);
    std::vector<geometry::HalfPlane> half_planes;
    for (const ShiftedCone& cone : cones) {
      geometry::HalfPlane h = *cone.cone.half_plane(-cone.apex);
      h.offset += dot(h.normal, cone.apex) + (i % 2 == 0 ? 0x1p-44 : -0.05);
      half_planes.push_back(h);
    }
    const Inside bounds = FreeVelocities(cones, {1.5, 1e-3}).compare(half_planes).inside;
    const bool exact = free.holds(half_planes);
    (exact ? yes : no) += 1;
    if (bounds != Inside::undecided) {
      EXPECT_EQ(exact, bounds == Inside::yes) << i;
    }
  }
  EXPECT_GT(yes, 4);
  EXPECT_GT(no, 4);
}

TEST(FreeArrangement, HalfPlanesAtTheExactLimit) {
  // The front of a disc of radius 1 at (3, 0), horizon 2, comes as near as (1, 0).
  const FreeArrangement free({cone_of(Disc{{3.0, 0.0}, 0.75}, 0.25, 2.0)}, 2.0);
  EXPECT_TRUE(free.holds({{{-1.0, 0.0}, -1.0}})) << "touching is no overlap of areas";
  EXPECT_FALSE(free.holds({{{-1.0, 0.0}, std::nextafter(-1.0, -2.0)}})) << "one ulp farther cuts in";
  EXPECT_FALSE(free.holds({}));
  EXPECT_TRUE(free.holds({{{1.0, 0.0}, 2.0}})) << "a region without area";
  EXPECT_TRUE(free.holds({{{0.0, 0.0}, 1.0}})) << "nothing is allowed";
  EXPECT_FALSE(free.holds({{{1.0, 0.0}, 1.99}})) << "all of it in the cone";
}

TEST(FreeArrangement, TwoDiscsThatTouchPinchWhatIsFree) {
  // Radius 1 at (3, 1) and (3, -1): they touch at (3, 0), the fronts at (1.5, 0); behind, the legs have crossed.
  const auto pair = [](double y) {
    return FreeArrangement({cone_of(Disc{{3.0, y}, 1.0}, 0.0, 2.0), cone_of(Disc{{3.0, -y}, 1.0}, 0.0, 2.0)}, 4.0);
  };
  EXPECT_EQ(pair(1.0).pieces().size(), 1u);
  EXPECT_GT(pair(std::nextafter(1.0, 0.0)).pieces().size(), 0u);
  // A gap of one ulp: still closed behind by the cones, and open to the front.
  EXPECT_EQ(pair(std::nextafter(1.0, 2.0)).pieces().size(), 1u);
  EXPECT_TRUE(pair(std::nextafter(1.0, 2.0)).contains({1.5, 0.0}));
  EXPECT_FALSE(pair(1.0).contains({1.5, 0.0}));
}

TEST(FreeArrangement, FrontsThatTouchPartThePieces) {
  // Two discs that come from opposite sides: apices shifted so that the fronts, circles of radius 1, touch at 0.
  const auto both = [](double shift) {
    return FreeArrangement({cone_of(Disc{{3.0, 0.0}, 1.0}, 0.0, 1.0, {-2.0 + shift, 0.0}),
                            cone_of(Disc{{-3.0, 0.0}, 1.0}, 0.0, 1.0, {2.0, 0.0})},
                           2.0);
  };
  EXPECT_EQ(both(0.0).pieces().size(), 2u) << "touching at a point parts them";
  EXPECT_EQ(both(0x1p-52).pieces().size(), 1u) << "a gap of one ulp joins them";
  EXPECT_EQ(both(-0x1p-52).pieces().size(), 2u);
  EXPECT_EQ(FreeVelocities(both(0.0).cones(), {2.0, 1e-3}).least_components(), 1u) << "what the bounds can say";
}

TEST(FreeArrangement, ConesThatShareALeg) {
  // Discs of radius 5 that touch the line along (4, 3) from its right, at 25 m, and from its left, at 50 m.
  const ShiftedCone right = cone_of(Disc{{20.0 + 3.0, 15.0 - 4.0}, 5.0}, 0.0, kInfinity);
  const ShiftedCone left = cone_of(Disc{{40.0 - 3.0, 30.0 + 4.0}, 5.0}, 0.0, kInfinity);
  const FreeArrangement two({right, left}, 1.0);
  EXPECT_EQ(two.pieces().size(), 1u);
  EXPECT_EQ(count(two, ArcKind::leg), 2) << "the shared one bounds nothing";
  expect_area(two, kPi - std::atan2(5.0, 25.0) - std::atan2(5.0, 50.0));
  // The same cone twice, and one within another along the leg.
  const ShiftedCone inner = cone_of(Disc{{40.0 + 3.0, 30.0 - 4.0}, 5.0}, 0.0, kInfinity);
  EXPECT_EQ(count(FreeArrangement({right, right}, 1.0), ArcKind::leg), 2);
  expect_area(FreeArrangement({right, inner}, 1.0), kPi - std::atan2(5.0, 25.0));
  // A horizon each: the shared leg begins at different points of it.
  const FreeArrangement truncated(
      {cone_of(Disc{{23.0, 11.0}, 5.0}, 0.0, 50.0), cone_of(Disc{{37.0, 34.0}, 5.0}, 0.0, 80.0)}, 1.0);
  EXPECT_EQ(truncated.pieces().size(), 1u);
  EXPECT_EQ(count(truncated, ArcKind::leg), 3) << "a stretch of the shared leg is bare";
}

TEST(FreeArrangement, AConeThatTouchesTheSpeedCircle) {
  // The front comes to (1, 0) from outside the unit circle; a wall's offset edge lies along x = 1.
  for (const geometry::ConvexShape& shape :
       {geometry::ConvexShape{Disc{{3.0, 0.0}, 1.0}}, geometry::ConvexShape{Segment{{2.5, -1.0}, {2.5, 1.0}}}}) {
    const double radius = std::holds_alternative<Disc>(shape) ? 0.0 : 0.5;
    const FreeArrangement free({cone_of(shape, radius, 2.0)}, 1.0);
    EXPECT_EQ(free.pieces().size(), 1u);
    expect_area(free, kPi);
    EXPECT_FALSE(free.contains({1.0, 0.0}));
  }
  // A front that is the speed's circle itself, bulging outward: the disc lies in the cone.
  const FreeArrangement whole({cone_of(Disc{{3.0, 0.0}, 1.0}, 0.0, 1.0, {-3.0, 0.0})}, 1.0);
  EXPECT_EQ(whole.area().high, 0.0);
  // From the inside: the circle through the front's far side leaves what is left of the front.
  const FreeArrangement from_within({cone_of(Disc{{3.0, 0.0}, 1.0}, 0.0, 1.0, {-2.0, 0.0})}, 2.0);
  EXPECT_EQ(from_within.pieces().size(), 1u);
}

TEST(FreeArrangement, ALegAlongATangentOfTheCircle) {
  // The apex at (1, -1), a wall that begins straight ahead: its left leg, x = 1, touches the circle from outside.
  const FreeArrangement free({cone_of(Segment{{0.0, 5.0}, {3.0, 5.0}}, 0.0, kInfinity, {1.0, -1.0})}, 1.0);
  EXPECT_EQ(free.pieces().size(), 1u);
  expect_area(free, kPi);
}

TEST(FreeArrangement, AWallSeenEndOnIsASlitWithTwoSides) {
  const ShiftedCone wall = cone_of(Segment{{2.0, 0.0}, {3.0, 0.0}}, 0.0, 4.0);
  const FreeArrangement free({wall}, 1.0);
  ASSERT_EQ(free.pieces().size(), 1u);
  EXPECT_EQ(count(free, ArcKind::leg), 2);
  expect_area(free, kPi);
  EXPECT_FALSE(free.contains({0.75, 0.0}));
  EXPECT_TRUE(free.contains({0.25, 0.0}));
  EXPECT_TRUE(free.holds({{{0.0, 1.0}, -2.0}})) << "it takes no area away";
  // Where one wall is behind another, only the slit of the nearer one counts.
  const FreeArrangement two({wall, cone_of(Segment{{3.0, 0.0}, {5.0, 0.0}}, 0.0, 4.0)}, 1.0);
  EXPECT_EQ(count(two, ArcKind::leg), 4) << "two stretches, each with two sides";
  expect_area(two, kPi);
}

TEST(FreeArrangement, SlitsThatMeetPartThePieces) {
  const auto slit = [](double side) { return cone_of(Segment{{3.0 * side, 0.0}, {4.0 * side, 0.0}}, 0.0, kInfinity); };
  EXPECT_EQ(FreeArrangement({slit(1.0)}, 1.0).pieces().size(), 1u);
  const FreeArrangement both({slit(1.0), slit(-1.0)}, 1.0);
  EXPECT_EQ(both.pieces().size(), 2u) << "they share nothing but the apex, which is no way through";
  expect_area(both, kPi);
  const FreeArrangement opposite({cone_of(Segment{{3.0, 0.0}, {4.0, 0.0}}, 0.0, 4.0), slit(-1.0)}, 1.0);
  EXPECT_EQ(opposite.pieces().size(), 1u);
  EXPECT_EQ(count(opposite, ArcKind::leg), 4);
}

TEST(FreeArrangement, ASlitAlongAnotherConesLegBoundsNothing) {
  // The triangle's right leg runs along x = 0: from the robot to (0, 4) and on.
  const ShiftedCone triangle = cone_of(geometry::ConvexPolygon{{{0.0, 4.0}, {0.0, 6.0}, {-4.0, 4.0}}}, 0.0, kInfinity);
  const ShiftedCone wall = cone_of(Segment{{0.0, 5.0}, {0.0, 7.0}}, 0.0, 5.0);
  for (const FreeArrangement& free : {FreeArrangement({triangle, wall}, 2.0), FreeArrangement({wall, triangle}, 2.0)}) {
    EXPECT_EQ(free.pieces().size(), 1u);
    expect_area(free, 4.0 * kPi - 0.5 * kPi);
  }
}

TEST(FreeArrangement, ContactLeavesNothing) {
  const FreeArrangement free({cone_of(Disc{{2.0, 0.0}, 1.0}, 1.0, 2.0)}, 1.0);
  EXPECT_TRUE(free.pieces().empty());
  EXPECT_FALSE(free.contains({-0.5, 0.0}));
  EXPECT_FALSE(free.holds({}));
  // One ulp from contact the cone is nearly a half-plane.
  const FreeArrangement almost({cone_of(Disc{{2.0, 0.0}, 1.0}, std::nextafter(1.0, 0.0), 2.0)}, 1.0);
  ASSERT_EQ(almost.pieces().size(), 1u);
  EXPECT_NEAR(almost.area().low, 0.5 * kPi, 1e-7);
}

TEST(FreeArrangement, SpeedsAndHorizonsOfEverySize) {
  for (const double scale : {vo::kLeastArrangedNumber, 1e-9, 1e9, vo::kMostArrangedNumber}) {
    const FreeArrangement free({cone_of(Disc{{2.0, 0.0}, 0.75}, 0.25, kInfinity)}, scale);
    ASSERT_EQ(free.pieces().size(), 1u);
    EXPECT_NEAR(free.area().low / (scale * scale), kPi * 5.0 / 6.0, kRounded);
  }
  for (const double tau : {1e-9, 1e9}) {
    const FreeArrangement free({cone_of(Disc{{2.0, 0.0}, 1.0}, 0.25, tau)}, 2.0);
    EXPECT_EQ(free.pieces().size(), 1u);
  }
}

TEST(FreeArrangement, MistakesAreNamed) {
  const ShiftedCone ellipse = cone_of(geometry::Ellipse{{4.0, 0.0}, 2.0, 0.0, 1.0}, 0.5, 2.0);
  EXPECT_FALSE(FreeArrangement::can_hold(ellipse));
  EXPECT_TRUE(FreeArrangement::can_hold(cone_of(geometry::Ellipse{{4.0, 0.0}, 1.0, 0.0, 1.0}, 0.5, 2.0)));
  EXPECT_THROW(FreeArrangement({ellipse}, 1.0), std::logic_error);
  EXPECT_THROW(FreeArrangement({}, 0.0), std::logic_error);
  const std::vector<ShiftedCone> many(vo::kMostCones + 1, cone_of(Disc{{2.0, 0.0}, 0.5}, 0.25, 2.0));
  EXPECT_THROW(FreeArrangement(many, 1.0), std::logic_error);
}

TEST(FreeArrangement, RefusalsAreNamed) {
  const ShiftedCone disc = cone_of(Disc{{2.0, 0.0}, 0.5}, 0.25, 2.0);
  const auto refusal = [&](const ShiftedCone& cone, double speed = 1.0) {
    const FreeArrangement::Attempt attempt = FreeArrangement::attempt({disc, cone}, speed);
    EXPECT_EQ(attempt.free.has_value(), attempt.refusal == vo::Refusal::none);
    return std::string(name(attempt.refusal));
  };
  EXPECT_EQ(refusal(disc), "none");
  EXPECT_EQ(refusal(cone_of(Disc{{1.0, 1.0}, 2.0}, 0.25, 2.0)), "none") << "in contact nothing is free";
  EXPECT_EQ(refusal(cone_of(geometry::Ellipse{{4.0, 0.0}, 2.0, 0.0, 1.0}, 0.5, 2.0)), "ellipse");
  EXPECT_EQ(name(FreeArrangement::attempt(std::vector<ShiftedCone>(vo::kMostCones + 1, disc), 1.0).refusal),
            std::string("cones"));
  geometry::ConvexPolygon round;
  for (int k = 0; k < 1200; ++k)
    round.vertices.push_back(geometry::rotated({1.0, 0.0}, 2.0 * kPi * k / 1200.0) + Vec2{4.0, 0.0});
  EXPECT_EQ(refusal(cone_of(geometry::convex_hull(round.vertices), 0.25, 2.0)), "curves");
}

TEST(FreeArrangement, NumbersOutOfRangeAreRefusedWhereverTheyStand) {
  const auto refusal = [](const geometry::ConvexShape& shape, double radius, double tau, Vec2 apex, double speed) {
    return FreeArrangement::attempt({cone_of(shape, radius, tau, apex)}, speed).refusal;
  };
  for (const double x : {1e-300, 1e-19, 0x1p31, 1e30, 1e200}) {
    EXPECT_EQ(refusal(Disc{{x < 1.0 ? 3.0 : 3.0 * x, 3.0}, x < 1.0 ? x : 1.0}, 0.25, 2.0, {}, 1.0), vo::Refusal::range);
    EXPECT_EQ(refusal(Segment{{3.0, x}, {x + 4.0, 4.0}}, 0.0, 2.0, {}, 1.0), vo::Refusal::range);
    EXPECT_EQ(refusal(geometry::ConvexPolygon{{{3.0, 3.0}, {4.0, 3.0}, {4.0, x < 1.0 ? 4.0 : 3.0 + x}}},
                      x < 1.0 ? x : 0.0, 2.0, {}, 1.0),
              vo::Refusal::range);
    EXPECT_EQ(refusal(Disc{{3.0, 3.0}, 1.0}, 0.25, x, {}, 1.0), vo::Refusal::range);
    EXPECT_EQ(refusal(Disc{{3.0, 3.0}, 1.0}, 0.25, 2.0, {0.0, x}, 1.0), vo::Refusal::range);
    EXPECT_EQ(refusal(Disc{{3.0, 3.0}, 1.0}, 0.25, 2.0, {}, x), vo::Refusal::range);
    EXPECT_THROW(FreeArrangement({}, x), std::logic_error);
    const geometry::ConvexPolygon robot{{{0.0, 0.0}, {1.0, 0.0}, {0.0, x < 1.0 ? x : 1.0}}};
    const VelocityObstacle seen(Disc{{x < 1.0 ? 3.0 : -3.0 * x, 3.0}, 1.0}, {}, robot, 2.0);
    EXPECT_EQ(FreeArrangement::attempt({{seen, {}, {}}}, 1.0).refusal, vo::Refusal::range);
  }
  EXPECT_EQ(refusal(Disc{{3.0, 3.0}, 1.0}, 0.0, kInfinity, {}, 1.0), vo::Refusal::none);
  EXPECT_EQ(FreeArrangement::refusal_of({}, std::nan("")), vo::Refusal::range);
}

TEST(FreeArrangement, HalfPlanesOutOfRangeAreNotJudged) {
  const FreeArrangement free({cone_of(Disc{{3.0, 0.0}, 0.75}, 0.25, 2.0)}, 2.0);
  EXPECT_EQ(free.attempt_holds({{{-1.0, 0.0}, -1.0}}), std::optional(true));
  EXPECT_EQ(free.attempt_holds({}), std::optional(false));
  EXPECT_EQ(free.attempt_holds({{{-1.0, 1e-40}, -1.0}}), std::optional(false)) << "what rounding leaves of a 0";
  for (const double x : {1e-300, 1e30, kInfinity, std::nan("")}) {
    EXPECT_EQ(free.attempt_holds({{{-1.0, x}, -1.0}}), std::nullopt);
    EXPECT_EQ(free.attempt_holds({{{-1.0, 0.0}, x}}), std::nullopt);
    EXPECT_THROW(free.holds({{{x, 1.0}, -1.0}}), std::logic_error);
  }
}

TEST(FreeArrangement, NumbersOfEverySizeInRangeAreAnswered) {
  SeededRandom random(seed_of_run(724));
  const auto number = [&] {
    return std::ldexp(random.uniform(1.0, 2.0), random.integer(-60, 29)) * (random.integer(0, 1) != 0 ? 1.0 : -1.0);
  };
  const auto size = [&] { return std::fabs(number()); };
  int arranged = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<ShiftedCone> cones;
    for (int k = 0; k <= i % 3; ++k) {
      const geometry::ConvexShape shape = k == 1 ? geometry::ConvexShape{Segment{{number(), number()}, {number(), 1.0}}}
                                                 : geometry::ConvexShape{Disc{{number(), number()}, size()}};
      const ShiftedCone cone = cone_of(shape, size(), size(), i % 2 == 0 ? Vec2{} : Vec2{number(), number()});
      if (!cone.cone.overlaps()) cones.push_back(cone);
    }
    const FreeArrangement::Attempt attempt = FreeArrangement::attempt(cones, size());
    ASSERT_TRUE(attempt.refusal == vo::Refusal::none || attempt.refusal == vo::Refusal::numbers_apart);
    arranged += attempt.free.has_value();
    if (attempt.free) attempt.free->attempt_holds({{{number(), number()}, number()}});
  }
  EXPECT_GT(arranged, 190);
}

}  // namespace
}  // namespace exactvo::test
