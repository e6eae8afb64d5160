// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What can be said of a formation before it runs: the spectrum of its topology, how fast it converges, and how long a
/// step its integrator bears. Free space, no saturation: x'' = -(k3 + k2 l) x' - (k3 kappa + k1 l) x for every
/// eigenvalue l of L + B. Robots on wheels have no v' = -k3 (v - w): their reference points drive at w itself, from
/// step to step x+ = x + T w, w = -(kappa + k1 l / k3) x - (k2 l / k3) w_before, while no limit of the wheels binds.
///
/// Rounded (Eigen's symmetric eigenvalue solver).

#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation {

/// What the linear formation comes to.
struct Stability {
  std::vector<double> eigenvalues;  ///< of L + B, ascending; 1, 4, 4 for the paper's (21)
  double convergence_rate = 0.0;    ///< 1/s: the slowest mode decays like e^{-rate t}
  double euler_step_limit = 0.0;    ///< s: 2 / (k3 + k2 l_max); explicit Euler is unstable not far above it
  double euler_exact_limit = 0.0;   ///< s: where the spectral radius of Euler's step matrix reaches 1
};

/// Whether robots track what they choose, v' = -k3 (v - w): those of a formation do, unless they are on wheels.
bool tracks_choices(const Scenario& scenario);

/// The stability of a formation whose robots track what they choose. REQUIRES: an n x n adjacency and n pinning gains
/// (simulation.h, `validate`).
Stability stability_of(const FormationSpec& spec);

/// The greatest modulus of the eigenvalues of one step with the decision held over it: below 1 the linear formation
/// converges. `exact` and `euler` have closed forms; the others approximate `exact` and get its answer, except rk4,
/// whose own polynomial is used. Without an integrator: for the reference points of robots on wheels.
double step_spectral_radius(const FormationSpec& spec, std::optional<Integrator> integrator, double dt);

/// In words, empty where all is well: a step at which the integrator or the held decision is unstable.
std::vector<std::string> step_warnings(const FormationSpec& spec, std::optional<Integrator> integrator, double dt);

}  // namespace exactvo::formation
