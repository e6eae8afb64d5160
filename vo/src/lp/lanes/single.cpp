// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/kernel.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "exactvo/geometry/require.h"
#include "exactvo/vo/lp/certificate.h"
#include "lp/lanes/layout.h"
#include "lp/problem/exact_sign.h"
#include "lp/proof/multipliers.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lp/lanes/single.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "lp/lanes/pack_proof.h"
#include "lp/lanes/relaxation.h"

HWY_BEFORE_NAMESPACE();
namespace exactvo::lp::HWY_NAMESPACE {

/// Of so few lines: a divider takes a register of 64 bytes twice as long as one of 32, and adds to the time until the
/// answer, which three short registers do not. Of 13 lines and more the wide ones win.
constexpr std::size_t kFewLines = 12;
using FewLines = hn::CappedTag<double, 4>;
using ManyLines = hn::CappedTag<double, kSinglePadding>;

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
template <class M>
HWY_INLINE M among(Every, M m) {
  return m;
}
template <class M>
HWY_INLINE M among(M lines, M m) {
  return hn::And(lines, m);
}

/// `what(k, lines)` for the lines from k on, a register full; of the last one only lanes in the mask are lines.
template <class D, class What>
HWY_INLINE void for_registers(D d, std::size_t count, What what) {
  std::size_t k = 0;
  for (; k + hn::Lanes(d) <= count; k += hn::Lanes(d)) what(k, Every());
  if (k < count) what(k, hn::FirstN(d, count - k));
}

/// The number of a line stands in so many last digits of its violation; 2^16 of them leave it 36.
constexpr std::size_t kMostNumbered = std::size_t{1} << 16U;

/// The line violated most, if by more than `allowed`, or -1. Each carries its number in its last digits, so that one
/// maximum finds both; among violations that differ by less, the later line is taken.
template <class D>
HWY_INLINE std::ptrdiff_t most_violated(D d, const SingleProblem& p, double x, double y, double allowed) {
  using V = hn::Vec<D>;
  const hn::RebindToUnsigned<D> bits;
  const V vx = hn::Set(d, x), vy = hn::Set(d, y), enough = hn::Set(d, allowed);
  const double nothing = std::numeric_limits<double>::min();
  V most = hn::Set(d, nothing);
  auto number = hn::Iota(bits, 0);
  for_registers(d, p.count, [&](std::size_t k, auto lines) {
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

  /// Whether the optimum or the least violation is proven (pack_proof.h).
  bool is_proven() const {
    const Proof<One> proof(pack_);
    return hn::AllTrue(One(), relaxing_ ? proof.relaxation() : proof.optimum());
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
    const double allowed = relaxing_ ? hn::GetLane(pack_.level) + noise : noise - slack;
    const std::ptrdiff_t line = most_violated(D(), p_, hn::GetLane(pack_.vx), hn::GetLane(pack_.vy), allowed);
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

  /// The search does not keep the disc in its basis; it may bind wherever a slot is free.
  HWY_INLINE bool answer(Solution& s) const {
    const double x = hn::GetLane(pack_.vx), y = hn::GetLane(pack_.vy);
    s.velocity = {x, y};
    s.status = relaxing_ ? Status::relaxed : Status::optimal;
    s.violation = relaxing_ ? std::max(hn::GetLane(pack_.level), 0.0) : 0.0;
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

/// One problem, its lines a register at a time. A problem alone is bound by latency, so chains are kept short: where
/// the search goes to a vertex line by line, here all lines cut the boundary of one at once, and multipliers tell
/// whether the optimum is found. What that does not settle is left to LoneSearch.
template <class D, bool kProve>
class Slide : private Allowance {
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

 public:
  explicit HWY_INLINE Slide(const SingleProblem& problem) : Allowance(problem.disc), p_(problem) {}

  /// False where the search has to tell, or the answer is not proven.
  HWY_INLINE bool run(Solution& s) const {
    const double px = p_.preferred.x, py = p_.preferred.y;
    const std::ptrdiff_t line = most_violated(D(), p_, px, py, noise - slack);
    if (line >= 0) return p_.count < kMostSlidLines && slide(given(p_, line), s);
    if (!(px * px + py * py <= p_.disc * p_.disc * (1.0 - kDiscUnits * 0x1p-53))) return false;  // nearest on the disc
    s.velocity = {px, py};
    s.status = Status::optimal;
    s.active = {};
    s.active_count = 0;
    s.violation = 0.0;
    return true;
  }

 private:
  /// Boundaries followed before the search is tried: one in 4 of 5 recorded problems, more than three in 1 of 10^4.
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
    for_registers(d, p_.count, [&](std::size_t k, auto lines) {
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
      // Of h, and where only h binds: looked up, not branched on. Parallel boundaries (h is tangent to the disc) leave
      // one point, or have no multipliers.
      const double shares[2] = {pull * turn - static_cast<double>(turn == 0.0), 0.0};
      if (shares[where == wish] >= 0.0) {
        s.velocity = {x, y};
        optimum(h.index, end, where != wish, s);
        const double of_both[2] = {pull / turn, (h.x * pull_y - h.y * pull_x) / turn};
        const double of_one = (h.x * pull_x + h.y * pull_y) * inverse;
        s.active[0].multiplier = std::max(0.0, where == wish ? of_one : of_both[0]);
        s.active[1].multiplier = where == wish ? 0.0 : std::max(0.0, of_both[1]);
        return !kProve || (all_hold(x, y) && keeps_disc(x, y) && is_proven(h, g, x, y, s));
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
    return p_.hard > 0 ? relax<true>(line, low, high, s) : relax<false>(line, low, high, s);
  }

  template <bool kHard>
  HWY_INLINE bool relax(const Line& line, const Line& low, const Line& high, Solution& s) const {
    LoneSearch<D, kHard> search(p_);
    return search.relax(line, low, high, s) && ((!kProve && !search.is_on_disc()) || search.is_proven());
  }

  /// Whether every line holds by more than the rounding of its sum (exact_sign.h).
  HWY_INLINE bool all_hold(double x, double y) const {
    const D d;
    const V vx = hn::Set(d, x), vy = hn::Set(d, y), share = hn::Set(d, kSignError), least = hn::Set(d, kSignUnderflow);
    M doubtful = hn::MaskFromVec(hn::Zero(d));
    for_registers(d, p_.count, [&](std::size_t k, auto lines) {
      const V along = hn::Mul(hn::LoadU(d, p_.normal_x + k), vx), across = hn::Mul(hn::LoadU(d, p_.normal_y + k), vy);
      const V c = hn::LoadU(d, p_.offset + k);
      const V terms = hn::Add(hn::Add(hn::Abs(along), hn::Abs(across)), hn::Abs(c));
      const V error = hn::Add(hn::Mul(share, terms), least);
      doubtful = hn::Or(doubtful, among(lines, hn::Le(hn::Sub(hn::Add(along, across), c), error)));
    });
    return hn::AllFalse(d, doubtful);
  }

  /// Whether the multipliers of two lines, the first with its slack, or of one and the disc prove (x, y) the optimum.
  HWY_INLINE bool is_proven(const Line& h, const Line& g, double x, double y, const Solution& s) const {
    if (s.active_count == 2 && !g.exists()) return is_proven_on_disc(h, x, y);
    return gap_is_narrow(h, g, s.active[0].multiplier, s.active[1].multiplier, x, y);
  }

  HWY_INLINE bool keeps_disc(double x, double y) const {
    return x * x + y * y <= p_.disc * p_.disc * (1.0 - 4 * 0x1p-53);  // a product and a sum, three units of each side
  }

  /// Inequality (4) of certificate.h, the disc out of it, in rounded arithmetic; its error as in pack_proof.h.
  HWY_INLINE bool gap_is_narrow(const Line& h, const Line& g, double a, double b, double x, double y) const {
    const double px = p_.preferred.x, py = p_.preferred.y, own = px * px + py * py, limit = p_.disc * p_.disc;
    const double pull_x = x - px, pull_y = y - py;
    const double gx = px + (a * h.x + b * g.x), gy = py + (a * h.y + b * g.y), pulled = gx * gx + gy * gy;
    const double c = h.c - slack, offsets = a * c + b * g.c;
    const double gap = (pull_x * pull_x + pull_y * pull_y) - ((own + (offsets + offsets)) - pulled);
    const double spread = (std::fabs(px) + std::fabs(py)) + (a + b);
    const double turned = ((std::fabs(gx) + std::fabs(gy)) + kSecondOrder * spread) * spread;
    const double terms = (own + (pulled + turned)) + (limit + (a * std::fabs(c) + b * std::fabs(g.c)));
    return a >= 0.0 && gap + kProofError * 0x1p-53 * terms <= kWidestGap * (limit + own);  // b is 0 or more
  }

  HWY_NOINLINE bool is_proven_on_disc(const Line& h, double x, double y) const {
    const One d;
    Pack<One> pack;
    ask(p_, pack);
    pack.vx = hn::Set(d, x);
    pack.vy = hn::Set(d, y);
    pack.level = hn::Zero(d);
    pack.first = in_lane(h);
    pack.second = pack.third = no_line(d);
    return hn::AllTrue(d, Proof<One>(pack).optimum());
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

template <class D, bool kProve, bool kHard>
HWY_INLINE bool search_alone(const SingleProblem& p, Solution& s) {
  LoneSearch<D, kHard> search(p);
  return search.run(s) && (!kProve || search.is_proven());
}

/// Of the square of the disc: where it is preferred to go faster than that, the disc mostly binds alone or with a line,
/// which the search finds sooner. Robots that prefer their full speed, up to rounding, are the common case.
constexpr double kFarthestSlid = 1.0625;

/// Squares in range (Pack::in_range) and lines that can be numbered: the rest takes a longer way.
template <class D, bool kProve>
HWY_INLINE bool run_in(const SingleProblem& p, Solution& s) {
  const double limit = p.disc * p.disc, squared = p.preferred.x * p.preferred.x + p.preferred.y * p.preferred.y;
  const double most = std::max(squared, limit);
  if (!(limit >= kLeastSquare<double> && most <= kMostSquare<double> && p.count <= kMostNumbered)) return false;
  if (squared <= limit * kFarthestSlid && Slide<D, kProve>(p).run(s)) return true;
  return p.hard > 0 ? search_alone<D, kProve, true>(p, s) : search_alone<D, kProve, false>(p, s);
}

template <bool kProve>
HWY_INLINE bool run(const SingleProblem& p, Solution& s) {
  return p.count <= kFewLines ? run_in<FewLines, kProve>(p, s) : run_in<ManyLines, kProve>(p, s);
}

bool run_single(const SingleProblem& p, Solution& s) {
  return run<false>(p, s);
}

bool run_single_proven(const SingleProblem& p, Solution& s) {
  return run<true>(p, s);
}

}  // namespace exactvo::lp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::lp {

HWY_EXPORT(run_single);
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

void solve(const SingleProblem& problem, Solution& answer) {
  if (!run_kernel(problem, answer)) solve_copied(problem, answer);
}

bool solve_certified(const SingleProblem& problem, Solution& answer) {
  return HWY_DYNAMIC_DISPATCH(run_single_proven)(problem, answer) || certify_copied(problem, answer);
}

}  // namespace exactvo::lp
#endif  // HWY_ONCE
