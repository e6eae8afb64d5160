// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/trajectory_survey.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "exactvo/geometry/require.h"

namespace exactvo::datasets {
namespace {

constexpr double kBinsOfDoubling = 8.0;

constexpr double kJumpShare = 0.95, kJumpTimes = 3.0;
constexpr double kGapTimes = 1.5;
constexpr std::uint64_t kLeastIntervals = 4;

/// By time, in the same basis: a uniform B-spline's knots are as far apart as its piece is long. Rounded.
geometry::CurvedMotion derivative(const geometry::CurvedMotion& curve) {
  geometry::CurvedMotion d{curve.basis, curve.start, curve.end, {}};
  const double length = curve.end - curve.start;
  const auto degree = static_cast<double>(curve.points.size() - 1);
  for (std::size_t k = 1; k < curve.points.size(); ++k) {
    if (curve.basis == geometry::CurveBasis::powers)
      d.points.push_back(static_cast<double>(k) * curve.points[k]);
    else
      d.points.push_back((curve.basis == geometry::CurveBasis::bezier ? degree : 1.0) / length *
                         (curve.points[k] - curve.points[k - 1]));
  }
  if (d.points.empty()) d.points.emplace_back();
  return d;
}

/// No vector on a curve is longer, up to rounding.
double bound_of(const geometry::CurvedMotion& curve) {
  double most = 0.0, sum = 0.0, power = 1.0;
  for (const geometry::Vec2 p : curve.points) {
    most = std::max(most, norm(p));
    sum += norm(p) * power;
    power *= curve.end - curve.start;
  }
  return curve.basis == geometry::CurveBasis::powers ? sum : most;
}

/// The longest vector on a curve: of samples, and from the longest on by golden section.
Extreme longest_on(const geometry::CurvedMotion& curve) {
  constexpr int kSamples = 32, kSteps = 40;
  const double step = (curve.end - curve.start) / kSamples;
  Extreme most{-1.0, curve.start, 0};
  const auto length_at = [&](double time) {
    const double length = norm(position_at(curve, time));
    if (length > most.value) most = {length, time, 0};
    return length;
  };
  for (int k = 0; k <= kSamples; ++k) length_at(k == kSamples ? curve.end : curve.start + k * step);
  double low = std::max(curve.start, most.time - step), high = std::min(curve.end, most.time + step);
  for (int k = 0; k < kSteps; ++k) {
    constexpr double kGolden = 0.6180339887498949;
    const double x = high - kGolden * (high - low), y = low + kGolden * (high - low);
    const bool is_first = length_at(x) >= length_at(y);
    (is_first ? high : low) = is_first ? y : x;
  }
  return most;
}

}  // namespace

void LogHistogram::add(double value) {
  if (!(value > 0.0) || !std::isfinite(value)) return;
  // A value at the end of a bin counts as in it, up to rounding: intervals of one length share a bin.
  ++bins_[static_cast<int>(std::ceil(kBinsOfDoubling * std::log2(value) - 1e-6))];
  ++count_;
}

double LogHistogram::quantile(double share) const {
  EXACTVO_REQUIRE(count_ > 0, std::string("no values"));
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t so_far = 0;
  for (const auto& [bin, count] : bins_)
    if ((so_far += count) >= wanted) return std::exp2(bin / kBinsOfDoubling);
  return std::exp2(bins_.rbegin()->first / kBinsOfDoubling);
}

double Move::speed() const {
  return norm(to.at - from.at) / interval();
}

bool Moves::next(const TrajectoryRow& row, Move& move) {
  if (row.agent >= last_.size()) {
    last_.resize(row.agent + 1);
    known_.resize(row.agent + 1, false);
  }
  const bool had_one = known_[row.agent];
  if (had_one) move = {row.agent, last_[row.agent], row};
  last_[row.agent] = row;
  known_[row.agent] = true;
  return had_one;
}

void TrajectorySurvey::add(const TrajectoryRow& row) {
  if (row.agent >= agents_.size()) {
    agents_.resize(row.agent + 1);
    paces_.resize(row.agent + 1);
  }
  AgentSurvey& agent = agents_[row.agent];
  if (agent.rows++ == 0) agent.first = row.time;
  agent.last = row.time;
  ++rows_;
  in_order_ = in_order_ && row.time >= latest_;
  latest_ = std::max(latest_, row.time);
  first_ = std::min(first_, row.time);
  last_ = std::max(last_, row.time);
  extent_.add(row.at);
  has_velocities_ = has_velocities_ || is_finite(row.velocity);
  if (!std::isnan(row.heading)) {
    has_headings_ = true;
    if (std::isnan(agent.heading)) agent.heading = row.heading;
    if (row.heading != agent.heading && agent.turns_at == 0) agent.turns_at = row.line;
  }
  Move move;
  if (!moves_.next(row, move)) return;
  const double interval = move.interval(), speed = move.speed();
  const geometry::Vec2 velocity = (move.to.at - move.from.at) / interval;
  agent.intervals.add(interval);
  intervals_.add(interval);
  speeds_.add(speed);
  if (speed > agent.speed.value) agent.speed = {speed, move.from.time, row.line};
  Pace& pace = paces_[row.agent];
  if (pace.interval > 0.0) {
    const double acceleration = 2.0 * norm(velocity - pace.velocity) / (pace.interval + interval);
    if (acceleration > agent.acceleration.value) agent.acceleration = {acceleration, move.from.time, row.line};
  }
  pace = {velocity, interval};
}

void TrajectorySurvey::add(std::size_t number, const geometry::Motion& piece) {
  const auto* curve = std::get_if<geometry::CurvedMotion>(&piece);
  if (!curve || !(curve->start < curve->end)) return;
  AgentSurvey& agent = agents_[number];
  if (!paces_[number].on_curves) agent.speed = agent.acceleration = {};
  paces_[number].on_curves = true;
  const geometry::CurvedMotion velocity = derivative(*curve);
  const auto look_at = [](const geometry::CurvedMotion& vectors, Extreme& most) {
    if (bound_of(vectors) <= most.value) return;
    const Extreme longest = longest_on(vectors);
    if (longest.value > most.value) most = longest;
  };
  look_at(velocity, agent.speed);
  look_at(derivative(velocity), agent.acceleration);
}

double TrajectorySurvey::usual_interval() const {
  return intervals_.count() == 0 ? 0.0 : intervals_.quantile(0.5);
}

double TrajectorySurvey::jump_speed() const {
  if (speeds_.count() < kLeastMoves) return std::numeric_limits<double>::infinity();
  return kJumpTimes * speeds_.quantile(kJumpShare);
}

double TrajectorySurvey::gap_of(std::size_t agent) const {
  const LogHistogram& own = agents_[agent].intervals;
  return kGapTimes * (own.count() >= kLeastIntervals ? own.quantile(0.5) : usual_interval());
}

}  // namespace exactvo::datasets
