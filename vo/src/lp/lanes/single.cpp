// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/kernel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "exactvo/geometry/require.h"
#include "exactvo/vo/lp/certificate.h"
#include "lp/lanes/layout.h"
#include "lp/lanes/vertex.h"
#include "lp/problem/exact_sign.h"
#include "lp/problem/region.h"
#include "lp/proof/multipliers.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lp/lanes/single.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "lp/lanes/relaxation.h"
#include "lp/lanes/single_proof.h"

HWY_BEFORE_NAMESPACE();
namespace exactvo::lp::HWY_NAMESPACE {

/// Up to this many lines use short registers: a divider takes twice as long for 64 bytes as for 32, which adds to the
/// time until the answer; three short registers do not. From 13 lines on the wide ones win.
constexpr std::size_t kFewLines = 12;
using FewLines = hn::CappedTag<double, 4>;
using ManyLines = hn::CappedTag<double, kSinglePadding>;

/// What the searches allow for rounding (layout.h).
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

/// `v` in those lanes, else 0 or `other`.
template <class D, class V>
HWY_INLINE V only(D, Every, V v) {
  return v;
}
template <class D, class V>
HWY_INLINE V only(D, hn::Mask<D> lines, V v) {
  return hn::IfThenElseZero(lines, v);
}
template <class D, class V>
HWY_INLINE V only(D, Every, V v, V) {
  return v;
}
template <class D, class V>
HWY_INLINE V only(D, hn::Mask<D> lines, V v, V other) {
  return hn::IfThenElse(lines, v, other);
}

/// How many lines there may be: where few are known to be, loops over them are unrolled.
struct AnyCount {};
template <std::size_t kLeast, std::size_t kMost>
struct CountBetween {};
using UpTo8 = CountBetween<1, 8>;  // arrays of no line may be null
using UpTo12 = CountBetween<9, 12>;

/// `what(k, lines)` for the lines from k on, a register full; of the last one only lanes in the mask are lines.
template <class D, class What>
HWY_INLINE void for_registers(D d, AnyCount, std::size_t count, What what) {
  std::size_t k = 0;
  for (; k + hn::Lanes(d) <= count; k += hn::Lanes(d)) what(k, Every());
  if (k < count) what(k, hn::FirstN(d, count - k));
}
template <class D, std::size_t kLeast, std::size_t kMost, class What>
HWY_INLINE void for_registers(D d, CountBetween<kLeast, kMost>, std::size_t count, What what) {
#pragma GCC unroll 8
  for (std::size_t k = 0; k < kMost; k += hn::MaxLanes(D())) {
    if (k + hn::MaxLanes(D()) <= kLeast)
      what(k, Every());
    else
      what(k, hn::FirstN(d, std::max(count, k) - k));
  }
}

/// What a line may be violated by: all lines the same, or hard lines, which come first, less than soft ones.
struct AllAlike {
  double allowed;
  template <class D>
  HWY_INLINE hn::Vec<D> of(D d, hn::Vec<hn::RebindToUnsigned<D>>) const {
    return hn::Set(d, allowed);
  }
};
struct HardLess {
  double soft, hard;
  std::size_t hard_count;
  template <class D>
  HWY_INLINE hn::Vec<D> of(D d, hn::Vec<hn::RebindToUnsigned<D>> number) const {
    const hn::RebindToUnsigned<D> bits;
    const auto is_hard = hn::RebindMask(d, hn::Lt(number, hn::Set(bits, std::uint64_t{hard_count})));
    return hn::IfThenElse(is_hard, hn::Set(d, hard), hn::Set(d, soft));
  }
};

/// The line violated most beyond what it may be, as lines come by in their order. Each carries its number in its last
/// digits, so that one maximum finds both; among violations that differ by less, the later line is taken.
template <class D, class Allowed>
class MostViolated {
  using V = hn::Vec<D>;
  using Bits = hn::RebindToUnsigned<D>;

 public:
  HWY_INLINE MostViolated(double x, double y, const Allowed& allowed)
      : vx_(hn::Set(D(), x)),
        vy_(hn::Set(D(), y)),
        most_(hn::Set(D(), kNothing)),
        number_(hn::Iota(Bits(), 0)),
        allowed_(allowed) {}

  template <class Lines>
  HWY_INLINE void see(V x, V y, V offset, Lines lines) {
    const V along = hn::Add(hn::Mul(x, vx_), hn::Mul(y, vy_));
    const V by = hn::Sub(hn::Sub(offset, along), allowed_.of(D(), number_));
    const auto digits = hn::And(hn::BitCast(Bits(), by), hn::Set(Bits(), ~std::uint64_t{kMostNumbered - 1}));
    most_ = hn::Max(most_, only(D(), lines, hn::BitCast(D(), hn::Or(digits, number_))));
    number_ = hn::Add(number_, hn::Set(Bits(), hn::Lanes(D())));
  }

