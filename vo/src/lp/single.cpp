// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/lp/single.h"

#include <algorithm>
#include <cmath>

#include "batch_layout.h"
#include "exactvo/geometry/require.h"
#include "exactvo/vo/lp/solve.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lp/single.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace exactvo::lp::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The walk of batch_walk.h and batch_relax.h for one problem: what lanes decide by masks is decided by branches here.
class SingleWalk {
  struct Line {
    double x = 0.0, y = 0.0, c = -1.0;
    std::ptrdiff_t index = -1;
    bool exists() const { return index >= 0; }
  };

 public:
  explicit SingleWalk(const SingleProblem& problem)
      : p_(problem),
        slack_(kSlackUnits * 0x1p-53 * problem.disc),
        noise_(kNoiseUnits * 0x1p-53 * problem.disc),
        disc_(problem.disc * (1.0 - kDiscUnits * 0x1p-53)),
        disc_squared_(disc_ * disc_) {}

  /// False where the walk cannot tell: for `solve`.
  HWY_INLINE bool run(Solution& s) {
    if (!in_range()) return false;
    start();
    int round = 0;
    for (; look(noise_ - slack_); ++round) {
      if (round == kMostLockstepRounds) return false;
      entering_.c += slack_;
      if (!step()) return relax(s);
    }
    answer(Status::optimal, s);
    return true;
  }

 private:
  /// As Pack::in_range.
  HWY_INLINE bool in_range() const {
    const double limit = p_.disc * p_.disc;
    const double squared = p_.preferred.x * p_.preferred.x + p_.preferred.y * p_.preferred.y;
    return limit >= kLeastSquare<double> && std::max(squared, limit) <= kMostSquare<double>;
  }

  HWY_INLINE void start() {
    const double squared = p_.preferred.x * p_.preferred.x + p_.preferred.y * p_.preferred.y;
    const double shrink =
        squared <= p_.disc * p_.disc * (1.0 - kDiscUnits * 0x1p-53) ? 1.0 : disc_ / std::sqrt(squared);
    x_ = p_.preferred.x * shrink;
    y_ = p_.preferred.y * shrink;
  }

  /// Whether a line is violated by more than `allowed`; the one violated most becomes `entering_`.
  HWY_INLINE bool look(double allowed) {
    const hn::CappedTag<double, kSinglePadding> d;
    const auto vx = hn::Set(d, x_), vy = hn::Set(d, y_), end = hn::Set(d, static_cast<double>(p_.count));
    auto most = hn::Set(d, allowed), which = hn::Zero(d), number = hn::Iota(d, 0);
    const auto step = hn::Set(d, static_cast<double>(hn::Lanes(d)));
    for (std::size_t k = 0; k < p_.count; k += hn::Lanes(d)) {
      const auto dot = hn::Add(hn::Mul(hn::LoadU(d, p_.normal_x + k), vx), hn::Mul(hn::LoadU(d, p_.normal_y + k), vy));
      const auto by = hn::Sub(hn::LoadU(d, p_.offset + k), dot);
      const auto more = hn::And(hn::Gt(by, most), hn::Lt(number, end));
      most = hn::IfThenElse(more, by, most);
      which = hn::IfThenElse(more, number, which);
      number = hn::Add(number, step);
    }
    const auto best = hn::MaxOfLanes(d, most);
    if (!(hn::GetLane(best) > allowed)) return false;
    const auto none = hn::Set(d, static_cast<double>(p_.count));
    const auto lowest = hn::MinOfLanes(d, hn::IfThenElse(hn::Eq(most, best), which, none));
    const std::size_t line = static_cast<std::size_t>(hn::GetLane(lowest));
    entering_ = {p_.normal_x[line], p_.normal_y[line], p_.offset[line], static_cast<std::ptrdiff_t>(line)};
    return true;
  }

  static double cross(const Line& a, const Line& b) { return a.x * b.y - a.y * b.x; }

  /// Where `other` cuts the boundary of `line` off, in the unit of `step`.
  HWY_INLINE double cut_off(const Line& line, double squared, const Line& other, double& low, double& high) const {
    const double slope = cross(line, other) + kParallel<double>;
    const double cut = (other.c * squared - (line.x * other.x + line.y * other.y) * line.c) / slope;
    if (slope > 0.0)
      low = std::max(low, cut);
    else
      high = std::min(high, cut);
    return cut;
  }

