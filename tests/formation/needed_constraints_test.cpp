// SPDX-License-Identifier: GPL-3.0-or-later
// Half-planes that are built on demand: what is left out changes no bit of a decision.
#include "decision/needed_constraints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "decision/decision.h"
#include "exactvo/datasets/generators.h"
#include "generators/counter_random.h"
#include "paper_scenes.h"
#include "scene/step_limits.h"

namespace exactvo::formation::detail {
namespace {

/// A floor, or a field of polygons, seen by a robot at random places, going anywhere at any speed.
struct Sight {
  Scenario scenario;
  DecisionRules rules;
  std::optional<Scene> scene;
  std::optional<StaticField> field;
  geometry::Box extent;

  Sight(const std::string& kind, Method method) {
    scenario.guidance = Guidance::none;
    scenario.liveness = Liveness::off;
    for (std::uint64_t item = 0; item < 3; ++item)
      for (SceneObstacle& o : datasets::generated_item(kind, item, 11)) scenario.obstacles.push_back(std::move(o));
    for (const SceneObstacle& o : scenario.obstacles)
      for (const Vec2 p : vertices_of(o.shape)) extent.add(p);
    SimulationOptions options;
    options.method = method;
    rules = rules_of(scenario, options);
    scene.emplace(scenario, options);
    field.emplace(*scene, rules, 0.2, extent.low, extent.high, HorizonRule::clamped);
  }

  Viewpoint draw(datasets::CounterRandom& random) const {
    const double x = random.uniform(0.0, 1.0), y = random.uniform(0.0, 1.0);
    const Vec2 size = extent.high - extent.low;
    const Viewpoint anywhere{extent.low + Vec2{x * size.x, y * size.y}, velocity(random), 0.2, 1.2};
    return random.uniform(0.0, 1.0) < 0.5 ? anywhere : along_edge(random);
  }

  /// The view of a robot that follows a boundary: next to an edge or a corner of it, at the margin or within rounding
  /// of it; it moves along the edge or a little off.
  Viewpoint along_edge(datasets::CounterRandom& random) const {
    const auto pick = [&](std::size_t n) {
      return std::min(n - 1, static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(n))));
    };
    const std::vector<Vec2> corners = vertices_of(scenario.obstacles[pick(scenario.obstacles.size())].shape);
    const std::size_t k = pick(corners.size());
    const Vec2 a = corners[k], b = corners[(k + 1) % corners.size()];
    const Vec2 along = geometry::normalized(b - a);
    constexpr double kOff[] = {0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.05, 0.3};
    const double gap = 0.2 + scenario.margins.obstacle + kContactSkin + kOff[pick(std::size(kOff))];
    const double turned = random.uniform(0.0, 1.0) < 0.5 ? 0.0 : kOff[pick(std::size(kOff))];
    const Vec2 place = a + random.uniform(-0.1, 1.1) * (b - a) + (pick(2) == 0 ? -gap : gap) * geometry::perp(along);
    return {place, 1.2 * geometry::rotated(along, turned), 0.2, 1.2};
  }

  static Vec2 velocity(datasets::CounterRandom& random) {
    const double angle = random.uniform(0.0, 6.28), speed = 1.2 * std::max(0.0, random.uniform(-0.3, 1.3));
    return {speed * std::cos(angle), speed * std::sin(angle)};
  }
};

bool are_same(const Constraint& a, const Constraint& b) {
  return a.body == b.body && a.half_plane.normal == b.half_plane.normal && a.half_plane.offset == b.half_plane.offset &&
         a.clearance == b.clearance && a.time_horizon == b.time_horizon && a.index == b.index && a.piece == b.piece &&
         a.proof == b.proof && a.trap_free == b.trap_free;
}

/// Those of `all` that are not among `some`, which must come in the same order.
std::vector<Constraint> left_out(const std::vector<Constraint>& all, const std::vector<Constraint>& some) {
  std::vector<Constraint> out;
  std::size_t next = 0;
  for (const Constraint& c : all) {
    if (next < some.size() && are_same(c, some[next]))
      ++next;
    else
      out.push_back(c);
  }
  EXPECT_EQ(next, some.size());
  return out;
}

