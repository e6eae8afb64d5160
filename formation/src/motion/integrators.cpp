// SPDX-License-Identifier: GPL-3.0-or-later
#include "motion/integrators.h"

#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <utility>

namespace exactvo::formation::detail {
namespace {

namespace odeint = boost::numeric::odeint;

using State = std::array<double, 4>;  // x, y, vx, vy
using UblasVector = boost::numeric::ublas::vector<double>;
using UblasMatrix = boost::numeric::ublas::matrix<double>;

/// Tolerances of the adaptive integrators: far below the 1e-9 that formations are judged by.
constexpr double kTolerance = 1e-12;

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

struct TrackingJacobian {
  double k3;
  void operator()(const UblasVector&, UblasMatrix& j, double, UblasVector& time_derivative) const {
    j.clear();
    j(0, 2) = j(1, 3) = 1.0;
    j(2, 2) = j(3, 3) = -k3;
    time_derivative.clear();
  }
};

BodyState closed_form(const BodyState& s, Vec2 w, const Decay& decay) {
  const Vec2 gap = s.velocity - w;
  const double lag = decay.settled / decay.gain;
  return {s.position + decay.duration * w + lag * gap, w + decay.left * gap};
}

State pack(const BodyState& s) {
  return {s.position.x, s.position.y, s.velocity.x, s.velocity.y};
}

template <typename S>
BodyState unpack(const S& s) {
  return {{s[0], s[1]}, {s[2], s[3]}};
}

template <typename Stepper>
BodyState fixed(Stepper stepper, const BodyState& s, const Tracking& system, double dt) {
  State state = pack(s);
  stepper.do_step(system, state, 0.0, dt);
  return unpack(state);
}

BodyState adaptive_dopri5(const BodyState& s, const Tracking& system, double dt) {
  State state = pack(s);
  const auto stepper = odeint::make_controlled<odeint::runge_kutta_dopri5<State>>(kTolerance, kTolerance);
  odeint::integrate_adaptive(stepper, system, state, 0.0, dt, dt);
  return unpack(state);
}

BodyState adaptive_rosenbrock4(const BodyState& s, const Tracking& system, double dt) {
  UblasVector state(4);
  const State packed = pack(s);
  std::copy(packed.begin(), packed.end(), state.begin());
  const auto stepper = odeint::make_controlled<odeint::rosenbrock4<double>>(kTolerance, kTolerance);
  odeint::integrate_adaptive(stepper, std::make_pair(system, TrackingJacobian{system.k3}), state, 0.0, dt, dt);
  return unpack(state);
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
    case Integrator::dopri5:
      return adaptive_dopri5(state, system, dt);
    case Integrator::rosenbrock4:
      return adaptive_rosenbrock4(state, system, dt);
  }
  return closed_form(state, tracked, decay);
}

MotionLaw motion_of(Integrator integrator) {
  if (integrator == Integrator::exact) return MotionLaw::exponential;
  return integrator == Integrator::euler ? MotionLaw::straight : MotionLaw::hermite;
}

}  // namespace exactvo::formation::detail
