// SPDX-License-Identifier: GPL-3.0-or-later
// What is said before a run about goals that obstacles shut off, against constructed rooms and a flooded grid.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exactvo/formation/disc_obstacle.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/round_polygon.h"
#include "reach/reachability.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using testing::HasSubstr;

constexpr double kRadius = 0.5;  // m

Scenario scene(Vec2 start, std::vector<Vec2> goals, std::vector<SceneObstacle> obstacles) {
  Scenario s;
  Robot r;
  r.id = "R1";
  r.radius = kRadius;
  r.position = start;
  r.goals = std::move(goals);
  s.robots = {r};
  s.obstacles = std::move(obstacles);
  return s;
}

/// A room of 6 m with a door of this width on its right.
geometry::Polyline room(double door) {
  return {{{3, 0.5 * door}, {3, 3}, {-3, 3}, {-3, -3}, {3, -3}, {3, -0.5 * door}}};
}

TEST(Preflight, AGoalInARoomWithANarrowDoorCannotBeReached) {
  const auto warnings = warnings_before(scene({8, 0}, {{0, 0}}, {{"room", room(0.9)}}));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0],
              HasSubstr("goal of R1, (0, 0), cannot be reached: obstacle 'room' encloses it, with a gap of 0.9 m "
                        "for a robot 1 m wide"));
  EXPECT_TRUE(warnings_before(scene({8, 0}, {{0, 0}}, {{"room", room(1.1)}})).empty());
  EXPECT_EQ(warnings_before(scene({8, 0}, {{0, 0}}, {{"room", room(0.0)}})).size(), 1u);
}

TEST(Preflight, NumbersThatAreComparedDifferInTheWarning) {
  const auto door = warnings_before(scene({8, 0}, {{0, 0}}, {{"room", room(0.9999)}}));
  ASSERT_EQ(door.size(), 1u);
  EXPECT_THAT(door[0], HasSubstr("with a gap of 0.9999 m for a robot 1 m wide"));
  Scenario fast = scene({0, 0}, {{9, 0}}, {});
  fast.robots[0].velocity = {3.00000002, 0};
  ASSERT_EQ(warnings_before(fast).size(), 1u);
  EXPECT_EQ(warnings_before(fast)[0], "R1 starts at 3.00000002 m/s, beyond its max_speed of 3 m/s");
  Scenario near = scene({0, 0}, {{9, 0}}, {});
  near.robots.push_back(near.robots[0]);
  near.robots[1].id = "R2";
  near.robots[1].position = {0, 5};
  near.robots[1].goals = {{9, 1.0 + near.margins.robot - 1e-5}};
  near.arrival_tolerance = 1e-6;
  ASSERT_EQ(warnings_before(near).size(), 1u);
  EXPECT_THAT(warnings_before(near)[0], HasSubstr("are 1.03999 m apart, and radii and margin take 1.04 m"));
}

TEST(Preflight, AStartThatIsShutInIsReported) {
  const auto warnings = warnings_before(scene({0, 0}, {{8, 0}}, {{"room", room(0.9)}}));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("'room' encloses the start"));
  EXPECT_TRUE(warnings_before(scene({0, 0}, {{1, 1}}, {{"room", room(0.9)}})).empty()) << "both are inside";
}

TEST(Preflight, EveryWaypointIsJudged) {
  const auto warnings = warnings_before(scene({8, 0}, {{0, 0}, {8, 5}}, {{"room", room(0.9)}}));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("goal 1 of R1"));
}

/// The scene moved, mirrored (scale < 0 turns it by half a turn) and scaled.
Scenario mapped(Scenario s, double scale, Vec2 shift, bool mirrored) {
  const auto to = [&](Vec2& p) { p = scale * (mirrored ? Vec2{-p.x, p.y} : p) + shift; };
  for (Robot& r : s.robots) {
    to(r.position);
    for (Vec2& goal : r.goals) to(goal);
    r.radius *= std::fabs(scale);
    r.max_speed *= std::fabs(scale);
  }
  for (SceneObstacle& o : s.obstacles)
    for (Vec2& p : std::get<geometry::Polyline>(o.shape).points) to(p);
  s.arrival_tolerance *= std::fabs(scale);
  s.margins.obstacle *= std::fabs(scale);
  s.margins.robot *= std::fabs(scale);
  s.neighbour_distance *= std::fabs(scale);
  return s;
}

