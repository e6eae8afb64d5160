// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/lyapunov.h"

#include <algorithm>
#include <cmath>
#include <string>

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

/// y^T L z: the sum over pairs of a_ij (y_i - y_j).(z_i - z_j).
double across(const Topology& t, const std::vector<Vec2>& y, const std::vector<Vec2>& z) {
  double sum = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) sum += t.adjacency[i][j] * dot(y[i] - y[j], z[i] - z[j]);
  return sum;
}

/// y^T B z: the sum of b_i y_i.z_i.
double pinned(const Topology& t, const std::vector<Vec2>& y, const std::vector<Vec2>& z) {
  double sum = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) sum += t.pinning[i] * dot(y[i], z[i]);
  return sum;
}

/// The potential whose slope is min(kappa s, v_s).
double huber(const FormationSpec& f, double s) {
  const double knee = f.catch_up_speed / f.gains.kappa;
  return s <= knee ? 0.5 * f.gains.kappa * s * s : f.catch_up_speed * (s - 0.5 * knee);
}

/// V_IVO of (15): the decision of row k, relative to the leader.
Vec2 avoidance(const Recording& recording, std::size_t k, std::size_t i) {
  const Step& row = recording.steps[k];
  return recording.relative_frame ? row.robots[i].chosen : row.robots[i].chosen - row.leader_velocity;
}

/// sum of v^_i.(v^_i - V_IVO,i).
double integrand(const Recording& recording, std::size_t k, const RelativeState& s) {
  double sum = 0.0;
  for (std::size_t i = 0; i < s.velocity.size(); ++i)
    sum += dot(s.velocity[i], s.velocity[i] - avoidance(recording, k, i));
  return sum;
}

/// The integral of v^.(v^ - a) over a step in which v^ goes from `from` to `to` as v' = -k3 (v - w).
/// Math: v^ = w + b e^{-k3 t}, so it is h w.(w - a) + E1 b.(2w - a) + E2 |b|^2 with E_n = (1 - e^{-n k3 h}) / (n k3).
double exponential_integral(Vec2 from, Vec2 to, Vec2 a, double k3, double h) {
  const double settled = -std::expm1(-k3 * h);
  const Vec2 b = (from - to) / settled;
  const Vec2 w = from - b;
  const double e1 = settled / k3, e2 = -std::expm1(-2.0 * k3 * h) / (2.0 * k3);
  return h * dot(w, w - a) + e1 * dot(b, 2.0 * w - a) + e2 * squared_norm(b);
}

/// Of the integrand over the step from row k on, with the decision and the leader's velocity of that row.
double integral_over_step(const Recording& recording, std::size_t k) {
  const double h = recording.time_step;
  double sum = 0.0;
  for (std::size_t i = 0; i < recording.steps[k].robots.size(); ++i) {
    const Vec2 leader = recording.steps[k].leader_velocity, a = avoidance(recording, k, i);
    const Vec2 from = recording.steps[k].robots[i].velocity - leader;
    const Vec2 to = recording.steps[k + 1].robots[i].velocity - leader;
    sum += recording.motion == MotionLaw::exponential ? exponential_integral(from, to, a, recording.tracking_gain, h)
                                                      : 0.5 * h * (dot(from, from - a) + dot(to, to - a));
  }
  return sum;
}

PaperTerms paper_terms(const FormationSpec& f, const RelativeState& s, double integral) {
  PaperTerms t;
  t.kinetic = 0.5 * sum_of_squares(s.velocity);
  t.consensus = 0.5 * f.gains.k1 * across(f.topology, s.position, s.position);
  t.pinning = 0.5 * f.gains.k1 * pinned(f.topology, s.position, s.position);
  t.integral = f.gains.k3 * integral;
  return t;
}

SoundTerms sound_terms(const FormationSpec& f, const RelativeState& s) {
  SoundTerms t;
  t.kinetic = 0.5 * sum_of_squares(s.velocity);
  t.consensus =
      0.5 * f.gains.k1 * (across(f.topology, s.position, s.position) + pinned(f.topology, s.position, s.position));
  for (Vec2 x : s.position) t.slots += f.gains.k3 * huber(f, norm(x));
  return t;
}

/// u_i at the row's time: of the exact law from both ends of the step, else the difference over the step.
Vec2 acceleration(const Recording& recording, std::size_t k, std::size_t i) {
  const Vec2 v = recording.steps[k].robots[i].velocity, next = recording.steps[k + 1].robots[i].velocity;
  if (recording.motion != MotionLaw::exponential) return (next - v) / recording.time_step;
  return recording.tracking_gain / -std::expm1(-recording.tracking_gain * recording.time_step) * (next - v);
}

