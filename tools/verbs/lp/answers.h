// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Answers of anybody's solver, from a file, and what is proven of them: `exactvo lp PROBLEMS --check ANSWERS`
/// (docs/guide/linear-program.md has the format).

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/lp/solution.h"

namespace exactvo::tools {

/// What a solver says of a problem.
struct GivenAnswer {
  std::optional<lp::Status> status;        ///< nothing: the velocity alone counts
  std::optional<geometry::Vec2> velocity;  ///< m/s
};

/// One for each of `count` problems, in their order; nothing where the file has none. JSON Lines, such as `lp --json`
/// prints, or CSV with the columns vx and vy and, where wanted, index and status. Throws datasets::DataError.
std::vector<std::optional<GivenAnswer>> read_lp_answers(const std::string& file, std::size_t count);

enum class LpVerdict {
  optimal,             ///< satisfies what it must, and no velocity is better by more than the tolerance
  infeasible,          ///< rightly said to be: the hard constraints contradict each other
  violated,            ///< violates what can be satisfied
  not_optimal,         ///< satisfies it, and a better velocity does too
  wrongly_infeasible,  ///< said to be infeasible, and a velocity satisfies everything
  wrongly_feasible,    ///< given a velocity, and none satisfies the hard constraints
  wrong_status,        ///< said to be relaxed where everything can be satisfied, or the other way round
  missing              ///< no answer
};

/// "optimal", "infeasible", "violated", "not-optimal", "wrongly-infeasible", "wrongly-feasible", "wrong-status",
/// "missing".
const char* name(LpVerdict verdict);

struct JudgedAnswer {
  LpVerdict verdict = LpVerdict::missing;
  lp::Status truth = lp::Status::optimal;  ///< what the exact solver proves of the problem
  geometry::Vec2 best;                     ///< m/s, its velocity
  /// m/s times |n|: by how much the velocity violates what it must satisfy, the speed bound included; of a relaxed
  /// problem, by how much more than the least possible it violates the soft constraints, where that is more.
  std::optional<double> violation;
  /// m/s: how much farther it is from the preferred velocity than the best one (farthest: how much less far along);
  /// below 0 where it is outside of what it must satisfy.
  std::optional<double> excess;
  /// In the unit of a certificate's gap: no velocity is better by more, proven by `lp::check`. Nothing where the
  /// velocity violates anything, by however little.
  std::optional<double> certified_gap;

  bool is_right() const { return verdict == LpVerdict::optimal || verdict == LpVerdict::infeasible; }
};

/// `tolerance`: m/s, of violations (times |n|) and of the excess. REQUIRES: a well-formed problem.
JudgedAnswer judge(const lp::Problem& problem, const std::optional<GivenAnswer>& answer, double tolerance);

}  // namespace exactvo::tools
