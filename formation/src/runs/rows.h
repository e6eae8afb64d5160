// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Passes rows from the simulation to a RunSink.

#include <memory>
#include <utility>
#include <vector>

#include "exactvo/formation/simulation.h"
#include "exactvo/vo/constraint.h"

namespace exactvo::formation::detail {

/// A non-owning pointer; `row` must outlive it.
inline std::shared_ptr<const Step> borrowed(const Step& row) {
  return {std::shared_ptr<void>(), &row};
}

/// Hands rows to a sink, before each what is new among the bodies and outlooks that it may name, and the plans made in
/// it.
class RowFeed {
 public:
  /// All must outlive the feed. `plans`: null where there are none.
  RowFeed(const vo::BodyTable& bodies, const std::vector<Outlook>& outlooks, const std::vector<JointPlan>* plans,
          RunSink& sink)
      : bodies_(bodies), outlooks_(outlooks), plans_(plans), sink_(sink) {}

  void add(Step row) {
    for (; told_bodies_ < bodies_.size(); ++told_bodies_) sink_.add_body(bodies_[told_bodies_]);
    for (; told_outlooks_ < outlooks_.size(); ++told_outlooks_) sink_.add_outlook(outlooks_[told_outlooks_]);
    for (; plans_ && told_plans_ < plans_->size(); ++told_plans_) sink_.add_plan((*plans_)[told_plans_]);
    sink_.add_row(std::move(row));
  }

 private:
  const vo::BodyTable& bodies_;
  const std::vector<Outlook>& outlooks_;
  const std::vector<JointPlan>* plans_;
  RunSink& sink_;
  std::size_t told_bodies_ = 0, told_outlooks_ = 0, told_plans_ = 0;
};

}  // namespace exactvo::formation::detail
