// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/crowd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <tbb/global_control.h>

#include "crowd/body.h"
#include "crowd/crowd_audit.h"
#include "crowd_scenes.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/vo/lp/batch.h"
#include "lp/sets/target.h"

namespace exactvo::formation {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
using geometry::kInfinity;

template <class Do>
void expect_problem(CrowdProblem expected, const std::string& named, const Do& what) {
  try {
    what();
    FAIL() << "nothing was refused, expected " << name(expected);
  } catch (const CrowdError& e) {
    EXPECT_STREQ(name(e.problem()), name(expected)) << e.what();
    EXPECT_NE(std::string(e.what()).find(named), std::string::npos) << e.what();
  }
}

Crowd with_one_kind(const CrowdOptions& options = {}) {
  Crowd crowd(options);
  crowd.add_kind({});
  return crowd;
}

void run(Crowd& crowd, int steps) {
  for (int k = 0; k < steps; ++k) crowd.step();
}

TEST(Crowd, AloneARobotTakesThePreferredVelocityOfTheLattice) {
  Crowd crowd = with_one_kind();
  const RobotId robot = crowd.add_robot({1.0, 2.0});
  crowd.set_preferred({{0.5, -0.25}});
  const StepReport report = crowd.step();
  EXPECT_EQ(report.robots, 1U);
  EXPECT_EQ(report.relaxed + report.neighbours + report.touching + report.widened, 0U);
  EXPECT_EQ(crowd.velocity(robot), (Vec2{0.5, -0.25}));
  EXPECT_EQ(crowd.position(robot), (Vec2{1.125, 1.9375}));
}

TEST(Crowd, Property3_NoRobotIsFasterThanMaxSpeed) {
  for (const CrowdPrecision precision : {CrowdPrecision::float_lines, CrowdPrecision::double_lines}) {
    CrowdOptions options;
    options.precision = precision;
    options.time_step = 0.1;
    Crowd crowd(options);
    crowd.add_kind({0.5, 1.0, 5.0, 15.0, 10});
    for (int k = 0; k < 80; ++k) crowd.add_robot({50.0 * k, 0.0 + k});
    std::vector<Vec2> preferred;
    for (int k = 0; k < 80; ++k) preferred.push_back({1000.0 * std::cos(0.1 * k), 1000.0 * std::sin(0.1 * k)});
    crowd.set_preferred(preferred);
    crowd.step();
    for (RobotId id = 0; id < 80; ++id) {
      const double speed = geometry::norm(crowd.velocity(id));
      EXPECT_LE(speed, 1.0) << id;
      EXPECT_GT(speed, 1.0 - 1e-4) << id;
    }
  }
}

TEST(Crowd, TwoRobotsHeadOnPassEachOther) {
  Crowd crowd = with_one_kind();
  const RobotId a = crowd.add_robot({-10.0, 0.0}), b = crowd.add_robot({10.0, 0.01});
  crowd.set_preferred({{1.0, 0.0}, {-1.0, 0.0}});
  for (int k = 0; k < 100; ++k) {
    const StepReport report = crowd.step();
    EXPECT_EQ(report.relaxed, 0U);
    EXPECT_GT(geometry::norm(crowd.position(a) - crowd.position(b)), 1.0);
  }
  EXPECT_GT(crowd.position(a).x, 9.0);
  EXPECT_LT(crowd.position(b).x, -9.0);
}

TEST(Crowd, ASteeringFunctionAndAnArrayGiveTheSameBits) {
  const CrowdScene scene = crowd_scene("crowd", 400);
  Crowd by_function = crowd_of(scene), by_array = crowd_of(scene);
  std::vector<Vec2> at, preferred(400);
  for (int k = 0; k < 20; ++k) {
    by_array.positions(at);
    for (std::size_t i = 0; i < 400; ++i) preferred[i] = scene.preferred(i, at[i]);
    by_array.set_preferred(preferred);
    by_array.step();
    by_function.step();
    ASSERT_EQ(by_array.digest(), by_function.digest()) << k;
  }
}

TEST(Crowd, RobotsKeepTheirIdsWhenOthersLeaveAndNewOnesReplaceThem) {
  const CrowdScene scene = crowd_scene("crowd", 100);
  Crowd crowd = crowd_of(scene);
  run(crowd, 3);
  const Vec2 before = crowd.position(57);
  crowd.remove_robot(3);
  crowd.remove_robot(99);
  EXPECT_EQ(crowd.size(), 98U);
  EXPECT_EQ(crowd.id_end(), 100U);
  EXPECT_EQ(crowd.position(57), before);
  expect_problem(CrowdProblem::unknown_robot, "robot 3", [&] { crowd.position(3); });
  expect_problem(CrowdProblem::unknown_robot, "robot 99", [&] { crowd.remove_robot(99); });
  expect_problem(CrowdProblem::unknown_robot, "robot 100", [&] { crowd.explain(100); });
  EXPECT_EQ(crowd.add_robot({-50.0, 0.0}), 99U);
  EXPECT_EQ(crowd.add_robot({-60.0, 0.0}), 3U);
  EXPECT_EQ(crowd.add_robot({-70.0, 0.0}), 100U);
  crowd.set_preferred(std::vector<Vec2>(101, Vec2{0.5, 0.0}));
  crowd.step();
  EXPECT_EQ(crowd.position(100), (Vec2{-69.875, 0.0}));
  EXPECT_EQ(crowd.position(3), (Vec2{-59.875, 0.0}));
}

TEST(Crowd, ANewRobotOfAnOldIdPrefersNothing) {
  Crowd crowd = with_one_kind();
  crowd.add_robot({0.0, 0.0});
  crowd.set_preferred({{1.0, 0.0}});
  crowd.remove_robot(0);
  EXPECT_EQ(crowd.add_robot({0.0, 0.0}), 0U);
  crowd.step();
  EXPECT_EQ(crowd.velocity(0), (Vec2{0.0, 0.0}));
}

TEST(Crowd, ARobotMayBeginInMotionWithinItsSpeedLimit) {
  Crowd crowd = with_one_kind();
  EXPECT_EQ(crowd.velocity(crowd.add_robot({0.0, 0.0}, 0, {0.5, -0.25})), (Vec2{0.5, -0.25}));
  const double share = (1.0 - 0x1p-50) * std::sqrt(0.5) * 1.5;
  EXPECT_LE(geometry::norm(crowd.velocity(crowd.add_robot({9.0, 0.0}, 0, {share, share}))), 1.5);
  expect_problem(CrowdProblem::out_of_range, "velocity", [&] { crowd.add_robot({20.0, 0.0}, 0, {1.5, 0.1}); });
  expect_problem(CrowdProblem::not_finite, "velocity", [&] { crowd.add_robot({20.0, 0.0}, 0, {kNaN, 0.1}); });
  EXPECT_EQ(crowd.size(), 2U);
}

/// Two head on: whoever sees the other move gives way at the first step.
TEST(Crowd, OthersSeeTheVelocityThatARobotBeginsWith) {
  for (const double speed : {0.0, 1.0}) {
    Crowd crowd = with_one_kind();
    crowd.add_robot({0.0, 0.0}, 0, {speed, 0.0});
    crowd.add_robot({5.0, 0.1}, 0, {-speed, 0.0});
    crowd.set_preferred({{0.2 * speed, 0.0}, {-0.2 * speed, 0.0}});
    const CrowdExplanation e = crowd.explain(0);
    ASSERT_EQ(e.neighbours.size(), 1U);
    const bool binds =
        geometry::dot(e.neighbours[0].half_plane.normal, {speed, 0.0}) < e.neighbours[0].half_plane.offset;
    EXPECT_EQ(binds, speed > 0.0);
  }
}

TEST(Crowd, AKindBeyondThe255thIsTheOneThatWasAskedFor) {
  Crowd few = with_one_kind(), many = with_one_kind();
  CrowdKind kind;
  for (int k = 1; k <= 300; ++k) {
    kind.radius = 0.5 + 0.001 * k;
    many.add_kind(kind);
  }
  const KindId asked = 300;
  EXPECT_EQ(few.add_kind(kind), 1U);
  for (int i = 0; i < 60; ++i) {
    const Vec2 at = {1.7 * (i % 8), 1.7 * (i / 8)};
    few.add_robot(at, i % 2 ? 1 : 0);
    many.add_robot(at, i % 2 ? asked : 0);
  }
  const std::vector<Vec2> preferred(60, Vec2{0.7, 0.3});
  few.set_preferred(preferred);
  many.set_preferred(preferred);
  EXPECT_EQ(many.kind_of(1), asked);
  run(few, 10);
  run(many, 10);
  std::vector<Vec2> a, b;
  few.positions(a);
  many.positions(b);
  EXPECT_EQ(a, b);
  std::stringstream stream;
  many.snapshot(stream);
  EXPECT_EQ(Crowd::restored(stream).kind_of(59), asked);
}

TEST(CrowdEdges, TheHorizonOfEdgesIsOneOfItsOwn) {
  std::vector<double> speeds;
  for (const double horizon : {0.0, 5.0, 1.0}) {
    Crowd crowd;
    CrowdKind kind;
    kind.edge_horizon = horizon;
    crowd.add_kind(kind);
    crowd.add_robot({0.0, 0.0});
    crowd.add_obstacle(geometry::Polyline{{{3.0, -9.0}, {3.0, 9.0}}});
    crowd.set_preferred({{1.5, 0.0}});
    crowd.step();
    speeds.push_back(crowd.velocity(0).x);
  }
  EXPECT_NEAR(speeds[0], 0.5, 1e-4);  // 2.5 m in 5 s
  EXPECT_EQ(speeds[1], speeds[0]);
  EXPECT_NEAR(speeds[2], 1.5, 1e-4);
}

TEST(CrowdEdges, ARobotStopsBeforeAWallUntilItIsRemoved) {
  Crowd crowd = with_one_kind();
  crowd.add_robot({0.0, 0.0});
  crowd.set_preferred({{1.0, 0.0}});
  const ObstacleId wall = crowd.add_obstacle(geometry::Polyline{{{5.0, -100.0}, {5.0, 100.0}}});
  for (int k = 0; k < 200; ++k) crowd.step();
  EXPECT_LT(crowd.position(0).x, 4.5);
  EXPECT_GT(crowd.position(0).x, 4.499);
  crowd.set_preferred({{1.0, 0.5}});
  for (int k = 0; k < 8; ++k) crowd.step();
  EXPECT_LT(crowd.position(0).x, 4.5);
  EXPECT_NEAR(crowd.position(0).y, 1.0, 1e-3);
  crowd.remove_obstacle(wall);
  for (int k = 0; k < 8; ++k) crowd.step();
  EXPECT_GT(crowd.position(0).x, 6.0);
  expect_problem(CrowdProblem::unknown_obstacle, "obstacle 0", [&] { crowd.remove_obstacle(wall); });
}

TEST(CrowdEdges, ARobotPassesADoorThatIsWiderAndNoOther) {
  for (const double half : {0.4999, 0.5001}) {
    Crowd crowd = with_one_kind();
    crowd.add_robot({-4.0, 0.0});
    crowd.add_obstacle(geometry::Polyline{{{0.0, -50.0}, {0.0, -half}}});
    crowd.add_obstacle(geometry::Polyline{{{0.0, half}, {0.0, 50.0}}});
    crowd.set_preferred({{1.0, 0.0}});
    for (int k = 0; k < 100; ++k) crowd.step();
    EXPECT_EQ(crowd.position(0).x > 4.0, half > 0.5) << half << ' ' << crowd.position(0).x;
  }
}

TEST(CrowdEdges, NoRobotIsPushedThroughAWall) {
  CrowdScene scene = crowd_scene("jam", 200);
  for (auto& robot : scene.robots) robot.goal = {100.0, 0.0};
  scene.obstacles.push_back(geometry::Polyline{{{16.0, -60.0}, {16.0, 60.0}}});
  Crowd crowd = crowd_of(scene);
  std::size_t relaxed = 0;
  for (int k = 0; k < 300; ++k) relaxed += crowd.step().relaxed;
  EXPECT_GT(relaxed, 100U);
  for (RobotId id = 0; id < 200; ++id) EXPECT_LT(crowd.position(id).x, 15.5) << id;
}

TEST(CrowdEdges, ARobotHasAHalfPlaneAgainstEachOfThirtyEdgesRoundIt) {
  for (const CrowdPrecision precision : {CrowdPrecision::float_lines, CrowdPrecision::double_lines}) {
    CrowdOptions options;
    options.precision = precision;
    Crowd crowd = with_one_kind(options);
    crowd.add_robot({0.0, 0.0});
    for (int k = 0; k < 30; ++k) {
      const Vec2 out = {std::cos(0.209 * k), std::sin(0.209 * k)};
      crowd.add_obstacle(geometry::Polyline{{2.5 * out, 2.7 * out}});
    }
    EXPECT_EQ(crowd.step().edges, 30U);
    std::vector<double> ends;
    for (const auto& line : crowd.explain(0).edges) ends.push_back(std::atan2(line.edge.a.y, line.edge.a.x));
    std::sort(ends.begin(), ends.end());
    EXPECT_EQ(ends.size(), 30U);
    EXPECT_EQ(std::adjacent_find(ends.begin(), ends.end()), ends.end());
  }
}

TEST(CrowdEdges, TheGridKnowsAllWithinReachByBruteForce) {
  SceneRandom random;
  std::vector<geometry::Segment> edges;
  for (int k = 0; k < 200; ++k) {
    const Vec2 a = {100.0 * random(), 60.0 * random()};
    const double length = k % 20 == 0 ? 60.0 : k % 7 == 0 ? 0.0 : 3.0;
    edges.push_back({a, a + length * Vec2{random() - 0.5, random() - 0.5}});
  }
  crowd::EdgeGrid grid;
  grid.set_edges(edges);
  for (const double reach : {0.5, 5.0, 30.0}) {
    grid.lay_out(reach);
    for (int k = 0; k < 2000; ++k) {
      const Vec2 p = {140.0 * random() - 20.0, 100.0 * random() - 20.0};
      std::vector<bool> known(edges.size());
      const crowd::EdgeGrid::Range cell = grid.near(p);
      for (std::uint32_t k = cell.first; k < cell.last; ++k) known[grid.items()[k]] = true;
      for (std::size_t e = 0; e < edges.size(); ++e) {
        const geometry::Segment& s = edges[e];
        const double squared = geometry::squared_norm(s.b - s.a);
        const double t = squared > 0.0 ? std::clamp(geometry::dot(p - s.a, s.b - s.a) / squared, 0.0, 1.0) : 0.0;
        ASSERT_TRUE(known[e] || geometry::norm(p - (s.a + t * (s.b - s.a))) > reach) << p.x << ' ' << p.y << ' ' << e;
      }
    }
  }
}

geometry::ConvexShape shape_like(int kind, Vec2 at, double size) {
  if (kind == 0) return geometry::Disc{at, size};
  if (kind == 1) return geometry::Segment{at - Vec2{0.0, size}, at + Vec2{0.0, size}};
  if (kind == 2)
    return geometry::ConvexPolygon{
        {at + Vec2{size, 0.0}, at + Vec2{0.0, size}, at - Vec2{size, 0.0}, at - Vec2{0.0, size}}};
  return geometry::Ellipse{at, size, 0.0, 2.0 * size};
}

TEST(CrowdBodies, ARobotStopsBeforeOneAtRestUntilItIsRemoved) {
  const double room[] = {2.0, 0.0, 2.0, 2.0};  // from the middle to where the robot comes
  for (int kind = 0; kind < 4; ++kind) {
    Crowd crowd = with_one_kind();
    crowd.add_robot({-6.0, 0.0});
    crowd.set_preferred({{1.0, 0.0}});
    const ObstacleId body = crowd.add_body(shape_like(kind, {0.0, 0.0}, 2.0));
    for (int k = 0; k < 200; ++k) EXPECT_EQ(crowd.step().bodies, 1U);
    EXPECT_LT(crowd.position(0).x, -room[kind] - 0.5) << kind;
    EXPECT_GT(crowd.position(0).x, -room[kind] - 0.501) << kind;
    crowd.remove_obstacle(body);
    for (int k = 0; k < 20; ++k) EXPECT_EQ(crowd.step().bodies, 0U);
    EXPECT_GT(crowd.position(0).x, 2.0) << kind;
    expect_problem(CrowdProblem::unknown_obstacle, "0", [&] { crowd.remove_obstacle(body); });
  }
}

TEST(CrowdBodies, ARobotPassesADiscAtTheSumOfTheRadii) {
  Crowd crowd = with_one_kind();
  crowd.add_robot({-6.0, 0.3});
  crowd.add_body(geometry::Disc{{0.0, 0.0}, 1.0});
  double nearest = 1e9;
  for (int k = 0; k < 100; ++k) {
    crowd.set_preferred({Vec2{8.0, 0.0} - crowd.position(0)});
    crowd.step();
    nearest = std::min(nearest, geometry::norm(crowd.position(0)));
  }
  EXPECT_GT(nearest, 1.5);
  EXPECT_LT(nearest, 1.51);
  EXPECT_NEAR(crowd.position(0).x, 8.0, 1e-3);
}

TEST(CrowdBodies, OneThatMovesGoesWholeStepsOfTheLatticeAndRobotsGetOutOfItsWay) {
  for (int kind = 0; kind < 4; ++kind) {
    Crowd crowd = with_one_kind();
    crowd.add_robot({0.0, 0.0});
    crowd.set_preferred({{0.0, 0.0}});
    const geometry::ConvexShape shape = shape_like(kind, {-20.0, 0.25}, 1.0);
    const ObstacleId body = crowd.add_moving_body(shape, {1.0, 0.0});
    EXPECT_EQ(crowd.body_velocity(body), (Vec2{1.0, 0.0}));
    for (int k = 0; k < 160; ++k) {
      EXPECT_EQ(crowd.step().relaxed, 0U) << kind << ' ' << k;
      const Vec2 seen = crowd.position(0) - crowd.body_displacement(body);
      EXPECT_NE(geometry::locate({shape, seen, 0.5}, Vec2{}), geometry::Place::inside) << kind << ' ' << k;
    }
    EXPECT_EQ(crowd.body_displacement(body), (Vec2{40.0, 0.0}));
    // The wide one pushes it ahead of itself.
    EXPECT_LT(geometry::norm(crowd.position(0)), kind == 1 ? 24.0 : 8.0) << kind;
    ASSERT_EQ(crowd.bodies().size(), 1U);
    EXPECT_EQ(crowd.bodies()[0].displacement, (Vec2{40.0, 0.0}));
    EXPECT_TRUE(crowd.bodies()[0].moves);
    crowd.set_body_velocity(body, {0.0, 1e-9});
    EXPECT_EQ(crowd.body_velocity(body), (Vec2{0.0, 0.0}));
    crowd.step();
    EXPECT_EQ(crowd.body_displacement(body), (Vec2{40.0, 0.0}));
  }
}

TEST(CrowdBodies, NoRobotIsPushedIntoABodyAtRest) {
  CrowdScene scene = crowd_scene("jam", 200);
  for (auto& robot : scene.robots) robot.goal = {100.0, 0.0};
  for (int k = 0; k < 12; ++k)
    scene.bodies.push_back({shape_like(k % 4, {17.0 + 0.1 * k, 6.0 * k - 33.0}, 2.0), false, {}});
  Crowd crowd = crowd_of(scene);
  std::size_t relaxed = 0;
  for (int k = 0; k < 200; ++k) relaxed += crowd.step().relaxed;
  EXPECT_GT(relaxed, 100U);
  for (RobotId id = 0; id < 200; ++id)
    for (const auto& body : scene.bodies)
      EXPECT_NE(geometry::locate({body.shape, crowd.position(id), 0.5}, Vec2{}), geometry::Place::inside) << id;
}

TEST(CrowdBodies, ARobotThatStartsInsideComesOut) {
  for (int kind = 0; kind < 4; ++kind) {
    Crowd crowd = with_one_kind();
    crowd.add_robot({0.3, 0.125});
    crowd.set_preferred({{0.0, 0.0}});
    const geometry::ConvexShape shape = shape_like(kind, {0.0, 0.0}, 1.0);
    crowd.add_moving_body(shape, {0.0, 0.0});
    for (int k = 0; k < 20; ++k) crowd.step();
    EXPECT_NE(geometry::locate({shape, crowd.position(0), 0.5}, Vec2{}), geometry::Place::inside) << kind;
  }
}

TEST(CrowdRefuses, BodiesThatAreNone) {
  Crowd crowd = with_one_kind();
  expect_problem(CrowdProblem::not_finite, "body", [&] { crowd.add_body(geometry::Disc{{kNaN, 0.0}, 1.0}); });
  expect_problem(CrowdProblem::out_of_range, "body", [&] { crowd.add_body(geometry::Disc{{0.0, 1e13}, 1.0}); });
  expect_problem(CrowdProblem::out_of_range, "body", [&] { crowd.add_body(geometry::Disc{{0.0, 0.0}, -1.0}); });
  expect_problem(CrowdProblem::out_of_range, "counter-clockwise", [&] {
    crowd.add_body(geometry::ConvexPolygon{{{0.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}}});
  });
  expect_problem(CrowdProblem::not_finite, "velocity", [&] {
    crowd.add_moving_body(geometry::Disc{{0.0, 0.0}, 1.0}, {kInfinity, 0.0});
  });
  expect_problem(CrowdProblem::out_of_range, "velocity", [&] {
    crowd.add_moving_body(geometry::Disc{{0.0, 0.0}, 1.0}, {100.0, 0.0});
  });
  const ObstacleId still = crowd.add_body(geometry::Disc{{0.0, 0.0}, 1.0});
  EXPECT_EQ(still, 0U);
  expect_problem(CrowdProblem::unknown_obstacle, "at rest", [&] { crowd.set_body_velocity(still, {}); });
  expect_problem(CrowdProblem::unknown_obstacle, "body 1", [&] { crowd.body_displacement(1); });
}

TEST(CrowdRefuses, ObstaclesThatAreNoPlaces) {
  Crowd crowd;
  expect_problem(CrowdProblem::not_finite, "obstacle", [&] {
    crowd.add_obstacle(geometry::Polyline{{{0.0, 0.0}, {kNaN, 1.0}}});
  });
  expect_problem(CrowdProblem::out_of_range, "obstacle", [&] {
    crowd.add_obstacle(geometry::Polyline{{{0.0, 0.0}, {1e13, 1.0}}});
  });
}

TEST(Crowd, AnEmptyCrowdSteps) {
  Crowd crowd;
  EXPECT_EQ(crowd.step().robots, 0U);
  std::stringstream stream;
  crowd.snapshot(stream);
  EXPECT_EQ(Crowd::restored(stream).size(), 0U);
}

TEST(CrowdRefuses, OptionsAndKindsOutOfRange) {
  const auto with = [](auto change) {
    return [change] {
      CrowdOptions options;
      change(options);
      Crowd crowd(options);
    };
  };
  expect_problem(CrowdProblem::not_finite, "time_step", with([](CrowdOptions& o) { o.time_step = kNaN; }));
  expect_problem(CrowdProblem::out_of_range, "time_step", with([](CrowdOptions& o) { o.time_step = 0.0; }));
  expect_problem(CrowdProblem::out_of_range, "position_step", with([](CrowdOptions& o) { o.position_step = 1e-6; }));
  expect_problem(CrowdProblem::out_of_range, "threads", with([](CrowdOptions& o) { o.threads = -1; }));
  const auto kind = [](auto change) {
    return [change] {
      CrowdKind k;
      change(k);
      Crowd().add_kind(k);
    };
  };
  expect_problem(CrowdProblem::out_of_range, "radius: found 0", kind([](CrowdKind& k) { k.radius = 0.0; }));
  expect_problem(CrowdProblem::out_of_range, "radius: found -1", kind([](CrowdKind& k) { k.radius = -1.0; }));
  expect_problem(CrowdProblem::not_finite, "radius", kind([](CrowdKind& k) { k.radius = kInfinity; }));
  expect_problem(CrowdProblem::out_of_range, "max_speed", kind([](CrowdKind& k) { k.max_speed = 1e-5; }));
  expect_problem(CrowdProblem::out_of_range, "max_speed", kind([](CrowdKind& k) { k.max_speed = 1e5; }));
  expect_problem(CrowdProblem::out_of_range, "time_horizon", kind([](CrowdKind& k) { k.time_horizon = 0.2; }));
  expect_problem(CrowdProblem::not_finite, "neighbour_distance",
                 kind([](CrowdKind& k) { k.neighbour_distance = kNaN; }));
  expect_problem(CrowdProblem::out_of_range, "neighbours", kind([](CrowdKind& k) { k.neighbours = 16; }));
  expect_problem(CrowdProblem::out_of_range, "edge_horizon", kind([](CrowdKind& k) { k.edge_horizon = 0.2; }));
  Crowd crowd;
  for (int k = 0; k < 1 << 14; ++k) crowd.add_kind({});
  expect_problem(CrowdProblem::too_many, "2^14", [&] { crowd.add_kind({}); });
}

TEST(CrowdRefuses, PositionsThatAreNoPlaceOfTheLattice) {
  Crowd crowd = with_one_kind();
  expect_problem(CrowdProblem::not_finite, "position", [&] { crowd.add_robot({kNaN, 0.0}); });
  expect_problem(CrowdProblem::not_finite, "position", [&] { crowd.add_robot({0.0, -kInfinity}); });
  expect_problem(CrowdProblem::beyond_lattice, "4096", [&] { crowd.add_robot({0.0, 4096.0}); });
  expect_problem(CrowdProblem::beyond_lattice, "4096", [&] { crowd.add_robot({-1e300, 0.0}); });
  expect_problem(CrowdProblem::unknown_kind, "kind: found 1", [&] { crowd.add_robot({}, 1); });
  EXPECT_EQ(crowd.size(), 0U);
}

TEST(CrowdRefuses, AStepOverTheEndOfTheLatticeAndMovesNoRobot) {
  Crowd crowd = with_one_kind();
  crowd.add_robot({4095.9, 0.0});
  crowd.add_robot({0.0, 0.0});
  crowd.set_preferred({{1.0, 0.0}, {1.0, 0.0}});
  expect_problem(CrowdProblem::beyond_lattice, "robot 0", [&] { crowd.step(); });
  EXPECT_EQ(crowd.position(1), (Vec2{0.0, 0.0}));
  crowd.remove_robot(0);
  crowd.step();
  EXPECT_EQ(crowd.position(1), (Vec2{0.25, 0.0}));
}

TEST(CrowdRefuses, PreferencesThatAreNoVelocities) {
  Crowd crowd = with_one_kind();
  for (int k = 0; k < 3; ++k) crowd.add_robot({0.0, 30.0 * k});
  crowd.set_preferred({{1.0, 0.0}, {0.0, 1.0}, {0.0, 0.0}});
  expect_problem(CrowdProblem::not_finite, "robot 1", [&] { crowd.set_preferred({{9.0, 0.0}, {kNaN, 0.0}, {}}); });
  expect_problem(CrowdProblem::out_of_range, "robot 2", [&] { crowd.set_preferred({{}, {}, {0.0, -1e7}}); });
  expect_problem(CrowdProblem::wrong_count, "expected 3", [&] { crowd.set_preferred({{}, {}}); });
  crowd.step();
  EXPECT_EQ(crowd.velocity(0), (Vec2{1.0, 0.0}));
  const std::uint64_t before = crowd.digest();
  crowd.set_steering([](CrowdSlice& slice) { slice.prefer(0, {kInfinity, 0.0}); });
  expect_problem(CrowdProblem::not_finite, "robot", [&] { crowd.step(); });
  crowd.set_steering([](CrowdSlice&) { throw std::runtime_error("mine"); });
  EXPECT_THROW(crowd.step(), std::runtime_error);
  EXPECT_EQ(crowd.digest(), before);
}

TEST(CrowdRefuses, TwoRobotsInOnePlaceUntilOneIsRemoved) {
  Crowd crowd = with_one_kind();
  crowd.add_robot({1.0, 0.0});
  crowd.add_robot({5.0, 0.0});
  crowd.step();
  crowd.add_robot({1.0 + 0x1p-20, 0.0});
  expect_problem(CrowdProblem::coincident, "robots 0 and 2", [&] { crowd.step(); });
  crowd.remove_robot(2);
  EXPECT_EQ(crowd.step().robots, 2U);
}

// Nothing that a caller does brings two moving robots into one place on purpose, but relaxed ones may come there.
TEST(Crowd, RobotsThatCameIntoOnePlacePart) {
  for (const CrowdPrecision precision : {CrowdPrecision::float_lines, CrowdPrecision::double_lines}) {
    CrowdOptions options;
    options.precision = precision;
    crowd::CrowdBody body(options);
    body.add_kind({});
    for (int k = 0; k < 20; ++k) body.add_robot({0.01 * k, 0.0}, 0);
    body.add_robot({30.0, 0.0}, 0);
    body.step();
    for (std::size_t i = 0; i < 21; ++i)
      if (body.core->robots.id[i] < 20)
        body.core->robots.x[i] = body.core->robots.y[i] = body.core->robots.mx[i] = body.core->robots.my[i] = 0;
    body.unsorted = true;
    EXPECT_EQ(body.step().touching, 20U);
    for (int k = 0; k < 100; ++k) body.step();
    EXPECT_EQ(body.step().touching, 0U) << name(precision);
  }
}

struct Case {
  const char* scene;
  std::size_t robots;
  int steps;
};

std::ostream& operator<<(std::ostream& to, const Case& c) {
  return to << c.scene << c.robots;
}

class CrowdScenes : public testing::TestWithParam<Case> {
 protected:
  CrowdScene scene() const { return crowd_scene(GetParam().scene, GetParam().robots); }
};

TEST_P(CrowdScenes, Properties1And2And3And7And9HoldInRationalsAndExplainSaysWhatStepChooses) {
  for (const CrowdPrecision precision : {CrowdPrecision::float_lines, CrowdPrecision::double_lines}) {
    CrowdScene s = scene();
    s.options.precision = precision;
    Crowd crowd = crowd_of(s);
    CrowdAudit audit;
    for (int k = 0; k < 4; ++k) {
      run(crowd, GetParam().steps / 4);
      CrowdAuditor auditor(crowd, s.obstacles);
      auditor.set_bodies(bodies_of(s));
      auditor.step(audit);
    }
    EXPECT_EQ(audit.edges > 0, !s.obstacles.empty());
    EXPECT_EQ(audit.bodies > 0, !s.bodies.empty());
    EXPECT_EQ(audit.failures(), 0U) << audit.first << "\nedges " << audit.edges << " open " << audit.edges_open
                                    << " met " << audit.edges_met << "\nbodies " << audit.bodies << " open "
                                    << audit.bodies_open << " met " << audit.bodies_met << "\nunsafe " << audit.unsafe
                                    << " unequal " << audit.unequal << " broken " << audit.broken << " met "
                                    << audit.met << " fast " << audit.fast << " differing " << audit.differing;
    EXPECT_GT(audit.pairs, 100U);
  }
}

TEST(CrowdAudit, FindsTheRuleUnsafeThatRoundsToNearest) {
  for (const CrowdPrecision precision : {CrowdPrecision::float_lines, CrowdPrecision::double_lines}) {
    CrowdScene s = crowd_scene("crowd", 400);
    s.options.precision = precision;
    s.options.certified = false;
    Crowd crowd = crowd_of(s);
    run(crowd, 20);
    CrowdAudit audit;
    CrowdAuditor(crowd).step(audit);
    EXPECT_GT(audit.unsafe, audit.pairs / 10) << name(precision);
    EXPECT_GT(audit.broken, 0U) << name(precision);
    EXPECT_EQ(audit.unequal + audit.differing, 0U) << audit.first;
  }
}

/// The robots of a crowd, in the order that decides between neighbours at one distance.
struct Oracle {
  explicit Oracle(crowd::CrowdBody& body)
      : robots(body.core->robots), kinds(body.core->kinds), options(body.core->options) {}