  /// -1 if none is.
  HWY_INLINE std::ptrdiff_t line() const {
    const double best = hn::GetLane(hn::MaxOfLanes(D(), most_));
    std::uint64_t digits = 0;
    std::memcpy(&digits, &best, sizeof digits);
    return best > kNothing ? static_cast<std::ptrdiff_t>(digits % kMostNumbered) : -1;
  }

 private:
  static constexpr double kNothing = std::numeric_limits<double>::min();
  V vx_, vy_, most_;
  hn::Vec<Bits> number_;
  Allowed allowed_;
};

/// The most violated of all lines; -1 if none is violated.
template <class D, class Count, class Allowed>
HWY_INLINE std::ptrdiff_t most_violated(D d, Count lines_at_most, const SingleProblem& p, double x, double y,
                                        const Allowed& allowed) {
  MostViolated<D, Allowed> most(x, y, allowed);
  for_registers(d, lines_at_most, p.count, [&](std::size_t k, auto lines) HWY_ATTR {
    most.see(hn::LoadU(d, p.normal_x + k), hn::LoadU(d, p.normal_y + k), hn::LoadU(d, p.offset + k), lines);
  });
  return most.line();
}

/// A register of one problem.
using One = hn::CappedTag<double, 1>;

HWY_INLINE LineV<One> in_lane(const Line& line) {
  const One d;
  return {hn::Set(d, line.x), hn::Set(d, line.y), hn::Set(d, line.c), hn::Set(d, static_cast<double>(line.index))};
}

/// Every line of the problem in turn, for the pricing of lanes.
HWY_INLINE Rows<double> rows_of(const SingleProblem& p) {
  return {p.normal_x, p.normal_y, p.offset, 1, p.count};
}

HWY_INLINE void ask(const SingleProblem& problem, Pack<One>& pack) {
  const One d;
  pack.px = hn::Set(d, problem.preferred.x);
  pack.py = hn::Set(d, problem.preferred.y);
  pack.speed = hn::Set(d, problem.disc);
  pack.hard_count = hn::Set(d, static_cast<double>(problem.hard));
  pack.derive();
  pack.numbered = problem.count;
}

/// The search of pack.h and relaxation.h for one problem: a register of one lane. Its lines are priced a register
/// at a time, except where hard lines stand beside soft ones that give.
template <class D, bool kHard>
class LoneSearch {
 public:
  explicit HWY_INLINE LoneSearch(const SingleProblem& problem) : p_(problem) {
    ask(problem, pack_);
    pack_.start();
    pack_.first = pack_.second = no_line(One());
    every_ = hn::Not(pack_.none());
  }

  /// False where the search cannot tell: for `solve`.
  bool run(Solution& s) {
    for (int round = 0; round < kMostLockstepRounds; ++round) {
      if (!price_next()) return answer(s);
      if (relaxing_ ? !pivot_on() : !step_on(round)) return relax_any_basis(s);
    }
    return false;
  }

  /// On the disc, the search from three lines may end before the least violation.
  bool is_on_disc() const {
    const double x = hn::GetLane(pack_.vx), y = hn::GetLane(pack_.vy);
    return x * x + y * y > p_.disc * p_.disc * (1.0 - kOnDisc);
  }

  /// From a contradiction of three lines that carry the slack.
  bool relax(const Line& a, const Line& b, const Line& c, Solution& s) {
    pack_.first = in_lane(a);
    pack_.second = in_lane(b);
    pack_.third = in_lane(c);
    if (!start_of_relaxation()) return relax_any_basis(s);
    return run(s);
  }

  /// From a basis of three soft planes that surround 0, where a hard line enters, or one that meets none of them in the
  /// disc.
  bool relax_from(const Line& a, const Line& b, const Line& c, const Line& enters, Solution& s) {
    pack_.first = in_lane(a);
    pack_.second = in_lane(b);
    pack_.third = in_lane(c);
    pack_.entering = in_lane(enters);
    relaxing_ = true;
    pack_.relaxing = every_;
    return pivot_on() ? run(s) : relax_any_basis(s);
  }

 private:
  static HWY_INLINE bool any(hn::Mask<One> m) { return !hn::AllFalse(One(), m); }

  /// Pricing: the line that enters; false where none is violated.
  HWY_INLINE bool price_next() {
    if (kHard && relaxing_) {
      price<kHard, true, Ask::nothing>(rows_of(p_), pack_);
      return any(pack_.violated);
    }
    const double noise = hn::GetLane(pack_.noise), slack = hn::GetLane(pack_.slack);
    const AllAlike alike{relaxing_ ? hn::GetLane(pack_.level) + noise : noise - slack};
    const std::ptrdiff_t line = most_violated(D(), AnyCount(), p_, hn::GetLane(pack_.vx), hn::GetLane(pack_.vy), alike);
    if (line < 0) return false;
    Line enters = given(p_, line);
    if (!relaxing_) enters.c += slack;
    pack_.entering = in_lane(enters);
    return true;
  }

