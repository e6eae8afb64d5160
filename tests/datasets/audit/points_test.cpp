// SPDX-License-Identifier: GPL-3.0-or-later
// The points of an audit, each by the forgery that it is there for. Braking: tests/formation/acceleration_test.cpp;
// wheels: tests/formation/wheels_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exactvo/datasets/audit.h"
#include "exactvo/formation/simulation.h"
#include "formation/liveness_scenes.h"
#include "recordings/exact_shapes.h"
#include "support/seeded_random.h"

namespace exactvo::datasets::test {
namespace {

using exactvo::test::SeededRandom;
using formation::ConstraintSource;
using formation::DecisionConstraint;
using formation::RobotStep;
using formation::Scenario;
using formation::Step;
using geometry::Vec2;

/// Two robots that pass each other along a wall, one behind a block.
Scenario scene() {
  Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  formation::Robot a, b;
  a.id = "a";
  a.position = {0.0, 0.1};
  a.goals = {{8.0, 0.0}};
  b.id = "b";
  b.position = {8.0, -0.1};
  b.goals = {{0.0, 0.0}};
  s.robots = {a, b};
  s.obstacles = {{"wall", geometry::Polyline{{{4.0, 0.9}, {4.0, 3.0}, {5.0, 4.0}}}},
                 {"block", geometry::Polygon{{{2.0, -3.0}, {3.0, -3.0}, {3.0, -0.7}, {2.0, -0.7}}, {}}}};
  s.time_limit = 20.0;
  return s;
}

RecordingFile recorded(const Scenario& s, formation::SimulationOptions options = {}) {
  RecordingFile file;
  file.scenario = s;
  file.info.method = name(options.method);
  if (s.formation) {
    file.info.controller = name(options.controller);
    file.info.integrator = name(options.integrator);
  }
  file.recording = formation::simulate(s, options);
  return file;
}

Scenario formation_scene() {
  Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.time_step = 0.02;
  s.time_limit = 1.0;
  for (int k = 0; k < 2; ++k) {
    formation::Robot r;
    r.id = "R" + std::to_string(k + 1);
    r.position = {0.0, 1.3 * k};
    s.robots.push_back(r);
  }
  s.formation.emplace();
  s.formation->topology = {{{0, 1}, {1, 0}}, {1, 1}};
  s.formation->offsets = {{0, 0}, {0, 1.3}};
  s.formation->leader = {{{{0.5, 0.5}, {9, 3}}, 1.5}};
  s.obstacles = {{"post", geometry::Polygon{{{0.9, -0.2}, {1.2, -0.2}, {1.2, 0.3}, {0.9, 0.3}}, {}}}};
  return s;
}

const RecordingFile& clean() {
  static const RecordingFile file = recorded(scene());
  return file;
}

/// The audit of `clean()` after a forgery of the first constraint that `which` picks.
template <class Which, class How>
AuditReport forged_constraint(const Which& which, const How& how) {
  RecordingFile file = clean();
  for (Step& row : file.recording.steps)
    for (RobotStep& robot : row.robots)
      for (DecisionConstraint& c : robot.constraints)
        if (which(c)) {
          how(robot, c);
          return audit(file);
        }
  ADD_FAILURE() << "nothing to forge";
  return {};
}
bool is_hard(const DecisionConstraint& c) {
  return c.hard;
}
bool is_of_pair(const DecisionConstraint& c) {
  return c.source == ConstraintSource::robot;
}

TEST(AuditPoints, AreAllProvenOfAnUnchangedRun) {
  const Scenario s = scene();
  for (const formation::Method method :
       {formation::Method::ivo, formation::Method::orca, formation::Method::ivo_edge}) {
    formation::SimulationOptions options;
    options.method = method;
    const AuditReport report = audit(recorded(s, options), &s);
    EXPECT_TRUE(report.clean()) << to_json(report);
    for (std::size_t p = 0; p < kAuditPoints; ++p) {
      const PointCount& point = report.points[p];
      const auto which = static_cast<AuditPoint>(p);  // it has no plans, no acceleration and no wheels
      const bool is_absent =
          which == AuditPoint::plans || which == AuditPoint::braking || which == AuditPoint::kinematics;
      EXPECT_EQ(point.proven > 0, !is_absent) << name(method);
      EXPECT_EQ(point.asked(), point.proven) << name(method);
    }
    EXPECT_EQ(report.largest_violation, 0.0) << "choices are rounded inward";
  }
}

/// Two groups that meet in a street too narrow to pass, and stay there in contact.
Scenario jam(double pitch) {
  Scenario s;
  s.time_limit = 14.0;
  const auto wall = [](double y) { return geometry::Polyline{{{-20, y}, {20, y}}}; };
  s.obstacles = {{"left", wall(2.0)}, {"right", wall(-2.0)}};
  for (int k = 0; k < 14; ++k) {
    formation::Robot r;
    r.id = "R" + std::to_string(k + 1);
    const double side = k % 2 == 0 ? -1.0 : 1.0;
    r.position = {side * (4.0 + pitch * (k / 6)), -1.3 + 1.3 * (k / 2 % 3)};
    r.goals = {{-side * 15.0, r.position.y}};
    r.max_speed = 1.5;
    s.robots.push_back(r);
  }
  return s;
}

TEST(AuditPoints, ChoicesOfRobotsInContactAreProven) {
  std::size_t exact = 0;
  for (const formation::Liveness liveness : {formation::Liveness::bias, formation::Liveness::off}) {
    for (const double pitch : {1.2, 1.7}) {
      formation::SimulationOptions options;
      options.liveness = liveness;
      const RecordingFile file = recorded(jam(pitch), options);
      const PointCount choices = audit(file)[AuditPoint::choices];
      EXPECT_EQ(choices.asked(), choices.proven) << name(liveness) << ' ' << pitch;
      for (const Step& row : file.recording.steps)
        for (const RobotStep& robot : row.robots) exact += robot.exact_multipliers;
    }
  }
  RecordProperty("exact", static_cast<int>(exact));
}

TEST(AuditPoints, MultipliersMarkedAsExactAreNotWritten) {
  const AuditReport report =
      forged_constraint([](const DecisionConstraint& c) { return c.multiplier > 1e-3; },
                        [](RobotStep& robot, DecisionConstraint&) { robot.exact_multipliers = true; });
  EXPECT_EQ(report[AuditPoint::choices].refuted, 1u);
  RecordingFile file = clean();
  RobotStep& robot = file.recording.steps[3].robots[0];
  robot.exact_multipliers = true;
  for (DecisionConstraint& c : robot.constraints) c.multiplier = 0.0;
  for (lp::ActiveConstraint& part : robot.bound) part.multiplier = 0.0;
  EXPECT_TRUE(audit(file).clean()) << "they follow from the half-planes";
  robot.chosen = 0.999 * robot.chosen;
  EXPECT_EQ(audit(file)[AuditPoint::choices].refuted, 1u);
}

TEST(AuditPoints, ARunThatEndsSinceItsRobotStaysIsWhole) {
  Scenario s;
  s.time_limit = 20.0;
  s.obstacles = {{"box", geometry::Polygon{{{4, -2}, {8, -2}, {8, 2}, {4, 2}}, {}}}};
  formation::Robot r;
  r.id = "R";
  r.goals = {{6, 0}};
  s.robots = {r};
  RecordingFile file = recorded(s);
  EXPECT_LT(file.recording.steps.size(), 10u) << "the goal lies inside the box";
  const AuditReport report = audit(file);
  EXPECT_TRUE(report.clean()) << to_json(report);
  EXPECT_TRUE(report.has_staying);
  EXPECT_EQ(not_audited(report).size(), not_audited(audit(clean())).size() + 1);
  for (Step& row : file.recording.steps) row.robots[0].mode = formation::Mode::guided;
  EXPECT_EQ(audit(file)[AuditPoint::sequence].refuted, 1u) << "a robot that goes on is not at its end";
}

TEST(AuditPoints, AnotherScenarioIsRefused) {
  Scenario other = scene();
  other.robots[0].radius = std::nextafter(0.5, 0.0);
  EXPECT_EQ(audit(clean(), &other)[AuditPoint::scenario].refuted, 1u);
  const Scenario same = scene();
  EXPECT_TRUE(audit(clean(), &same).clean());
  const std::vector<std::string> without = not_audited(audit(clean())), with = not_audited(audit(clean(), &same));
  EXPECT_EQ(without.size(), with.size() + 1);
}

TEST(AuditPoints, ABodyThatIsSmallerThanItsObstacleIsRefused) {
  formation::SimulationOptions options;
  options.method = formation::Method::ivo_edge;
  const RecordingFile good = recorded(scene(), options);
  std::size_t forged = 0;
  for (std::size_t k = 0; k < good.recording.bodies.size(); ++k) {
    RecordingFile file = good;
    auto* ellipse = std::get_if<geometry::Ellipse>(&file.recording.bodies[k].shape);
    if (!ellipse) continue;
    ellipse->l11 *= 0.5;
    ellipse->l21 *= 0.5;
    ellipse->l22 *= 0.5;
    EXPECT_GT(audit(file)[AuditPoint::bodies].refuted, 0u);
    file = good;
    file.recording.bodies[k].owners = {file.recording.bodies[k].owners.front() == 0 ? std::size_t{1} : 0};
    EXPECT_GT(audit(file)[AuditPoint::bodies].refuted, 0u) << "it stands for another obstacle";
    ++forged;
  }
  EXPECT_GT(forged, 0u);
}

TEST(AuditPoints, GoalBodiesThatLeaveABodyOutAreRefused) {
  for (std::size_t k = 0; k < clean().recording.goal_bodies[0].bodies.size(); ++k) {
    RecordingFile file = clean();
    std::vector<std::size_t>& bodies = file.recording.goal_bodies[0].bodies;
    bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(k));
    EXPECT_GT(audit(file)[AuditPoint::bodies].refuted, 0u);
  }
}

TEST(AuditPoints, AHalfPlaneThatIsMissingIsNoticedThoughItDoesNotBind) {
  // Rows hold what binds and what is within reach of a step; of these some do not bind.
  std::size_t noticed = 0;
  for (std::size_t k = 0; k < clean().recording.steps.size(); ++k)
    for (std::size_t i = 0; i < 2; ++i) {
      const std::vector<DecisionConstraint>& all = clean().recording.steps[k].robots[i].constraints;
      for (std::size_t c = 0; c < all.size(); ++c) {
        if (all[c].active) continue;
        RecordingFile file = clean();
        std::vector<DecisionConstraint>& left = file.recording.steps[k].robots[i].constraints;
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(c));
        noticed += audit(file)[AuditPoint::completeness].refuted;
      }
    }
  EXPECT_GT(noticed, 3u);
}