  float squared(std::size_t i, std::size_t j) const {
    const auto dx = static_cast<float>(robots.x[i] - robots.x[j]), dy = static_cast<float>(robots.y[i] - robots.y[j]);
    return crowd::without_number(dx * dx + dy * dy);
  }
  double distance(std::size_t i, std::size_t j) const {
    return options.position_step * std::hypot(double(robots.x[i]) - robots.x[j], double(robots.y[i]) - robots.y[j]);
  }
  const CrowdKind& kind(std::size_t i) const { return kinds[robots.tag[i] & crowd::Robots::kKind]; }

  const crowd::Robots& robots;
  const std::vector<CrowdKind>& kinds;
  const CrowdOptions& options;
};

TEST_P(CrowdScenes, Property5_TheNearestAndAllWithinReachAreNeighboursByBruteForce) {
  const CrowdScene s = scene();
  crowd::CrowdBody body(s.options);
  for (const CrowdKind& kind : s.kinds) body.add_kind(kind);
  for (const auto& robot : s.robots) body.add_robot(robot.at, robot.kind);
  for (const auto& obstacle : s.obstacles) body.add_obstacle(obstacle);
  for (const auto& b : s.bodies) body.add_body(b.shape, b.moves, b.velocity);
  body.core->steering = [&s](CrowdSlice& slice) {
    for (std::size_t k = 0; k < slice.size(); ++k) slice.prefer(k, s.preferred(slice.id(k), slice.position(k)));
  };
  for (int k = 0; k < GetParam().steps; ++k) body.step();
  body.make_ready();
  const Oracle o(body);
  const std::size_t every = std::max<std::size_t>(1, s.robots.size() / 300);
  for (std::size_t i = 0; i < s.robots.size(); i += every) {
    std::vector<std::pair<float, std::size_t>> others;
    for (std::size_t j = 0; j < s.robots.size(); ++j)
      if (j != i) others.emplace_back(o.squared(i, j), j);
    std::sort(others.begin(), others.end());
    const CrowdExplanation e = body.core->explain(i);
    const auto most = static_cast<std::size_t>(o.kind(i).neighbours);
    for (std::size_t k = 0; k < others.size(); ++k) {
      const std::size_t j = others[k].second;
      const double away = o.distance(i, j);
      const double reach =
          o.kind(i).radius + o.kind(j).radius + (o.kind(i).max_speed + o.kind(j).max_speed) * o.options.time_step;
      const bool is_listed = k < e.neighbours.size() && e.neighbours[k].robot == static_cast<RobotId>(o.robots.id[j]);
      ASSERT_TRUE(is_listed || away > reach) << i << " can meet " << j << " within the step";
      const bool is_near = k < most && away < o.kind(i).neighbour_distance * 0.9999;
      ASSERT_TRUE(is_listed || !is_near) << i << ' ' << k << ' ' << j << ' ' << away;
    }
    ASSERT_LE(e.neighbours.size(), others.size());
  }
}

TEST_P(CrowdScenes, Property4_RangesCutElsewhereGiveTheSameBits) {
  const CrowdScene s = scene();
  std::uint64_t digest = 0;
  StepReport first;
  for (const std::size_t range : {4096, 1, 7, 33, 100}) {
    crowd::CrowdBody body(s.options);
    for (const CrowdKind& kind : s.kinds) body.add_kind(kind);
    for (const auto& robot : s.robots) body.add_robot(robot.at, robot.kind);
    for (const auto& obstacle : s.obstacles) body.add_obstacle(obstacle);
    for (const auto& b : s.bodies) body.add_body(b.shape, b.moves, b.velocity);
    for (const auto& b : s.bodies) body.add_body(b.shape, b.moves, b.velocity);
    body.core->steering = [&s](CrowdSlice& slice) {
      for (std::size_t k = 0; k < slice.size(); ++k) slice.prefer(k, s.preferred(slice.id(k), slice.position(k)));
    };
    body.core->range = range;
    StepReport report;
    for (int k = 0; k < GetParam().steps; ++k) report = body.step();
    if (digest == 0) digest = body.digest(), first = report;
    EXPECT_EQ(body.digest(), digest) << range;
    EXPECT_EQ(report.neighbours, first.neighbours) << range;
    EXPECT_EQ(report.relaxed, first.relaxed) << range;
    EXPECT_EQ(report.touching, first.touching) << range;
    EXPECT_EQ(report.widened, first.widened) << range;
  }
}

TEST_P(CrowdScenes, Property4_EveryTargetAndNumberOfThreadsGivesTheSameBits) {
  const tbb::global_control more_than_processors(tbb::global_control::max_allowed_parallelism, 7);
  for (const CrowdPrecision precision : {CrowdPrecision::float_lines, CrowdPrecision::double_lines}) {
    CrowdScene s = scene();
    s.options.precision = precision;
    std::uint64_t digest = 0;
    for (const char* target : {"", "AVX3", "AVX2", "SSE4", "SSE2"}) {
      if (!lp::limit_batch_target(target)) continue;  // not on this machine
      for (const int threads : {1, 2, 7}) {
        s.options.threads = threads;
        Crowd crowd = crowd_of(s);
        run(crowd, GetParam().steps);
        if (digest == 0) digest = crowd.digest();
        EXPECT_EQ(crowd.digest(), digest) << crowd_target() << ' ' << threads << ' ' << name(precision);
      }
    }
    lp::limit_batch_target("");
  }
}

TEST_P(CrowdScenes, Property6_ARunGoesOnFromASnapshotOfAnyStep) {
  CrowdScene s = scene();
  s.options.threads = 2;
  Crowd through = crowd_of(s), other = crowd_of(s);
  const auto steer = [&s](CrowdSlice& slice) {
    for (std::size_t k = 0; k < slice.size(); ++k) slice.prefer(k, s.preferred(slice.id(k), slice.position(k)));
  };
  for (int k = 0; k < GetParam().steps; ++k) {
    std::stringstream stream;
    other.snapshot(stream);
    other = Crowd::restored(stream, 1 + k % 2);
    other.set_steering(steer);
    other.step();
    through.step();
    ASSERT_EQ(other.digest(), through.digest()) << k;
  }
  std::stringstream of_through, of_other;
  through.snapshot(of_through);
  other.snapshot(of_other);
  EXPECT_TRUE(of_through.str() == of_other.str());
}

INSTANTIATE_TEST_SUITE_P(All, CrowdScenes,
                         testing::Values(Case{"crowd", 1000, 40}, Case{"ring", 120, 300}, Case{"streams", 1000, 40},
                                         Case{"groups", 400, 200}, Case{"mixture", 1000, 60}, Case{"jam", 500, 80},
                                         Case{"blocks", 200, 160}, Case{"pillars", 400, 60}, Case{"bodies", 400, 60},
                                         Case{"clumps", 1300, 12}),
                         [](const auto& scene) { return std::string(scene.param.scene); });

TEST(CrowdSnapshot, ChangedOrCutOffIsRefused) {
  const CrowdScene scene = crowd_scene("pillars", 40);
  Crowd crowd = crowd_of(scene);
  run(crowd, 3);
  crowd.remove_robot(7);
  crowd.set_preferred(std::vector<Vec2>(40, Vec2{1.0, 0.5}));
  for (int kind = 0; kind < 4; ++kind) crowd.add_moving_body(shape_like(kind, {40.0, 10.0 * kind}, 1.0), {-0.5, 0.25});
  crowd.step();
  std::stringstream stream;
  crowd.snapshot(stream);
  const std::string bytes = stream.str();
  std::istringstream whole(bytes);
  Crowd restored = Crowd::restored(whole);
  restored.step();
  crowd.step();
  EXPECT_EQ(restored.digest(), crowd.digest());
  EXPECT_EQ(restored.add_robot({-90.0, 0.0}), 7U);
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    std::string changed = bytes;
    changed[k] = static_cast<char>(changed[k] ^ 0x40);
    std::istringstream from(changed), short_one(bytes.substr(0, k));
    EXPECT_THROW(Crowd::restored(from), CrowdError) << k;
    EXPECT_THROW(Crowd::restored(short_one), CrowdError) << k;
  }
}

