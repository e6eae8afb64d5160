// SPDX-License-Identifier: GPL-3.0-or-later
// Lemmas of docs/guide/liveness.md over whole runs, by their numbers. Lemmas 2 and 3: joint_plan_test.cpp, 5:
// liveness_test.cpp.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "decision/decision.h"
#include "exactvo/datasets/audit.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "liveness/groups.h"
#include "liveness_scenes.h"
#include "scene/step_limits.h"
#include "support/seeded_random.h"

namespace exactvo::formation {
namespace {

using Rational = mpq_class;

Rational dot_of(Vec2 a, Vec2 b) {
  return Rational(a.x) * Rational(b.x) + Rational(a.y) * Rational(b.y);
}

/// Whether radius |n| <= most, for a radius >= 0.
bool is_at_most(const Rational& radius, Vec2 n, const Rational& most) {
  return most >= 0 && radius * radius * dot_of(n, n) <= most * most;
}

/// So full that the half-planes of many robots contradict each other.
Scenario crowd(test::SeededRandom& random) {
  Scenario s;
  s.liveness = Liveness::bias;
  s.time_limit = 8.0;
  test_scenes::add_box(s, 4.0, 4.0);
  for (int i = 0; i < 25; ++i) {
    const Vec2 place{-2.8 + 1.4 * (i % 5), -2.8 + 1.4 * (i / 5)};
    test_scenes::add_robot(s, place + random.in_box(0.15), random.in_box(3.2));
  }
  return s;
}

/// In rationals: in every row of a crowd the halves of each pair add up to a half-plane of v_i - v_j that holds no
/// interior point of the velocity obstacle, nothing is relaxed, and v = 0 satisfies what fell back.
TEST(Lemmas, Lemma1_HalvesOfAPairAddUpAndNothingIsRelaxed) {
  test::SeededRandom random(test::seed_of_run(41));
  std::size_t pairs = 0, fallen = 0;
  for (int k = 0; k < 2; ++k) {
    const Scenario s = crowd(random);
    SimulationOptions options;
    options.record_all = true;
    const Recording run = simulate(s, options);
    const double at_rest = detail::contact_time(s.time_step, s.horizons);
    for (std::size_t row = 0; row + 1 < run.steps.size(); ++row) {
      const Step& step = run.steps[row];
      std::map<std::pair<std::size_t, std::size_t>, const DecisionConstraint*> half;
      for (std::size_t i = 0; i < step.robots.size(); ++i) {
        ASSERT_EQ(step.robots[i].status, lp::Status::optimal) << step.time << " " << i;
        for (const DecisionConstraint& c : step.robots[i].constraints)
          if (c.source == vo::BodyKind::robot) half[{i, c.index}] = &c;
      }
      for (const auto& [key, mine] : half) {
        const auto [i, j] = key;
        if (i > j) continue;
        const auto theirs = half.find({j, i});
        ASSERT_NE(theirs, half.end()) << step.time << " " << i << " " << j;
        const Vec2 n = mine->half_plane.normal, d = step.robots[j].position - step.robots[i].position;
        ASSERT_EQ(theirs->second->half_plane.normal, -n);
        const Rational offset = Rational(mine->half_plane.offset) + Rational(theirs->second->half_plane.offset);
        const Rational radii = Rational(s.robots[i].radius) + Rational(s.robots[j].radius);
        const Rational apart =
            Rational(n.x) * (Rational(step.robots[j].position.x) - Rational(step.robots[i].position.x)) +
            Rational(n.y) * (Rational(step.robots[j].position.y) - Rational(step.robots[i].position.y));
        // h_S(n) = n.d + (r + r') |n| <= 0, and h_S(n) / tau <= offset.
        EXPECT_TRUE(is_at_most(radii, n, -apart)) << step.time << " " << i << " " << j << " " << norm(d);
        EXPECT_TRUE(is_at_most(radii, n, offset * Rational(s.time_step) - apart)) << step.time << " " << i << " " << j;
        ++pairs;
        if (mine->time_horizon > at_rest) continue;
        ++fallen;
        EXPECT_LE(mine->half_plane.offset, 0.0);
        EXPECT_LE(theirs->second->half_plane.offset, 0.0);
      }
    }
  }
  EXPECT_GT(pairs, 10000u);
  EXPECT_GT(fallen, 100u) << "the crowd is no test";
}

/// Robots go back along a run, row by row, as those of a group that goes back do.
class Backwards {
 public:
  Backwards(const Scenario& scenario, const Recording& run) : run_(run), scenario_(reversed(scenario, run)) {
    file_.scenario = scenario_;
    file_.recording.time_step = scenario_.time_step;
    file_.recording.motion = MotionLaw::straight;
  }

  datasets::RecordingFile recorded() {
    detail::Scene scene(scenario_, options_);
    std::vector<std::unique_ptr<detail::StaticField>> fields;
    for (std::size_t i = 0; i < scenario_.robots.size(); ++i) {
      const Robot& r = scenario_.robots[i];
      fields.push_back(std::make_unique<detail::StaticField>(scene, rules_, r.radius, r.position, r.goals[0],
                                                             detail::HorizonRule::clamped));
      fields.back()->set_margin(0.0);
      file_.recording.goal_bodies.push_back({0.0, i, 0, fields.back()->shapes()});
      at_.push_back({r.position, r.velocity});
    }
    detail::Decider decider(rules_, scene.bodies());
    for (std::size_t row = run_.steps.size() - 1; row > 0; --row) add_row(row, scene, fields, decider);
    Step last;
    last.time = time();
    for (const detail::Anchor& a : at_) add_robot(last, a);
    file_.recording.steps.push_back(last);
    for (std::size_t k = 0; k < scene.bodies().size(); ++k) file_.recording.bodies.push_back(scene.bodies()[k]);
    return file_;
  }