/// A closed room from (0, 0) to (10, 10), and the robot to its left.
Scenario sealed_room(std::vector<Vec2> goals) {
  return scene({-3, 5}, std::move(goals), {{"room", geometry::Polyline{{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}}}}});
}

TEST(Preflight, AWaypointInASealedRoomIsEnclosedAndSoIsTheGoalAfterIt) {
  struct Placement {
    double scale;
    Vec2 shift;
    bool mirrored;
  };
  int judged = 0;
  for (const Placement& at :
       {Placement{1, {}, false}, Placement{1, {}, true}, Placement{-1, {}, false}, Placement{1e3, {}, false},
        Placement{1e-3, {}, true}, Placement{1, {1e6, -1e6}, false}, Placement{1e-3, {1e6, 1e6}, false}}) {
    for (const bool is_reversed : {false, true}) {
      Scenario s = sealed_room({{5, 9.75}, {9, 1}});
      if (is_reversed) std::reverse(s.robots[0].goals.begin(), s.robots[0].goals.end());
      const auto warnings = warnings_before(mapped(s, at.scale, at.shift, at.mirrored));
      ASSERT_EQ(warnings.size(), 2u) << at.scale << " " << is_reversed;
      for (int k = 0; k < 2; ++k, ++judged) {
        EXPECT_THAT(warnings[k], HasSubstr("goal " + std::to_string(k + 1) + " of R1"));
        EXPECT_THAT(warnings[k], HasSubstr("cannot be reached: obstacle 'room' encloses it"));
        EXPECT_THAT(warnings[k], testing::Not(HasSubstr("radius")));
      }
    }
  }
  EXPECT_EQ(judged, 28);
}

TEST(Preflight, AGoalAtTheWallOfASealedRoomIsEnclosed) {
  // Less room than the robot's radius and the tolerance leave: a smaller robot would be shut out as well.
  const auto warnings = warnings_before(sealed_room({{5, 9.75}}));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("cannot be reached: obstacle 'room' encloses it"));
  // On the outside the radius is to blame.
  const auto outside = warnings_before(sealed_room({{5, 10.25}}));
  ASSERT_EQ(outside.size(), 1u);
  EXPECT_THAT(outside[0], HasSubstr("too near to obstacle 'room' for the robot's radius"));
}

TEST(Preflight, GoalsAfterOneThatIsOutOfReachAreJudgedFromTheLastThatIsNot) {
  EXPECT_EQ(warnings_before(sealed_room({{-3, 9}, {5, 5}, {5, 12}})).size(), 1u);
  EXPECT_EQ(warnings_before(sealed_room({{5, 5}, {5, 12}, {9, 1}, {1, 1}})).size(), 3u);
  Scenario inside = sealed_room({{-3, 9}, {5, 9.75}, {9, 1}});
  inside.robots[0].position = {5, 5};
  const auto warnings = warnings_before(inside);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("obstacle 'room' encloses the start"));
}

TEST(Preflight, TheReasonInARunIsTheRoomToo) {
  Scenario s = sealed_room({{5, 9.75}, {9, 1}});
  s.time_limit = 5.0;
  const std::string outcome = simulate(s).outcome;
  EXPECT_THAT(outcome, HasSubstr("R1 cannot reach its goal 1: obstacle 'room' encloses the goal"));
  EXPECT_THAT(outcome, testing::Not(HasSubstr("no proof")));
}

TEST(Preflight, AChainOfSeveralObstaclesIsNamed) {
  // Two halves of a ring that come within 0.6 m of each other, and something that does not matter.
  const std::vector<SceneObstacle> halves{{"north", geometry::Polyline{{{-3, 0.3}, {-3, 3}, {3, 3}, {3, 0.3}}}},
                                          {"south", geometry::Polyline{{{-3, -0.3}, {-3, -3}, {3, -3}, {3, -0.3}}}},
                                          {"far", geometry::Polyline{{{9, 9}, {12, 12}}}}};
  const auto warnings = warnings_before(scene({8, 0}, {{0, 0}}, halves));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("obstacles 'north' and 'south' enclose it, with 2 gaps of at most 0.6 m"));
}

