// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/lp/single.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "batch_layout.h"
#include "exactvo/geometry/require.h"
#include "exactvo/vo/lp/solve.h"
#include "multipliers.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lp/single.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace exactvo::lp::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, kSinglePadding>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

struct Line {
  double x = 0.0, y = 0.0, c = -1.0;
  std::ptrdiff_t index = -1;
  bool exists() const { return index >= 0; }
};

HWY_INLINE double cross(const Line& a, const Line& b) {
  return a.x * b.y - a.y * b.x;
}

HWY_INLINE Line given(const SingleProblem& p, std::ptrdiff_t line) {
  return {p.normal_x[line], p.normal_y[line], p.offset[line], line};
}

/// What the walks allow for rounding (batch_layout.h).
struct Allowance {
  explicit HWY_INLINE Allowance(double speed)
      : slack(kSlackUnits * 0x1p-53 * speed),
        noise(kNoiseUnits * 0x1p-53 * speed),
        disc(speed * (1.0 - kDiscUnits * 0x1p-53)),
        disc_squared(disc * disc) {}
  double slack, noise, disc, disc_squared;
};

/// Every lane of a register.
struct Every {};
HWY_INLINE M among(Every, M m) {
  return m;
}
HWY_INLINE M among(M lines, M m) {
  return hn::And(lines, m);
}

/// `what(k, lines)` for the lines from k on, a register full; of the last one only lanes in the mask are lines.
template <class What>
HWY_INLINE void for_registers(std::size_t count, What what) {
  const D d;
  std::size_t k = 0;
  for (; k + hn::Lanes(d) <= count; k += hn::Lanes(d)) what(k, Every());
  if (k < count) what(k, hn::FirstN(d, count - k));
}

/// The number of a line stands in so many last digits of its violation; 2^16 of them leave it 36.
constexpr std::size_t kMostNumbered = std::size_t{1} << 16U;

/// The line violated most, if by more than `allowed`, or -1. Each carries its number in its last digits, so that one
/// maximum finds both; among violations that differ by less, the later line is taken.
HWY_INLINE std::ptrdiff_t most_violated(const SingleProblem& p, double x, double y, double allowed) {
  const D d;
  const hn::RebindToUnsigned<D> bits;
  const V vx = hn::Set(d, x), vy = hn::Set(d, y), enough = hn::Set(d, allowed);
  const double nothing = std::numeric_limits<double>::min();
  V most = hn::Set(d, nothing);
  auto number = hn::Iota(bits, 0);
  for_registers(p.count, [&](std::size_t k, auto lines) {
    const V along = hn::Add(hn::Mul(hn::LoadU(d, p.normal_x + k), vx), hn::Mul(hn::LoadU(d, p.normal_y + k), vy));
    const V by = hn::Sub(hn::Sub(hn::LoadU(d, p.offset + k), along), enough);
    const auto digits = hn::And(hn::BitCast(bits, by), hn::Set(bits, ~std::uint64_t{kMostNumbered - 1}));
    const V numbered = hn::BitCast(d, hn::Or(digits, number));
    most = hn::IfThenElse(among(lines, hn::Gt(numbered, most)), numbered, most);
    number = hn::Add(number, hn::Set(bits, hn::Lanes(d)));
  });
  const double best = hn::GetLane(hn::MaxOfLanes(d, most));
  std::uint64_t digits = 0;
  std::memcpy(&digits, &best, sizeof digits);
  return best > nothing ? static_cast<std::ptrdiff_t>(digits % kMostNumbered) : -1;
}

/// The walk of batch_walk.h and batch_relax.h for one problem: what lanes decide by masks is decided by branches here.
class SingleWalk : private Allowance {
 public:
  explicit SingleWalk(const SingleProblem& problem) : Allowance(problem.disc), p_(problem) {}

  /// False where the walk cannot tell: for `solve`.
  bool run(Solution& s) {
    start();
    for (int round = 0; round < kMostLockstepRounds; ++round) {
      const std::ptrdiff_t line = most_violated(p_, x_, y_, noise - slack);
      if (line < 0) {
        answer(Status::optimal, s);
        return true;
      }
      entering_ = given(p_, line);
      entering_.c += slack;
      if (!step()) return second_.exists() && relax(entering_, first_, second_, s);
    }
    return false;
  }

