// SPDX-License-Identifier: GPL-3.0-or-later
// Controller options, stability, Lyapunov functions, patterns, moving obstacles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "exactvo/formation/lyapunov.h"
#include "exactvo/formation/patterns.h"
#include "exactvo/formation/stability.h"
#include "paper_scenes.h"

namespace exactvo::formation {
namespace {

using test::paper_scene;
using test::run;

SimulationOptions with(const ControllerOptions& wanted) {
  SimulationOptions options;
  options.controller_options = wanted;
  return options;
}

TEST(ControllerOptions, AddedOneByOneTheyEndAtTheDefault) {
  const std::vector<NamedControllerOptions> sets = incremental_controller_options();
  const Recording top = simulate(paper_scene("B1"), with(sets.back().options));
  const Recording standard = simulate(paper_scene("B1"));
  EXPECT_EQ(top.steps.back().robots[0].position, standard.steps.back().robots[0].position);
  EXPECT_EQ(top.outcome, standard.outcome);
}

TEST(ControllerOptions, EverySwitchChangesTheRun) {
  const Recording standard = simulate(paper_scene("B3"));
  std::size_t judged = 0;
  for (const NamedControllerOptions& n : ablated_controller_options()) {
    if (n.name == "default") continue;
    const Recording r = simulate(paper_scene("B3"), with(n.options));
    double farthest = 0.0;
    for (std::size_t k = 0; k < std::min(r.steps.size(), standard.steps.size()); ++k)
      for (std::size_t i = 0; i < 3; ++i)
        farthest = std::max(farthest, norm(r.steps[k].robots[i].position - standard.steps[k].robots[i].position));
    EXPECT_GT(farthest, 0.01) << n.name << ": m, between the two runs";
    ++judged;
  }
  EXPECT_EQ(judged, 8u);
}

TEST(ControllerOptions, CorrectedFormsInFreeSpace) {
  const Metrics m = run(paper_scene("B0"), test::with_controller(Controller::corrected)).metrics;
  EXPECT_LT(m.formation_position_error.value(), 1e-9);
}

TEST(ControllerOptions, SaturationAloneTakesMostOfTheJitter) {
  ControllerOptions constant;
  constant.saturation = false;
  const double with_it = run(paper_scene("B0"), {}).metrics.jitter;
  const double without = run(paper_scene("B0"), with(constant)).metrics.jitter;
  EXPECT_GT(without, 50.0 * with_it);
}

TEST(ControllerOptions, SmoothingLowersJitterAndStillForms) {
  ControllerOptions smooth;
  smooth.smoothing = true;
  for (const char* scene : {"B1", "B2", "B3"}) {
    const Metrics m = run(paper_scene(scene), with(smooth)).metrics;
    EXPECT_LT(m.jitter, run(paper_scene(scene), {}).metrics.jitter) << scene;
    EXPECT_LT(m.formation_position_error.value(), 1e-9) << scene;
    EXPECT_GT(m.min_obstacle_clearance.value(), 0.0) << scene;
    EXPECT_GT(m.min_robot_clearance.value(), 0.0) << scene;
  }
}

TEST(ControllerOptions, TheAccelerationBoundHolds) {
  ControllerOptions bounded;
  bounded.acceleration_bound = 8.0;
  const Recording r = simulate(paper_scene("B0"), with(bounded));
  for (std::size_t k = 0; k + 1 < r.steps.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec2 dv = r.steps[k + 1].robots[i].velocity - r.steps[k].robots[i].velocity;
      ASSERT_LE(norm(dv), 8.0 * r.time_step * (1.0 + 1e-9));
    }
  EXPECT_LT(measure(paper_scene("B0"), r).formation_position_error.value(), 1e-6);
}

TEST(Stability, ThePapersTopologyHasEigenvaluesOneFourFour) {
  const Stability s = stability_of(*paper_scene("B0").formation);
  ASSERT_EQ(s.eigenvalues.size(), 3u);
  EXPECT_NEAR(s.eigenvalues[0], 1.0, 1e-12);
  EXPECT_NEAR(s.eigenvalues[1], 4.0, 1e-12);
  EXPECT_NEAR(s.eigenvalues[2], 4.0, 1e-12);
  EXPECT_NEAR(s.euler_step_limit, 2.0 / (37.5 + 4.0 * 0.45), 1e-12);
  EXPECT_GE(s.euler_exact_limit, s.euler_step_limit);
}

TEST(Stability, TheSpectralRadiusCrossesOneAtTheLimit) {
  const Scenario scene = paper_scene("B0");
  const FormationSpec& f = *scene.formation;
  const double limit = stability_of(f).euler_exact_limit;
  EXPECT_LT(step_spectral_radius(f, Integrator::euler, 0.999 * limit), 1.0);
  EXPECT_GT(step_spectral_radius(f, Integrator::euler, 1.001 * limit), 1.0);
  EXPECT_LT(step_spectral_radius(f, Integrator::exact, 0.5), 1.0);
}

TEST(Stability, EulerAtSixHundredthsDivergesAndTheStepLimitWarningSaidSoBefore) {
  Scenario s = paper_scene("B0");
  SimulationOptions options;
  options.integrator = Integrator::euler;
  EXPECT_TRUE(simulate(s, options).warnings.empty());
  s.time_step = 0.06;
  const Recording r = simulate(s, options);
  EXPECT_TRUE(r.diverged);
  ASSERT_FALSE(r.warnings.empty());
  EXPECT_NE(r.warnings.front().find("0.05"), std::string::npos) << r.warnings.front();
}

TEST(Stability, TheSlowestModeIsTheOneThatIsSeen) {
  const Scenario s = paper_scene("B0");
  const Recording r = simulate(s);
  const std::vector<double> error = formation_error_series(s, r, 0);
  // Between two late times, while far above rounding.
  const std::size_t from = 450, to = 650;
  const double seen = std::log(error[from] / error[to]) / (static_cast<double>(to - from) * r.time_step);
  // What is held over a step decays a little faster than the continuous law.
  const double stepped = -std::log(step_spectral_radius(*s.formation, Integrator::exact, s.time_step)) / s.time_step;
  EXPECT_NEAR(seen, stepped, 0.03 * seen);  // the modes lie within 5 % of each other
  EXPECT_NEAR(stability_of(*s.formation).convergence_rate, stepped, 0.05 * stepped);
}

TEST(Lyapunov, TheSoundFunctionFallsInFreeSpace) {
  Scenario s = paper_scene("B0");
  s.formation->leader.path = {{0, 0}, {200, 200}};  // no corner within the run
  const Recording r = simulate(s);
  const std::vector<LyapunovRow> rows = lyapunov_along(s, r);
  ASSERT_EQ(rows.size(), r.steps.size());
  EXPECT_GT(rows.front().sound.value(), 100.0);
  for (std::size_t k = 1; k < rows.size(); ++k)
    ASSERT_LE(rows[k].sound.value(), rows[k - 1].sound.value() + 1e-12 * rows.front().sound.value()) << k;
  EXPECT_LT(rows.back().sound.value(), 1e-12);
}

TEST(Lyapunov, ItsDerivativeIsTheOneStated) {
  // Where nothing intervenes, differences over a small step match the rate.
  Scenario s = paper_scene("B0");
  s.formation->leader.path = {{0, 0}, {200, 200}};
  s.time_step = 1e-4;
  s.time_limit = 1.0;
  s.robots[0].position = {6.0, 0.0};  // apart enough for no robot to bind
  s.robots[1].position = {0.0, 6.0};
  s.robots[2].position = {-6.0, -3.0};
  const std::vector<LyapunovRow> rows = lyapunov_along(s, simulate(s));
  for (std::size_t k = 2000; k + 1 < rows.size(); k += 500) {
    const double slope = (rows[k + 1].sound.value() - rows[k].sound.value()) / s.time_step;
    const double stated = 0.5 * (rows[k].sound_rates.value() + rows[k + 1].sound_rates.value());
    EXPECT_NEAR(slope, stated, 0.02 * std::fabs(stated)) << k;
  }
}

TEST(Lyapunov, ItsDerivativeHoldsNearObstaclesTermByTerm) {
  // V' = -k2 v^T (L+B) v - k3 |v|^2 + k3 v.e: what obstacles and robots ask for is the third term.
  Scenario s = paper_scene("B1");
  s.formation->leader.path = {{0, 0}, {200, 200}};
  s.time_step = 1e-4;
  s.time_limit = 3.5;
  const Recording r = simulate(s);
  const std::vector<LyapunovRow> rows = lyapunov_along(s, r);
  double most = 0.0;
  for (std::size_t k = 2000; k + 2 < rows.size(); k += 250) {
    const double slope = (rows[k + 1].sound.value() - rows[k].sound.value()) / s.time_step;
    const double stated = 0.5 * (rows[k].sound_rates.value() + rows[k + 1].sound_rates.value());
    EXPECT_NEAR(slope, stated, 0.02 * std::fabs(stated) + 0.02) << k;
    EXPECT_LE(rows[k].sound_rates.value(), rows[k].rate_bound + 1e-9 * std::fabs(rows[k].rate_bound) + 1e-9) << k;
    most = std::max(most, std::fabs(rows[k].sound_rates.intervention));
  }
  EXPECT_GT(most, 1.0);  // the wall is met
}

TEST(Lyapunov, Equation19HoldsTermByTermAndEquation20DoesNot) {
  Scenario s = paper_scene("B1");
  s.formation->leader.path = {{0, 0}, {200, 200}};
  s.time_step = 1e-4;
  s.time_limit = 3.5;
  const std::vector<LyapunovRow> rows = lyapunov_along(s, simulate(s));
  bool rises = false;
  for (std::size_t k = 2000; k + 2 < rows.size(); k += 250) {
    const double slope = (rows[k + 1].paper.value() - rows[k].paper.value()) / s.time_step;
    const double stated = 0.5 * (rows[k].paper_rates.value() + rows[k + 1].paper_rates.value());
    // To 2 % of its greatest terms, which cancel.
    const double terms = std::fabs(rows[k].paper_rates.kinetic) + std::fabs(rows[k].paper_rates.integral);
    EXPECT_NEAR(slope, stated, 0.02 * terms + 0.02) << k;
    rises = rises || rows[k].paper_rates.value() > rows[k].paper_rate + 1.0;
  }
  EXPECT_TRUE(rises);
}

TEST(Lyapunov, Equation20IsTheDerivativeOf18UnderThePapersOwnLaw) {
  // The paper defines the integral of (18) so that (20) follows from (15): with V_IVO in the paper's frame it does.
  for (const char* scene : {"B0", "B1"}) {
    const Scenario s = paper_scene(scene);
    const Recording r = simulate(s, test::with_controller(Controller::paper_signs));
    const std::vector<LyapunovRow> rows = lyapunov_along(s, r);
    for (std::size_t k = 0; k + 1 < rows.size(); ++k)
      ASSERT_NEAR(rows[k].paper_rates.value(), rows[k].paper_rate, 1e-9) << scene << " row " << k;
  }
}

TEST(Lyapunov, TheIntegralOf18KeepsTheDecisionOfItsStep) {
  // V falls in B0 all along, and to where the exact integral of the held decisions leads. (The run is chaotic: another
  // rounding of decisions ends some per cent away.)
  const Scenario s = paper_scene("B0");
  const Recording r = simulate(s, test::with_controller(Controller::paper_signs));
  const LyapunovCourse course = summary_of(s, r).paper;
  EXPECT_EQ(course.largest_rise, 0.0);
  EXPECT_NEAR(course.last, -1444.4, 1.0);
}

TEST(Lyapunov, ThePapersFunctionFallsBelowZeroWhileTheFormationIsLost) {
  // A constant relative V_IVO = 0.1 on robot 1 against equations (14) and (15): x^ settles at (7.5, 3.75, 3.75) and V
  // of (18) only falls, to -0.3256.
  const Counterexample c = theorem_one_counterexample();
  const std::vector<LyapunovRow> rows = lyapunov_along(c.scenario, c.recording);
  EXPECT_NEAR(c.recording.steps.back().robots[0].position.x, 7.5, 0.1);
  EXPECT_NEAR(c.recording.steps.back().robots[1].position.x, 3.75, 0.15);
  EXPECT_LT(rows.back().paper.value(), -0.2);
  for (std::size_t k = 100; k < rows.size(); k += 100)
    ASSERT_LT(rows[k].paper.value(), rows[k - 100].paper.value() + 1e-9);
}

TEST(Patterns, AreCentredAndKeepTheirSpacing) {
  for (const std::string word : {"line", "wedge", "circle", "grid"}) {
    Pattern pattern{};
    ASSERT_TRUE(parse(word, pattern));
    for (const std::size_t n : {1u, 2u, 3u, 7u, 10u, 100u}) {
      const std::vector<Vec2> offsets = pattern_offsets(pattern, n, 2.0, {1.0, 1.0});
      ASSERT_EQ(offsets.size(), n);
      Vec2 mean{};
      double nearest = 1e9;
      for (std::size_t i = 0; i < n; ++i) {
        mean += offsets[i];
        for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, norm(offsets[i] - offsets[j]));
      }
      EXPECT_LT(norm(mean), 1e-9) << word;
      if (n > 1) {
        EXPECT_NEAR(nearest, 2.0, 1e-9) << word << " " << n;
      }
    }
  }
}

TEST(Patterns, AWedgeLeadsWithItsPoint) {
  const std::vector<Vec2> offsets = pattern_offsets(Pattern::wedge, 5, 1.0);
  for (std::size_t k = 1; k < 5; ++k) EXPECT_LT(offsets[k].x, offsets[0].x);
}

TEST(Patterns, NeighbourTopologyIsConnectedAlongAGrid) {
  const std::vector<Vec2> offsets = pattern_offsets(Pattern::grid, 12, 2.0);
  Scenario s = paper_scene("B0");
  s.robots.clear();
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    Robot r;
    r.id = "R" + std::to_string(i);
    r.position = offsets[i];
    s.robots.push_back(r);
  }
  s.formation->offsets = offsets;
  s.formation->topology = neighbour_topology(offsets, 2.1, {0});
  EXPECT_TRUE(validate(s).empty());
  s.formation->topology = neighbour_topology(offsets, 1.9, {0});
  EXPECT_FALSE(validate(s).empty());
}