  /// A pivot of the feasibility phase; false where the relaxation has to be any basis's.
  HWY_INLINE bool step_on(int round) {
    const auto contradict = round == 0   ? step<0, true>(pack_, every_)
                            : round == 1 ? step<1, true>(pack_, every_)
                                         : step<2, true>(pack_, every_);
    if (!any(contradict)) return true;
    pack_.third = pack_.entering;
    return start_of_relaxation();
  }

  /// False where the contradiction is not of three soft planes that surround 0, or where they meet outside the disc.
  HWY_INLINE bool start_of_relaxation() {
    start_relaxing<kHard, true>(pack_, every_);
    relaxing_ = any(surround_zero<kHard>(pack_));
    if (!relaxing_) return false;
    pack_.relaxing = every_;
    return pivot_on();
  }

  HWY_INLINE bool pivot_on() { return !any(pivot<kHard, true>(pack_, every_)); }

  /// Any basis: soft planes, walls, the disc.
  HWY_NOINLINE bool relax_any_basis(Solution& s) {
    const One d;
    pack_.vx = pack_.vy = pack_.level = hn::Zero(d);
    pack_.violated = pack_.none();
    pack_.relaxing = every_;
    relaxing_ = true;
    Descent<One> descent(pack_);
    descent.template run<kHard, true>(rows_of(p_), every_);
    return !any(descent.unsettled) && answer(s);
  }

  /// The search does not keep the disc in its basis; it may bind wherever a slot is free. False where nothing is
  /// violated: within the slack lines contradict, but perhaps not at all.
  HWY_INLINE bool answer(Solution& s) const {
    if (relaxing_ && !(hn::GetLane(pack_.level) > 0.0)) return false;
    const double x = hn::GetLane(pack_.vx), y = hn::GetLane(pack_.vy);
    s.velocity = {x, y};
    s.status = relaxing_ ? Status::relaxed : Status::optimal;
    s.violation = relaxing_ ? hn::GetLane(pack_.level) : 0.0;
    s.active = {};
    s.active_count = 0;
    Normals normals{};
    for (const LineV<One>* line : {&pack_.first, &pack_.second, &pack_.third}) {
      const double index = hn::GetLane(line->index);
      if (!(index >= 0.0) || !any(pack_.exists(*line))) continue;
      normals[s.active_count] = {hn::GetLane(line->x), hn::GetLane(line->y)};
      s.active[s.active_count++].binding = constraint_at(static_cast<std::size_t>(index));
    }
    if (is_on_disc() && s.active_count < (relaxing_ ? 3U : 2U)) s.active[s.active_count++].binding = kDisc;
    set_multipliers(normals, Objective::nearest, p_.preferred, s);
    return true;
  }

  const SingleProblem& p_;
  Pack<One> pack_;
  hn::Mask<One> every_;
  bool relaxing_ = false;
};

/// Without kApart all count as soft.
template <class D, class Count, bool kApart>
HWY_INLINE Worst worst_of(const SingleProblem& p, double x, double y) {
  using V = hn::Vec<D>;
  const D d;
  const hn::RebindToUnsigned<D> bits;
  const V vx = hn::Set(d, x), vy = hn::Set(d, y), low = hn::Set(d, -HUGE_VAL);
  V soft = low, hard = low;
  const auto by = [&](std::size_t k) HWY_ATTR {
    const V along = hn::Add(hn::Mul(hn::LoadU(d, p.normal_x + k), vx), hn::Mul(hn::LoadU(d, p.normal_y + k), vy));
    return hn::Sub(hn::LoadU(d, p.offset + k), along);
  };
  if (!kApart || p.hard == 0) {
    for_registers(d, Count(), p.count,
                  [&](std::size_t k, auto lines) { soft = hn::Max(soft, only(d, lines, by(k), low)); });
    return {-HUGE_VAL, hn::GetLane(hn::MaxOfLanes(d, soft))};
  }
  auto number = hn::Iota(bits, 0);
  for_registers(d, Count(), p.count, [&](std::size_t k, auto lines) {
    const V excess = only(d, lines, by(k), low);
    const auto is_hard = hn::RebindMask(d, hn::Lt(number, hn::Set(bits, std::uint64_t{p.hard})));
    hard = hn::Max(hard, hn::IfThenElse(is_hard, excess, low));
    soft = hn::Max(soft, hn::IfThenElse(is_hard, low, excess));
    number = hn::Add(number, hn::Set(bits, hn::Lanes(d)));
  });
  return {hn::GetLane(hn::MaxOfLanes(d, hard)), hn::GetLane(hn::MaxOfLanes(d, soft))};
}

/// Whether the multipliers of a solution prove it. Sets its violation.
template <class D, class Count = AnyCount>
HWY_NOINLINE bool prove_in(const SingleProblem& p, Solution& s) {
  if (s.status == Status::optimal)
    return SingleProof(p, s.velocity, worst_of<D, Count, false>(p, s.velocity.x, s.velocity.y)).of(s);
  const Worst worst = worst_of<D, Count, true>(p, s.velocity.x, s.velocity.y);
  if (s.status == Status::relaxed) s.violation = std::max(worst.soft, 0.0);
  return SingleProof(p, s.velocity, worst).of(s);
}

/// One problem, its lines a register at a time. A problem alone is bound by latency, so chains are kept short: where
/// the search goes to a vertex line by line, here all lines cut the boundary of one at once, and multipliers tell
/// whether the optimum is found. What that does not settle is left to LoneSearch.
template <class D, class Count, bool kProve>
class Slide : private Allowance {
  using V = hn::Vec<D>;