TEST(Preflight, AGapBetweenDiscsThatTheirPolygonsCloseIsNoProof) {
  // The gap lies between two corners of the polygons, where these are widest.
  constexpr double kPost = 5.0;
  const double angle = geometry::kPi / geometry::kRoundCorners;
  const Vec2 along{std::cos(angle), std::sin(angle)}, across{-along.y, along.x};
  const auto posts = [&](double gap) {
    const double to_centre = kPost + 0.5 * gap;
    const Vec2 a = -to_centre * along, b = to_centre * along;
    return scene(-12.0 * across, {12.0 * across},
                 {disc_obstacle("left", {a, kPost}),
                  disc_obstacle("right", {b, kPost}),
                  {"room", geometry::Polyline{{a, a + 20.0 * across, b + 20.0 * across, b}}}});
  };
  const Scenario wide = posts(2 * kRadius + 0.04);
  for (double y = -12.0; y <= 12.0; y += 0.01)  // it can drive straight on
    for (const SceneObstacle& o : wide.obstacles) ASSERT_GT(signed_distance(o, y * across), kRadius);
  const auto open = warnings_before(wide);
  ASSERT_EQ(open.size(), 1u);
  EXPECT_THAT(open[0], HasSubstr("has no route to it: obstacles 'left', 'right' and 'room' enclose it"));
  EXPECT_THAT(open[0], HasSubstr("no proof, as discs count as the polygons round them, up to 0.0242 m wider"));
  EXPECT_THAT(open[0], testing::Not(HasSubstr("cannot be reached")));

  const auto closed = warnings_before(posts(2 * kRadius - 0.04));
  ASSERT_EQ(closed.size(), 1u);
  EXPECT_THAT(closed[0], HasSubstr("cannot be reached: obstacles 'left', 'right' and 'room' enclose it"));
  EXPECT_THAT(closed[0], testing::Not(HasSubstr("proof")));
  EXPECT_TRUE(warnings_before(posts(2 * kRadius + 0.06)).empty());

  // A large disc elsewhere has no part in a room of walls.
  const auto elsewhere =
      warnings_before(scene({8, 0}, {{0, 0}}, {{"room", room(0.9)}, disc_obstacle("far", {{80, 0}, 50.0})}));
  ASSERT_EQ(elsewhere.size(), 1u);
  EXPECT_THAT(elsewhere[0], HasSubstr("cannot be reached: obstacle 'room' encloses it"));
  EXPECT_THAT(elsewhere[0], testing::Not(HasSubstr("proof")));
}

TEST(Preflight, WallsThatCrossOrTouchCloseARoom) {
  std::vector<SceneObstacle> bars{{"a", geometry::Polyline{{{-4, 3}, {4, 3}}}},
                                  {"b", geometry::Polyline{{{-4, -3}, {4, -3}}}},
                                  {"c", geometry::Polyline{{{3, -4}, {3, 4}}}},
                                  {"d", geometry::Polyline{{{-3, -3}, {-3, 3}}}}};
  const auto warnings = warnings_before(scene({8, 0}, {{0, 0}}, bars));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("obstacles 'a', 'b', 'c' and 1 more enclose it"));
  bars.pop_back();
  EXPECT_TRUE(warnings_before(scene({8, 0}, {{0, 0}}, bars)).empty());
}

TEST(Preflight, ACourtyardIsClosed) {
  const geometry::Polygon house{{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}, {{{-3, -3}, {-3, 3}, {3, 3}, {3, -3}}}};
  EXPECT_EQ(warnings_before(scene({8, 0}, {{0, 0}}, {{"house", house}})).size(), 1u);
  EXPECT_TRUE(warnings_before(scene({-1, 0}, {{1, 0}}, {{"house", house}})).empty());
}

TEST(Preflight, AGoalWithinReachOverTheWallIsNotShutOff) {
  // The robot may stay 2 m away from its goal, so that it need not enter.
  Scenario s = scene({8, 0}, {{2, 0}}, {{"room", room(0.9)}});
  EXPECT_EQ(warnings_before(s).size(), 1u);
  s.arrival_tolerance = 2.0;
  EXPECT_TRUE(warnings_before(s).empty());
}