TEST(AuditPoints, AnObstacleThatNoRobotSawIsMissing) {
  RecordingFile file = clean();
  const Vec2 at = file.recording.steps[20].robots[0].position;
  file.scenario.obstacles.push_back({"ghost", geometry::Polyline{{at + Vec2{-0.1, 0.55}, at + Vec2{0.1, 0.55}}}});
  const AuditReport report = audit(file);
  EXPECT_GT(report[AuditPoint::completeness].refuted, 0u);
  EXPECT_GT(report[AuditPoint::bodies].refuted, 0u);
}

TEST(AuditPoints, AHorizonBelowTheTimeStepIsRefused) {
  const AuditReport report =
      forged_constraint(is_hard, [](RobotStep&, DecisionConstraint& c) { c.time_horizon = 0.049; });
  EXPECT_EQ(report[AuditPoint::half_planes].refuted, 1u);
}

TEST(AuditPoints, AHardHalfPlaneMarkedAsSoftIsRefused) {
  const AuditReport report = forged_constraint(is_hard, [](RobotStep&, DecisionConstraint& c) { c.hard = false; });
  EXPECT_GT(report[AuditPoint::half_planes].refuted, 0u);
}

TEST(AuditPoints, AHalfPlaneOfAnotherBodyIsRefused) {
  const AuditReport report = forged_constraint(is_hard, [](RobotStep&, DecisionConstraint& c) { c.body = 1000; });
  EXPECT_GT(report[AuditPoint::half_planes].refuted, 0u);
}

