// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Passes rows from the simulation to a RunSink.

#include <chrono>
#include <utility>
#include <vector>

#include "exactvo/formation/simulation.h"
#include "exactvo/vo/constraint.h"

namespace exactvo::formation::detail {

/// The row of a robot that has not decided yet.
inline RobotStep undecided(Vec2 position, Vec2 velocity) {
  RobotStep step;
  step.position = step.anchor = position;
  step.velocity = step.anchor_velocity = velocity;
  return step;
}

/// Hands rows to a sink, before each what is new among the bodies, and those of each goal, that it may name, and the
/// plans made in it.
class RowFeed {
 public:
  /// All must outlive the feed. `run` has what is known before the first row; `plans`: null where there are none.
  RowFeed(Recording& run, const vo::BodyTable& bodies, std::vector<GoalBodies>& goal_bodies,
          const std::vector<JointPlan>* plans, RunSink& sink)
      : run_(run), bodies_(bodies), goal_bodies_(goal_bodies), plans_(plans), sink_(sink) {
    timed([&] { sink_.begin(run); });
  }

  void add(Step row) {
    timed([&] {
      for (; told_bodies_ < bodies_.size(); ++told_bodies_) sink_.add_body(bodies_[told_bodies_]);
      for (; told_goal_bodies_ < goal_bodies_.size(); ++told_goal_bodies_)
        sink_.add_goal_bodies(goal_bodies_[told_goal_bodies_]);
      for (; plans_ && told_plans_ < plans_->size(); ++told_plans_) sink_.add_plan((*plans_)[told_plans_]);
      sink_.add_row(std::move(row));
    });
  }

  /// After the last row: what it has handed over, for the recording. The time that the sink took is not the run's.
  void finish() {
    for (vo::BodyTable::Number k = 0; k < bodies_.size(); ++k) run_.bodies.push_back(bodies_[k]);
    run_.goal_bodies = std::move(goal_bodies_);
    if (plans_) run_.plans = *plans_;
    run_.wall_time -= seconds_;
  }

 private:
  template <class Work>
  void timed(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  Recording& run_;
  const vo::BodyTable& bodies_;
  std::vector<GoalBodies>& goal_bodies_;
  const std::vector<JointPlan>* plans_;
  RunSink& sink_;
  std::size_t told_bodies_ = 0, told_goal_bodies_ = 0, told_plans_ = 0;
  double seconds_ = 0.0;
};

}  // namespace exactvo::formation::detail