  /// From a contradiction of three lines that carry the slack. Only three soft planes at a time.
  bool relax(Line a, Line b, Line c, Solution& s) {
    if (p_.hard > 0) return false;
    first_ = a;
    second_ = b;
    third_ = c;
    for (Line* line : {&first_, &second_, &third_}) line->c -= slack;
    if (cross(first_, second_) < 0.0) std::swap(first_, second_);
    if (!(cross(first_, second_) > 0.0 && cross(second_, third_) > 0.0 && cross(third_, first_) > 0.0)) return false;
    if (!meet(first_, second_, third_)) return false;
    for (int round = 0; round < kMostLockstepRounds; ++round) {
      const std::ptrdiff_t line = most_violated(p_, x_, y_, level_ + noise);
      if (line < 0) {
        answer(Status::relaxed, s);
        return true;
      }
      if (!pivot(given(p_, line))) return false;
    }
    return false;
  }

 private:
  HWY_INLINE void start() {
    const double squared = p_.preferred.x * p_.preferred.x + p_.preferred.y * p_.preferred.y;
    const double shrink = squared <= p_.disc * p_.disc * (1.0 - kDiscUnits * 0x1p-53) ? 1.0 : disc / std::sqrt(squared);
    x_ = p_.preferred.x * shrink;
    y_ = p_.preferred.y * shrink;
  }

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
    if (h.c * h.c + where * where > disc_squared * squared) {
      const double room = disc_squared * squared - h.c * h.c;
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

  /// See batch_relax.h.
  HWY_INLINE bool pivot(const Line& a) {
    const double by_first = cross(a, first_), by_second = cross(a, second_), by_third = cross(a, third_);
    const bool from_first = by_first > 0.0 && !(by_second > 0.0), from_second = by_second > 0.0 && !(by_third > 0.0);
    const Line b = from_first ? first_ : from_second ? second_ : third_;
    const Line c = from_first ? second_ : from_second ? third_ : first_;
    if (!((from_first || from_second || by_third > 0.0) && cross(a, c) < 0.0)) return false;
    first_ = a;
    second_ = b;
    third_ = c;
    return meet(a, b, c);
  }

  /// Goes to where three planes meet; false where that is outside the disc.
  HWY_INLINE bool meet(const Line& a, const Line& b, const Line& c) {
    const double bx = a.x - b.x, by = a.y - b.y, bc = a.c - b.c, cx = a.x - c.x, cy = a.y - c.y, cc = a.c - c.c;
    const double inverse = 1.0 / (bx * cy - by * cx);
    x_ = (bc * cy - by * cc) * inverse;
    y_ = (bx * cc - bc * cx) * inverse;
    level_ = a.c - (a.x * x_ + a.y * y_);
    return x_ * x_ + y_ * y_ <= disc_squared;
  }

  /// The disc is not told of by the walk; it may bind wherever a slot is free.
  HWY_INLINE void answer(Status status, Solution& s) const {
    s.velocity = {x_, y_};
    s.status = status;
    s.violation = status == Status::relaxed ? std::max(level_, 0.0) : 0.0;
    s.active = {};
    s.active_count = 0;
    Normals normals{};
    for (const Line* line : {&first_, &second_, &third_}) {
      if (!line->exists()) continue;
      normals[s.active_count] = {line->x, line->y};
      s.active[s.active_count++].binding = constraint_at(static_cast<std::size_t>(line->index));
    }
    const bool on_disc = x_ * x_ + y_ * y_ > p_.disc * p_.disc * (1.0 - kOnDisc);
    if (on_disc && s.active_count < (status == Status::optimal ? 2U : 3U)) s.active[s.active_count++].binding = kDisc;
    set_multipliers(normals, Objective::nearest, p_.preferred, s);
  }

  const SingleProblem& p_;
  double x_ = 0.0, y_ = 0.0, level_ = 0.0;
  Line first_, second_, third_, entering_;
};

/// One problem, its lines a register at a time. A problem alone is bound by latency, so chains are kept short: where
/// the walk goes to a vertex line by line, here all lines cut the boundary of one at once, and multipliers tell whether
/// the optimum is found. What that does not settle is left to SingleWalk.
class Slide : private Allowance {
 public:
  explicit HWY_INLINE Slide(const SingleProblem& problem) : Allowance(problem.disc), p_(problem) {}

  /// False where the walk has to tell.
  HWY_INLINE bool run(Solution& s) const {
    const double px = p_.preferred.x, py = p_.preferred.y;
    const std::ptrdiff_t line = most_violated(p_, px, py, noise - slack);
    if (line >= 0) return p_.count < kMostSlidLines && slide(given(p_, line), s);
    s.velocity = {px, py};
    s.status = Status::optimal;
    s.active = {};
    s.active_count = 0;
    s.violation = 0.0;
    return true;
  }