/// Which cells of a grid a robot's centre can be in, and which of them hang together.
class Flood {
 public:
  /// `slack` m is added to the robot's radius: > 0 leaves out cells that are not certainly free.
  Flood(const Scenario& s, double slack) {
    for (int i = 0; i < kCells * kCells; ++i) {
      double least = kRadius + 1.0;
      for (const SceneObstacle& o : s.obstacles)
        least = std::min(least, std::fabs(geometry::signed_distance(o.shape, at(i))));
      free_.push_back(least >= kRadius + slack);
    }
  }
  static int cell(Vec2 p) { return index(p.x) + kCells * index(p.y); }
  bool is_free(Vec2 p) const { return free_[static_cast<std::size_t>(cell(p))]; }

  bool connects(Vec2 from, Vec2 to) const {
    std::vector<char> seen(free_.size(), 0);
    std::vector<int> queue{cell(from)};
    seen[static_cast<std::size_t>(queue[0])] = 1;
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const int x = queue[head] % kCells, y = queue[head] / kCells;
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy) {
          const int u = x + dx, v = y + dy;
          if (u < 0 || v < 0 || u >= kCells || v >= kCells) continue;
          const auto next = static_cast<std::size_t>(u + kCells * v);
          if (seen[next] || !free_[next]) continue;
          seen[next] = 1;
          queue.push_back(u + kCells * v);
        }
    }
    return seen[static_cast<std::size_t>(cell(to))] != 0;
  }

  static constexpr double kCell = 0.1;  // m

 private:
  static constexpr int kCells = 156;
  static constexpr double kLow = -7.8;  // m
  static int index(double x) { return static_cast<int>((x - kLow) / kCell); }
  static Vec2 at(int i) { return {kLow + kCell * (i % kCells + 0.5), kLow + kCell * (i / kCells + 0.5)}; }

  std::vector<bool> free_;
};

/// Parts of a ring, turned, shifted and with gaps round the diameter, and some walls across.
Scenario random_scene(test::SeededRandom& random) {
  std::vector<SceneObstacle> obstacles;
  const int parts = static_cast<int>(random.uniform(2.0, 6.0));
  const double ring = random.uniform(2.0, 4.5);
  const double narrow = random.uniform(0.4, 1.4);  // m, about
  double angle = random.uniform(0.0, 6.28);
  for (int k = 0; k < parts; ++k) {
    const double gap = (narrow + random.uniform(-0.1, 0.1)) / ring, span = 6.283 / parts - gap;
    geometry::Polyline arc;
    for (int j = 0; j <= 4; ++j)
      arc.points.push_back(geometry::rotated({ring + random.uniform(-0.15, 0.15), 0.0}, angle + span * j / 4));
    obstacles.push_back({"arc" + std::to_string(k), arc});
    angle += 6.283 / parts;
  }
  const Vec2 middle = random.in_box(3.0), half = random.uniform(0.3, 2.0) * random.direction();
  obstacles.push_back({"wall", geometry::Polyline{{middle - half, middle + half}}});
  return scene(random.in_box(6.0), {random.in_box(2.0)}, obstacles);
}

TEST(Preflight, AgreesWithAFloodedGrid) {
  test::SeededRandom random(test::seed_of_run(16));
  constexpr double kDiagonal = 0.7072 * Flood::kCell;  // m: from a cell's middle to its corner
  int separated = 0, joined = 0, open = 0;
  for (int k = 0; k < 60; ++k) {
    const Scenario s = random_scene(random);
    const Vec2 start = s.robots[0].position, goal = s.robots[0].goals[0];
    const Flood certain(s, kDiagonal);
    if (!certain.is_free(start) || !certain.is_free(goal)) continue;
    const bool shut = !detail::Reachability(detail::terrain_of(s)).reachable_place(kRadius, start, {goal, 0.0});
    if (certain.connects(start, goal)) {
      EXPECT_FALSE(shut) << "case " << k << ": a way exists";
      ++joined;
    } else if (!Flood(s, -kDiagonal).connects(start, goal)) {
      EXPECT_TRUE(shut) << "case " << k << ": no way exists";
      ++separated;
    } else {
      ++open;  // too near to call on this grid
    }
  }
  EXPECT_GT(separated, 5);
  EXPECT_GT(joined, 5);
  EXPECT_LT(open, 25);
}