 public:
  explicit HWY_INLINE Slide(const SingleProblem& problem) : Allowance(problem.disc), p_(problem) {}

  /// From the line that the preferred velocity violates most, or -1. False where the search has to tell, or the answer
  /// is not proven.
  HWY_INLINE bool run(std::ptrdiff_t line, Solution& s) const {
    const double px = p_.preferred.x, py = p_.preferred.y;
    if (line >= 0) return p_.count <= kMostSlidLines && slide(line, s);
    put(s, px, py, Status::optimal, 0, 0.0);
    set(s.active[0], 0, 0.0);
    set(s.active[1], 0, 0.0);
    // All lines hold by more than their violation can be wrong by, which proves the preferred velocity.
    return px * px + py * py <= disc_squared || sign_of_excess_speed(p_.preferred, p_.disc) <= 0 || stop_at_disc(s);
  }

 private:
  /// Boundaries followed before the search is tried: one in 4 of 5 recorded problems, more than three in 1 of 10^4.
  static constexpr int kMostSlides = 4;

  /// A bit a line.
  static constexpr std::size_t kMostSlidLines = 64;

  /// What is left of the boundary of a line, in the unit of `step`, and where each line cuts it off.
  struct Stretch {
    HWY_ALIGN double cuts[kMostSlidLines];
    double low, high;
  };

  /// The disc binds alone; false where lines have a say.
  HWY_NOINLINE bool stop_at_disc(Solution& s) const {
    s.active[0].binding.kind = BindingKind::disc;
    s.active_count = 1;
    return set_vertex(p_, s) && prove_in<D, Count>(p_, s);
  }

  /// Two lines bind, of which the first is followed.
  HWY_NOINLINE bool stop_at(std::ptrdiff_t line, std::ptrdiff_t other, Solution& s) const {
    put(s, 0.0, 0.0, Status::optimal, 2, 0.0);
    set(s.active[0], line, 0.0);
    set(s.active[1], other, 0.0);
    return set_vertex(p_, s) && prove_in<D, Count>(p_, s);
  }

  /// The first line that cuts it off there; -1 where none does.
  HWY_INLINE std::ptrdiff_t line_at(const Stretch& left, double where) const {
    const D d;
    const V end = hn::Set(d, where);
    std::uint64_t found = 0;
    for_registers(d, Count(), p_.count, [&](std::size_t k, auto) HWY_ATTR {
      std::uint8_t bits = 0;
      hn::StoreMaskBits(d, hn::Eq(hn::Load(d, left.cuts + k), end), &bits);
      found |= std::uint64_t{bits} << k;
    });
    if (found == 0) return -1;
    return static_cast<std::ptrdiff_t>(hwy::Num0BitsBelowLS1Bit_Nonzero64(found));
  }

  /// Lines that are all but the same must not cut each other off by a rounding: the others may give by half of what is
  /// called noise, which leaves them 20 u V inward. A cut is wrong by 8 u V / slope, where both offsets, their products
  /// with |n|^2 and n.n' and the difference round, and by 3 u of itself; a velocity made of it by 6 u V. The line is
  /// kept exactly, since that is 17 u V of it in all.
  HWY_INLINE void cut_by_all(const Line& line, double squared, Stretch& left) const {
    const D d;
    const V hx = hn::Set(d, line.x), hy = hn::Set(d, line.y), hc = hn::Set(d, line.c), square = hn::Set(d, squared);
    const V inward = hn::Set(d, slack - 0.5 * noise), far = hn::Set(d, HUGE_VAL), zero = hn::Zero(d);
    V low = hn::Neg(far), high = far;
    for_registers(d, Count(), p_.count, [&](std::size_t k, auto lines) {
      const V x = hn::LoadU(d, p_.normal_x + k), y = hn::LoadU(d, p_.normal_y + k);
      const V c = hn::Add(hn::LoadU(d, p_.offset + k), inward);
      const V slope = hn::Add(hn::Sub(hn::Mul(hx, y), hn::Mul(hy, x)), hn::Set(d, kParallel<double>));
      const V along = hn::Add(hn::Mul(hx, x), hn::Mul(hy, y));
      const V cut = only(d, lines, hn::Div(hn::Sub(hn::Mul(c, square), hn::Mul(along, hc)), slope), far);
      const auto lowers = hn::Lt(only(d, lines, slope, hn::Neg(far)), zero);
      hn::Store(cut, d, left.cuts + k);
      low = hn::Max(low, hn::IfThenElse(lowers, hn::Neg(far), cut));
      high = hn::Min(high, hn::IfThenElse(lowers, cut, far));
    });
    left.low = hn::GetLane(hn::MaxOfLanes(d, low));
    left.high = hn::GetLane(hn::MinOfLanes(d, high));
  }