 private:
  /// Boundaries followed before the walk is tried: one in 4 of 5 recorded problems, more than three in 1 of 10^4.
  static constexpr int kMostSlides = 4;

  /// A bit a line, the last of which says that there is none.
  static constexpr std::size_t kMostSlidLines = 64;

  /// What is left of the boundary of a line, in the unit of `step`, and what each line leaves of it to either side.
  struct Stretch {
    HWY_ALIGN double lows[kMostSlidLines], highs[kMostSlidLines];
    double low = -HUGE_VAL, high = HUGE_VAL;
    std::size_t count;

    /// The first of the lines that end it at the one side or the other, without a branch; -1 where none does.
    HWY_INLINE std::ptrdiff_t line_at(bool at_low) const {
      const D d;
      const double* cuts = at_low ? lows : highs;
      const V end = hn::Set(d, at_low ? low : high);
      std::uint64_t found = 0;
      for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
        std::uint8_t bits = 0;
        hn::StoreMaskBits(d, hn::Eq(hn::Load(d, cuts + k), end), &bits);
        found |= std::uint64_t{bits} << k;
      }
      const std::size_t line = hwy::Num0BitsBelowLS1Bit_Nonzero64(found | std::uint64_t{1} << (kMostSlidLines - 1));
      return line < count ? static_cast<std::ptrdiff_t>(line) : -1;
    }
  };

  /// Lines that are all but the same must not cut each other off by a rounding: the others may give by half of what is
  /// called noise, which leaves them 20 u V inward. A cut is wrong by 8 u V / slope, where both offsets, their products
  /// with |n|^2 and n.n' and the difference round, and by 3 u of itself; a velocity made of it by 6 u V. The line is
  /// kept exactly, since that is 17 u V of it in all.
  HWY_INLINE void cut_by_all(const Line& line, double squared, Stretch& left) const {
    const D d;
    const V hx = hn::Set(d, line.x), hy = hn::Set(d, line.y), hc = hn::Set(d, line.c), square = hn::Set(d, squared);
    const V inward = hn::Set(d, slack - 0.5 * noise), zero = hn::Zero(d), far = hn::Set(d, HUGE_VAL);
    V low = hn::Neg(far), high = far;
    for_registers(p_.count, [&](std::size_t k, auto lines) {
      const V x = hn::LoadU(d, p_.normal_x + k), y = hn::LoadU(d, p_.normal_y + k);
      const V c = hn::Add(hn::LoadU(d, p_.offset + k), inward);
      const V slope = hn::Add(hn::Sub(hn::Mul(hx, y), hn::Mul(hy, x)), hn::Set(d, kParallel<double>));
      const V along = hn::Add(hn::Mul(hx, x), hn::Mul(hy, y));
      const V cut = hn::Div(hn::Sub(hn::Mul(c, square), hn::Mul(along, hc)), slope);
      const M raises = hn::Gt(slope, zero);
      const V from = hn::IfThenElse(among(lines, raises), cut, hn::Neg(far));
      const V to = hn::IfThenElse(among(lines, hn::Not(raises)), cut, far);
      hn::Store(from, d, left.lows + k);
      hn::Store(to, d, left.highs + k);
      low = hn::Max(low, from);
      high = hn::Min(high, to);
    });
    left.low = hn::GetLane(hn::MaxOfLanes(d, low));
    left.high = hn::GetLane(hn::MinOfLanes(d, high));
    left.count = p_.count;
  }