TEST(AuditPoints, ARobotsHalfThatTakesLessThanItsShareIsRefused) {
  const AuditReport report =
      forged_constraint(is_of_pair, [](RobotStep&, DecisionConstraint& c) { c.half_plane.offset -= 0.1; });
  EXPECT_GT(report[AuditPoint::half_planes].refuted, 0u);
}

TEST(AuditPoints, APairWhoseNormalsAreNotOppositeIsNotKeptApart) {
  RecordingFile file = clean();
  for (Step& row : file.recording.steps) {
    RobotStep &a = row.robots[0], &b = row.robots[1];
    const auto half = [](RobotStep& r) { return std::find_if(r.constraints.begin(), r.constraints.end(), is_of_pair); };
    if (norm(a.position - b.position) > 1.2 || half(a) == a.constraints.end() || half(b) == b.constraints.end())
      continue;
    half(b)->half_plane.normal.x = std::nextafter(half(b)->half_plane.normal.x, 2.0);
    EXPECT_GT(audit(file)[AuditPoint::completeness].refuted, 0u);
    return;
  }
  FAIL() << "they never come near";
}

TEST(AuditPoints, AChoiceBeyondAHalfPlaneOrTheSpeedLimitIsRefused) {
  const AuditReport beyond =
      forged_constraint([](const DecisionConstraint& c) { return c.active; },
                        [](RobotStep& robot, DecisionConstraint& c) { robot.chosen -= 1e-6 * c.half_plane.normal; });
  EXPECT_GT(beyond[AuditPoint::choices].refuted, 0u);
  EXPECT_NEAR(beyond.largest_violation, 1e-6, 1e-9);
  RecordingFile file = clean();
  RobotStep& robot = file.recording.steps[3].robots[0];
  robot.chosen = robot.preferred = {std::nextafter(3.0, 4.0), 0.0};
  EXPECT_GT(audit(file)[AuditPoint::choices].refuted, 0u);
}