  /// From the optimum on the boundary of one line to that on the next, downhill, until multipliers say that it is the
  /// optimum of all. False where the disc has a say, or where the boundary of the first line is cut off wholly and that
  /// proves nothing. Lines go by number: as a whole they would be copied from where they were just written, for which
  /// a processor waits.
  HWY_INLINE bool slide(std::ptrdiff_t line, Solution& s) const {
    Stretch left;
    for (int count = 0; count < kMostSlides; ++count) {
      const Line h = with_slack(given(p_, line));
      const double squared = h.x * h.x + h.y * h.y, inverse = 1.0 / squared;
      cut_by_all(h, squared, left);
      const double room = disc_squared * squared - h.c * h.c;
      if (!(room >= 0.0)) return false;
      const double reach = std::sqrt(room), wish = h.x * p_.preferred.y - h.y * p_.preferred.x;
      const double low = std::max(left.low, -reach), high = std::min(left.high, reach);
      if (low > high) {
        const std::ptrdiff_t at_low = line_at(left, left.low), at_high = line_at(left, left.high);
        if (left.low > left.high && surround_zero(line, at_low, at_high)) return relax(line, at_low, at_high, s);
        const bool low_is_worse = low - wish > wish - high;
        const bool is_disc = low_is_worse ? low > left.low : high < left.high;
        line = low_is_worse != is_disc ? at_low : at_high;
        if (line < 0) return false;
        continue;
      }
      const double where = std::min(std::max(wish, low), high);
      const double x = (h.x * h.c - where * h.y) * inverse, y = (h.y * h.c + where * h.x) * inverse;
      const double pull_x = x - p_.preferred.x, pull_y = y - p_.preferred.y;
      if (where == wish) {
        const double share = std::max(0.0, (pull_x * h.x + pull_y * h.y) / squared);
        put(s, x, y, Status::optimal, 1, 0.0);
        set(s.active[0], line, share);
        set(s.active[1], 0, 0.0);
        return !kProve || is_proven(h, share, Line(), 0.0, {x, y});
      }
      const std::ptrdiff_t end = line_at(left, where), number = std::max<std::ptrdiff_t>(end, 0);
      const bool at_disc = end < 0;
      const double gx = at_disc ? -x : p_.normal_x[number], gy = at_disc ? -y : p_.normal_y[number];
      // Parallel boundaries (h is tangent to the disc) leave one point, or have no multipliers.
      const double pull = pull_x * gy - pull_y * gx, turn = h.x * gy - h.y * gx;
      if (pull * turn > 0.0) {
        if (kProve && ((count > 0) & !at_disc)) {  // one branch: whether it is the disc is not predicted
          const Vertex vertex(Objective::nearest, p_.preferred, p_.disc, p_.disc, kSlacks[0]);
          if (!vertex.follows(binding_line(line), binding_line(end))) return stop_at(end, line, s);
        }
        put(s, x, y, Status::optimal, 2, 0.0);
        const double of_h = std::max(0.0, pull / turn), of_g = std::max(0.0, (h.x * pull_y - h.y * pull_x) / turn);
        set(s.active[0], line, of_h);
        set(s.active[1], number, of_g);
        s.active[1].binding.kind = at_disc ? BindingKind::disc : BindingKind::constraint;
        const double gc = at_disc ? -p_.disc * p_.disc : p_.offset[number];
        return !kProve || is_proven(h, of_h, {gx, gy, gc, end}, of_g, {x, y});
      }
      if (at_disc) return false;
      line = end;
    }
    return false;
  }

  HWY_INLINE BindingLine binding_line(std::ptrdiff_t k) const {
    return {{p_.normal_x[k], p_.normal_y[k]}, p_.offset[k], static_cast<std::size_t>(k), false};
  }

  HWY_INLINE bool is_proven(Line h, double of_h, const Line& g, double of_g, Vec2 v) const {
    h.c = p_.offset[h.index];
    return SingleProof(p_, v, worst_of<D, Count, false>(p_, v.x, v.y)).optimum(h, of_h, g, of_g);
  }

  /// Number by number, as lines.
  static HWY_INLINE void put(Solution& s, double x, double y, Status status, std::size_t active, double violation) {
    s.velocity.x = x;
    s.velocity.y = y;
    s.status = status;
    s.violation = violation;
    s.active_count = active;
    set(s.active[2], 0, 0.0);
  }
  static HWY_INLINE void set(ActiveConstraint& a, std::ptrdiff_t line, double multiplier) {
    a.binding.kind = BindingKind::constraint;
    a.binding.index = static_cast<std::size_t>(line);
    a.multiplier = multiplier;
  }

