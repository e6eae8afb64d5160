// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One step of v' = -k3 (v - w), x' = v with w held: what a digital controller does between two decisions.
/// `exact` is the closed form, right at any dt; the others are there to compare (explicit Euler is stable for
/// dt < 2 / k3 at the most).

#include <cmath>

#include "exactvo/formation/recording.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation::detail {

struct BodyState {
  Vec2 position;  ///< m
  Vec2 velocity;  ///< m/s
};

/// What time leaves of v - w: the same in every step of a run, and computed once.
struct Decay {
  Decay() = default;
  Decay(double gain_of_law, double time)
      : gain(gain_of_law), duration(time), left(std::exp(-gain * time)), settled(-std::expm1(-gain * time)) {}
  double gain = 0.0;      ///< 1/s, k3
  double duration = 0.0;  ///< s
  double left = 1.0;      ///< e^{-k3 duration}
  double settled = 0.0;   ///< 1 - e^{-k3 duration}, accurate where that is small too
};

BodyState step_body(Integrator integrator, const BodyState& state, Vec2 tracked, const Decay& decay);

/// How the position runs between two rows under that integrator.
MotionLaw motion_of(Integrator integrator);

}  // namespace exactvo::formation::detail