/// A robot in a corridor as wide as itself, up to 1e-13 m: no double keeps clear of both walls but by rounding.
Scenario corridor() {
  Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.time_limit = 1.0;
  s.margins.obstacle = s.margins.robot = 0.0;
  formation::Robot r;
  r.id = "R";
  r.position = {0.8892168273742458, -1.2330433374031655};
  r.goals = {{2.7383534027677423, 6.550316729145344}};
  s.robots = {r};
  s.obstacles = {
      {"a", geometry::Polyline{{{-0.2906693925575987, -4.036232326396762}, {2.4830354705326463, 7.638807773426002}}}},
      {"b", geometry::Polyline{{{0.6822506157609678, -4.26737439832095}, {3.455955478851213, 7.407665701501813}}}}};
  return s;
}

TEST(AuditPoints, AChoiceWithoutRoomIsDecidedAgain) {
  formation::SimulationOptions options;
  options.method = formation::Method::orca;
  const RecordingFile good = recorded(corridor(), options);
  const auto has_no_room = [](const RobotStep& r) { return r.status == lp::Status::no_interior; };
  std::size_t without_room = 0;
  for (const Step& row : good.recording.steps) without_room += has_no_room(row.robots[0]);
  EXPECT_GT(without_room, 5u);
  const AuditReport report = audit(good);
  EXPECT_TRUE(report.clean()) << to_json(report);
  EXPECT_EQ(report[AuditPoint::choices].proven, report[AuditPoint::choices].asked());
  // Another point of the same corridor.
  RecordingFile forged = good;
  RobotStep& robot = *std::find_if(forged.recording.steps.begin(), forged.recording.steps.end(), [&](const Step& row) {
                        return has_no_room(row.robots[0]);
                      })->robots.begin();
  robot.chosen = 0.99 * robot.chosen;
  EXPECT_EQ(audit(forged)[AuditPoint::choices].refuted, 1u);
}

TEST(AuditPoints, AChoiceWithRoomMarkedAsHavingNoneIsRefused) {
  const auto binds = [](const DecisionConstraint& c) { return c.active && c.hard; };
  const AuditReport one =
      forged_constraint(binds, [](RobotStep& robot, DecisionConstraint&) { robot.status = lp::Status::no_interior; });
  EXPECT_EQ(one[AuditPoint::choices].refuted, 1u);
  RecordingFile all = clean();
  for (Step& row : all.recording.steps)
    for (RobotStep& robot : row.robots) robot.status = lp::Status::no_interior;
  const PointCount choices = audit(all)[AuditPoint::choices];
  EXPECT_EQ(choices.refuted, choices.asked());
}

TEST(AuditPoints, HalfPlanesMarkedAsUncertifiedAreProvenAllTheSame) {
  RecordingFile file = clean();
  for (Step& row : file.recording.steps)
    for (RobotStep& robot : row.robots) {
      robot.uncertified = robot.constraints.size();
      for (DecisionConstraint& c : robot.constraints) c.certified = false;
    }
  const PointCount half_planes = audit(file)[AuditPoint::half_planes];
  EXPECT_EQ(half_planes.proven, half_planes.asked()) << "they are true, whatever is said of them";
  const AuditReport report = forged_constraint(is_hard, [](RobotStep& robot, DecisionConstraint& c) {
    c.certified = false;
    robot.uncertified = 1;
    c.half_plane.offset -= 0.1;
  });
  EXPECT_EQ(report[AuditPoint::half_planes].refuted, 1u) << "the robot is clear of the body";
}

TEST(AuditPoints, AChoiceThatIsNotTheBestIsRefused) {
  RecordingFile file = clean();
  RobotStep& robot = file.recording.steps[3].robots[0];
  robot.chosen = 0.999 * robot.chosen;
  EXPECT_EQ(audit(file)[AuditPoint::choices].refuted, 1u);
}

TEST(AuditPoints, MultipliersThatDoNotProveTheChoiceAreRefused) {
  const auto presses = [](const DecisionConstraint& c) { return c.multiplier > 1e-3; };
  for (const double factor : {0.0, 0.9, 1.1, -1.0}) {
    const AuditReport report =
        forged_constraint(presses, [&](RobotStep&, DecisionConstraint& c) { c.multiplier *= factor; });
    EXPECT_EQ(report[AuditPoint::choices].refuted, 1u) << factor;
  }
}

