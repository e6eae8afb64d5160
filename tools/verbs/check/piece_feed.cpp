// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/check/piece_feed.h"

#include <utility>

namespace exactvo::tools {

using geometry::Between;
using geometry::StraightMotion;
using geometry::TimedPoint;

PieceFeed::PieceFeed(const std::vector<datasets::AgentSurvey>& agents, const Options& options, Take take)
    : surveys_(agents),
      options_(options),
      take_(std::move(take)),
      agents_(agents.size()),
      has_piece_(agents.size(), false) {}

void PieceFeed::add(const datasets::TrajectoryRow& row) {
  Agent& agent = agents_[row.agent];
  const TimedPoint here{row.time, row.at};
  if (agent.is_open && row.time - agent.last.time > options_.longest_gap) close(row.agent, !has_piece_[row.agent]);
  if (agent.is_open) {
    put(row.agent,
        options_.between == Between::hold ? geometry::held(agent.last, row.time) : StraightMotion{agent.last, here});
  }
  agent.last = here;
  agent.is_open = true;
  if (++agent.rows == surveys_[row.agent].rows) {
    close(row.agent, !has_piece_[row.agent]);
  } else {
    begins_.emplace(row.time, row.agent);
  }
  hand_on(row.time);
}

void PieceFeed::finish() {
  hand_on(std::numeric_limits<double>::infinity());
}

void PieceFeed::put(std::size_t agent, const StraightMotion& piece) {
  waiting_.push({piece, agent, count_++});
  has_piece_[agent] = true;
}

void PieceFeed::close(std::size_t agent, bool is_alone) {
  const TimedPoint last = agents_[agent].last;
  if (is_alone || options_.between == Between::hold) put(agent, {last, last});
  agents_[agent].is_open = false;
  has_piece_[agent] = false;
}

void PieceFeed::hand_on(double now) {
  // The earliest begin that may still come: where an open agent was seen last, unless that is too long ago.
  double earliest = now;
  while (!begins_.empty()) {
    const auto [time, agent] = begins_.top();
    const bool is_current = agents_[agent].is_open && agents_[agent].last.time == time;
    if (is_current && now - time > options_.longest_gap) close(agent, !has_piece_[agent]);
    if (is_current && agents_[agent].is_open) {
      earliest = time;
      break;
    }
    begins_.pop();
  }
  while (!waiting_.empty() && waiting_.top().piece.from.time <= earliest) {
    const Waiting next = waiting_.top();
    waiting_.pop();
    take_(next.agent, next.piece);
  }
}

}  // namespace exactvo::tools