  /// The optimum on the boundary of `entering_`; false where nothing is left of it.
  HWY_INLINE bool step() {
    const Line h = entering_;
    const double squared = h.x * h.x + h.y * h.y, inverse = 1.0 / squared;
    double low = -HUGE_VAL, high = HUGE_VAL, first = 0.0, second = 0.0;
    if (first_.exists()) first = cut_off(h, squared, first_, low, high);
    if (second_.exists()) second = cut_off(h, squared, second_, low, high);
    const double wish = h.x * p_.preferred.y - h.y * p_.preferred.x;
    double where = std::min(std::max(wish, low), high);
    if (h.c * h.c + where * where > disc_squared_ * squared) {
      const double room = disc_squared_ * squared - h.c * h.c;
      if (room < 0.0) return false;
      low = std::max(low, -std::sqrt(room));
      high = std::min(high, std::sqrt(room));
      where = std::min(std::max(wish, low), high);
    }
    if (low > high) return false;
    x_ = (h.x * h.c - where * h.y) * inverse;
    y_ = (h.y * h.c + where * h.x) * inverse;
    if (first_.exists() && where == first)
      second_ = first_;
    else if (!(second_.exists() && where == second))
      second_ = Line();
    first_ = h;
    return true;
  }

  /// From a contradiction of entering, first and second. Only three soft planes at a time.
  bool relax(Solution& s) {
    if (p_.hard > 0 || !second_.exists()) return false;
    third_ = entering_;
    for (Line* line : {&first_, &second_, &third_}) line->c -= slack_;
    if (cross(first_, second_) < 0.0) std::swap(first_, second_);
    if (!(cross(first_, second_) > 0.0 && cross(second_, third_) > 0.0 && cross(third_, first_) > 0.0)) return false;
    entering_ = first_;
    for (int round = 0; round < kMostLockstepRounds; ++round) {
      if (!pivot()) return false;
      if (look(level_ + noise_)) continue;
      answer(Status::relaxed, s);
      return true;
    }
    return false;
  }

  /// See batch_relax.h.
  HWY_INLINE bool pivot() {
    const Line a = entering_;
    const double by_first = cross(a, first_), by_second = cross(a, second_), by_third = cross(a, third_);
    const bool from_first = by_first > 0.0 && !(by_second > 0.0), from_second = by_second > 0.0 && !(by_third > 0.0);
    const Line b = from_first ? first_ : from_second ? second_ : third_;
    const Line c = from_first ? second_ : from_second ? third_ : first_;
    if (!((from_first || from_second || by_third > 0.0) && cross(a, c) < 0.0)) return false;
    const double bx = a.x - b.x, by = a.y - b.y, bc = a.c - b.c, cx = a.x - c.x, cy = a.y - c.y, cc = a.c - c.c;
    const double inverse = 1.0 / (bx * cy - by * cx);
    const double x = (bc * cy - by * cc) * inverse, y = (bx * cc - bc * cx) * inverse;
    if (!(x * x + y * y <= disc_squared_)) return false;
    x_ = x;
    y_ = y;
    level_ = a.c - (a.x * x + a.y * y);
    first_ = a;
    second_ = b;
    third_ = c;
    return true;
  }

  /// The disc is not told of by the walk; it may bind wherever a slot is free.
  HWY_INLINE void answer(Status status, Solution& s) const {
    s.velocity = {x_, y_};
    s.status = status;
    s.violation = status == Status::relaxed ? std::max(level_, 0.0) : 0.0;
    for (const Line* line : {&first_, &second_, &third_})
      if (line->exists()) s.active[s.active_count++] = static_cast<std::size_t>(line->index);
    const bool on_disc = x_ * x_ + y_ * y_ > p_.disc * p_.disc * (1.0 - kOnDisc);
    if (on_disc && s.active_count < (status == Status::optimal ? 2U : 3U)) s.active[s.active_count++] = kSpeedBound;
  }

  const SingleProblem& p_;
  double slack_, noise_, disc_, disc_squared_;
  double x_ = 0.0, y_ = 0.0, level_ = 0.0;
  Line first_, second_, third_, entering_;
};

bool run_single(const SingleProblem& problem, Solution& s) {
  return SingleWalk(problem).run(s);
}

}  // namespace exactvo::lp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::lp {

HWY_EXPORT(run_single);

namespace {

Problem problem_of(const SingleProblem& p) {
  Problem problem;
  problem.bound.disc = p.disc;
  problem.preferred = p.preferred;
  problem.constraints.reserve(p.count);
  for (std::size_t k = 0; k < p.count; ++k)
    problem.constraints.push_back(
        {{{p.normal_x[k], p.normal_y[k]}, p.offset[k]}, k < p.hard ? Priority::hard : Priority::soft, -1});
  return problem;
}

}  // namespace

Solution solve_single(const SingleProblem& problem) {
  Solution s;
  if (HWY_DYNAMIC_DISPATCH(run_single)(problem, s)) return s;
  return solve(problem_of(problem));
}

}  // namespace exactvo::lp
#endif  // HWY_ONCE