/// Eight robots in a street, four from each end, who wait for each other, go back and pass by a joint plan.
Scenario street() {
  Scenario s;
  s.time_limit = 120.0;
  for (const double y : {-1.5, 1.5})
    s.obstacles.push_back({y < 0 ? "south" : "north", geometry::Polyline{{{-30, y}, {30, y}}}});
  for (int k = 0; k < 8; ++k) {
    formation::Robot& r = s.robots.emplace_back();
    r.id = "R" + std::to_string(k + 1);
    const double side = k % 2 == 0 ? -1.0 : 1.0;
    r.position = {side * (6.0 + 1.5 * (k / 4)), side * (k / 2 % 2 == 0 ? 0.9 : -0.9)};
    r.max_speed = 1.5;
    r.goals = {{-r.position.x, r.position.y}};
  }
  return s;
}

TEST(AuditPoints, AreProvenOfRunsByPlan) {
  const RecordingFile file = recorded(street());
  const AuditReport report = audit(file);
  EXPECT_TRUE(report.clean()) << to_json(report);
  bool by_plan = false;
  for (const Step& step : file.recording.steps)
    for (const RobotStep& r : step.robots) {
      by_plan = by_plan || r.mode == formation::Mode::by_plan;
      EXPECT_NE(r.status, lp::Status::relaxed) << step.time;
    }
  EXPECT_TRUE(by_plan) << "the street is no test";
  // A half-plane of a pair that goes by plan which gives more than its share is refuted.
  RecordingFile forged = file;
  for (Step& step : forged.recording.steps)
    for (RobotStep& r : step.robots)
      if (r.mode == formation::Mode::by_plan)
        for (DecisionConstraint& c : r.constraints)
          if (c.source == ConstraintSource::robot) c.half_plane.offset -= 1.0;
  EXPECT_GT(audit(forged)[AuditPoint::half_planes].refuted, 0u);
  EXPECT_GT(audit(forged)[AuditPoint::completeness].refuted, 0u);
}

TEST(AuditPoints, AnAnchorElsewhereIsRefused) {
  RecordingFile file = clean();
  file.recording.steps[5].robots[0].anchor.x += 0x1p-50;
  EXPECT_GT(audit(file)[AuditPoint::sequence].refuted, 0u);
}

TEST(AuditPoints, ATimeThatIsNotTheTimeOfItsRowIsRefused) {
  RecordingFile file = clean();
  file.recording.steps[6].time = std::nextafter(file.recording.steps[6].time, 9.0);
  EXPECT_EQ(audit(file)[AuditPoint::sequence].refuted, 1u);
}

TEST(AuditPoints, AreProvenOfFormationsWithEveryIntegrator) {
  for (const formation::Integrator i :
       {formation::Integrator::exact, formation::Integrator::euler, formation::Integrator::rk4}) {
    formation::SimulationOptions options;
    options.integrator = i;
    const RecordingFile file = recorded(formation_scene(), options);
    const AuditReport report = audit(file);
    EXPECT_TRUE(report.clean()) << name(i) << to_json(report);
    EXPECT_EQ(report[AuditPoint::sequence].open, 0u) << name(i);
    // Another velocity, by a millionth of a metre a second, does not come from the choice.
    RecordingFile forged = file;
    forged.recording.steps[7].robots[1].velocity.y += 1e-5;
    EXPECT_GT(audit(forged)[AuditPoint::sequence].refuted, 0u) << name(i);
  }
}

TEST(AuditPoints, AnUnknownIntegratorIsRefused) {
  RecordingFile file = recorded(formation_scene());
  file.info.integrator = "dopri5";
  EXPECT_GT(audit(file)[AuditPoint::sequence].refuted, 0u);
}

TEST(AuditPoints, LeadersAndMovingObstaclesAreHeldToTheirPaths) {
  Scenario s = formation_scene();
  s.moving_obstacles = {
      {"cart", geometry::Polyline{{{-3, -2}, {-2, -2}}}, {{{0, 0}, {1, 0}, {1, 1}}, 0.0, {{0, 0}, {2, 3}}}}};
  const RecordingFile file = recorded(s);
  EXPECT_TRUE(audit(file).clean()) << to_json(audit(file));
  const auto refuted = [&](const auto& forge) {
    RecordingFile forged = file;
    forge(forged.recording.steps[9]);
    return audit(forged)[AuditPoint::sequence].refuted;
  };
  EXPECT_EQ(refuted([](Step& row) { row.leader_position.x += 1e-8; }), 1u);
  EXPECT_EQ(refuted([](Step& row) { row.leader_velocity.y += 1e-8; }), 1u);
  EXPECT_EQ(refuted([](Step& row) { row.moving[0].displacement.x += 1e-8; }), 1u);
  EXPECT_EQ(refuted([](Step& row) { row.moving[0].velocity.x += 1e-8; }), 1u);
}