double violation_of_unit(const Constraint& c, Vec2 v) {
  return geometry::violation(c.half_plane, v) / norm(c.half_plane.normal);
}

class NeededHalfPlanes : public testing::TestWithParam<std::tuple<const char*, Method>> {};

TEST_P(NeededHalfPlanes, LeaveOutNoneThatAVelocityViolatesMost) {
  const Sight sight(std::get<0>(GetParam()), std::get<1>(GetParam()));
  datasets::CounterRandom random(3);
  NeededConstraints needed;
  std::vector<Constraint> all;
  std::size_t built = 0, asked = 0;
  for (int k = 0; k < 2000; ++k) {
    const Viewpoint from = sight.draw(random);
    sight.field->constraints(from, all);
    needed.look(*sight.field, from, 0.1);
    for (const Constraint& c : left_out(all, needed.lines())) EXPECT_GT(c.clearance, 0.1);
    for (const Vec2 v : {from.velocity, Sight::velocity(random)}) {
      needed.need_at(v);
      double most = 0.0;
      for (const Constraint& c : needed.lines())
        most = std::max({most, geometry::violation(c.half_plane, v), violation_of_unit(c, v)});
      for (const Constraint& c : left_out(all, needed.lines())) {
        EXPECT_LT(violation_of_unit(c, v), most - 1e-4);
        EXPECT_NE(c.proof, vo::Proof::none);
      }
    }
    built += needed.lines().size();
    asked += all.size();
  }
  EXPECT_LT(built, (3 * asked) / 4);  // of what stands round a place that may lie inside an obstacle
}

TEST_P(NeededHalfPlanes, NameTheFirstThatATurningVelocityViolates) {
  const Sight sight(std::get<0>(GetParam()), std::get<1>(GetParam()));
  datasets::CounterRandom random(5);
  NearConstraints near;
  std::vector<Constraint> all;
  std::size_t met = 0;
  for (int k = 0; k < 2000; ++k) {
    const Viewpoint from = sight.draw(random);
    const double reach = k % 2 == 0 ? 0.36 : 2.0;
    sight.field->constraints(from, all);
    near.look(*sight.field, from, reach);
    for (int turn = 0; turn < 3; ++turn) {
      const Vec2 v = turn == 1 ? from.velocity : Sight::velocity(random);
      const Constraint* found = near.first_violated(v);
      const auto first = std::find_if(all.begin(), all.end(), [&](const Constraint& c) {
        return c.clearance <= reach && violates(c.half_plane, v);
      });
      ASSERT_EQ(found != nullptr, first != all.end());
      if (found) {
        EXPECT_TRUE(are_same(*found, *first));
      }
      met += found != nullptr;
    }
    for (const Constraint& c : all) {
      const Constraint* of_body = near.of_body(c.body);
      ASSERT_EQ(of_body != nullptr, c.clearance <= reach);
      if (of_body) {
        EXPECT_EQ(of_body->half_plane.offset, c.half_plane.offset);
      }
    }
  }
  EXPECT_GT(met, 50u);
}

/// Whether any, asked of one sight after the other on a way, so that what is near is gathered now and then only.
TEST_P(NeededHalfPlanes, SayWhetherAnyIsViolatedOnAWay) {
  const Sight sight(std::get<0>(GetParam()), std::get<1>(GetParam()));
  datasets::CounterRandom random(6);
  NearConstraints near;
  std::vector<Constraint> all;
  std::size_t met = 0, asked = 0;
  for (int way = 0; way < 40; ++way) {
    Viewpoint from = sight.draw(random);
    for (int k = 0; k < 50; ++k) {
      const double reach = 0.36;
      sight.field->constraints(from, all);
      near.look(*sight.field, from, reach);
      const Vec2 v = k % 3 == 0 ? from.velocity : Sight::velocity(random);
      const bool any = std::any_of(all.begin(), all.end(), [&](const Constraint& c) {
        return c.clearance <= reach && violates(c.half_plane, v);
      });
      ASSERT_EQ(near.any_violated(v), any);
      met += any;
      ++asked;
      from.velocity = k % 10 == 9 ? Sight::velocity(random) : from.velocity;
      from.position += 0.02 * from.velocity;
    }
  }
  EXPECT_GT(met, 50u);
  EXPECT_LT(met, asked);
}