 private:
  static Scenario reversed(Scenario s, const Recording& run) {
    for (std::size_t i = 0; i < s.robots.size(); ++i) {
      s.robots[i].goals = {s.robots[i].position};
      s.robots[i].position = run.steps.back().robots[i].position;
      s.robots[i].velocity = {};
    }
    return s;
  }

  double time() const { return static_cast<double>(file_.recording.steps.size()) * scenario_.time_step; }

  static RobotStep& add_robot(Step& row, const detail::Anchor& a) {
    RobotStep& r = row.robots.emplace_back();
    r.position = r.anchor = a.position;
    r.velocity = r.anchor_velocity = a.velocity;
    return r;
  }

  void add_row(std::size_t row, detail::Scene& scene, const std::vector<std::unique_ptr<detail::StaticField>>& fields,
               detail::Decider& decider) {
    std::vector<std::optional<Vec2>> back;
    for (std::size_t i = 0; i < at_.size(); ++i)
      back.emplace_back(detail::velocity_along(rules_, scenario_.robots[i].max_speed,
                                               run_.steps[row - 1].robots[i].position - at_[i].position));
    detail::PairMemory memory;
    const detail::RobotsAt now{rules_, scenario_.robots, at_, scene};
    detail::robot_constraints(now, memory, others_);
    detail::follow_plans(now, back, others_);
    Step step;
    step.time = time();
    for (std::size_t i = 0; i < at_.size(); ++i) {
      RobotStep& r = add_robot(step, at_[i]);
      r.mode = Mode::going_back;
      const Robot& spec = scenario_.robots[i];
      detail::Viewpoint here{at_[i].position, *back[i], spec.radius, spec.max_speed};
      here.horizon = scenario_.time_step;
      fields[i]->constraints(here, statics_, detail::reach_of_step(rules_.time_step, here.max_speed));
      const std::optional<double> share = detail::allowed_share(*back[i], statics_, others_[i]);
      EXPECT_TRUE(share.has_value() && *share == 1.0) << "row " << row << ", robot " << i;
      decider.decide({share.value_or(0.0) * *back[i], here, &statics_, &others_[i], false}, r);
    }
    for (std::size_t i = 0; i < at_.size(); ++i) {
      at_[i].velocity = step.robots[i].chosen;
      at_[i].position += scenario_.time_step * step.robots[i].chosen;
    }
    file_.recording.steps.push_back(std::move(step));
  }

  const Recording& run_;
  Scenario scenario_;
  SimulationOptions options_;
  detail::DecisionRules rules_ = detail::rules_of(scenario_, options_);
  datasets::RecordingFile file_;
  std::vector<detail::Anchor> at_;
  std::vector<detail::Constraint> statics_;
  std::vector<std::vector<detail::Constraint>> others_;
};

/// From where runs ended, robots go back as they came: every step is admitted, and the audit of that run finds
/// nothing. Circles in the open; a street with its walls, by plan; a crowd that touches.
TEST(Lemmas, Lemma4_RecordedRunsReplayedBackwardsAuditClean) {
  test::SeededRandom random(test::seed_of_run(42));
  Scenario in_a_box = crowd(random);
  in_a_box.time_limit = 3.0;
  Scenario street = test_scenes::street(14, 3.0);
  street.time_limit = 16.0;
  for (const Scenario& s : {test_scenes::circle(6), street, in_a_box}) {
    const Recording run = simulate(s);
    datasets::RecordingFile file = Backwards(s, run).recorded();
    const datasets::AuditReport report = datasets::audit(file);
    EXPECT_TRUE(report.clean()) << s.name << ": " << datasets::to_json(report);
    EXPECT_EQ(report.collisions, 0u) << s.name;
    EXPECT_GT(report.robot_questions, 100u) << s.name;
    for (std::size_t i = 0; i < s.robots.size(); ++i)
      EXPECT_NEAR(norm(file.recording.steps.back().robots[i].position - s.robots[i].position), 0.0, 1e-9) << s.name;
  }
}

/// In a closed strip narrower than two diameters the order never changes, and neighbours keep a certain distance along
/// it, whatever the robots want.
TEST(Lemmas, Lemma6_InANarrowStripTheOrderStays) {
  test::SeededRandom random(test::seed_of_run(43));
  for (int k = 0; k < 6; ++k) {
    const double radius = 0.5, width = random.uniform(1.05, 1.95);
    Scenario s;
    s.time_limit = 12.0;
    s.liveness = k % 2 == 0 ? Liveness::plan : Liveness::bias;
    test_scenes::add_wall(s, {{-9, 0}, {9, 0}, {9, width}, {-9, width}, {-9, 0}});
    const auto across = [&] { return random.uniform(radius + 0.01, width - radius - 0.01); };
    for (int i = 0; i < 4; ++i)
      test_scenes::add_robot(s, {-6.0 + 4.0 * i, across()}, {random.uniform(-8.0, 8.0), across()});
    // sqrt(4 r^2 - (w - 2 r)^2), rounded down.
    const double least =
        std::sqrt(4.0 * radius * radius - (width - 2.0 * radius) * (width - 2.0 * radius)) * (1 - 1e-12);
    const Recording run = simulate(s);
    EXPECT_TRUE(measure(s, run).collisions.empty());
    for (const Step& row : run.steps)
      for (std::size_t i = 1; i < row.robots.size(); ++i)
        ASSERT_GE(row.robots[i].position.x - row.robots[i - 1].position.x, least) << k << " " << row.time << " " << i;
  }
}

}  // namespace
}  // namespace exactvo::formation
