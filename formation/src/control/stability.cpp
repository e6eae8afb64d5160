// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/stability.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

#include "exactvo/geometry/require.h"
#include "exactvo/geometry/told_apart.h"

namespace exactvo::formation {
namespace {

Eigen::MatrixXd pinned_laplacian(const Topology& t) {
  const auto n = static_cast<Eigen::Index>(t.pinning.size());
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    m(i, i) += t.pinning[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j) {
      const double a = t.adjacency[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      m(i, i) += a;
      m(i, j) -= a;
    }
  }
  return m;
}

std::vector<double> eigenvalues_of(const Topology& t) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(pinned_laplacian(t), Eigen::EigenvaluesOnly);
  const Eigen::VectorXd& values = solver.eigenvalues();
  return {values.data(), values.data() + values.size()};
}

/// s^2 + p s + q of one mode.
struct Polynomial {
  double p, q;
};
Polynomial mode_of(const Gains& g, double l) {
  return {g.k3 + g.k2 * l, g.k3 * g.kappa + g.k1 * l};
}

/// The real part of the slower root, negated.
double decay_of(const Polynomial& m) {
  const double d = m.p * m.p - 4.0 * m.q;
  return d <= 0.0 ? 0.5 * m.p : 2.0 * m.q / (m.p + std::sqrt(d));
}

/// |1 + dt s| < 1 for both roots.
double euler_limit_of(const Polynomial& m) {
  const double d = m.p * m.p - 4.0 * m.q;
  return d <= 0.0 ? m.p / m.q : 4.0 / (m.p + std::sqrt(d));
}

/// How much of v - w is left after a step, and the time over which it carried the position: of a reference point that
/// drives at w nothing.
struct Held {
  double left = 0.0, lag = 0.0;
};
Held held_step(std::optional<Integrator> integrator, double k3, double dt) {
  if (!integrator) return {};
  const double z = -k3 * dt;
  if (integrator == Integrator::euler) return {1.0 + z, dt};
  if (integrator != Integrator::rk4) return {std::exp(z), -std::expm1(z) / k3};
  const double share = 1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0));
  return {1.0 + z * share, dt * share};
}

/// x+ = x + dt w + lag (v - w), v+ = w + left (v - w), w = -(kappa + k1 l / k3) x - (k2 l / k3) v.
double radius_of_mode(const Gains& g, double l, const Held& h, double dt) {
  const double from_x = -(g.kappa + g.k1 * l / g.k3), from_v = -g.k2 * l / g.k3;
  const double a = 1.0 + (dt - h.lag) * from_x, b = h.lag + (dt - h.lag) * from_v;
  const double c = (1.0 - h.left) * from_x, d = h.left + (1.0 - h.left) * from_v;
  const std::complex<double> root = std::sqrt(std::complex<double>((a - d) * (a - d) + 4.0 * b * c));
  return std::max(std::abs(0.5 * (a + d + root)), std::abs(0.5 * (a + d - root)));
}

}  // namespace

Stability stability_of(const FormationSpec& spec) {
  EXACTVO_REQUIRE(spec.topology.adjacency.size() == spec.topology.pinning.size(), "a topology of two sizes");
  Stability s;
  s.eigenvalues = eigenvalues_of(spec.topology);
  s.euler_step_limit = 2.0 / (spec.gains.k3 + spec.gains.k2 * s.eigenvalues.back());
  s.convergence_rate = decay_of(mode_of(spec.gains, s.eigenvalues.front()));
  s.euler_exact_limit = euler_limit_of(mode_of(spec.gains, s.eigenvalues.front()));
  for (double l : s.eigenvalues) {
    s.convergence_rate = std::min(s.convergence_rate, decay_of(mode_of(spec.gains, l)));
    s.euler_exact_limit = std::min(s.euler_exact_limit, euler_limit_of(mode_of(spec.gains, l)));
  }
  return s;
}

bool tracks_choices(const Scenario& scenario) {
  return scenario.formation &&
         std::none_of(scenario.robots.begin(), scenario.robots.end(), [](const Robot& r) { return r.drive; });
}

double step_spectral_radius(const FormationSpec& spec, std::optional<Integrator> integrator, double dt) {
  const Held held = held_step(integrator, spec.gains.k3, dt);
  double greatest = 0.0;
  for (double l : eigenvalues_of(spec.topology)) greatest = std::max(greatest, radius_of_mode(spec.gains, l, held, dt));
  return greatest;
}

std::vector<std::string> step_warnings(const FormationSpec& spec, std::optional<Integrator> integrator, double dt) {
  std::vector<std::string> warnings;
  const Stability s = stability_of(spec);
  if (integrator == Integrator::euler && dt >= s.euler_step_limit)
    warnings.push_back("time_step " + geometry::lossless(dt) +
                       " s is at or beyond explicit Euler's limit 2 / (k3 + k2 l_max) = " +
                       geometry::lossless(s.euler_step_limit) + " s");
  const double radius = step_spectral_radius(spec, integrator, dt);
  if (radius >= 1.0)
    warnings.push_back("the formation does not converge at time_step " + geometry::lossless(dt) +
                       " s: the spectral radius of a step is " + geometry::told_apart(1.0, radius, 6).second);
  return warnings;
}

}  // namespace exactvo::formation
