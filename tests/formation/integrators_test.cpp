// SPDX-License-Identifier: GPL-3.0-or-later
#include "motion/integrators.h"

#include <gtest/gtest.h>

#include <cmath>

#include "paper_scenes.h"

namespace exactvo::formation {
namespace {

using detail::BodyState;
using detail::Decay;
using detail::step_body;

constexpr double kGain = 37.5;  // 1/s
constexpr double kAgreement = 1e-9;

TEST(Integrators, ExactIsTheClosedFormAtAnyStep) {
  const Vec2 w{0.7, -0.2};
  const BodyState start{{0.0, 0.0}, {3.0, 1.0}};
  BodyState many = start;
  for (int k = 0; k < 1000; ++k) many = step_body(Integrator::exact, many, w, Decay(kGain, 1e-3));
  const BodyState once = step_body(Integrator::exact, start, w, Decay(kGain, 1.0));
  EXPECT_LT(norm(many.position - once.position), 1e-12);
  EXPECT_LT(norm(many.velocity - once.velocity), 1e-12);
}

TEST(Integrators, RungeKuttaIsOfFourthOrder) {
  // Far from the stiff limit; halving the step must divide the error by about 2^4.
  const auto error = [](double dt) {
    const Vec2 w{0.7, -0.2};
    BodyState rk{{0.0, 0.0}, {3.0, 1.0}}, exact = rk;
    for (int k = 0; k < std::lround(0.032 / dt); ++k) {
      rk = step_body(Integrator::rk4, rk, w, Decay(kGain, dt));
      exact = step_body(Integrator::exact, exact, w, Decay(kGain, dt));
    }
    return norm(rk.velocity - exact.velocity);
  };
  const double ratio = error(2e-3) / error(1e-3);
  EXPECT_GT(ratio, 14.0);
  EXPECT_LT(ratio, 18.0);
  EXPECT_LT(error(2.5e-4), kAgreement);
}

TEST(Integrators, EulerIsStableBelowTwoOverTheGainOnly) {
  const auto left_over = [](double dt) {
    BodyState s{{0.0, 0.0}, {1.0, 0.0}};
    for (int k = 0; k < 200; ++k) s = step_body(Integrator::euler, s, {0.0, 0.0}, Decay(kGain, dt));
    return norm(s.velocity);
  };
  EXPECT_LT(left_over(0.02), 1e-9);
  EXPECT_GT(left_over(0.06), 1e6);
}

SimulationOptions euler() {
  SimulationOptions options;
  options.integrator = Integrator::euler;
  return options;
}

TEST(Integrators, EulerFormsAtSmallStepsAndDivergesAtLargeOnes) {
  Scenario scenario = test::paper_scene("B0");
  scenario.time_step = 0.02;
  EXPECT_LT(test::run(scenario, euler()).metrics.formation_position_error.value(), kAgreement);
  scenario.time_step = 0.06;
  EXPECT_TRUE(test::run(scenario, euler()).recording.diverged);
}

}  // namespace
}  // namespace exactvo::formation
