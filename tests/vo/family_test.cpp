// SPDX-License-Identifier: GPL-3.0-or-later
// The numbered properties of family.h; cones without end; robots that are polygons.
#include "exactvo/vo/family.h"
#include "exactvo/geometry/infinity.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>

#include "exactvo/geometry/pi.h"
#include "exactvo/vo/certificate.h"
#include "exactvo/vo/reciprocal.h"
#include "vo/half_plane_audit.h"

namespace exactvo::test {
namespace {

using geometry::ConvexPolygon;
using geometry::ConvexShape;
using geometry::Disc;
using geometry::Ellipse;
using geometry::HalfPlane;
using geometry::Segment;
using geometry::Vec2;
using geometry::VectorSum;
using vo::Encounter;
using vo::family_member;
using vo::Member;
using vo::Variant;
using vo::VelocityObstacle;

using geometry::kInfinity;

constexpr Variant kVariants[] = {Variant::vo, Variant::rvo, Variant::hrvo, Variant::orca};

Encounter random_encounter(SeededRandom& random, Kind kind) {
  Encounter e;
  e.position = random.in_box(2.0);
  e.radius = random.uniform(0.1, 0.5);
  e.obstacle = random_shape(random, kind, e.position + random.uniform(1.8, 5.0) * random.direction(), 1.0);
  e.obstacle_velocity = random.in_box(1.5);
  e.velocity = random.in_box(1.5);
  e.time_horizon = random.integer(0, 2) == 0 ? kInfinity : random.uniform(0.5, 5.0);
  return e;
}

TEST(Family, Property1_AtRestTheCornersAreZero) {
  SeededRandom random(seed_of_run(601));
  for (int i = 0; i < 400; ++i) {
    Encounter e = random_encounter(random, kKinds[i % 4]);
    e.velocity = e.obstacle_velocity = {};
    for (const Variant v : {Variant::vo, Variant::rvo, Variant::hrvo}) {
      const Member m = family_member(v, e);
      ASSERT_TRUE(m.cone);
      EXPECT_EQ(m.cone->apex, Vec2{}) << static_cast<int>(v);
    }
  }
}

TEST(Family, Property2_And_3_RvoIsTheVoOfTheMeanExactly) {
  SeededRandom random(seed_of_run(602));
  int inside = 0;
  for (int i = 0; i < 4000; ++i) {
    const Encounter e = random_encounter(random, kKinds[i % 4]);
    const Member rvo = family_member(Variant::rvo, e);
    ASSERT_TRUE(rvo.cone);
    EXPECT_LE(norm(rvo.cone->apex - 0.5 * (e.velocity + e.obstacle_velocity)), 1e-15);
    const Vec2 v = random.in_box(3.0);
    // 2 v - velocity - obstacle_velocity, unrounded.
    const bool in_vo = cone_of(e).contains_sum(VectorSum{{2.0 * v, -e.velocity, -e.obstacle_velocity}});
    ASSERT_EQ(rvo.cone->contains(v), in_vo);
    inside += in_vo ? 1 : 0;
  }
  EXPECT_GT(inside, 250);
}

TEST(Family, Property4_HrvoTakesTheLegOfItsOwnSideFromRvo) {
    SeededRandom random(seed_of_run(603));
  int sides = 0;
  for (int i = 0; i < 2000; ++i) {
    const Encounter e = random_encounter(random, kKinds[i % 4]);
    const Member hrvo = family_member(Variant::hrvo, e);
    const Member rvo = family_member(Variant::rvo, e);
    ASSERT_TRUE(hrvo.cone && rvo.cone);
    const auto legs = hrvo.cone->cone.legs();
    ASSERT_TRUE(legs);
    const Vec2 from_rvo = hrvo.cone->apex - rvo.cone->apex;
    const Vec2 from_vo = hrvo.cone->apex - e.obstacle_velocity;
    const auto off = [](Vec2 d, Vec2 leg) { return std::fabs(cross(d, leg)) / (1.0 + norm(d)); };
    const double left = std::max(off(from_rvo, legs->left.direction), off(from_vo, legs->right.direction));
    const double right = std::max(off(from_rvo, legs->right.direction), off(from_vo, legs->left.direction));
    EXPECT_LT(std::min(left, right), 1e-12);
    // Untruncated, it forbids what RVO forbids on the robot's own side and at least as much on the other.
    const double side = cross(legs->left.direction + legs->right.direction, e.velocity - e.obstacle_velocity);
        if (std::fabs(side) > 1e-9) {
      EXPECT_EQ(left<right, side> 0.0);
      ++sides;
    }
  }
  EXPECT_GT(sides, 1500);
}

TEST(Family, Property5_OrcaIsAffineInTheResponsibility) {
  SeededRandom random(seed_of_run(604));
  for (int i = 0; i < 2000; ++i) {
    Encounter e = random_encounter(random, kKinds[i % 4]);
    const auto offset = [&](double responsibility) {
      e.responsibility = responsibility;
      return family_member(Variant::orca, e).half_plane->offset;
    };
    ASSERT_TRUE(family_member(Variant::orca, e).half_plane);
    EXPECT_NEAR(offset(0.25), 0.75 * offset(0.0) + 0.25 * offset(1.0), 1e-13);
    EXPECT_NEAR(offset(0.0), dot(family_member(Variant::orca, e).half_plane->normal, e.velocity), 1e-13);
  }
}

TEST(Family, InContactNoRuleSaysAnything) {
  Encounter e;
  e.radius = 1.0;
  for (const double centre : {0.5, 1.5, 2.0}) {  // 2: touching
    e.obstacle = Disc{{centre, 0.0}, 1.0};
    for (const Variant v : kVariants) {
      EXPECT_FALSE(family_member(v, e).cone) << static_cast<int>(v);
      EXPECT_FALSE(family_member(v, e).half_plane) << static_cast<int>(v);
    }
  }
  e.obstacle = Disc{{3.0, 0.0}, 1.0};
  for (const Variant v : kVariants) {
    const Member m = family_member(v, e);
    ASSERT_NE(m.cone.has_value(), m.half_plane.has_value()) << static_cast<int>(v);
    const auto allows = [&](Vec2 x) { return m.cone ? !m.cone->contains(x) : violation(*m.half_plane, x) <= 0.0; };
    EXPECT_TRUE(allows({-1.0, 0.0})) << static_cast<int>(v);
    EXPECT_FALSE(allows({9.0, 0.0})) << static_cast<int>(v);
  }
}

TEST(Family, OrcaOfTwoDiscsIsTheReciprocalPair) {
  SeededRandom random(seed_of_run(605));
  for (int i = 0; i < 2000; ++i) {
    Encounter e = random_encounter(random, Kind::disc);
    if (!std::isfinite(e.time_horizon)) e.time_horizon = 2.0;
    const Disc other = std::get<Disc>(e.obstacle);
    const auto pair = vo::reciprocal_half_planes({e.position, e.velocity, e.radius},
                                                 {other.center, e.obstacle_velocity, other.radius}, {e.time_horizon});
    const Member orca = family_member(Variant::orca, e);
    ASSERT_TRUE(orca.half_plane);
    EXPECT_NEAR(norm(orca.half_plane->normal - pair.a.normal), 0.0, 1e-12);
    EXPECT_NEAR(orca.half_plane->offset, pair.a.offset, 1e-12);
  }
}

TEST(Family, Property6_MovesWithTheFrame) {
    SeededRandom random(seed_of_run(606));
  int half_planes = 0;
  for (int i = 0; i < 2000; ++i) {
    const Encounter e = random_encounter(random, kKinds[i % 4]);
    Encounter moved = e;
    const Vec2 w{random.integer(-8, 8) * 0.25, random.integer(-8, 8) * 0.25};
    // On a grid, so that nothing rounds and the cones answer alike.
    const auto on_grid = [](Vec2 v) { return Vec2{std::round(v.x * 1024) / 1024, std::round(v.y * 1024) / 1024}; };
    Encounter still = e;
    still.velocity = on_grid(e.velocity);
    still.obstacle_velocity = on_grid(e.obstacle_velocity);
    moved.velocity = still.velocity + w;
    moved.obstacle_velocity = still.obstacle_velocity + w;
    const Vec2 v = on_grid(random.in_box(3.0));
    for (const Variant variant : {Variant::vo, Variant::rvo})
      ASSERT_EQ(family_member(variant, still).cone->contains(v), family_member(variant, moved).cone->contains(v + w));
    const auto a = family_member(Variant::orca, still).half_plane, b = family_member(Variant::orca, moved).half_plane;
    ASSERT_EQ(a.has_value(), b.has_value());
    if (a) {
      EXPECT_NEAR(a->offset + dot(a->normal, w), b->offset, 1e-12);
      ++half_planes;
    }
  }
  EXPECT_GT(half_planes, 1900);
}

TEST(Family, FullHalfPlanesAreProvenAgainstMovingObstacles) {
    SeededRandom random(seed_of_run(607));
  for (int i = 0; i < 3000; ++i) {
    Encounter e = random_encounter(random, kKinds[i % 4]);
    e.responsibility = 1.0;
    const Member orca = family_member(Variant::orca, e);
    ASSERT_TRUE(orca.half_plane);
    EXPECT_TRUE(vo::is_true({e.obstacle, e.position, e.radius, e.time_horizon, e.obstacle_velocity, *orca.half_plane}));
  }
}

TEST(Family, HorizonsOfThePaperAndClamped) {
  const VelocityObstacle wall(Segment{{3.0, -1.0}, {3.0, 1.0}}, {}, 1.0, 1.0);
  EXPECT_DOUBLE_EQ(vo::paper_time_horizon(wall, {0.5, 0.0}), 4.0);
  EXPECT_EQ(vo::paper_time_horizon(wall, {}), kInfinity);
  EXPECT_EQ(vo::paper_time_horizon(VelocityObstacle(Segment{{1, -1}, {1, 1}}, {}, 1.0, 1.0), {1, 0}), 0.0);
  EXPECT_DOUBLE_EQ(vo::clamped_time_horizon(wall, {0.8, 0.0}), 2.5);
  EXPECT_EQ(vo::clamped_time_horizon(wall, {}), 3.0);
  EXPECT_EQ(vo::clamped_time_horizon(wall, {100.0, 0.0}), 0.3);
}

// --- Cones without end ---

TEST(InfiniteHorizon, ContainsWhatSomeHorizonContains) {
  SeededRandom random(seed_of_run(611));
  int inside = 0;
  for (int i = 0; i < 4000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    if (VelocityObstacle(scene.s.shape, scene.s.origin, scene.s.radius, 1.0).overlaps()) continue;
    const VelocityObstacle cone(scene.s.shape, scene.s.origin, scene.s.radius, kInfinity);
    const Vec2 v = random_velocity(random, scene.s, 1.0);
    const VelocityObstacle large(scene.s.shape, scene.s.origin, scene.s.radius, 0x1p60);
    ASSERT_EQ(cone.contains(v), large.contains(v));
    ASSERT_EQ(cone.contains(v), cone.contains(0x1p-900 * v)) << "a cone has no scale";
    ASSERT_FALSE(cone.contains(Vec2{}));
    inside += cone.contains(v) ? 1 : 0;
  }
  EXPECT_GT(inside, 300);
}

TEST(InfiniteHorizon, HalfPlanesAreProvenAndNearest) {
  SeededRandom random(seed_of_run(612));
  int apices = 0;
  for (int i = 0; i < 4000; ++i) {
    const RandomScene scene = random_scene(random, kKinds[i % 4]);
    const VelocityObstacle cone(scene.s.shape, scene.s.origin, scene.s.radius, kInfinity);
    if (cone.overlaps()) continue;
    const Vec2 v = i % 5 == 0 ? random.direction() : random_velocity(random, scene.s, 1.0);
    const auto h = cone.half_plane(v);
    if (!h) continue;
    const auto certificate = vo::certify({scene.s.shape, scene.s.origin, scene.s.radius, kInfinity, {}, *h});
    ASSERT_TRUE(certificate);
    const auto read = vo::read_certificate(write_certificate(*certificate));
    ASSERT_TRUE(read);
    ASSERT_EQ(check(*read), vo::Verdict::valid);
    ASSERT_EQ(h->offset, 0.0);
    const vo::NearestBoundary nearest = cone.nearest_boundary(v);
    if (std::fabs(nearest.signed_distance) > 1e-6 * norm(v)) {  // nearer, the rounded distance may have either sign
      ASSERT_EQ(nearest.signed_distance < 0.0, cone.contains(v)) << nearest.signed_distance;
    }
    apices += nearest.part == vo::BoundaryPart::apex ? 1 : 0;
    if (nearest.part == vo::BoundaryPart::apex) {
      EXPECT_NEAR(nearest.signed_distance, norm(v), 1e-12 * norm(v));
    }
  }
  EXPECT_GT(apices, 200);
}

TEST(InfiniteHorizon, AHalfPlaneThroughTheConeIsNotTrue) {
  const vo::HalfPlaneClaim through{Disc{{2, 0}, 0.5}, {}, 0.5, kInfinity, {}, {{-1, 0}, -1e-300}};
  EXPECT_FALSE(vo::is_true(through));
  vo::HalfPlaneClaim at = through;
  at.half_plane.offset = 0.0;
  EXPECT_TRUE(vo::is_true(at));
}

// --- Robots that are polygons ---

ConvexPolygon regular(int sides, double radius) {
  ConvexPolygon p;
  for (int i = 0; i < sides; ++i)
    p.vertices.push_back(geometry::rotated({radius, 0.0}, 2.0 * geometry::kPi * i / sides));
  return p;
}

TEST(PolygonRobot, ManySidesTendToTheDisc) {
    SeededRandom random(seed_of_run(621));
  int inside = 0;
  for (int i = 0; i < 400; ++i) {
    const Encounter e = random_encounter(random, kKinds[i % 4]);
    const VelocityObstacle disc = cone_of(e);
    double before = kInfinity;
    for (const int sides : {8, 32, 128}) {
      Encounter polygonal = e;
      polygonal.robot = regular(sides, e.radius);
      const VelocityObstacle polygon = cone_of(polygonal);
      const Vec2 v{0.3, 0.4};
      const double gap = std::fabs(polygon.nearest().distance - disc.nearest().distance);
      // The sagitta of a side, and what the outer shape adds.
      const double sagitta = e.radius * (1.0 - std::cos(geometry::kPi / sides));
      EXPECT_LE(gap, sagitta + polygon.grown_error() + 1e-12) << sides;
      EXPECT_LE(gap, before + polygon.grown_error() + 1e-12);
      before = std::max(gap, 1e-15);
      // Inscribed: what hits with the polygon hits with the disc.
            if (polygon.contains(v)) {
        EXPECT_TRUE(disc.contains(v));
        ++inside;
      }
    }
  }
  EXPECT_GT(inside, 50);
}

using Q = mpq_class;

/// Whether two convex polygons over the rationals have a point in common: an edge pair crosses or one holds the other.
bool polygons_meet(const std::vector<QPoint>& a, const std::vector<QPoint>& b) {
  if (in_hull(a, b[0]) || in_hull(b, a[0])) return true;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j)
      if (sgn(squared_distance_of_segments(a[i], a[(i + 1) % a.size()], b[j], b[(j + 1) % b.size()])) == 0) return true;
  return false;
}

/// By time: the robot at some of its places, and the parallelograms that its sides sweep.
bool sweeps_into(const std::vector<QPoint>& obstacle, const std::vector<QPoint>& robot, const QPoint& step) {
  std::vector<QPoint> end;
  for (const QPoint& p : robot) end.push_back({Q(p.x + step.x), Q(p.y + step.y)});
  if (polygons_meet(obstacle, robot) || polygons_meet(obstacle, end)) return true;
  for (std::size_t i = 0; i < robot.size(); ++i) {
    const std::size_t next = (i + 1) % robot.size();
    std::vector<QPoint> swept{robot[i], robot[next], end[next], end[i]};
    if (sgn(cross(minus(swept[1], swept[0]), minus(swept[2], swept[0]))) < 0) std::swap(swept[1], swept[3]);
    if (polygons_meet(obstacle, swept)) return true;
  }
  return false;
}

TEST(PolygonRobot, ContainsAgreesWithRationals) {
  SeededRandom random(seed_of_run(622));
  int inside = 0, touching = 0;
  for (int i = 0; i < 3000; ++i) {
    // A grid of small integers: many exact contacts.
    const auto on_grid = [&](int reach) {
      return Vec2{1.0 * random.integer(-reach, reach), 1.0 * random.integer(-reach, reach)};
    };
    std::vector<Vec2> around, body;
    const Vec2 centre = on_grid(6);
    const Vec2 position = on_grid(6);
    for (int k = 0; k < 5; ++k) {
      around.push_back(centre + on_grid(2));
      body.push_back(on_grid(2));
    }
    const ConvexPolygon obstacle = geometry::convex_hull(around), robot = geometry::convex_hull(body);
    const Vec2 v = on_grid(6);
    std::vector<QPoint> o, r;
    for (const Vec2 p : obstacle.vertices) o.push_back(exactly(p));
    for (const Vec2 p : robot.vertices) r.push_back(exactly(p + position));
    const bool expected = sweeps_into(o, r, exactly(v));
    const bool found = sweep_meets(obstacle, robot, position, VectorSum{{v}}, 1.0);
    ASSERT_EQ(found, expected) << geometry::to_string(obstacle) << " | " << geometry::to_string(robot);
    inside += found ? 1 : 0;
    const bool a_little_shorter = sweep_meets(obstacle, robot, position, VectorSum{{v}}, 1.0 - 0x1p-40);
    touching += found != a_little_shorter ? 1 : 0;
  }
  EXPECT_GT(inside, 300);
  EXPECT_GT(touching, 20);
}

TEST(PolygonRobot, AgainstDiscsAndEllipsesTheOuterShapeDecidesButForItsError) {
  SeededRandom random(seed_of_run(623));
  int inside = 0, decided = 0;
  for (int i = 0; i < 1500; ++i) {
    Encounter e = random_encounter(random, i % 2 == 0 ? Kind::disc : Kind::ellipse);
    e.robot = random_convex_polygon(random, {}, e.radius, 5);
    e.time_horizon = 2.0;
    const VelocityObstacle obstacle = cone_of(e);
    if (obstacle.overlaps()) continue;
    const Vec2 v = random.in_box(3.0);
    geometry::GrownShape inner = obstacle.grown();
    const bool within = obstacle.contains(v);
    if (!segment_meets(inner, v, 2.0)) {
      EXPECT_FALSE(within) << "the outer shape holds S";
      continue;
    }
    inside += within ? 1 : 0;
    // Shrunk by its error, the outer shape lies within S: met well inside, S is met.
    if (obstacle.nearest_boundary(v).signed_distance < -2.0 * obstacle.grown_error() - 1e-9) {
      ++decided;
      EXPECT_TRUE(within);
    }
  }
  EXPECT_GT(inside, 60);
  EXPECT_GT(decided, 60);
}

TEST(PolygonRobot, HalfPlanesKeepEveryCornerClear) {
    SeededRandom random(seed_of_run(624));
  int judged = 0;
  for (int i = 0; i < 1500; ++i) {
    Encounter e = random_encounter(random, kKinds[i % 4]);
    e.robot = random_convex_polygon(random, {}, e.radius, 5);
    const VelocityObstacle obstacle = cone_of(e);
    if (obstacle.overlaps()) continue;
    const auto h = obstacle.half_plane(random.in_box(2.0));
    ASSERT_TRUE(h);
    // On the boundary of the half-plane and beyond: free, exactly.
    const Vec2 n = h->normal;
    const Vec2 foot = (h->offset / squared_norm(n)) * n + random.uniform(-2.0, 2.0) * perp(n);
        const Vec2 v = foot + 1e-9 * n;
    EXPECT_FALSE(obstacle.contains(v));
    ++judged;
  }
  EXPECT_GT(judged, 750);
}

TEST(PolygonRobot, DegenerateRobotsAndObstacles) {
  const ConvexPolygon point{{{0, 0}}}, bar{{{0, -1}, {0, 1}}};
  const Segment wall{{2, 0}, {4, 0}};
  EXPECT_TRUE(sweep_meets(wall, point, {}, VectorSum{{{2, 0}}}, 1.0));
  EXPECT_FALSE(sweep_meets(wall, point, {}, VectorSum{{{2, 0}}}, 1.0 - 0x1p-50));
  EXPECT_FALSE(sweep_meets(wall, point, {0, 0x1p-40}, VectorSum{{{2, 0}}}, 100.0));
  EXPECT_TRUE(sweep_meets(wall, bar, {0, 0x1p-40}, VectorSum{{{2, 0}}}, 1.0));
  EXPECT_TRUE(sweep_meets(Ellipse{{2, 0}, 0.0, 3.0, 4.0}, point, {2, 5}, {}, 0.0));
  EXPECT_FALSE(sweep_meets(Ellipse{{2, 0}, 0.0, 3.0, 4.0}, point, {2, 5.0 + 0x1p-40}, {}, 0.0));
  EXPECT_TRUE(sweep_meets(Disc{{3, 0}, 1}, point, {}, VectorSum{{{1, 0}}}, kInfinity));
  EXPECT_FALSE(sweep_meets(Disc{{3, 0}, 1}, point, {}, VectorSum{{{-1, 0}}}, kInfinity));
  EXPECT_FALSE(sweep_meets(Disc{{3, 0}, 1}, point, {}, {}, kInfinity));
}

}  // namespace
}  // namespace exactvo::test
