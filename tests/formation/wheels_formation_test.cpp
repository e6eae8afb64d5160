// SPDX-License-Identifier: GPL-3.0-or-later
// Formations on wheels: the paper's scenes B0 to B3 with three Huskies, beside discs that move in any direction.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/formation/stability.h"
#include "support/seeded_random.h"
#include "wheels_scenes.h"

namespace exactvo::formation {
namespace {

using namespace test_scenes;
using datasets::AuditPoint;

Scenario huskies(const std::string& scene) {
  return datasets::load_scenario(EXACTVO_SOURCE_DIR "/datasets/data/robots/" + scene + "_huskies.json");
}

/// The same bodies and speeds without wheels: discs about where the reference points start. `wide`: as large as those
/// that wheels need.
Scenario without_wheels(Scenario s, bool wide = false) {
  for (Robot& r : s.robots) {
    if (!wide) r.radius = r.drive->body_radius;
    r.drive.reset();
  }
  return s;
}

std::string first_finding(const datasets::AuditReport& report) {
  return report.findings.empty() ? "" : report.findings.front();
}

/// What the table of the guide says of a run: m and s.
struct Course {
  double formed;    ///< when all are first within the tolerance of their slots
  double restored;  ///< from when on they are until the leader stops; else from when on after that
  double arrived;   ///< when they are for good
  double largest;   ///< slot error after 15 s, by when all have formed
  double rms;       ///< of the slot errors
};

Course course_of(const datasets::RecordingFile& file) {
  const Scenario& s = file.scenario;
  const Metrics m = measure(s, file.recording);
  EXPECT_EQ(m.arrived, s.robots.size()) << s.name;
  EXPECT_TRUE(m.collisions.empty()) << s.name;
  Course c{m.formation_course->first_formed.value_or(-1.0), 0.0, m.formation_course->formed_since.value_or(-1.0), 0.0,
           m.formation_course->rms_error};
  for (const Step& row : file.recording.steps) {
    double error = 0.0;
    for (std::size_t i = 0; i < row.robots.size(); ++i)
      error = std::max(error, norm(row.robots[i].position - row.leader_position - file.recording.offsets[i]));
    if (row.time > 15.0) c.largest = std::max(c.largest, error);
    if (row.leader_velocity != Vec2{} && error > s.arrival_tolerance) c.restored = row.time + s.time_step;
  }
  if (c.restored > *m.leader_arrival_time) c.restored = c.arrived;
  return c;
}

void expect_near(const char* scene, const Course& is, const Course& said) {
  constexpr double kSeconds = 0.5, kMetres = 0.05;
  EXPECT_NEAR(is.formed, said.formed, kSeconds) << scene;
  EXPECT_NEAR(is.restored, said.restored, kSeconds) << scene;
  EXPECT_NEAR(is.arrived, said.arrived, kSeconds) << scene;
  EXPECT_NEAR(is.largest, said.largest, kMetres) << scene;
  EXPECT_NEAR(is.rms, said.rms, kMetres) << scene;
  std::printf("%s: {%.2f, %.2f, %.2f, %.2f, %.2f}\n", scene, is.formed, is.restored, is.arrived, is.largest, is.rms);
}

/// The table of docs/guide/wheels.md.
TEST(WheeledFormation, ScenesBAreDrivenRestoredAndProven) {
  struct Case {
    const char* scene;
    Course wheels, discs;
    double wide;  ///< s, of the wide discs: `Course::arrived`
  };
  const Case cases[] = {{"B0", {11.90, 11.90, 50.95, 0.12, 0.75}, {11.40, 11.40, 11.40, 0.07, 0.72}, 11.40},
                        {"B1", {11.90, 45.40, 50.95, 4.41, 1.40}, {11.40, 36.20, 36.20, 3.90, 1.09}, 46.90},
                        {"B2", {11.90, 55.55, 55.55, 8.03, 2.37}, {11.40, 27.85, 27.85, 1.34, 0.75}, 46.75},
                        {"B3", {11.90, 55.20, 55.20, 4.40, 1.70}, {11.40, 46.90, 46.90, 3.36, 1.15}, 40.85}};
  for (const Case& c : cases) {
    const Scenario s = huskies(c.scene);
    ASSERT_TRUE(validate(s).empty());
    const datasets::RecordingFile file = recorded(s), other = recorded(without_wheels(s));
    const datasets::AuditReport report = datasets::audit(file);
    EXPECT_TRUE(report.clean()) << c.scene << ": " << first_finding(report);
    const std::size_t decisions = (file.recording.steps.size() - 1) * s.robots.size();
    EXPECT_EQ(report[AuditPoint::kinematics].asked(), report[AuditPoint::kinematics].proven);
    EXPECT_GT(report[AuditPoint::kinematics].proven, 4 * decisions);
    EXPECT_GT(report[AuditPoint::braking].proven, 2 * decisions);
    EXPECT_EQ(relaxed_in(file.recording), 0u) << c.scene;
    EXPECT_TRUE(datasets::audit(other).clean()) << c.scene;
    expect_near(c.scene, course_of(file), c.wheels);
    expect_near(c.scene, course_of(other), c.discs);
    EXPECT_NEAR(course_of(recorded(without_wheels(s, true))).arrived, c.wide, 0.5) << c.scene;
  }
}

/// While no half-plane and no limit binds, slot errors of reference points obey the law of stability.h, so that a step
/// leaves `step_spectral_radius` of them in the end.
TEST(WheeledFormation, ErrorsDecayByTheLinearLawWhereNothingBinds) {
  Scenario s = huskies("B0");
  s.time_limit = 18.0;
  const Recording run = simulate(s);
  const FormationSpec& f = *s.formation;
  const double radius = step_spectral_radius(f, std::nullopt, s.time_step);
  EXPECT_LT(radius, 1.0);
  const auto errors = [&](std::size_t row) {
    std::vector<Vec2> all;
    for (std::size_t i = 0; i < s.robots.size(); ++i)
      all.push_back(run.steps[row].robots[i].position - run.steps[row].leader_position - run.offsets[i]);
    return all;
  };
  const auto whole = [](const std::vector<Vec2>& all) {
    double square = 0.0;
    for (const Vec2 e : all) square += squared_norm(e);
    return std::sqrt(square);
  };
  const auto binds = [&](const Step& row) {
    return std::any_of(row.robots.begin(), row.robots.end(),
                       [](const RobotStep& r) { return norm(r.chosen - r.preferred) > 1e-12; });
  };
  std::size_t free_rows = 0;
  for (std::size_t k = 1; k + 1 < run.steps.size(); ++k) {
    const std::vector<Vec2> now = errors(k), next = errors(k + 1);
    const bool is_saturated =
        std::any_of(now.begin(), now.end(), [&](Vec2 e) { return f.gains.kappa * norm(e) > f.catch_up_speed; });
    if (is_saturated || binds(run.steps[k])) continue;
    ++free_rows;
    for (std::size_t i = 0; i < now.size(); ++i) {
      Vec2 position = f.topology.pinning[i] * now[i], velocity;
      const auto relative = [&](std::size_t j) {
        return run.steps[k].robots[j].velocity - run.steps[k].leader_velocity;
      };
      velocity = f.topology.pinning[i] * relative(i);
      for (std::size_t j = 0; j < now.size(); ++j) {
        position += f.topology.adjacency[i][j] * (now[i] - now[j]);
        velocity += f.topology.adjacency[i][j] * (relative(i) - relative(j));
      }
      const Vec2 w = -f.gains.kappa * now[i] - (f.gains.k1 * position + f.gains.k2 * velocity) / f.gains.k3;
      EXPECT_LT(norm(next[i] - (now[i] + s.time_step * w)), 1e-12) << k << " " << i;
    }
    const double before = whole(now), after = whole(next);
    if (free_rows > 40 && before > 1e-6) {
      EXPECT_NEAR(after / before, radius, 0.003) << k;
    }
  }
  EXPECT_GT(free_rows, 60u);
}

/// Random rooms with headings and slots at random, full enough that half-planes contradict each other: braking stays.
TEST(WheeledFormation, RandomScenesRelaxNothingAndAreProven) {
  test::SeededRandom random(test::seed_of_run(43));
  std::size_t decisions = 0, fell_back = 0;
  for (int scene = 0; scene < 12; ++scene) {
    Scenario s = huskies("B0");
    s.time_limit = 25.0;
    s.formation->leader.path = {{0.0, 0.0}, {10.0, 10.0}};
    for (Robot& r : s.robots) {
      DifferentialDrive d = *r.drive;
      d.heading = random.uniform(-180.0, 180.0);
      if (scene % 3 == 2) d.footprint = {{0.495, 0.335}, {-0.495, 0.335}, {-0.495, -0.335}, {0.495, -0.335}};
      put_on_wheels(r, d, s.time_step);
    }
    for (Vec2& offset : s.formation->offsets) offset = 1.3 * random.direction();
    for (int k = 0; k < 4; ++k) {
      const Vec2 at = Vec2{6.0, 6.0} + random.in_box(3.0), half{random.uniform(0.1, 0.6), random.uniform(0.1, 0.6)};
      s.obstacles.push_back(
          {"block " + std::to_string(k),
           geometry::Polygon{{at - half, at + Vec2{half.x, -half.y}, at + half, at + Vec2{-half.x, half.y}}, {}}});
    }
    ASSERT_TRUE(validate(s).empty()) << scene << ": " << validate(s).front().found;
    const datasets::RecordingFile file = recorded(s);
    const datasets::AuditReport report = datasets::audit(file);
    EXPECT_TRUE(report.clean()) << scene << ": " << first_finding(report);
    EXPECT_EQ(relaxed_in(file.recording), 0u) << scene;
    for (const Step& row : file.recording.steps)
      for (const RobotStep& r : row.robots) {
        ++decisions;
        fell_back += std::any_of(r.constraints.begin(), r.constraints.end(),
                                 [](const DecisionConstraint& c) { return c.fell_back; });
      }
  }
  EXPECT_GT(decisions, 15000u);
  EXPECT_GT(fell_back, 50u) << "half-planes contradict each other too seldom to test anything";
}

/// R2 stands before a wall that its discs would pass.
TEST(WheeledFormation, ARobotWithoutRoomToTurnIsGivenThatReason) {
  Scenario s = huskies("B1");
  for (Robot& r : s.robots) {
    DifferentialDrive d = *r.drive;
    d.footprint = {{0.495, 0.335}, {-0.495, 0.335}, {-0.495, -0.335}, {0.495, -0.335}};
    put_on_wheels(r, d, s.time_step);
  }
  EXPECT_THAT(simulate(s).outcome, testing::HasSubstr("; R2 has no room between obstacles to turn its footprint"));
}

TEST(WheeledFormation, EditsAreRefused) {
  Scenario s = huskies("B1");
  s.time_limit = 4.0;
  const datasets::RecordingFile file = recorded(s);
  ASSERT_TRUE(datasets::audit(file).clean());
  test::SeededRandom random(test::seed_of_run(44));
  for (int k = 0; k < 30 * kKindsOfEdit; ++k) {
    datasets::RecordingFile forged = file;
    const std::string what = edit_wheels(forged, k % kKindsOfEdit, random);
    EXPECT_FALSE(datasets::audit(forged).clean()) << k << ": " << what;
  }
  const auto refuted = [&](const auto& forge) {
    datasets::RecordingFile forged = file;
    forge(forged);
    return !datasets::audit(forged).clean();
  };
  EXPECT_TRUE(refuted([](auto& f) { f.recording.relative_frame = true; }));
  EXPECT_TRUE(refuted([](auto& f) {
    f.recording.relative_frame = true;
    f.recording.controller_options->absolute_frame = false;
  }));
  EXPECT_TRUE(refuted([](auto& f) { f.recording.tracking_gain = f.scenario.formation->gains.k3; }));
  EXPECT_TRUE(refuted([](auto& f) { f.recording.motion = MotionLaw::exponential; }));
  EXPECT_TRUE(refuted([](auto& f) { f.recording.offsets[0].x += 0.1; }));
  EXPECT_TRUE(refuted([](auto& f) { f.recording.steps[9].robots[1].wheels.reset(); }));
}

TEST(WheeledFormation, WhatItsProofLacksIsRefused) {
  const Scenario s = huskies("B1");
  const auto pointer_of = [&](const auto& change) {
    Scenario other = s;
    change(other);
    const std::vector<ScenarioProblem> problems = validate(other);
    return problems.empty() ? "" : problems.front().pointer;
  };
  EXPECT_EQ(pointer_of([](Scenario& o) { o.robots[1].drive.reset(); }), "/robots/1/kinematics");
  EXPECT_EQ(pointer_of([](Scenario& o) { o.acceleration.emplace(); }), "/acceleration");
  EXPECT_EQ(pointer_of([](Scenario& o) { o.formation->controller_options.acceleration_bound = 3.0; }),
            "/formation/controller_options/acceleration_bound");
  EXPECT_EQ(pointer_of([](Scenario& o) { o.formation->controller_options.filter_last = false; }),
            "/formation/controller_options/filter_last");
  EXPECT_EQ(pointer_of([](Scenario& o) { o.formation->controller_options.brake_point = true; }),
            "/formation/controller_options/brake_point");
  EXPECT_EQ(pointer_of([](Scenario& o) { o.formation->controller_options.brake_point = false; }), "");
  EXPECT_EQ(pointer_of([](Scenario& o) {
              o.moving_obstacles.push_back({"cart", geometry::Polyline{{{20.0, 0.0}, {21.0, 0.0}}}, {{{0.0, 0.0}}}});
            }),
            "/moving_obstacles");
  const auto unfit = [&](const SimulationOptions& options) {
    const std::vector<ScenarioProblem> problems = option_problems(s, options);
    return problems.empty() ? "" : problems.front().pointer;
  };
  EXPECT_EQ(unfit({}), "");
  for (const Controller controller : {Controller::paper_literal, Controller::paper_signs, Controller::corrected}) {
    SimulationOptions options;
    options.controller = controller;
    EXPECT_EQ(unfit(options), "controller") << name(controller);
  }
  SimulationOptions euler;
  euler.integrator = Integrator::euler;
  EXPECT_EQ(unfit(euler), "integrator");
  SimulationOptions smooth;
  smooth.controller_options = ControllerOptions{};
  smooth.controller_options->smoothing = true;
  EXPECT_EQ(unfit(smooth), "");
}

/// No function of Lyapunov and no brake point ahead of the robot: these are of robots that track what they choose.
TEST(WheeledFormation, LyapunovFunctionsAreNotReported) {
  Scenario s = huskies("B0");
  s.time_limit = 2.0;
  const Recording run = simulate(s);
  EXPECT_FALSE(measure(s, run).lyapunov);
  EXPECT_TRUE(measure(without_wheels(s), simulate(without_wheels(s))).lyapunov);
  EXPECT_FALSE(run.controller_options->brake_point);
  EXPECT_NE(run.outcome.find("on wheels no theorem says that robots reach their slots"), std::string::npos);
}

}  // namespace
}  // namespace exactvo::formation