TEST(CrowdSnapshot, AnExplanationBetweenChangesNothing) {
  const CrowdScene scene = crowd_scene("crowd", 300);
  Crowd plain = crowd_of(scene), asked = crowd_of(scene);
  asked.explain(3);
  asked.add_robot({-100.0, -100.0});
  plain.add_robot({-100.0, -100.0});
  const CrowdScene bigger = crowd_scene("crowd", 301);
  for (Crowd* crowd : {&plain, &asked})
    crowd->set_steering([&bigger](CrowdSlice& s) {
      for (std::size_t k = 0; k < s.size(); ++k) s.prefer(k, bigger.preferred(s.id(k), s.position(k)));
    });
  for (int k = 0; k < 10; ++k) {
    asked.explain(static_cast<RobotId>(k));
    std::stringstream stream;
    asked.snapshot(stream);
    asked.step();
    plain.step();
    ASSERT_EQ(asked.digest(), plain.digest()) << k;
  }
}

TEST(CrowdMemory, StaysBelow96BytesARobotInDenseCrowdsWithPreferencesByArray) {
  const std::size_t count = 10000;
  for (const char* kind : {"crowd", "dense"})
    for (const CrowdPrecision precision : {CrowdPrecision::float_lines, CrowdPrecision::double_lines}) {
      CrowdScene scene = crowd_scene(kind, count);
      scene.options.precision = precision;
      Crowd crowd = crowd_of(scene);
      crowd.set_steering(nullptr);
      std::vector<Vec2> positions, preferred(count);
      for (int k = 0; k < 41; ++k) {
        crowd.positions(positions);
        for (std::size_t i = 0; i < count; ++i) preferred[i] = scene.preferred(i, positions[i]);
        crowd.set_preferred(preferred);
        crowd.step();
      }
      EXPECT_LT(crowd.bytes(), 96 * count) << kind << ' ' << name(precision);
      EXPECT_GT(crowd.bytes(), 60 * count) << kind << ' ' << name(precision);
    }
}

}  // namespace
}  // namespace exactvo::formation