TEST(AuditPoints, ChoicesThatWereRelaxedAreProvenToViolateLeast) {
  Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.time_limit = 1.0;
  for (int k = 0; k < 6; ++k) {
    formation::Robot r;
    r.id = "r" + std::to_string(k);
    r.position = {1.02 * (k % 3), 1.02 * (k / 3)};
    r.goals = {{2.0 - 5.0 * (k % 3), 5.0 - 9.0 * (k / 3)}};
    s.robots.push_back(r);
  }
  RecordingFile file = recorded(s);
  std::size_t relaxed = 0;
  for (Step& row : file.recording.steps)
    for (RobotStep& robot : row.robots) relaxed += robot.status == lp::Status::relaxed;
  ASSERT_GT(relaxed, 0u);
  EXPECT_EQ(audit(file)[AuditPoint::choices].refuted, 0u) << to_json(audit(file));
  for (Step& row : file.recording.steps)
    for (RobotStep& robot : row.robots)
      if (robot.status == lp::Status::relaxed) {
        robot.violation += 1e-6;
        EXPECT_EQ(audit(file)[AuditPoint::choices].refuted, 1u);
        return;
      }
}

// --- Runs as they were made are not refuted ---

geometry::Ring star(SeededRandom& random, Vec2 middle, double size) {
  const int corners = random.integer(3, 9);
  geometry::Ring ring;
  for (int k = 0; k < corners; ++k) {
    const double angle = 6.283185307179586 * (k + random.uniform(0.0, 0.8)) / corners;
    ring.push_back(middle + size * random.uniform(0.3, 1.0) * Vec2{std::cos(angle), std::sin(angle)});
  }
  return ring;
}

/// A clutter of walls, stars, a room with a hole, carts and robots that want across.
Scenario clutter(SeededRandom& random) {
  Scenario s;
  s.guidance = formation::Guidance::none;
  s.liveness = formation::Liveness::off;
  s.time_step = random.integer(0, 1) ? 0.05 : 0.1;
  s.time_limit = 40 * s.time_step;
  s.speed_bound = random.integer(0, 1) ? formation::SpeedBoundKind::disc : formation::SpeedBoundKind::box;
  for (int k = random.integer(1, 5); k > 0; --k) {
    const Vec2 middle = random.in_box(3.0);
    const std::string id = "o" + std::to_string(k);
    if (random.integer(0, 2) == 0) {
      geometry::Polyline wall{{middle}};
      for (int n = random.integer(1, 4); n > 0; --n) wall.points.push_back(wall.points.back() + random.in_box(2.0));
      s.obstacles.push_back({id, wall});
    } else {
      s.obstacles.push_back({id, geometry::Polygon{star(random, middle, random.uniform(0.3, 2.0)), {}}});
    }
  }
  if (random.integer(0, 2) == 0)
    s.obstacles.push_back(
        {"room", geometry::Polygon{{{-8, -8}, {8, -8}, {8, 8}, {-8, 8}}, {{{-7, -7}, {-7, 7}, {7, 7}, {7, -7}}}}});
  for (int k = random.integer(0, 2); k > 0; --k)
    s.moving_obstacles.push_back({"cart" + std::to_string(k),
                                  geometry::Polygon{star(random, random.in_box(5.0), 0.6), {}},
                                  {{{0, 0}, random.in_box(4.0), random.in_box(4.0)}, random.uniform(0.1, 2.0)}});
  for (int k = random.integer(1, 4); k > 0; --k) {
    formation::Robot r;
    r.id = "r" + std::to_string(k);
    r.position = random.in_box(6.0);
    r.velocity = random.in_box(1.0);
    r.radius = random.uniform(0.1, 0.6);
    r.goals = {random.in_box(6.0)};
    r.cooperates = random.integer(0, 5) > 0;
    s.robots.push_back(r);
  }
  return s;
}

void make_a_formation_of(Scenario& s, SeededRandom& random) {
  const std::size_t n = s.robots.size();
  s.time_step = 0.02;
  s.time_limit = 1.0;
  s.formation.emplace();
  s.formation->topology = {std::vector<std::vector<double>>(n, std::vector<double>(n, 1.0)),
                           std::vector<double>(n, 1.0)};
  for (std::size_t i = 0; i < n; ++i) {
    s.formation->topology.adjacency[i][i] = 0.0;
    s.formation->offsets.push_back(random.in_box(2.0));
    s.robots[i].goals.clear();
  }
  s.formation->leader = {{{random.in_box(3.0), random.in_box(5.0), random.in_box(5.0)}, random.uniform(0.0, 3.0)}};
  if (random.integer(0, 1))
    s.formation->leader.profile = {{0.1, 0.0}, {0.4, 2.0}, {0.4, random.uniform(0.0, 3.0)}, {0.7, 0.0}};
}