TEST(Moving, AnObstacleThatCrossesTheWayIsAvoided) {
  Scenario s;
  Robot r;
  r.id = "R1";
  r.goals = {{20.0, 0.0}};
  s.robots = {r};
  s.time_limit = 30.0;
  MovingObstacle cart;
  cart.id = "cart";
  cart.shape = geometry::Polygon{{{9, -5}, {11, -5}, {11, -3}, {9, -3}}, {}};
  cart.motion = {{{0, 0}, {0, 20}}, 1.2};
  s.moving_obstacles = {cart};
  ASSERT_TRUE(validate(s).empty());
  for (const Method method : {Method::ivo, Method::ivo_cluster, Method::orca}) {
    const Metrics m = run(s, test::with_method(method)).metrics;
    EXPECT_TRUE(m.all_arrived) << name(method);
    EXPECT_GT(m.min_obstacle_clearance.value(), 0.0) << name(method);
    EXPECT_EQ(m.uncertified_half_planes, 0u);
  }
}

TEST(Moving, TheClearanceIsMeasuredWhereTheObstacleIsThen) {
  // The robot stands still; the obstacle passes it 0.25 m away at t = 5 s.
  Scenario s;
  Robot r;
  r.id = "R1";
  r.goals = {{0.0, 0.0}};
  s.robots = {r};
  MovingObstacle cart;
  cart.shape = geometry::Polygon{{{4, 0.75}, {6, 0.75}, {6, 2}, {4, 2}}, {}};
  cart.motion = {{{0, 0}, {-10, 0}}, 1.0};
  s.moving_obstacles = {cart};
  Recording rec;
  rec.time_step = 10.0;
  rec.steps.resize(2);
  rec.steps[1].time = 10.0;
  for (Step& row : rec.steps) row.robots.resize(1);
  EXPECT_NEAR(measure(s, rec).min_obstacle_clearance.value(), 0.25, 1e-12);
}

TEST(NonCooperating, TheOtherRobotTakesTheWholeResponsibility) {
  Scenario s;
  for (int i = 0; i < 2; ++i) {
    Robot r;
    r.id = i == 0 ? "polite" : "rude";
    r.position = {i == 0 ? 0.0 : 12.0, i == 0 ? 0.0 : 0.2};
    r.goals = {{i == 0 ? 12.0 : 0.0, 0.0}};
    r.cooperates = i == 0;
    s.robots.push_back(r);
  }
  s.robots[1].goals = {{0.0, 0.2}};
  const test::FinishedRun r = run(s, {});
  EXPECT_TRUE(r.metrics.all_arrived);
  EXPECT_GT(r.metrics.min_robot_clearance.value(), 0.0);
  for (const Step& row : r.recording.steps) EXPECT_NEAR(row.robots[1].position.y, 0.2, 1e-9);
}

}  // namespace
}  // namespace exactvo::formation