PaperRates paper_rates(const FormationSpec& f, const Recording& recording, std::size_t k, const RelativeState& s) {
  PaperRates r;
  for (std::size_t i = 0; i < s.velocity.size(); ++i) r.kinetic += dot(s.velocity[i], acceleration(recording, k, i));
  r.consensus = f.gains.k1 * across(f.topology, s.position, s.velocity);
  r.pinning = f.gains.k1 * pinned(f.topology, s.position, s.velocity);
  r.integral = f.gains.k3 * integrand(recording, k, s);
  return r;
}

/// e_i: what is tracked, whatever the controller (v + u / k3), less the preference of the law that the function belongs
/// to, consensus term and all: what obstacles, robots and steering ask for.
Vec2 intervention(const FormationSpec& f, const Recording& recording, std::size_t k, const RelativeState& s,
                  std::size_t i) {
  const RobotStep& robot = recording.steps[k].robots[i];
  const Vec2 tracked = robot.velocity + acceleration(recording, k, i) / f.gains.k3;
  const Vec2 slotwards = detail::preference(f, Remedies{}, s.position[i], recording.steps[k].leader_velocity, 0.0);
  return tracked - slotwards - detail::consensus_input(f, s, i, -1.0) / f.gains.k3;
}

void add_rates(const FormationSpec& f, const Recording& recording, std::size_t k, const RelativeState& s,
               LyapunovRow& out) {
  const double consensus = across(f.topology, s.velocity, s.velocity) + pinned(f.topology, s.velocity, s.velocity);
  const double speed2 = sum_of_squares(s.velocity);
  out.paper_rates = paper_rates(f, recording, k, s);
  out.paper_rate = -f.gains.k2 * consensus;
  double along = 0.0, squared = 0.0;
  for (std::size_t i = 0; i < s.velocity.size(); ++i) {
    const Vec2 e = intervention(f, recording, k, s, i);
    along += dot(s.velocity[i], e);
    squared += squared_norm(e);
  }
  out.sound_rates = {-f.gains.k2 * consensus, -f.gains.k3 * speed2, f.gains.k3 * along};
  out.rate_bound = -0.5 * f.gains.k3 * speed2 + 0.5 * f.gains.k3 * squared;
}

LyapunovCourse course_of(const std::vector<LyapunovRow>& rows, const Recording& recording,
                         double (*value)(const LyapunovRow&)) {
  LyapunovCourse c{value(rows.front()), value(rows.back()), value(rows.front()), 0.0};
  for (std::size_t k = 1; k < rows.size(); ++k) {
    c.least = std::min(c.least, value(rows[k]));
    if (recording.steps[k].leader_velocity == recording.steps[k - 1].leader_velocity)
      c.largest_rise = std::max(c.largest_rise, value(rows[k]) - value(rows[k - 1]));
  }
  return c;
}

}  // namespace

std::vector<LyapunovRow> lyapunov_along(const Scenario& scenario, const Recording& recording) {
  EXACTVO_REQUIRE(scenario.formation && recording.offsets.size() == scenario.robots.size(), scenario.name);
  const FormationSpec& f = *scenario.formation;
  EXACTVO_REQUIRE(f.topology.adjacency.size() == scenario.robots.size(), scenario.name);
  std::vector<LyapunovRow> rows;
  double integral = 0.0;
  for (std::size_t k = 0; k < recording.steps.size(); ++k) {
    const Step& row = recording.steps[k];
    const RelativeState s = relative_state(row, recording.offsets);
    LyapunovRow out;
    out.time = row.time;
    out.paper = paper_terms(f, s, integral);
    out.sound = sound_terms(f, s);
    out.has_rates = k + 1 < recording.steps.size();
    if (out.has_rates) {
      add_rates(f, recording, k, s, out);
      integral += integral_over_step(recording, k);
    }
    rows.push_back(out);
  }
  return rows;
}

LyapunovSummary summary_of(const std::vector<LyapunovRow>& rows, const Recording& recording) {
  EXACTVO_REQUIRE(!rows.empty() && rows.size() == recording.steps.size(), std::to_string(rows.size()));
  return {course_of(rows, recording, [](const LyapunovRow& r) { return r.paper.value(); }),
          course_of(rows, recording, [](const LyapunovRow& r) { return r.sound.value(); })};
}

}  // namespace exactvo::formation
