// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/trajectory_pieces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/geometry/pi.h"

namespace exactvo::datasets {

using geometry::Between;
using geometry::StraightMotion;
using geometry::TimedPoint;
using geometry::Vec2;

namespace {

TimedPoint point_of(const TrajectoryRow& row) {
  return {row.time, row.at};
}

/// The row's own velocity, or another one where it has none.
Vec2 velocity_of(const TrajectoryRow& row, Vec2 otherwise) {
  return is_finite(row.velocity) ? row.velocity : otherwise;
}

void for_each_row_in_time(TrajectoryReader& reader, bool is_in_order,
                          const std::function<void(const TrajectoryRow&)>& take) {
  if (is_in_order) {
    reader.read(take);
    return;
  }
  std::vector<TrajectoryRow> rows;
  reader.read([&](const TrajectoryRow& row) { rows.push_back(row); });
  std::stable_sort(rows.begin(), rows.end(),
                   [](const TrajectoryRow& a, const TrajectoryRow& b) { return a.time < b.time; });
  for (const TrajectoryRow& row : rows) take(row);
}

/// The curves of a file of polynomials, by the time at which they begin.
class CurveFeed {
 public:
  CurveFeed(std::vector<std::vector<geometry::CurvedMotion>> curves, const TrajectoryPieces::Take& take)
      : curves_(std::move(curves)), take_(take) {
    for (std::size_t agent = 0; agent < curves_.size(); ++agent)
      for (const geometry::CurvedMotion& curve : curves_[agent]) waiting_.push_back({agent, &curve});
    std::stable_sort(waiting_.begin(), waiting_.end(),
                     [](const Waiting& a, const Waiting& b) { return a.curve->start < b.curve->start; });
  }
  /// Hands on what begins before this time.
  void advance(double time) {
    for (; next_ < waiting_.size() && waiting_[next_].curve->start < time; ++next_)
      take_(waiting_[next_].agent, *waiting_[next_].curve, {});
  }

 private:
  struct Waiting {
    std::size_t agent;
    const geometry::CurvedMotion* curve;
  };
  std::vector<std::vector<geometry::CurvedMotion>> curves_;
  const TrajectoryPieces::Take& take_;
  std::vector<Waiting> waiting_;
  std::size_t next_ = 0;
};

}  // namespace

void for_each_piece(TrajectoryReader& reader, const TrajectorySurvey& survey, const TrajectoryPieces::Options& options,
                    const std::function<void(TrajectoryRow&)>& look, const TrajectoryPieces::Take& take) {
  const bool has_curves = !reader.file().curves.empty();
  CurveFeed curves(reader.file().curves, take);
  TrajectoryPieces pieces(survey.agents(), options, take);
  for_each_row_in_time(reader, survey.is_in_order(), [&](TrajectoryRow row) {
    look(row);
    has_curves ? curves.advance(row.time) : pieces.add(row);
  });
  has_curves ? curves.advance(std::numeric_limits<double>::infinity()) : pieces.finish();
}

TrajectoryPieces::TrajectoryPieces(const std::vector<AgentSurvey>& agents, const Options& options, Take take)
    : surveys_(agents), options_(options), take_(std::move(take)), agents_(agents.size()) {
  for (std::size_t k = 0; k < agents.size(); ++k)
    if (!std::isnan(agents[k].heading)) agents_[k].heading = agents[k].heading;
}

void TrajectoryPieces::add(const TrajectoryRow& row) {
  Agent& agent = agents_[row.agent];
  const double heading = std::isnan(row.heading) ? agent.heading : row.heading;
  if (options_.between == Between::none) {
    const TimedPoint here = point_of(row);
    agent.heading = heading;
    put(row.agent, StraightMotion{here, here}, {heading, 0.0});
    return hand_on(row.time);
  }
  if (agent.is_open && row.time - agent.last.time > options_.longest_gap) close(row.agent);
  if (agent.is_open) go_on(row.agent, row, heading);
  agent.last = row;
  agent.heading = heading;
  agent.is_open = true;
  if (++agent.rows == surveys_[row.agent].rows) {
    close(row.agent);
  } else {
    begins_.emplace(agent.begin(), row.agent);
  }
  hand_on(row.time);
}

void TrajectoryPieces::go_on(std::size_t number, const TrajectoryRow& row, double heading) {
  Agent& agent = agents_[number];
  const TimedPoint last = point_of(agent.last), here = point_of(row);
  if (options_.between == Between::hold) return put(number, geometry::held(last, row.time), {agent.heading, 0.0});
  if (options_.between != Between::cubic)
    return put(number, StraightMotion{last, here},
               {agent.heading, std::remainder(heading - agent.heading, 2.0 * geometry::kPi)});
  const TimedPoint before = agent.has_cubic ? agent.before.point : last;
  const Vec2 velocity = velocity_of(agent.last, geometry::catmull_rom_velocity(before, here));
  put_cubic(number, velocity);
  agent.before = {last, velocity, agent.heading};
  agent.has_cubic = true;
}

void TrajectoryPieces::put_cubic(std::size_t number, Vec2 end_velocity) {
  Agent& agent = agents_[number];
  if (!agent.has_cubic) return;
  agent.has_cubic = false;
  put(number, geometry::hermite_cubic(agent.before.point, agent.before.velocity, point_of(agent.last), end_velocity),
      {agent.before.heading, 0.0});
}

void TrajectoryPieces::finish() {
  hand_on(std::numeric_limits<double>::infinity());
}

void TrajectoryPieces::put(std::size_t agent, const geometry::Motion& piece, const geometry::Turned& turned) {
  waiting_.push({piece, turned, start_of(piece), agent, count_++});
  agents_[agent].has_piece = true;
}

void TrajectoryPieces::close(std::size_t number) {
  Agent& agent = agents_[number];
  const TimedPoint last = point_of(agent.last);
  if (agent.has_cubic)
    put_cubic(number, velocity_of(agent.last, geometry::catmull_rom_velocity(agent.before.point, last)));
  if (!agent.has_piece || options_.between == Between::hold)
    put(number, StraightMotion{last, last}, {agent.heading, 0.0});
  agent.is_open = false;
  agent.has_piece = false;
}

void TrajectoryPieces::hand_on(double now) {
  // The earliest begin that may still come: where an open agent was seen last, unless that is too long ago.
  double earliest = now;
  while (!begins_.empty()) {
    const auto [time, number] = begins_.top();
    const Agent& agent = agents_[number];
    const bool is_current = agent.is_open && agent.begin() == time;
    if (is_current && now - agent.last.time > options_.longest_gap) close(number);
    if (is_current && agent.is_open) {
      earliest = time;
      break;
    }
    begins_.pop();
  }
  while (!waiting_.empty() && waiting_.top().begin <= earliest) {
    const Waiting next = waiting_.top();
    waiting_.pop();
    take_(next.agent, next.piece, next.turned);
  }
}

}  // namespace exactvo::datasets