TEST(Preflight, OutsideOfAllObstaclesTheMapOfRoutesHasAWayToo) {
  test::SeededRandom random(test::seed_of_run(17));
  int outside = 0;
  for (int k = 0; k < 200; ++k) {
    Scenario s = random_scene(random);
    const Vec2 start = s.robots[0].position = random.in_box(7.0), goal = s.robots[0].goals[0] = random.in_box(7.0);
    geometry::Box box;
    for (const SceneObstacle& o : s.obstacles)
      for (const Vec2 p : geometry::vertices_of(o.shape)) box.add(p);
    detail::Reachability asked(detail::terrain_of(s)), with_map(detail::terrain_of(s));
    EXPECT_EQ(asked.reachable_place(kRadius, start, {goal, 0.0}).has_value(),
              with_map.plan(kRadius).is_reachable(start, goal))
        << "case " << k;
    outside += geometry::distance_below(box, start) > kRadius && geometry::distance_below(box, goal) > kRadius;
  }
  EXPECT_GT(outside, 20);
}

TEST(Preflight, RobotsThatHaveArrivedBeforeTheyMoveAreNamed) {
  Scenario s = scene({0.002, 0.001}, {{0.008, 0.001}}, {});  // metres and a map in millimetres, say
  s.robots.push_back(s.robots[0]);
  s.robots[1].id = "R2";
  s.robots[1].position = {5.0, 5.0};
  s.robots[1].goals = {{5.05, 5.0}, {4.95, 5.0}};
  const std::vector<std::string> warnings = warnings_before(s);
  ASSERT_EQ(warnings.size(), 1u) << testing::PrintToString(warnings);
  EXPECT_THAT(warnings[0], HasSubstr("2 robots within arrival_tolerance, 0.1 m, of the goal at the start"));
  EXPECT_THAT(warnings[0], HasSubstr(": R1, R2"));
  s.robots[0].goals = {s.robots[0].position};
  s.robots[1].goals = {{5.05, 5.0}, {8.0, 5.0}};
  EXPECT_TRUE(warnings_before(s).empty()) << "one stays where it is, the other has a way to go";
}

/// Five in a wedge, their leader on a straight way.
Scenario wedge() {
  Scenario s;
  s.formation.emplace();
  s.formation->leader = {{{{0, 0}, {20, 0}}, 1.0}};
  s.formation->offsets = {{0, 0}, {-2, 2}, {-2, -2}, {-4, 4}, {-4, -4}};
  s.formation->topology.adjacency.assign(5, std::vector<double>(5, 1.0));
  s.formation->topology.pinning.assign(5, 1.0);
  for (std::size_t i = 0; i < 5; ++i) {
    s.formation->topology.adjacency[i][i] = 0.0;
    Robot& r = s.robots.emplace_back();
    r.id = "R" + std::to_string(i + 1);
    r.position = s.formation->offsets[i];
  }
  return s;
}

TEST(Preflight, AFormationThatFollowsItsChoicesTooSlowlyIsWarnedOf) {
  EXPECT_TRUE(warnings_before(wedge()).empty());
  Scenario slow = wedge();
  slow.formation->gains.k3 = 1.0;
  std::vector<std::string> warnings = warnings_before(slow);
  ASSERT_EQ(warnings.size(), 1u) << testing::PrintToString(warnings);
  EXPECT_THAT(warnings[0], HasSubstr("gain k3 = 1 1/s: robots that pass each other at 3 m/s"));
  EXPECT_THAT(warnings[0], HasSubstr("k3 = 10.6 1/s would do"));
  slow.formation->gains.k3 = 10.7;
  EXPECT_TRUE(warnings_before(slow).empty());
  Scenario bounded = wedge();
  bounded.formation->controller_options.acceleration_bound = 1.0;
  warnings = warnings_before(bounded);
  ASSERT_EQ(warnings.size(), 1u) << testing::PrintToString(warnings);
  EXPECT_THAT(warnings[0], HasSubstr("acceleration_bound = 1 m/s^2: a robot takes 3 s to stop"));
  bounded.formation->controller_options.acceleration_bound = 10.0;
  EXPECT_TRUE(warnings_before(bounded).empty());
}

}  // namespace
}  // namespace exactvo::formation
