// SPDX-License-Identifier: GPL-3.0-or-later
// Steering and half-planes of a user, from the run to the audit.
#include "exactvo/formation/own_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "audited.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/pi.h"
#include "support/thread_ranks.h"

namespace exactvo::formation {
namespace {

using testing::HasSubstr;

/// Robots on a circle, each to the opposite side, without routes.
Scenario circle(int robots, double radius = 4.0) {
  Scenario s;
  s.name = "circle";
  s.guidance = Guidance::none;
  s.time_step = 0.1;
  s.time_limit = 30.0;
  for (int k = 0; k < robots; ++k) {
    const double angle = 2.0 * geometry::kPi * k / robots;
    Robot r;
    r.id = "R" + std::to_string(k + 1);
    r.radius = 0.3;
    r.max_speed = 1.0;
    r.position = radius * Vec2{std::cos(angle), std::sin(angle)};
    r.goals = {-1.0 * r.position};
    s.robots.push_back(r);
  }
  return s;
}

datasets::RecordingFile file_of(const Scenario& s, const SimulationOptions& options) {
  return {datasets::run_info(s, options, datasets::make_provenance({}, 0, {})), s, simulate(s, options)};
}

datasets::AuditReport audit_of(const Scenario& s, const SimulationOptions& options, Recording run) {
  return datasets::audit(
      datasets::RecordingFile{datasets::run_info(s, options, datasets::make_provenance({}, 0, {})), s, std::move(run)});
}

std::string first(const datasets::AuditReport& report) {
  return report.findings.empty() ? "" : report.findings.front();
}

/// The number of decisions that were made in `stage`.
std::size_t count(const Recording& run, OwnStage stage) {
  std::size_t found = 0;
  for (std::size_t k = 0; k + 1 < run.steps.size(); ++k)
    for (const RobotStep& r : run.steps[k].robots) found += r.own_stage == stage;
  return found;
}

TEST(Steering, SetsThePreferredVelocitiesThatAreRecorded) {
  const Scenario s = circle(5);
  SimulationOptions options;
  std::size_t steps = 0;
  options.steering = [&](const RobotSlice& robots, std::vector<Vec2>& preferred) {
    EXPECT_EQ(robots.first, 0U);
    EXPECT_EQ(robots.last, 5U);
    EXPECT_NEAR(robots.time, 0.1 * static_cast<double>(steps++), 1e-12);
    for (std::size_t i = 0; i < 5; ++i) {
      const Vec2 way = s.robots[i].goals[0] - robots.positions[i];
      EXPECT_LE(norm(preferred[i] - std::min(1.0, norm(way) / 0.1) * geometry::normalized(way)), 1e-12);
      preferred[i] = 0.5 * preferred[i] + Vec2{-0.2 * preferred[i].y, 0.2 * preferred[i].x};
    }
  };
  const Recording run = simulate(s, options);
  EXPECT_EQ(steps, run.steps.size() - 1);
  std::size_t steered = 0;
  for (std::size_t k = 0; k < steps; ++k)
    for (const RobotStep& r : run.steps[k].robots) {
      steered += r.mode == Mode::steered;
      EXPECT_LT(norm(r.preferred), 0.55);
    }
  EXPECT_GT(steered, 3 * steps);
  const datasets::AuditReport report = audit_of(s, options, run);
  EXPECT_TRUE(report.clean()) << first(report);
}

TEST(Steering, RobotsThatAreSteeredIntoEachOtherStayApart) {
  Scenario s = circle(14);
  s.time_limit = 12.0;
  SimulationOptions options;
  options.steering = [](const RobotSlice& robots, std::vector<Vec2>& preferred) {
    for (std::size_t i = robots.first; i < robots.last; ++i) preferred[i] = -3.0 * robots.positions[i];
  };
  const datasets::RecordingFile file = file_of(s, options);
  const datasets::AuditReport report = datasets::audit(file);
  EXPECT_TRUE(report.clean()) << first(report);
  EXPECT_GT(report.robot_questions, 1000U);
  const std::vector<RobotStep>& end = file.recording.steps.back().robots;
  for (const RobotStep& r : end) EXPECT_LT(norm(r.position), 2.5) << "they have gathered";
}

TEST(OwnHalfPlanes, HardOnesHoldInEveryDecisionThatCanHoldThem) {
  Scenario s = circle(6);
  s.time_limit = 60.0;
  SimulationOptions options;
  // Slowly within 2 m of the middle: a square of velocities.
  const auto is_slow = [](Vec2 at) { return norm(at) < 2.0; };
  options.half_planes = [&](const RobotSlice& robots, const std::vector<Vec2>& preferred,
                            std::vector<OwnHalfPlane>& out) {
    EXPECT_EQ(preferred.size(), 6U);
    for (std::size_t i = robots.first; i < robots.last; ++i)
      for (const Vec2 side : {Vec2{1, 0}, Vec2{-1, 0}, Vec2{0, 1}, Vec2{0, -1}})
        if (is_slow(robots.positions[i])) out.push_back({i, {side, -0.25}, true});
  };
  datasets::RecordingFile file = file_of(s, options);
  const Recording& run = file.recording;
  EXPECT_GT(count(run, OwnStage::held), 400U);
  EXPECT_LT(count(run, OwnStage::gave), 100U) << "where robots push each other off, out of the way of a third";
  EXPECT_EQ(count(run, OwnStage::left_out), 0U);
  std::size_t binding = 0;
  for (std::size_t k = 0; k + 1 < run.steps.size(); ++k)
    for (const RobotStep& r : run.steps[k].robots) {
      EXPECT_EQ(r.own.size(), is_slow(r.position) ? 4U : 0U);
      if (r.own_stage != OwnStage::held) continue;
      for (const OwnConstraint& c : r.own) {
        EXPECT_GE(dot(c.half_plane.normal, r.chosen), c.half_plane.offset);
        binding += c.active;
      }
    }
  EXPECT_GT(binding, 50U);
  EXPECT_EQ(measure(s, run).arrived, 6U);
  const datasets::AuditReport report = datasets::audit(file);
  EXPECT_TRUE(report.clean()) << first(report);

  // What is read is what was written; a forged one is refuted.
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "exactvo_own_rules.jsonl";
  datasets::write_recording(path, file);
  datasets::RecordingFile read = datasets::read_recording(path);
  std::filesystem::remove(path);
  std::size_t same = 0, refuted = 0, forged = 0;
  for (std::size_t k = 0; k < run.steps.size(); ++k)
    for (std::size_t i = 0; i < 6; ++i) {
      const RobotStep &a = run.steps[k].robots[i], &b = read.recording.steps[k].robots[i];
      ASSERT_EQ(a.own_stage, b.own_stage);
      ASSERT_EQ(a.own.size(), b.own.size());
      for (std::size_t j = 0; j < a.own.size(); ++j, ++same) {
        EXPECT_EQ(a.own[j].half_plane.normal, b.own[j].half_plane.normal);
        EXPECT_EQ(a.own[j].half_plane.offset, b.own[j].half_plane.offset);
        EXPECT_EQ(a.own[j].multiplier, b.own[j].multiplier);
        EXPECT_EQ(a.own[j].hard, b.own[j].hard);
        EXPECT_EQ(a.own[j].active, b.own[j].active);
      }
    }
  EXPECT_GT(same, 400U);
  const auto forge = [&](const auto& change) {
    for (std::size_t k = 0; k < run.steps.size(); ++k)
      for (std::size_t i = 0; i < 6; ++i) {
        const RobotStep& r = run.steps[k].robots[i];
        const bool binds = std::any_of(r.own.begin(), r.own.end(),
                                       [](const OwnConstraint& c) { return c.active && c.multiplier > 0.1; });
        if (!binds || r.own_stage != OwnStage::held) continue;
        Recording changed = run;
        change(changed.steps[k].robots[i]);
        ++forged;
        refuted += !audit_of(s, options, std::move(changed)).clean();
        return;
      }
  };
  forge([](RobotStep& r) { r.own_stage = OwnStage::gave; });
  forge([](RobotStep& r) { r.own_stage = OwnStage::left_out; });
  forge([](RobotStep& r) { r.own_stage = OwnStage::none; });
  forge([](RobotStep& r) { r.own.clear(); });
  forge([](RobotStep& r) {
    for (OwnConstraint& c : r.own) c.half_plane.offset = -0.2;
  });
  forge([](RobotStep& r) {
    for (OwnConstraint& c : r.own) c.multiplier *= 0.5;
  });
  EXPECT_EQ(forged, 6U);
  EXPECT_EQ(refuted, 6U);
}

/// A robot before a wall that it is told to drive through.
struct BeforeAWall {
  BeforeAWall() {
    s = circle(1);
    s.robots[0].position = {0.0, 0.0};
    s.robots[0].goals = {{0.0, 3.0}};
    s.obstacles = {{"wall", geometry::Polyline{{{0.5, -9.0}, {0.5, 9.0}}}}};
    s.time_limit = 4.0;
  }
  Recording run(bool hard) {
    options.half_planes = [hard](const RobotSlice&, const std::vector<Vec2>&, std::vector<OwnHalfPlane>& out) {
      out.push_back({0, {{1.0, 0.0}, 0.5}, hard});
    };
    return simulate(s, options);
  }
  Scenario s;
  SimulationOptions options;
};

TEST(OwnHalfPlanes, GiveBeforeThoseOfObstaclesDo) {
  for (const bool hard : {true, false}) {
    BeforeAWall scene;
    const Recording run = scene.run(hard);
    const std::size_t gave = count(run, hard ? OwnStage::gave : OwnStage::held);
    EXPECT_GT(gave, 20U) << hard;
    EXPECT_EQ(count(run, OwnStage::left_out), 0U);
    std::size_t relaxed = 0;
    for (const Step& row : run.steps) relaxed += row.robots[0].status == lp::Status::relaxed;
    EXPECT_GT(relaxed, 20U) << hard;
    const Metrics m = measure(scene.s, run);
    EXPECT_GE(*m.min_obstacle_clearance, 0.0);
    EXPECT_LT(*m.min_obstacle_clearance, 0.15) << "it drives as near as it may";
    const datasets::AuditReport report = audit_of(scene.s, scene.options, run);
    EXPECT_TRUE(report.clean()) << first(report);
  }
}

TEST(OwnHalfPlanes, SoftOnesGiveBeforeHardOnesDo) {
  Scenario s = circle(1);
  s.time_limit = 2.0;
  SimulationOptions options;
  options.half_planes = [](const RobotSlice&, const std::vector<Vec2>&, std::vector<OwnHalfPlane>& out) {
    out.push_back({0, {{0.0, 1.0}, 0.5}, true});
    out.push_back({0, {{0.0, -1.0}, 0.2}, false});
  };
  const Recording run = simulate(s, options);
  EXPECT_EQ(count(run, OwnStage::held), run.steps.size() - 1);
  for (std::size_t k = 0; k + 1 < run.steps.size(); ++k) {
    EXPECT_GE(run.steps[k].robots[0].chosen.y, 0.5);
    EXPECT_EQ(run.steps[k].robots[0].status, lp::Status::relaxed);
    EXPECT_NEAR(run.steps[k].robots[0].violation, 0.7, 1e-9);
  }
  EXPECT_EQ(measure(s, run).relaxed_steps, 0U) << "no half-plane against a body gave";
  const datasets::AuditReport report = audit_of(s, options, run);
  EXPECT_TRUE(report.clean()) << first(report);
}

/// A lane that is a line through velocities no double lies on: half-planes with opposite normals and no width.
TEST(OwnHalfPlanes, ALaneWithoutWidthIsKept) {
  Scenario s = circle(3);
  s.time_limit = 3.0;
  const Vec2 normal{0.6123724356957945, 0.7905694150420949};
  for (const bool hard : {true, false}) {
    SimulationOptions options;
    options.half_planes = [&](const RobotSlice& robots, const std::vector<Vec2>&, std::vector<OwnHalfPlane>& out) {
      for (std::size_t i = robots.first; i < robots.last; ++i) {
        out.push_back({i, {normal, 0.1}, hard});
        out.push_back({i, {-normal, -0.1}, hard});
      }
    };
    Recording run = simulate(s, options);
    const std::size_t decisions = 3 * (run.steps.size() - 1);
    EXPECT_EQ(count(run, OwnStage::held), decisions) << hard;
    for (std::size_t k = 0; k + 1 < run.steps.size(); ++k)
      for (const RobotStep& r : run.steps[k].robots) {
        EXPECT_NEAR(dot(normal, r.chosen), 0.1, 1e-8);
        for (const OwnConstraint& c : r.own) EXPECT_NEAR(std::fabs(c.half_plane.offset), 0.1, 1e-8);
      }
    const datasets::AuditReport report = audit_of(s, options, run);
    EXPECT_TRUE(report.clean()) << first(report);
    EXPECT_EQ(report[datasets::AuditPoint::choices].open, 0U);
    // Left out although bodies leave all the room there is: as decisions with lines were recorded once.
    RobotStep& forged = run.steps[0].robots[0];
    forged.own_stage = OwnStage::left_out;
    forged.chosen = forged.preferred;
    forged.status = lp::Status::optimal;
    forged.bound.clear();
    forged.violation = 0.0;
    for (DecisionConstraint& c : forged.constraints) c.active = false, c.multiplier = 0.0;
    for (std::size_t k : {0U, 1U}) forged.own[k] = {{k == 0 ? normal : -normal, k == 0 ? 0.1 : -0.1}, hard, false, 0.0};
    EXPECT_THAT(first(audit_of(s, options, run)), HasSubstr("gives up half-planes of a user that can be held")) << hard;
  }
}

/// Half-planes that robots cannot hold never make two of them overlap, and the audit can tell.
TEST(OwnHalfPlanes, NeverCostTheDistanceBetweenRobots) {
  Scenario s = circle(10);
  s.time_limit = 12.0;
  SimulationOptions options;
  options.half_planes = [](const RobotSlice& robots, const std::vector<Vec2>&, std::vector<OwnHalfPlane>& out) {
    for (std::size_t i = robots.first; i < robots.last; ++i) {
      const Vec2 in = geometry::normalized(-1.0 * robots.positions[i]);
      if (in != Vec2{}) out.push_back({i, {in, 0.6}, i % 3 != 0});
    }
  };
  const Recording run = simulate(s, options);
  EXPECT_GT(count(run, OwnStage::gave), 100U);
  EXPECT_GT(count(run, OwnStage::held), 100U);
  EXPECT_TRUE(measure(s, run).collisions.empty());
  const datasets::AuditReport report = audit_of(s, options, run);
  EXPECT_TRUE(report.clean()) << first(report);
  EXPECT_GT(report.robot_questions, 300U);
}

TEST(OwnRules, AnswersThatAreNoneAreRefused) {
  const Scenario s = circle(2);
  const auto refusal = [&](const SimulationOptions& options) -> std::string {
    try {
      simulate(s, options);
    } catch (const std::logic_error& e) {
      return e.what();
    }
    return "";
  };
  SimulationOptions steered;
  steered.steering = [](const RobotSlice&, std::vector<Vec2>& preferred) { preferred[1] = {NAN, 0.0}; };
  EXPECT_THAT(refusal(steered), HasSubstr("steering: the preferred velocity of robot 1 is not finite"));
  steered.steering = [](const RobotSlice&, std::vector<Vec2>& preferred) { preferred.clear(); };
  EXPECT_THAT(refusal(steered), HasSubstr("steering: 0 preferred velocities, of 2 robots"));
  const auto asking = [](const OwnHalfPlane& h) {
    SimulationOptions options;
    options.half_planes = [h](const RobotSlice&, const std::vector<Vec2>&, std::vector<OwnHalfPlane>& out) {
      out.push_back(h);
    };
    return options;
  };
  EXPECT_THAT(refusal(asking({2, {{1, 0}, 0}, true})), HasSubstr("half_planes: robot 2, of 2 robots"));
  EXPECT_THAT(refusal(asking({1, {{0, 0}, 0}, true})), HasSubstr("one of R2 is not finite, or has the normal 0"));
  EXPECT_THAT(refusal(asking({1, {{1, 0}, INFINITY}, true})), HasSubstr("one of R2 is not finite"));
}

/// What to change stands in the message, by the option's name.
TEST(OwnRules, OptionsThatAScenarioCannotHaveAreNamed) {
  Scenario braking = circle(2), formation = circle(2);
  braking.acceleration = Acceleration{1.0};
  formation.formation.emplace();
  SimulationOptions steered, asks, rvo;
  steered.steering = [](const RobotSlice&, std::vector<Vec2>&) {};
  asks.half_planes = [](const RobotSlice&, const std::vector<Vec2>&, std::vector<OwnHalfPlane>&) {};
  rvo.method = Method::rvo;
  const auto problem = [](const Scenario& s, const SimulationOptions& options) {
    const std::vector<ScenarioProblem> all = option_problems(s, options);
    return all.size() == 1 ? all[0].pointer + ": " + all[0].found + "; " + all[0].expected : std::to_string(all.size());
  };
  EXPECT_EQ(problem(braking, steered), "0");
  EXPECT_THAT(problem(braking, asks), HasSubstr("half_planes: a function, with an acceleration; none, since braking"));
  EXPECT_THAT(problem(formation, asks), HasSubstr("half_planes: a function, in a formation; none"));
  EXPECT_THAT(problem(formation, steered), HasSubstr("steering: a function, in a formation; none"));
  EXPECT_THAT(problem(formation, rvo), HasSubstr("method: rvo, which formations do not have; another method"));
  EXPECT_THAT(problem(braking, rvo), HasSubstr("cannot promise to brake in time, with an acceleration"));
  EXPECT_THROW(simulate(braking, asks), std::logic_error);
}

struct Places final : RunSink {
  std::vector<std::vector<Vec2>> rows;
  void add_state(const RunState& now) override { rows.push_back(now.positions); }
};

/// Robots that the crowd's own preferences would lead to their goals are steered round in a circle, on any number of
/// ranks alike.
TEST(OwnRules, ARunOnACrowdTakesSteering) {
  Scenario s = circle(12);
  s.time_limit = 10.0;
  const auto run = [&](Ranks* ranks, Places& places) {
    SimulationOptions options;
    options.ranks = ranks;
    options.steering = [](const RobotSlice& robots, std::vector<Vec2>& preferred) {
      for (std::size_t i = robots.first; i < robots.last; ++i) {
        const Vec2 at = robots.positions[i];
        preferred[i] = 0.8 * geometry::normalized(Vec2{-at.y, at.x}) + 0.1 * (4.0 / norm(at) - 1.0) * at;
      }
    };
    return run_crowd(s, options, &places);
  };
  Places alone;
  const RunReport expected = run(nullptr, alone);
  EXPECT_EQ(expected.overlapping, 0U);
  EXPECT_EQ(expected.steps, 100U);
  ASSERT_EQ(alone.rows.size(), 101U);
  for (std::size_t i = 0; i < 12; ++i) {
    const Vec2 from = alone.rows[20][i], to = alone.rows[40][i];
    EXPECT_NEAR(norm(to), 4.0, 0.3);
    EXPECT_GT(cross(from, to), 0.0) << "counter-clockwise";
  }
  test::in_ranks(3, [&](Ranks& ranks) {
    Places places;
    EXPECT_EQ(run(&ranks, places).digest, expected.digest);
  });
  SimulationOptions asks;
  asks.half_planes = [](const RobotSlice&, const std::vector<Vec2>&, std::vector<OwnHalfPlane>&) {};
  EXPECT_THROW(run_crowd(s, asks), std::logic_error);
  for (const Method method : {Method::rvo, Method::hrvo}) {
    SimulationOptions other;
    other.method = method;
    EXPECT_THROW(run_crowd(s, other), std::logic_error) << "it would be driven by orca";
  }
}

}  // namespace
}  // namespace exactvo::formation