  /// Whether normals surround 0, in this order: then a line whose boundary two others cut off wholly excludes all that
  /// they leave. Elsewhere all that they leave lies inside.
  HWY_INLINE bool surround_zero(std::ptrdiff_t line, std::ptrdiff_t low, std::ptrdiff_t high) const {
    if (low < 0 || high < 0) return false;
    const Line a = given(p_, line), b = given(p_, low), c = given(p_, high);
    return (cross(a, b) > 0.0) & (cross(b, c) > 0.0) & (cross(c, a) > 0.0);
  }

  HWY_NOINLINE bool relax(std::ptrdiff_t line, std::ptrdiff_t low, std::ptrdiff_t high, Solution& s) const {
    const auto hard = static_cast<std::ptrdiff_t>(p_.hard);
    const Line a = given(p_, line), b = given(p_, low), c = given(p_, high);
    if (hard == 0) return pivot(a, b, c, AllAlike{}, s);
    if (line >= hard && low >= hard && high >= hard) return pivot(a, b, c, HardLess{0.0, noise - slack, p_.hard}, s);
    return relax_beside_walls(a, b, c, s);
  }

  HWY_NOINLINE bool relax_beside_walls(Line line, Line low, Line high, Solution& s) const {
    line.c += slack;
    low.c += slack;
    high.c += slack;
    LoneSearch<D, true> search(p_);
    return search.relax(line, low, high, s) && ((!kProve && !search.is_on_disc()) || prove_in<D>(p_, s));
  }

  static HWY_INLINE void set_level(AllAlike& allowed, double level) { allowed.allowed = level; }
  static HWY_INLINE void set_level(HardLess& allowed, double level) { allowed.soft = level; }

  /// Three soft planes whose normals surround 0, counter-clockwise, as `pivot` of relaxation.h. The slack is put
  /// on and taken off again as in a lane of a batch.
  template <class Allowed>
  HWY_INLINE bool pivot(Line a, Line b, Line c, Allowed allowed, Solution& s) const {
    for (Line* line : {&a, &b, &c}) line->c = (line->c + slack) - slack;
    Line enters = a, left = b, right = c;
    for (int round = 0; round < kMostLockstepRounds; ++round) {
      const double bx = enters.x - left.x, by = enters.y - left.y, bc = enters.c - left.c;
      const double cx = enters.x - right.x, cy = enters.y - right.y, cc = enters.c - right.c;
      const double inverse = 1.0 / (bx * cy - by * cx);
      const double x = (bc * cy - by * cc) * inverse, y = (bx * cc - bc * cx) * inverse;
      if (!(x * x + y * y <= disc_squared)) return relax_from(a, b, c, enters, s);
      a = enters;
      b = left;
      c = right;
      const double level = a.c - (a.x * x + a.y * y);
      set_level(allowed, level + noise);
      const std::ptrdiff_t line = most_violated(D(), Count(), p_, x, y, allowed);
      if (line < 0) {
        if (!(level > 0.0)) return false;
        const double of_a = cross(b, c), of_b = cross(c, a), of_c = cross(a, b);
        put(s, x, y, Status::relaxed, 3, level);
        set(s.active[0], a.index, of_a);
        set(s.active[1], b.index, of_b);
        set(s.active[2], c.index, of_c);
        return !kProve || prove_in<D>(p_, s);
      }
      enters = given(p_, line);
      if (line < static_cast<std::ptrdiff_t>(p_.hard)) return relax_from(a, b, c, with_slack(enters), s);
      const double by_a = cross(enters, a), by_b = cross(enters, b), by_c = cross(enters, c);
      double by_left = by_b, by_right = by_c;
      if (!(by_b > 0.0) && by_a > 0.0) {
        left = a;
        right = b;
        by_left = by_a;
        by_right = by_b;
      } else if (!(by_b > 0.0) || by_c > 0.0) {
        left = c;
        right = a;
        by_left = by_c;
        by_right = by_a;
      }
      if (!(by_left > 0.0 && by_right < 0.0)) return relax_from(a, b, c, enters, s);
    }
    return false;
  }

  HWY_INLINE Line with_slack(Line line) const {
    line.c += slack;
    return line;
  }

  HWY_NOINLINE bool relax_from(Line a, Line b, Line c, Line enters, Solution& s) const {
    if (p_.hard > 0) {
      LoneSearch<D, true> search(p_);
      return search.relax_from(a, b, c, enters, s) && ((!kProve && !search.is_on_disc()) || prove_in<D>(p_, s));
    }
    LoneSearch<D, false> search(p_);
    return search.relax_from(a, b, c, enters, s) && ((!kProve && !search.is_on_disc()) || prove_in<D>(p_, s));
  }