/// The half-planes that bind, with their multipliers. Two obstacles that share an edge have the same half-plane, and
/// either may be named.
std::set<std::array<double, 4>> binding(const RobotStep& step) {
  std::set<std::array<double, 4>> found;
  for (const DecisionConstraint& c : step.constraints)
    if (c.active) found.insert({c.half_plane.normal.x, c.half_plane.normal.y, c.half_plane.offset, c.multiplier});
  return found;
}

TEST_P(NeededHalfPlanes, GiveTheDecisionThatAllGive) {
  const Sight sight(std::get<0>(GetParam()), std::get<1>(GetParam()));
  datasets::CounterRandom random(4);
  NeededConstraints needed;
  std::vector<Constraint> all;
  Decider decider(sight.rules, sight.scene->bodies());
  const std::vector<Constraint> others;
  int ties = 0;
  for (int k = 0; k < 2000; ++k) {
    const Viewpoint from = sight.draw(random);
    const Vec2 preferred = Sight::velocity(random);
    sight.field->constraints(from, all);
    needed.look(*sight.field, from, reach_of_step(sight.rules.time_step, from.max_speed));
    RobotStep of_all, of_needed;
    decider.decide({preferred, from, &all, &others, false, nullptr}, of_all);
    decider.decide({preferred, from, &needed.lines(), &others, false, &needed}, of_needed);
    EXPECT_EQ(of_needed.status, of_all.status);
    EXPECT_EQ(of_needed.violation, of_all.violation);
    EXPECT_EQ(of_needed.uncertified, of_all.uncertified);
    if (of_needed.chosen != of_all.chosen) {  // three lines meet up to rounding: obstacles that share an edge or corner
      EXPECT_LT(norm(of_needed.chosen - of_all.chosen), 1e-14);
      ++ties;
      continue;
    }
    ASSERT_EQ(of_needed.constraints.size(), of_all.constraints.size());
    for (std::size_t i = 0; i < of_all.constraints.size(); ++i)
      EXPECT_EQ(of_needed.constraints[i].body, of_all.constraints[i].body);
    EXPECT_EQ(binding(of_needed), binding(of_all));
  }
  EXPECT_LE(ties, 10) << "of 2000";
}

INSTANTIATE_TEST_SUITE_P(Scenes, NeededHalfPlanes,
                         testing::Combine(testing::Values("floor", "polygon", "field-open", "block", "maze"),
                                          testing::Values(Method::ivo, Method::ivo_edge)),
                         [](const auto& row) {
                           std::string text = std::string(std::get<0>(row.param)) + "_" + name(std::get<1>(row.param));
                           std::replace(text.begin(), text.end(), '-', '_');
                           return text;
                         });

/// The decision with some half-planes and with all: every row of a run, as it is written.
TEST(NeededHalfPlanes, ARunThatKeepsAllDrivesTheSameRows) {
  for (const char* scene : {"A2", "A7", "A14", "B1", "B3"}) {
    const Scenario s = test::paper_scene(scene);
    SimulationOptions all;
    all.record_all = true;
    const Recording whole = simulate(s, all), usual = simulate(s);
    ASSERT_EQ(whole.steps.size(), usual.steps.size());
    for (std::size_t k = 0; k < whole.steps.size(); ++k)
      for (std::size_t i = 0; i < s.robots.size(); ++i) {
        const RobotStep &a = whole.steps[k].robots[i], &b = usual.steps[k].robots[i];
        EXPECT_EQ(a.chosen, b.chosen);
        EXPECT_EQ(a.mode, b.mode);
        EXPECT_EQ(a.note, b.note);
        EXPECT_EQ(a.uncertified, b.uncertified);
      }
  }
}

}  // namespace
}  // namespace exactvo::formation::detail
