// SPDX-License-Identifier: GPL-3.0-or-later
// What must hold at every step of every run.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "exactvo/geometry/predicates.h"
#include "paper_scenes.h"
#include "steering/steering.h"

namespace exactvo::formation {
namespace {

using test::paper_scene;

/// m/s: the solver keeps 16 u V inside every line; V is at most 10 m/s here.
constexpr double kSolverSlack = 1e-13;

const char* const kStaticScenes[] = {"A1",  "A3",  "A4",  "A5",  "A6",  "A8", "A9",
                                     "A10", "A11", "A12", "A13", "A14", "A15"};

SimulationOptions everything_of(Method method) {
  SimulationOptions options;
  options.guidance = Guidance::none;
  options.liveness = Liveness::off;
  options.method = method;
  options.record_all = true;
  return options;
}

TEST(Notes, ARowKeepsBoth) {
  const auto both = [](std::string notes, const char* second) {
    detail::add_note(notes, second);
    return notes;
  };
  EXPECT_EQ(both("goal 1 passed", "stalled"), "goal 1 passed; stalled");
  EXPECT_EQ(both("", "stalled"), "stalled");
  EXPECT_EQ(both("goal 1 passed", ""), "goal 1 passed");
}

bool a_robot_binds(const RobotStep& step) {
  for (const DecisionConstraint& c : step.constraints)
    if (c.active && c.source == ConstraintSource::robot) return true;
  return false;
}

/// |p - g| may grow by so much in a step (steering.h, `with_tie_broken`).
double allowed_growth(const Scenario& s, const RobotStep& step, Vec2 to_goal, double max_speed) {
  constexpr double kStraight = 1e-9;  // rad
  const double turned = std::fabs(cross(to_goal, step.preferred)) / (norm(to_goal) * norm(step.preferred));
  const double rate = turned < kStraight ? kSolverSlack : max_speed * detail::kTieAngle * detail::kTieAngle / 2.0;
  const double rounding = 4.0 * geometry::kUnitRoundoff * (norm(to_goal) + norm(step.position));
  return s.time_step * rate + rounding;
}

class PureTwelve : public testing::TestWithParam<const char*> {};

TEST_P(PureTwelve, DistanceToTheGoalNeverGrows) {
  const Scenario s = paper_scene(GetParam());
  const Recording r = simulate(s, everything_of(Method::ivo_cluster));
  std::size_t judged = 0;
  for (std::size_t k = 0; k + 1 < r.steps.size(); ++k) {
    for (std::size_t i = 0; i < s.robots.size(); ++i) {
      const RobotStep& step = r.steps[k].robots[i];
      if (a_robot_binds(step) || step.mode != Mode::direct) continue;
      const Vec2 to_goal = s.robots[i].goals.back() - step.position;
      const Vec2 after = s.robots[i].goals.back() - r.steps[k + 1].robots[i].position;
      ASSERT_LE(norm(after), norm(to_goal) + allowed_growth(s, step, to_goal, s.robots[i].max_speed))
          << "step " << k << " robot " << i;
      ++judged;
    }
  }
  EXPECT_GT(judged, 100u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, PureTwelve, testing::ValuesIn(kStaticScenes),
                         [](const auto& row) { return std::string(row.param); });

/// Exactly: the half-plane excludes the velocity obstacle that it was built on.
bool proven(const DecisionConstraint& c, const SeenBody& seen) {
  return geometry::half_plane_is_safe({seen.shape, seen.position, seen.radius}, c.time_horizon, c.half_plane);
}

struct Audit {
  std::size_t statics = 0, pairs = 0;
};

void audit_statics(const Scenario& s, const Recording& run, const Step& row, std::size_t robot, Audit& audit) {
  for (const DecisionConstraint& c : row.robots[robot].constraints) {
    if (c.source == ConstraintSource::robot) continue;
    ASSERT_TRUE(c.certified);
    const SeenBody seen = seen_body(s, run.bodies, row, robot, c);
    ASSERT_TRUE(proven(c, seen)) << geometry::to_string(seen.shape);
    ASSERT_LE(c.half_plane.offset, 0.0) << "v = 0 is not admitted";
    ++audit.statics;
  }
}

const DecisionConstraint* against(const RobotStep& step, std::size_t other) {
  for (const DecisionConstraint& c : step.constraints)
    if (c.source == ConstraintSource::robot && c.index == other) return &c;
  return nullptr;
}

void audit_pairs(const Scenario& s, const Recording& run, const Step& row, Audit& audit) {
  for (std::size_t i = 0; i < row.robots.size(); ++i) {
    for (std::size_t j = i + 1; j < row.robots.size(); ++j) {
      const DecisionConstraint* a = against(row.robots[i], j);
      const DecisionConstraint* b = against(row.robots[j], i);
      ASSERT_EQ(a == nullptr, b == nullptr);
      if (!a) continue;
      ASSERT_EQ(a->half_plane.normal, -b->half_plane.normal);
      // The sum rounded down: what the relative velocity is certain to keep.
      const double sum =
          std::nextafter(a->half_plane.offset + b->half_plane.offset, -std::numeric_limits<double>::max());
      DecisionConstraint both = *a;
      both.half_plane.offset = sum;
      ASSERT_TRUE(proven(both, seen_body(s, run.bodies, row, i, both)));
      ++audit.pairs;
    }
  }
}

Audit audited(const Scenario& s, const Recording& recording) {
  Audit audit;
  for (std::size_t k = 0; k + 1 < recording.steps.size(); ++k) {
    const Step& row = recording.steps[k];
    for (std::size_t i = 0; i < row.robots.size(); ++i) audit_statics(s, recording, row, i, audit);
    audit_pairs(s, recording, row, audit);
    if (testing::Test::HasFatalFailure()) break;
  }
  return audit;
}

TEST(Recorded, EveryHalfPlaneOfTheKinematicRunsIsProven) {
  for (const char* scene : kStaticScenes) {
    for (const Method method : {Method::ivo_edge, Method::ivo_cluster, Method::ivo}) {
      Scenario s = paper_scene(scene);
      s.time_limit = 20.0;
      const Audit audit = audited(s, simulate(s, everything_of(method)));
      EXPECT_GT(audit.statics, 100u) << scene << " " << name(method);
    }
  }
}

TEST(Recorded, EveryHalfPlaneOfOrcaIsProven) {
  for (const char* scene : kStaticScenes) {
    Scenario s = paper_scene(scene);
    s.time_limit = 20.0;
    EXPECT_GT(audited(s, simulate(s, everything_of(Method::orca))).statics, 20u) << scene;
  }
}

TEST(Recorded, TheHalvesOfEveryPairAddUp) {
  for (const char* scene : {"A7", "B0", "B1", "B2", "B3"}) {
    const Scenario s = paper_scene(scene);
    const Audit audit = audited(s, simulate(s, everything_of(Method::ivo)));
    EXPECT_GT(audit.pairs, 100u) << scene;
  }
}

TEST(Recorded, ActiveHalfPlanesBind) {
  const Scenario s = paper_scene("A4");
  const Recording r = simulate(s, everything_of(Method::ivo));
  std::size_t active = 0;
  for (std::size_t k = 0; k + 1 < r.steps.size(); ++k) {
    for (const RobotStep& step : r.steps[k].robots) {
      for (const DecisionConstraint& c : step.constraints) {
        ASSERT_LE(geometry::violation(c.half_plane, step.chosen), 0.0);
        if (!c.active) continue;
        ++active;
        ASSERT_GT(geometry::violation(c.half_plane, step.chosen), -kSolverSlack);
      }
    }
  }
  EXPECT_GT(active, 10u);
}

}  // namespace
}  // namespace exactvo::formation