  const SingleProblem& p_;
};

template <class D, bool kHard>
HWY_NOINLINE bool search_alone(const SingleProblem& p, Solution& s) {
  LoneSearch<D, kHard> search(p);
  return search.run(s);
}

/// Share of the squared radius of the disc: for faster preferences the disc mostly binds alone or with a line,
/// which the search finds sooner. Robots that prefer their full speed, up to rounding, are the common case.
constexpr double kFarthestSlid = 1.0625;

/// What the preferred velocity may violate a line by.
HWY_INLINE AllAlike allowed_at_first(const SingleProblem& p) {
  const Allowance of(p.disc);
  return {of.noise - of.slack};
}

/// Squares in range (Pack::in_range) and lines that can be numbered: the rest takes a longer way. `first` gives the
/// line that the preferred velocity violates most.
template <class D, class Count, bool kProve, class First>
HWY_INLINE bool run_from(const SingleProblem& p, const First& first, Solution& s) {
  const double limit = p.disc * p.disc, squared = p.preferred.x * p.preferred.x + p.preferred.y * p.preferred.y;
  const double most = std::max(squared, limit);
  if (!(limit >= kLeastSquare<double> && most <= kMostSquare<double> && p.count <= kMostNumbered)) return false;
  if (squared <= limit * kFarthestSlid && Slide<D, Count, kProve>(p).run(first(), s)) return true;
  if (!(p.hard > 0 ? search_alone<D, true>(p, s) : search_alone<D, false>(p, s))) return false;
  if (!kProve) return true;
  return (s.status != Status::optimal || set_vertex(p, s)) && prove_in<D>(p, s);
}

template <class D, class Count, bool kProve>
HWY_NOINLINE bool run_in(const SingleProblem& p, Solution& s) {
  const auto first = [&]() HWY_ATTR {
    return most_violated(D(), Count(), p, p.preferred.x, p.preferred.y, allowed_at_first(p));
  };
  return run_from<D, Count, kProve>(p, first, s);
}

template <bool kProve>
HWY_INLINE bool run(const SingleProblem& p, Solution& s) {
  if (p.count == 0 || p.count > kFewLines) return run_in<ManyLines, AnyCount, kProve>(p, s);
  return p.count > 8 ? run_in<FewLines, UpTo12, kProve>(p, s) : run_in<FewLines, UpTo8, kProve>(p, s);
}

bool run_single(const SingleProblem& p, Solution& s) {
  return run<false>(p, s);
}

bool run_single_proven(const SingleProblem& p, Solution& s) {
  return run<true>(p, s);
}

/// The numbers of a Constraint, of which the fourth holds its priority.
static_assert(sizeof(Constraint) == 4 * sizeof(double) && offsetof(Constraint, priority) == 3 * sizeof(double) &&
              static_cast<int>(Priority::soft) == 1);

/// The most lines that are copied.
constexpr std::size_t kMostCopied = 64;

struct CopiedLines {
  double x[kMostCopied], y[kMostCopied], offset[kMostCopied];
};

/// A register of constraints by what they hold.
struct ConstraintsV {
  hn::Vec<FewLines> x, y, offset, rest;
};

/// The constraints from number k on; lanes behind the last one repeat it.
template <class Lines>
HWY_INLINE ConstraintsV load_constraints(const Constraint* from, std::size_t k, std::size_t last, Lines) {
  const FewLines d;
  const auto row = [&](std::size_t lane) HWY_ATTR {
    const std::size_t at = std::is_same_v<Lines, Every> ? k + lane : std::min(k + lane, last);
    return reinterpret_cast<const double*>(from + at);  // NOLINT: four each
  };
#if HWY_TARGET == HWY_SCALAR
  return {hn::LoadU(d, row(0)), hn::LoadU(d, row(0) + 1), hn::LoadU(d, row(0) + 2), hn::LoadU(d, row(0) + 3)};
#else
  using V = hn::Vec<FewLines>;
  const V a = hn::LoadU(d, row(0)), b = hn::LoadU(d, row(1));
  if constexpr (hn::MaxLanes(FewLines()) == 2) {
    const V a_rest = hn::LoadU(d, row(0) + 2), b_rest = hn::LoadU(d, row(1) + 2);
    return {hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b), hn::InterleaveLower(d, a_rest, b_rest),
            hn::InterleaveUpper(d, a_rest, b_rest)};
  } else {
    const V e = hn::LoadU(d, row(2)), f = hn::LoadU(d, row(3));
    const V ab = hn::InterleaveLower(d, a, b), ab_next = hn::InterleaveUpper(d, a, b);
    const V ef = hn::InterleaveLower(d, e, f), ef_next = hn::InterleaveUpper(d, e, f);
    return {hn::ConcatLowerLower(d, ef, ab), hn::ConcatLowerLower(d, ef_next, ab_next), hn::ConcatUpperUpper(d, ef, ab),
            hn::ConcatUpperUpper(d, ef_next, ab_next)};
  }
#endif
}