TEST(AuditPoints, RandomRunsAreRefutedByTheirMotionsAlone) {
  using formation::Method;
  SeededRandom random(exactvo::test::seed_of_run(98));
  std::size_t runs = 0, asked = 0;
  for (int round = 0; round < 90; ++round) {
    Scenario s = clutter(random);
    if (round % 3 == 0) make_a_formation_of(s, random);
    if (!formation::validate(s).empty()) continue;
    formation::SimulationOptions options;
    constexpr Method kMethods[] = {Method::ivo, Method::orca, Method::ivo_edge, Method::ivo_cluster};
    options.method = kMethods[round % 4];
    options.record_all = round % 5 == 0;
    options.integrator = static_cast<formation::Integrator>(random.integer(0, 2));
    options.controller = static_cast<formation::Controller>(random.integer(0, 3));
    const AuditReport report = audit(recorded(s, options), &s);
    for (std::size_t p = 0; p < kAuditPoints; ++p) {
      if (static_cast<AuditPoint>(p) == AuditPoint::motions) continue;
      EXPECT_EQ(report.points[p].refuted, 0u) << round << " " << to_json(report);
    }
    asked += report[AuditPoint::completeness].proven;
    ++runs;
  }
  EXPECT_GT(runs, 60u);
  EXPECT_GT(asked, 300u);
}

// --- Plans ---

/// The audit of point (8) of `clean()` with a plan that begins in its first row.
AuditReport with_plan(const std::vector<formation::PlanMove>& moves, Vec2 off = {}) {
  RecordingFile file = clean();
  const std::vector<RobotStep>& first = file.recording.steps.front().robots;
  file.recording.plans = {{0, 0, {0, 1}, {first[0].position + off, first[1].position}, moves}};
  return audit(file);
}

/// a is at (0, 0.1), b at (8, -0.1), of radius 0.5 both.
TEST(AuditPlans, MovesThatAreClearAreProven) {
  const AuditReport report = with_plan({{0, {0.0, 3.0}}, {1, {8.0, 5.0}}, {0, {0.0, 0.1}}, {0, {8.0, 0.1}}});
  EXPECT_EQ(report[AuditPoint::plans].proven, 6u) << to_json(report);
  EXPECT_TRUE(report.clean()) << to_json(report);
}

TEST(AuditPlans, AMoveIntoAnObstacleIsRefuted) {
  const AuditReport report = with_plan({{0, {2.5, -0.5}}, {0, {0.0, 0.1}}});
  EXPECT_EQ(report[AuditPoint::plans].refuted, 1u) << to_json(report);
  EXPECT_FALSE(report.clean());
  EXPECT_NE(to_json(report).find("move 0 of the plan takes a too near to obstacle 'block'"), std::string::npos)
      << to_json(report);
  EXPECT_EQ(with_plan({{0, {2.5, -2.0}}})[AuditPoint::plans].refuted, 1u) << "into its middle";
}

/// Robots of the plan stand where their last move took them: the order decides.
TEST(AuditPlans, AMoveIntoARobotThatStandsThereIsRefuted) {
  const std::vector<formation::PlanMove> good = {{1, {8.0, 5.0}}, {0, {8.0, 0.1}}};
  EXPECT_EQ(with_plan(good)[AuditPoint::plans].proven, 4u);
  const AuditReport report = with_plan({good[1], good[0]});
  EXPECT_EQ(report[AuditPoint::plans].refuted, 1u) << to_json(report);
  EXPECT_NE(to_json(report).find("row 0: move 0 of the plan takes a too near to robot 'b'"), std::string::npos);
}

TEST(AuditPlans, DistancesHoldUpToTheRoundingOfPlans) {
  const auto up_to = [](double gap) {
    return with_plan({{0, {5.5, 0.1}}, {0, {8.0 - 1.0 - gap, -0.1}}})[AuditPoint::plans];
  };
  EXPECT_EQ(up_to(0.0).proven, 4u);
  EXPECT_EQ(up_to(-1e-9).proven, 4u);
  EXPECT_EQ(up_to(-1e-7).refuted, 1u);
}

TEST(AuditPlans, AStartThatIsNotWhereTheRobotWasIsRefuted) {
  const AuditReport report = with_plan({}, {0.0, 0x1p-50});
  EXPECT_EQ(report[AuditPoint::plans].refuted, 1u) << to_json(report);
  EXPECT_NE(to_json(report).find("row 0: the plan does not begin where a was in row 0"), std::string::npos);
}

