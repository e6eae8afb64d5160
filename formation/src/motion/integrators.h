// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One step of v' = -k3 (v - w), x' = v with w held: what a digital controller does between two decisions.
/// `exact` is the closed form, right at any dt; the others are there to compare (explicit Euler is stable for
/// dt < 2 / k3 at the most).

#include "exactvo/formation/recording.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation::detail {

struct BodyState {
  Vec2 position;  ///< m
  Vec2 velocity;  ///< m/s
};

BodyState step_body(Integrator integrator, const BodyState& state, Vec2 tracked, double k3, double dt);

/// How the position runs between two rows under that integrator.
MotionLaw motion_of(Integrator integrator);

}  // namespace exactvo::formation::detail