/// False where a normal is not of unit length, an offset not finite or a soft constraint before a hard one. In passing
/// the line that the preferred velocity violates most is found, first: the search waits for it, and for nothing else.
template <class Count>
HWY_INLINE bool copy_lines(const Constraint* from, CopiedLines& to, SingleProblem& p, std::ptrdiff_t& first) {
  using V = hn::Vec<FewLines>;
  const FewLines d;
  const hn::RebindToUnsigned<FewLines> bits;
  const std::size_t count = p.count;
  MostViolated<FewLines, AllAlike> most(p.preferred.x, p.preferred.y, allowed_at_first(p));
  std::uint64_t soft = 0;
  for_registers(d, Count(), count, [&](std::size_t k, auto lines) HWY_ATTR {
    const ConstraintsV c = load_constraints(from, k, count - 1, lines);
    most.see(c.x, c.y, c.offset, lines);
    hn::StoreU(c.x, d, to.x + k);
    hn::StoreU(c.y, d, to.y + k);
    hn::StoreU(c.offset, d, to.offset + k);
    const auto in_sign = hn::BitCast(d, hn::ShiftLeft<63>(hn::BitCast(bits, c.rest)));
    std::uint8_t is_soft = 0;
    hn::StoreMaskBits(d, hn::MaskFromVec(in_sign), &is_soft);
    soft |= std::uint64_t{is_soft} << k;
  });
  first = most.line();
  const V one = hn::Set(d, 1.0), unit = hn::Set(d, kUnitLength), far = hn::Set(d, HUGE_VAL);
  auto all_good = hn::Eq(one, one);
  for_registers(d, Count(), count, [&](std::size_t k, auto) HWY_ATTR {
    const V x = hn::LoadU(d, to.x + k), y = hn::LoadU(d, to.y + k), offset = hn::LoadU(d, to.offset + k);
    const V length = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
    const auto is_unit = hn::Le(hn::Abs(hn::Sub(length, one)), unit);
    all_good = hn::And(all_good, hn::And(is_unit, hn::Lt(hn::Abs(offset), far)));
  });
  if (!hn::AllTrue(d, all_good)) return false;
  const std::uint64_t all = count < 64 ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0};
  soft &= all;
  p.hard = soft == 0 ? count : hwy::Num0BitsBelowLS1Bit_Nonzero64(soft);
  return soft == 0 || soft == (all >> p.hard << p.hard);
}

template <class D, class Count>
HWY_NOINLINE bool run_copied(const Problem& problem, Solution& s) {
  CopiedLines lines;
  SingleProblem p{lines.x, lines.y, lines.offset, problem.constraints.size(), 0, problem.preferred, problem.bound.disc};
  std::ptrdiff_t first = -1;
  if (!copy_lines<Count>(problem.constraints.data(), lines, p, first)) return false;
  return run_from<D, Count, true>(
      p, [&] { return first; }, s);
}

bool run_plain_lines(const Problem& problem, Solution& s) {
  const std::size_t count = problem.constraints.size();
  // What was just stored is loaded by registers of the same width: a wider load waits until all stores are done.
  if (count == 0 || count > kFewLines) return count <= kMostCopied && run_copied<FewLines, AnyCount>(problem, s);
  return count > 8 ? run_copied<FewLines, UpTo12>(problem, s) : run_copied<FewLines, UpTo8>(problem, s);
}

}  // namespace exactvo::lp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::lp {

HWY_EXPORT(run_single);
HWY_EXPORT(run_plain_lines);
HWY_EXPORT(run_single_proven);

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

/// Out of line: what the search settles need not save registers for it.
HWY_NOINLINE void solve_copied(const SingleProblem& problem, Solution& answer) {
  answer = solve(problem_of(problem));
}

HWY_NOINLINE bool certify_copied(const SingleProblem& problem, Solution& answer) {
  const Problem copy = problem_of(problem);
  const Proven proven = solve_certified(copy);
  answer = proven.solution;
  return proven.certificate && is_tight(copy, *proven.certificate);
}

}  // namespace

bool run_kernel(const SingleProblem& problem, Solution& answer) {
  return HWY_DYNAMIC_DISPATCH(run_single)(problem, answer);
}

bool run_plain(const Problem& problem, Solution& answer) {
  return HWY_DYNAMIC_DISPATCH(run_plain_lines)(problem, answer);
}

void solve(const SingleProblem& problem, Solution& answer) {
  if (!HWY_DYNAMIC_DISPATCH(run_single)(problem, answer)) solve_copied(problem, answer);
}

bool solve_certified(const SingleProblem& problem, Solution& answer) {
  return HWY_DYNAMIC_DISPATCH(run_single_proven)(problem, answer) || certify_copied(problem, answer);
}

}  // namespace exactvo::lp
#endif  // HWY_ONCE
