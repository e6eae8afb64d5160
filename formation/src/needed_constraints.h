// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The static half-planes of one decision, built as far as it needs them: what is left out changes no bit of it.

#include <vector>

#include "exactvo/vo/lp/solve.h"
#include "static_field.h"

namespace exactvo::formation::detail {

/// Grows on demand; each half-plane is the same bits as StaticField::constraints gives, in the same order.
class NeededConstraints {
 public:
  /// Begins with what lies within `reach` (m, from the rim). `field` must outlive the questions.
  void look(const StaticField& field, const Viewpoint& from, double reach);

  /// Nearest first.
  const std::vector<Constraint>& lines() const { return lines_; }

  // What is asked for is there afterwards. True where half-planes were added.

  /// Those within `reach`.
  bool need_within(double reach);
  /// The one that v violates most, and any that it might violate as much; with a normal of unit length or as it is.
  bool need_at(Vec2 v);
  /// All that the answer rests on.
  bool need_for(const lp::Solution& solution, const lp::Pricing& pricing);
  bool need_all();

 private:
  bool need(const Need& need);

  const StaticField* field_ = nullptr;
  Viewpoint from_;
  Need have_;
  bool has_all_ = false;
  std::vector<Constraint> lines_;
};

}  // namespace exactvo::formation::detail