TEST(AuditPlans, APlanFromARowThatIsNotThereIsRefuted) {
  RecordingFile file = recorded(formation::test_scenes::siding());
  ASSERT_FALSE(file.recording.plans.empty());
  formation::JointPlan& plan = file.recording.plans.front();
  plan.from_row = file.recording.steps.size();
  EXPECT_GE(audit(file)[AuditPoint::plans].refuted, plan.robots.size());
}

/// Plans are made from where robots stand, be that too near to something: then nothing is said of the way out.
TEST(AuditPlans, AMoveThatBeginsTooNearIsLeftOpen) {
  const AuditReport report = with_plan({{0, {7.5, -3.0}}}, {7.5, -0.2});
  EXPECT_EQ(report[AuditPoint::plans].open, 1u) << to_json(report);
  EXPECT_EQ(report[AuditPoint::plans].refuted, 1u) << "it does not begin there";
}

TEST(AuditPlans, PlacesOutOfRangeAreRefused) {
  EXPECT_FALSE(with_plan({{0, {std::nan(""), 0.0}}}).clean());
  EXPECT_FALSE(with_plan({{0, {1e300, 0.0}}}).clean());
}

/// As they are made: two head-on that back into a siding, and a street.
TEST(AuditPlans, ThoseOfRunsAreProven) {
  for (Scenario s : {formation::test_scenes::siding(), formation::test_scenes::street(14, 3.0)}) {
    s.time_limit = 25.0;
    const RecordingFile file = recorded(s);
    ASSERT_FALSE(file.recording.plans.empty()) << s.name;
    std::size_t asked = 0;
    for (const formation::JointPlan& plan : file.recording.plans) {
      EXPECT_LE(plan.from_row, plan.row);
      EXPECT_EQ(plan.starts.size(), plan.robots.size());
      asked += plan.robots.size() + plan.moves.size();
    }
    const AuditReport report = audit(file);
    EXPECT_EQ(report[AuditPoint::plans].proven, asked) << s.name << to_json(report);
    EXPECT_EQ(report[AuditPoint::plans].asked(), asked) << s.name;
  }
}

/// By sampling: points of the shape lie in it, points a little outward do not.
TEST(ExactShapes, ContainTheirPointsAndNoOthers) {
  SeededRandom random(exactvo::test::seed_of_run(97));
  for (int round = 0; round < 500; ++round) {
    const geometry::Ellipse e{random.in_box(3), random.uniform(0.1, 2), random.uniform(-1, 1), random.uniform(0.1, 2)};
    const Vec2 w = random.direction();
    const auto at = [&](double scale) {
      return exact::exactly(e.center + scale * Vec2{e.l11 * w.x, e.l21 * w.x + e.l22 * w.y});
    };
    EXPECT_TRUE(exact::contains(e, at(1.0 - 1e-9)));
    EXPECT_FALSE(exact::contains(e, at(1.0 + 1e-9)));
  }
  const geometry::ConvexPolygon square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  EXPECT_TRUE(exact::contains(square, exact::exactly(geometry::Vec2{1.0, 0.5})));
  EXPECT_FALSE(exact::contains(square, exact::exactly(geometry::Vec2{std::nextafter(1.0, 2.0), 0.5})));
  EXPECT_FALSE(
      exact::contains(geometry::ConvexPolygon{{{0, 0}, {2, 0}}}, exact::exactly(geometry::Vec2{1.0, 0x1p-60})));
  EXPECT_TRUE(exact::contains(geometry::Segment{{0, 0}, {2, 2}}, exact::exactly(geometry::Vec2{1.0, 1.0})));
  EXPECT_FALSE(exact::contains(geometry::Segment{{0, 0}, {2, 2}}, exact::exactly(geometry::Vec2{3.0, 3.0})));
  EXPECT_TRUE(exact::contains(geometry::Ellipse{{0, 0}, 0.0, 3.0, 4.0}, exact::exactly(geometry::Vec2{0.0, 5.0})));
  EXPECT_FALSE(
      exact::contains(geometry::Ellipse{{0, 0}, 0.0, 3.0, 4.0}, exact::exactly(geometry::Vec2{0.0, 5.0000001})));
  EXPECT_TRUE(exact::contains(geometry::Ellipse{{0, 0}, 2.0, 1.0, 0.0}, exact::exactly(geometry::Vec2{-2.0, -1.0})));
  EXPECT_TRUE(exact::contains(geometry::Disc{{0, 0}, 5.0}, exact::exactly(geometry::Vec2{3.0, 4.0})));
}

}  // namespace
}  // namespace exactvo::datasets::test