  /// From the optimum on the boundary of one line to that on the next, downhill, until multipliers say that it is the
  /// optimum of all. False where the disc has a say, or where the boundary of the first line is cut off wholly and that
  /// proves nothing.
  HWY_INLINE bool slide(Line h, Solution& s) const {
    Stretch left;
    for (int count = 0; count < kMostSlides; ++count) {
      h.c += slack;
      const double squared = h.x * h.x + h.y * h.y, inverse = 1.0 / squared;
      cut_by_all(h, squared, left);
      const double room = disc_squared * squared - h.c * h.c;
      if (!(room >= 0.0)) return false;
      const double reach = std::sqrt(room), wish = h.x * p_.preferred.y - h.y * p_.preferred.x;
      const double low = std::max(left.low, -reach), high = std::min(left.high, reach);
      if (low > high) {
        if (contradict(h, left)) return relax(h, left, s);
        h = worse_end(left, low, high, wish);
        if (!h.exists()) return false;
        continue;
      }
      const double where = std::min(std::max(wish, low), high);
      const double x = (h.x * h.c - where * h.y) * inverse, y = (h.y * h.c + where * h.x) * inverse;
      const bool at_low = where == low, at_disc = (at_low & (low > left.low)) | (!at_low & (high < left.high));
      const std::ptrdiff_t end = at_disc ? -1 : left.line_at(at_low);
      const Line g = end < 0 ? Line{-x, -y, 0.0, -1} : given(p_, end);
      const double pull_x = x - p_.preferred.x, pull_y = y - p_.preferred.y;
      const double pull = pull_x * g.y - pull_y * g.x, turn = cross(h, g);
      const double shares[2] = {pull * turn, 0.0};  // of h, and where only h binds: looked up, not branched on
      if (shares[where == wish] >= 0.0) {
        s.velocity = {x, y};
        optimum(h.index, end, where != wish, s);
        const double of_both[2] = {pull / turn, (h.x * pull_y - h.y * pull_x) / turn};
        const double of_one = (h.x * pull_x + h.y * pull_y) * inverse;
        s.active[0].multiplier = where == wish ? of_one : of_both[0];
        s.active[1].multiplier = where == wish ? 0.0 : std::max(0.0, of_both[1]);
        return true;
      }
      if (end < 0) return false;
      h = g;
    }
    return false;
  }

  HWY_INLINE void optimum(std::ptrdiff_t line, std::ptrdiff_t end, bool binds, Solution& s) const {
    s.status = Status::optimal;
    const bool second_is_line = binds & (end >= 0);
    s.active[0].binding = constraint_at(static_cast<std::size_t>(line));
    s.active[1].binding.kind = binds & (end < 0) ? BindingKind::disc : BindingKind::constraint;
    s.active[1].binding.index = static_cast<std::size_t>(end) & (std::size_t{0} - std::size_t{second_is_line});
    s.active[2] = {};
    s.active_count = 1 + std::size_t{binds};
    s.violation = 0.0;
  }

  /// Whether a line whose boundary two others cut off wholly excludes all that they leave: where normals surround 0.
  /// Elsewhere all that they leave lies inside.
  HWY_INLINE bool contradict(const Line& line, const Stretch& left) const {
    if (!(left.low > left.high)) return false;
    const Line low = given(p_, left.line_at(true)), high = given(p_, left.line_at(false));
    return (cross(line, low) > 0.0) & (cross(low, high) > 0.0) & (cross(high, line) > 0.0);
  }

  HWY_NOINLINE bool relax(const Line& line, const Stretch& left, Solution& s) const {
    Line low = given(p_, left.line_at(true)), high = given(p_, left.line_at(false));
    low.c += slack;
    high.c += slack;
    return SingleWalk(p_).relax(line, low, high, s);
  }

  /// Which of the two lines to go on with: the one that cuts more off.
  HWY_INLINE Line worse_end(const Stretch& left, double low, double high, double wish) const {
    const bool at_low = low - wish > wish - high;
    const bool at_disc = at_low ? low > left.low : high < left.high;
    const std::ptrdiff_t end = left.line_at(at_low != at_disc);
    return end < 0 ? Line() : given(p_, end);
  }

  const SingleProblem& p_;
};

/// Preferred velocities inside the disc, squares in range (Pack::in_range) and lines that can be numbered: the rest
/// takes a longer way.
bool run_single(const SingleProblem& p, Solution& s) {
  const double limit = p.disc * p.disc, squared = p.preferred.x * p.preferred.x + p.preferred.y * p.preferred.y;
  const double most = std::max(squared, limit);
  if (!(limit >= kLeastSquare<double> && most <= kMostSquare<double> && p.count <= kMostNumbered)) return false;
  if (squared <= limit * (1.0 - kDiscUnits * 0x1p-53) && Slide(p).run(s)) return true;
  return SingleWalk(p).run(s);
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

/// Out of line: what the walk settles need not save registers for it.
HWY_NOINLINE void solve_copied(const SingleProblem& problem, Solution& answer) {
  answer = solve(problem_of(problem));
}

}  // namespace

void solve_single(const SingleProblem& problem, Solution& answer) {
  if (!HWY_DYNAMIC_DISPATCH(run_single)(problem, answer)) solve_copied(problem, answer);
}

Solution solve_single(const SingleProblem& problem) {
  Solution answer;
  solve_single(problem, answer);
  return answer;
}

}  // namespace exactvo::lp
#endif  // HWY_ONCE
