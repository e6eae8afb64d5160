// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/lyapunov.h"

#include <algorithm>
#include <utility>

#include "control/consensus.h"
#include "control/lyapunov_accumulator.h"
#include "exactvo/geometry/require.h"
#include "scene/borrowed_row.h"

namespace exactvo::formation {
namespace {

using detail::Decay;
using detail::Decays;
using detail::RelativeState;

void take_relative_state(const Step& row, const std::vector<Vec2>& offsets, RelativeState& s) {
  s.position.clear();
  s.velocity.clear();
  for (std::size_t i = 0; i < row.robots.size(); ++i) {
    s.position.push_back(row.robots[i].position - row.leader_position - offsets[i]);
    s.velocity.push_back(row.robots[i].velocity - row.leader_velocity);
  }
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

/// V_IVO of (15): the decision of a row, relative to the leader.
Vec2 avoidance(const Recording& run, const Step& row, std::size_t i) {
  return run.relative_frame ? row.robots[i].chosen : row.robots[i].chosen - row.leader_velocity;
}

/// sum of v^_i.(v^_i - V_IVO,i).
double integrand(const Recording& run, const Step& row, const RelativeState& s) {
  double sum = 0.0;
  for (std::size_t i = 0; i < s.velocity.size(); ++i) sum += dot(s.velocity[i], s.velocity[i] - avoidance(run, row, i));
  return sum;
}

/// The integral of v^.(v^ - a) over a step in which v^ goes from `from` to `to` as v' = -k3 (v - w).
/// Math: v^ = w + b e^{-k3 t}, so it is h w.(w - a) + E1 b.(2w - a) + E2 |b|^2 with E_n = (1 - e^{-n k3 h}) / (n k3).
double exponential_integral(Vec2 from, Vec2 to, Vec2 a, const Decays& decays) {
  const Decay& once = decays.of_step;
  const Vec2 b = (from - to) / once.settled;
  const Vec2 w = from - b;
  const double e1 = once.settled / once.gain, e2 = decays.twice_as_fast.settled / decays.twice_as_fast.gain;
  return once.duration * dot(w, w - a) + e1 * dot(b, 2.0 * w - a) + e2 * squared_norm(b);
}

/// The integral of the integrand over the step from a row to the next, with that row's decision and leader's velocity.
double integral_over_step(const Recording& run, const Decays& decays, const Step& row, const Step& next) {
  const double h = run.time_step;
  double sum = 0.0;
  for (std::size_t i = 0; i < row.robots.size(); ++i) {
    const Vec2 leader = row.leader_velocity, a = avoidance(run, row, i);
    const Vec2 from = row.robots[i].velocity - leader;
    const Vec2 to = next.robots[i].velocity - leader;
    sum += run.motion == MotionLaw::exponential ? exponential_integral(from, to, a, decays)
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

/// A row and the next one.
struct RowPair {
  const Recording& run;
  const Decay& decay;
  const Step& row;
  const Step& next;
};

/// u_i at the row's time: of the exact law from both ends of the step, else the difference over the step.
Vec2 acceleration(const RowPair& p, std::size_t i) {
  const Vec2 change = p.next.robots[i].velocity - p.row.robots[i].velocity;
  if (p.run.motion != MotionLaw::exponential) return change / p.run.time_step;
  return p.decay.gain / p.decay.settled * change;
}

PaperTerms paper_rates(const FormationSpec& f, const RowPair& p, const RelativeState& s) {
  PaperTerms r;
  for (std::size_t i = 0; i < s.velocity.size(); ++i) r.kinetic += dot(s.velocity[i], acceleration(p, i));
  r.consensus = f.gains.k1 * across(f.topology, s.position, s.velocity);
  r.pinning = f.gains.k1 * pinned(f.topology, s.position, s.velocity);
  r.integral = f.gains.k3 * integrand(p.run, p.row, s);
  return r;
}

/// e_i: what is tracked, whatever the controller (v + u / k3), less the preference of the law that the function belongs
/// to, consensus term and all: what obstacles, robots and steering ask for.
Vec2 intervention(const FormationSpec& f, const RowPair& p, const RelativeState& s, std::size_t i) {
  const Vec2 tracked = p.row.robots[i].velocity + acceleration(p, i) / f.gains.k3;
  const Vec2 slotwards = detail::preference(f, ControllerOptions{}, s.position[i], p.row.leader_velocity, 0.0);
  return tracked - slotwards - detail::consensus_input(f, s, i, -1.0) / f.gains.k3;
}

void add_rates(const FormationSpec& f, const RowPair& p, const RelativeState& s, LyapunovRow& out) {
  const double consensus = across(f.topology, s.velocity, s.velocity) + pinned(f.topology, s.velocity, s.velocity);
  const double speed2 = sum_of_squares(s.velocity);
  out.has_rates = true;
  out.paper_rates = paper_rates(f, p, s);
  out.paper_rate = -f.gains.k2 * consensus;
  double along = 0.0, squared = 0.0;
  for (std::size_t i = 0; i < s.velocity.size(); ++i) {
    const Vec2 e = intervention(f, p, s, i);
    along += dot(s.velocity[i], e);
    squared += squared_norm(e);
  }
  out.sound_rates = {-f.gains.k2 * consensus, -f.gains.k3 * speed2, f.gains.k3 * along};
  out.rate_bound = -0.5 * f.gains.k3 * speed2 + 0.5 * f.gains.k3 * squared;
}

}  // namespace

namespace detail {

LyapunovAccumulator::LyapunovAccumulator(const Scenario& scenario, const Recording& run)
    : spec_(*scenario.formation),
      run_(run),
      decays_{Decay(run.tracking_gain, run.time_step), Decay(2.0 * run.tracking_gain, run.time_step)} {
  EXACTVO_REQUIRE(run.offsets.size() == scenario.robots.size(), scenario.name);
  EXACTVO_REQUIRE(spec_.topology.adjacency.size() == scenario.robots.size(), scenario.name);
}

std::optional<LyapunovRow> LyapunovAccumulator::add(std::shared_ptr<const Step> row) {
  std::optional<LyapunovRow> before;
  if (row_) {
    add_rates(spec_, {run_, decays_.of_step, *row_, *row}, state_, values_);
    integral_ += integral_over_step(run_, decays_, *row_, *row);
    before = values_;
  }
  take_relative_state(*row, run_.offsets, state_);
  values_ = {};
  values_.time = row->time;
  values_.has_rates = false;
  values_.paper = paper_terms(spec_, state_, integral_);
  values_.sound = sound_terms(spec_, state_);
  const bool steady = row_ && row->leader_velocity == row_->leader_velocity;
  paper_.add(values_.paper.value(), steady);
  sound_.add(values_.sound.value(), steady);
  row_ = std::move(row);
  return before;
}

void LyapunovAccumulator::Course::add(double value, bool steady) {
  if (!begun_) {
    course = {value, value, value, 0.0};
    begun_ = true;
    return;
  }
  course.least = std::min(course.least, value);
  if (steady) course.largest_rise = std::max(course.largest_rise, value - course.last);
  course.last = value;
}

}  // namespace detail

std::vector<LyapunovRow> lyapunov_along(const Scenario& scenario, const Recording& recording) {
  EXACTVO_REQUIRE(scenario.formation.has_value(), scenario.name);
  detail::LyapunovAccumulator watch(scenario, recording);
  std::vector<LyapunovRow> rows;
  for (const Step& step : recording.steps)
    if (const auto before = watch.add(detail::borrowed(step))) rows.push_back(*before);
  if (!recording.steps.empty()) rows.push_back(watch.last());
  return rows;
}

LyapunovSummary summary_of(const Scenario& scenario, const Recording& recording) {
  EXACTVO_REQUIRE(scenario.formation.has_value(), scenario.name);
  EXACTVO_REQUIRE(!recording.steps.empty(), "an empty recording");
  detail::LyapunovAccumulator watch(scenario, recording);
  for (const Step& step : recording.steps) watch.add(detail::borrowed(step));
  return watch.summary();
}

}  // namespace exactvo::formation
