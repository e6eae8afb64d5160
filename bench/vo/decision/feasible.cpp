// SPDX-License-Identifier: GPL-3.0-or-later
// One answer and one exact look at it. The look is the proof, so the search need not be analysed: few lines are
// searched in the textbook's order (de Berg et al., chapter 4), with the slack of the other solvers.
#include "decision/feasible.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lp/lanes/layout.h"
#include "lp/problem/exact_sign.h"

namespace exactvo::bench {
namespace {

using geometry::dot;
using geometry::perp;
using geometry::squared_norm;
using geometry::Vec2;
using lp::SingleProblem;

/// Up to here the search below was faster than looking at a register of lines at a time.
constexpr std::size_t kFewLines = 16;

class FewLines {
 public:
  explicit FewLines(const SingleProblem& problem)
      : p_(problem),
        slack_(lp::kSlackUnits * 0x1p-53 * problem.disc),
        noise_(lp::kNoiseUnits * 0x1p-53 * problem.disc),
        disc_(problem.disc * (1.0 - lp::kDiscUnits * 0x1p-53)) {}

  /// False where a line cuts off all that the ones before it leave.
  bool run(Vec2& v) const {
    v = p_.preferred;
    const double squared = squared_norm(v);
    if (squared > disc_ * disc_) v = (disc_ / std::sqrt(squared)) * v;
    for (std::size_t k = 0; k < p_.count; ++k)
      if (dot(normal(k), v) < p_.offset[k] + slack_ - noise_ && !go_to(k, v)) return false;
    return true;
  }

 private:
  Vec2 normal(std::size_t k) const { return {p_.normal_x[k], p_.normal_y[k]}; }

  /// To the best point on the boundary of line k, as far as the lines before it leave some: foot + t along.
  bool go_to(std::size_t k, Vec2& v) const {
    const Vec2 n = normal(k), along = perp(n);
    const double inverse = 1.0 / squared_norm(n), away = (p_.offset[k] + slack_) * inverse;
    const Vec2 foot = away * n;
    const double room = disc_ * disc_ * inverse - away * away;
    if (!(room >= 0.0)) return false;
    double low = -std::sqrt(room), high = -low;
    for (std::size_t i = 0; i < k; ++i) {
      const double slope = dot(normal(i), along) + lp::kParallel<double>;
      const double cut = (p_.offset[i] + slack_ - dot(normal(i), foot)) / slope;
      if (slope > 0.0)
        low = std::max(low, cut);
      else
        high = std::min(high, cut);
    }
    if (!(low <= high)) return false;
    v = foot + std::clamp(dot(p_.preferred, along) * inverse, low, high) * along;
    return true;
  }

  const SingleProblem& p_;
  double slack_, noise_, disc_;
};

/// Whether every line is kept by more than the rounding of its sum. Counted, not jumped out of: nearly always it is.
bool keeps_plainly(const SingleProblem& p, Vec2 v) {
  std::int64_t doubtful = 0;
  for (std::size_t k = 0; k < p.count; ++k) {
    const double px = p.normal_x[k] * v.x, py = p.normal_y[k] * v.y, c = p.offset[k];
    const double error = lp::kSignError * (std::fabs(px) + std::fabs(py) + std::fabs(c)) + lp::kSignUnderflow;
    doubtful += static_cast<std::int64_t>(!((px + py) - c > error));
  }
  return doubtful == 0;
}

bool keeps_each(const SingleProblem& p, Vec2 v) {
  for (std::size_t k = 0; k < p.count; ++k)
    if (lp::sign_of_violation({{p.normal_x[k], p.normal_y[k]}, p.offset[k]}, v) > 0) return false;
  return true;
}

/// Whether the squares of FewLines neither overflow nor lose digits.
bool squares_are_in_range(const SingleProblem& p) {
  const double limit = p.disc * p.disc;
  return limit >= lp::kLeastSquare<double> && std::max(squared_norm(p.preferred), limit) <= lp::kMostSquare<double>;
}

bool search(const SingleProblem& problem, Vec2& v) {
  if (problem.count <= kFewLines && squares_are_in_range(problem)) return FewLines(problem).run(v);
  lp::Solution answer;
  solve(problem, answer);
  v = answer.velocity;
  return answer.status == lp::Status::optimal;
}

}  // namespace

bool keeps(const SingleProblem& p, Vec2 v) {
  return lp::sign_of_excess_speed(v, p.disc) <= 0 && (keeps_plainly(p, v) || keeps_each(p, v));
}

bool solve_feasible(const SingleProblem& problem, Vec2& velocity) {
  return search(problem, velocity) && is_finite(velocity) && keeps(problem, velocity);
}

}  // namespace exactvo::bench
