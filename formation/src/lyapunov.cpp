// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/lyapunov.h"

#include <algorithm>

#include "consensus.h"
#include "exactvo/geometry/require.h"

namespace exactvo::formation {
namespace {

using detail::RelativeState;
using geometry::norm;
using geometry::squared_norm;

RelativeState relative_state(const Step& row, const std::vector<Vec2>& offsets) {
  RelativeState s;
  for (std::size_t i = 0; i < row.robots.size(); ++i) {
    s.position.push_back(row.robots[i].position - row.leader_position - offsets[i]);
    s.velocity.push_back(row.robots[i].velocity - row.leader_velocity);
  }
  return s;
}

double sum_of_squares(const std::vector<Vec2>& v) {
  double sum = 0.0;
  for (Vec2 x : v) sum += squared_norm(x);
  return sum;
}

/// sum over i, j of a_ij |y_i - y_j|^2: twice y^T L y.
double disagreement(const Topology& t, const std::vector<Vec2>& y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i)
    for (std::size_t j = 0; j < y.size(); ++j) sum += t.adjacency[i][j] * squared_norm(y[i] - y[j]);
  return sum;
}

/// sum of b_i |y_i|^2: y^T B y.
double pinned(const Topology& t, const std::vector<Vec2>& y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) sum += t.pinning[i] * squared_norm(y[i]);
  return sum;
}

/// The potential whose slope is min(kappa s, v_s).
double huber(const FormationSpec& f, double s) {
  const double knee = f.catch_up_speed / f.gains.kappa;
  return s <= knee ? 0.5 * f.gains.kappa * s * s : f.catch_up_speed * (s - 0.5 * knee);
}

/// sum of v^_i.(v^_i - V_IVO,i), V_IVO relative to the leader.
double integrand(const Step& row, const RelativeState& s) {
  double sum = 0.0;
  for (std::size_t i = 0; i < s.velocity.size(); ++i)
    sum += dot(s.velocity[i], s.velocity[i] - (row.robots[i].chosen - row.leader_velocity));
  return sum;
}

PaperTerms paper_terms(const FormationSpec& f, const RelativeState& s, double integral) {
  PaperTerms t;
  t.kinetic = 0.5 * sum_of_squares(s.velocity);
  t.consensus = 0.25 * f.gains.k1 * disagreement(f.topology, s.position);
  t.pinning = 0.5 * f.gains.k1 * pinned(f.topology, s.position);
  t.integral = f.gains.k3 * integral;
  return t;
}

SoundTerms sound_terms(const FormationSpec& f, const RelativeState& s) {
  SoundTerms t;
  t.kinetic = 0.5 * sum_of_squares(s.velocity);
  t.consensus = 0.5 * f.gains.k1 * (0.5 * disagreement(f.topology, s.position) + pinned(f.topology, s.position));
  for (Vec2 x : s.position) t.slots += f.gains.k3 * huber(f, norm(x));
  return t;
}

/// sum of |e_i|^2: how far the filter moved each preference.
double squared_intervention(const Step& row) {
  double sum = 0.0;
  for (const RobotStep& r : row.robots) sum += squared_norm(r.chosen - r.preferred);
  return sum;
}

void add_rates(const FormationSpec& f, const Step& row, const RelativeState& s, LyapunovRow& out) {
  const double consensus = 0.5 * disagreement(f.topology, s.velocity) + pinned(f.topology, s.velocity);
  const double speed2 = sum_of_squares(s.velocity);
  out.paper_rate = -f.gains.k2 * consensus;
  out.free_rate = -f.gains.k2 * consensus - f.gains.k3 * speed2;
  out.rate_bound = -0.5 * f.gains.k3 * speed2 + 0.5 * f.gains.k3 * squared_intervention(row);
}

}  // namespace

std::vector<LyapunovRow> lyapunov_along(const Scenario& scenario, const Recording& recording) {
  EXACTVO_REQUIRE(scenario.formation && recording.offsets.size() == scenario.robots.size(), scenario.name);
  const FormationSpec& f = *scenario.formation;
  std::vector<LyapunovRow> rows;
  double integral = 0.0, last_integrand = 0.0;
  for (std::size_t k = 0; k < recording.steps.size(); ++k) {
    const Step& row = recording.steps[k];
    const RelativeState s = relative_state(row, recording.offsets);
    // The last row has no decision: its integrand is that of the row before.
    const double now = k + 1 < recording.steps.size() ? integrand(row, s) : last_integrand;
    if (k > 0) integral += 0.5 * recording.time_step * (last_integrand + now);
    last_integrand = now;
    LyapunovRow out;
    out.time = row.time;
    out.paper = paper_terms(f, s, integral);
    out.sound = sound_terms(f, s);
    add_rates(f, row, s, out);
    rows.push_back(out);
  }
  return rows;
}

}  // namespace exactvo::formation
