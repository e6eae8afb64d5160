// SPDX-License-Identifier: GPL-3.0-or-later
#include "motion/integrators.h"

#include <array>
#include <boost/numeric/odeint/stepper/euler.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

namespace exactvo::formation::detail {
namespace {

namespace odeint = boost::numeric::odeint;

using State = std::array<double, 4>;  // x, y, vx, vy

struct Tracking {
  Vec2 w;
  double k3;

  template <typename S>
  void operator()(const S& s, S& rate, double) const {
    rate[0] = s[2];
    rate[1] = s[3];
    rate[2] = -k3 * (s[2] - w.x);
    rate[3] = -k3 * (s[3] - w.y);
  }
};

BodyState closed_form(const BodyState& s, Vec2 w, const Decay& decay) {
  const Vec2 gap = s.velocity - w;
  const double lag = decay.settled / decay.gain;
  return {s.position + decay.duration * w + lag * gap, w + decay.left * gap};
}

template <typename Stepper>
BodyState fixed(Stepper stepper, const BodyState& s, const Tracking& system, double dt) {
  State state{s.position.x, s.position.y, s.velocity.x, s.velocity.y};
  stepper.do_step(system, state, 0.0, dt);
  return {{state[0], state[1]}, {state[2], state[3]}};
}

}  // namespace

BodyState step_body(Integrator integrator, const BodyState& state, Vec2 tracked, const Decay& decay) {
  const Tracking system{tracked, decay.gain};
  const double dt = decay.duration;
  switch (integrator) {
    case Integrator::exact:
      break;
    case Integrator::euler:
      return fixed(odeint::euler<State>{}, state, system, dt);
    case Integrator::rk4:
      return fixed(odeint::runge_kutta4<State>{}, state, system, dt);
  }
  return closed_form(state, tracked, decay);
}

MotionLaw motion_of(Integrator integrator) {
  if (integrator == Integrator::exact) return MotionLaw::exponential;
  return integrator == Integrator::euler ? MotionLaw::straight : MotionLaw::hermite;
}

}  // namespace exactvo::formation::detail
