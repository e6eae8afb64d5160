// SPDX-License-Identifier: GPL-3.0-or-later
// The lockstep walk, compiled once a SIMD target. No include guard of the usual kind: batch.cpp includes it through
// hwy/foreach_target.h.
#if defined(EXACTVO_BATCH_PACK_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EXACTVO_BATCH_PACK_H
#undef EXACTVO_BATCH_PACK_H
#else
#define EXACTVO_BATCH_PACK_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace exactvo::lp::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Rounds after which a lane is left to the scalar solver; recorded problems need at most a dozen.
inline constexpr int kMostLockstepRounds = 40;

/// Roundings of a proof: at most 30 operations deep on terms of at most the scale it is multiplied with, doubled.
inline constexpr double kProofError = 64.0;

template <class D>
struct Walk {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

  /// A line a lane. A lane without one has normal (0, 0) and offset -1: it cuts nothing.
  struct LineV {
    V x, y, c, index;
    M soft;
  };

  /// What cuts a stretch off: one of two lines in hand, or the disc.
  struct StretchV {
    V low, high;
    M low_first, low_second, high_first, high_second;
    M empty;
  };

  D d;
  const BatchProblems<T>& in;
  std::size_t at;  ///< the first problem of the pack
  V disc, disc_squared, px, py, noise, slack, hard_count;
  M has_hard;
  bool any_hard;

  V vx, vy, level;
  LineV first, second, third;  ///< the basis
  LineV entering;
  V worst;
  M contradiction;  ///< lanes that left the first walk infeasible
  M unsettled;      ///< lanes for the scalar solver

  HWY_INLINE Walk(D tag, const BatchProblems<T>& problems, std::size_t first_problem)
      : d(tag), in(problems), at(first_problem) {
    const V speed = hn::LoadU(d, in.disc + at);
    const T u = sizeof(T) == 8 ? static_cast<T>(0x1p-53) : static_cast<T>(0x1p-24);
    slack = hn::Mul(speed, hn::Set(d, T(16) * T(1.5) * u));
    noise = hn::Mul(speed, hn::Set(d, T(8) * u));
    disc = hn::Mul(speed, hn::Set(d, T(1) - T(8) * u));
    disc_squared = hn::Mul(disc, disc);
    px = hn::LoadU(d, in.preferred_x + at);
    py = hn::LoadU(d, in.preferred_y + at);
    hard_count = hn::Zero(d);
    if (in.hard) hard_count = load_hard_counts();
    has_hard = hn::Gt(hard_count, hn::Zero(d));
    any_hard = !hn::AllFalse(d, has_hard);
    const M none = hn::MaskFromVec(hn::Zero(d));
    contradiction = unsettled = none;
    level = hn::Zero(d);
    first = second = third = entering = nothing();
    worst = hn::Zero(d);
    const V squared = hn::Add(hn::Mul(px, px), hn::Mul(py, py));
    const V limit = hn::Mul(hn::Mul(speed, speed), hn::Set(d, T(1) - T(8) * u));
    const V shrink = hn::Div(disc, hn::Sqrt(hn::Max(squared, limit)));
    const M inside = hn::Le(squared, limit);
    vx = hn::IfThenElse(inside, px, hn::Mul(px, shrink));
    vy = hn::IfThenElse(inside, py, hn::Mul(py, shrink));
  }

  HWY_INLINE V load_hard_counts() const {
    HWY_ALIGN T counts[HWY_MAX_BYTES / sizeof(T)];
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) counts[lane] = static_cast<T>(in.hard[at + lane]);
    return hn::Load(d, counts);
  }

  HWY_INLINE LineV nothing() const {
    const V zero = hn::Zero(d);
    return {zero, zero, hn::Set(d, T(-1)), hn::Set(d, T(kNoLine)), hn::MaskFromVec(hn::Zero(d))};
  }

  static HWY_INLINE V pick(M m, V yes, V no) { return hn::IfThenElse(m, yes, no); }
  static HWY_INLINE M pick(M m, M yes, M no) { return hn::Or(hn::And(m, yes), hn::AndNot(m, no)); }
  static HWY_INLINE LineV pick(M m, const LineV& yes, const LineV& no) {
    return {pick(m, yes.x, no.x), pick(m, yes.y, no.y), pick(m, yes.c, no.c), pick(m, yes.index, no.index),
            pick(m, yes.soft, no.soft)};
  }
  static HWY_INLINE V product(V ax, V ay, V bx, V by) { return hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)); }
  static HWY_INLINE V excess(const LineV& line, V x, V y) { return hn::Sub(line.c, product(line.x, line.y, x, y)); }

  /// The most violated line a lane, soft ones against `level`. In the first walk all carry the slack.
  template <bool kRelaxing>
  HWY_INLINE void price() {
    const std::size_t start = first_line_of(in, at);
    const T* nx = in.normal_x + start;
    const T* ny = in.normal_y + start;
    const T* c = in.offset + start;
    V most = noise;
    V ex = hn::Zero(d), ey = ex, ec = ex, index = hn::Set(d, T(kNoLine));
    const V over = kRelaxing ? level : hn::Neg(slack);
    V largest = hn::Zero(d);
    for (std::size_t k = 0; k < in.lines; ++k, nx += in.block, ny += in.block, c += in.block) {
      const V x = hn::LoadU(d, nx), y = hn::LoadU(d, ny);
      V offset = hn::LoadU(d, c);
      V by = hn::Sub(hn::Sub(offset, product(x, y, vx, vy)), over);
      if (kRelaxing && any_hard) {
        const M hard = hn::Lt(hn::Set(d, static_cast<T>(k)), hard_count);
        largest = hn::IfThenElse(hard, largest, hn::Max(largest, by));
        offset = pick(hard, hn::Add(offset, slack), offset);
        by = pick(hard, hn::Sub(offset, product(x, y, vx, vy)), by);
      } else if (kRelaxing) {
        largest = hn::Max(largest, by);
      }
      const M more = hn::Gt(by, most);
      most = hn::Max(most, by);
      ex = pick(more, x, ex);
      ey = pick(more, y, ey);
      ec = pick(more, offset, ec);
      index = pick(more, hn::Set(d, static_cast<T>(k)), index);
    }
    if (!kRelaxing) ec = hn::Add(ec, slack);
    worst = most;
    largest_violation = hn::Add(largest, level);
    entering = {ex, ey, ec, index, hn::Not(hn::Lt(index, hard_count))};
  }
  V largest_violation;

  /// The part of the boundary of `line` (foot q, direction (-y, x)) inside the disc.
  HWY_INLINE StretchV inside_disc(const LineV& line, V inverse) const {
    const V room = hn::Sub(disc_squared, hn::Mul(hn::Mul(line.c, line.c), inverse));
    const V reach = hn::Sqrt(hn::Mul(hn::Max(room, hn::Zero(d)), inverse));
    const M none = hn::MaskFromVec(hn::Zero(d));
    return {hn::Neg(reach), reach, none, none, none, none, hn::Lt(room, hn::Zero(d))};
  }

  template <bool kSecond>
  HWY_INLINE void clip(StretchV& s, V qx, V qy, V dx, V dy, const LineV& other) const {
    const V zero = hn::Zero(d);
    const V slope = product(other.x, other.y, dx, dy);
    const V missing = excess(other, qx, qy);
    const V where = hn::Div(missing, slope);
    const M raises = hn::And(hn::Gt(slope, zero), hn::Gt(where, s.low));
    const M lowers = hn::And(hn::Lt(slope, zero), hn::Lt(where, s.high));
    s.low = pick(raises, where, s.low);
    s.high = pick(lowers, where, s.high);
    if (kSecond) {
      s.low_first = hn::AndNot(raises, s.low_first);
      s.high_first = hn::AndNot(lowers, s.high_first);
      s.low_second = raises;
      s.high_second = lowers;
    } else {
      s.low_first = raises;
      s.high_first = lowers;
    }
    s.empty = hn::Or(s.empty, hn::And(hn::Eq(slope, zero), hn::Gt(missing, noise)));
  }

  /// One round of the first walk for the lanes in `moving`.
  HWY_INLINE void step(M moving) {
    const LineV h = entering;
    const V inverse = hn::Div(hn::Set(d, T(1)), product(h.x, h.y, h.x, h.y));
    const V scale = hn::Mul(h.c, inverse);
    const V qx = hn::Mul(h.x, scale), qy = hn::Mul(h.y, scale);
    const V dx = hn::Neg(h.y), dy = h.x;
    StretchV s = inside_disc(h, inverse);
    clip<false>(s, qx, qy, dx, dy, first);
    clip<true>(s, qx, qy, dx, dy, second);
    const M empty = hn::Or(s.empty, hn::Gt(s.low, s.high));
    const V wish = hn::Mul(product(px, py, dx, dy), inverse);
    const M at_low = hn::Lt(wish, s.low), at_high = hn::Gt(wish, s.high);
    const V where = hn::Min(hn::Max(wish, s.low), s.high);
    const M keeps_first = hn::Or(hn::And(at_low, s.low_first), hn::And(at_high, s.high_first));
    const M keeps_second = hn::Or(hn::And(at_low, s.low_second), hn::And(at_high, s.high_second));
    const M stuck = hn::And(moving, empty);
    contradiction = hn::Or(contradiction, stuck);
    third = pick(stuck, h, third);
    const M moves = hn::AndNot(empty, moving);
    vx = pick(moves, hn::Add(qx, hn::Mul(where, dx)), vx);
    vy = pick(moves, hn::Add(qy, hn::Mul(where, dy)), vy);
    const LineV kept = pick(keeps_first, first, pick(keeps_second, second, nothing()));
    second = pick(moves, kept, second);
    first = pick(moves, h, first);
  }

  /// The nearest velocity; afterwards `contradiction` holds the infeasible lanes with their witness in the basis.
  HWY_INLINE void nearest() {
    for (int round = 0; round < kMostLockstepRounds; ++round) {
      price<false>();
      const M moving = hn::AndNot(contradiction, hn::Gt(worst, noise));
      if (hn::AllFalse(d, moving)) return;
      step(moving);
    }
    unsettled = hn::AndNot(contradiction, hn::Gt(worst, noise));
  }

  /// `line` as a half-plane on the plane of soft line `top`: where it is violated no more than top.
  HWY_INLINE LineV below(const LineV& top, const LineV& line) const {
    return {pick(line.soft, hn::Sub(line.x, top.x), line.x), pick(line.soft, hn::Sub(line.y, top.y), line.y),
            pick(line.soft, hn::Sub(line.c, top.c), line.c), line.index, line.soft};
  }

  /// The point of the plane `top` that is lowest among what the lines before `line` leave: on `line`, where violated.
  template <int kBefore>
  HWY_INLINE void descend(const LineV& top, const LineV& line, const LineV& before0, const LineV& before1, V& x, V& y,
                          M& on_line, M& on_before0, M& on_before1, M& failed) const {
    const V zero = hn::Zero(d);
    const V squared = product(line.x, line.y, line.x, line.y);
    const M violated = hn::And(hn::Gt(excess(line, x, y), zero), hn::Gt(squared, zero));
    on_line = violated;
    on_before0 = on_before1 = hn::MaskFromVec(hn::Zero(d));
    if (hn::AllFalse(d, violated)) return;
    const V inverse = hn::Div(hn::Set(d, T(1)), squared);
    const V scale = hn::Mul(line.c, inverse);
    const V qx = hn::Mul(line.x, scale), qy = hn::Mul(line.y, scale);
    const V dx = hn::Neg(line.y), dy = line.x;
    StretchV s = inside_disc(line, inverse);
    if (kBefore > 0) clip<false>(s, qx, qy, dx, dy, before0);
    if (kBefore > 1) clip<true>(s, qx, qy, dx, dy, before1);
    const V along = product(top.x, top.y, dx, dy);
    const V foot = hn::Min(hn::Max(hn::Mul(product(px, py, dx, dy), inverse), s.low), s.high);
    const M up = hn::Gt(along, zero), down = hn::Lt(along, zero);
    const V where = pick(up, s.high, pick(down, s.low, foot));
    on_before0 = hn::And(violated, hn::Or(hn::And(up, s.high_first), hn::And(down, s.low_first)));
    on_before1 = hn::And(violated, hn::Or(hn::And(up, s.high_second), hn::And(down, s.low_second)));
    failed = hn::Or(failed, hn::And(violated, hn::Or(s.empty, hn::Gt(s.low, s.high))));
    x = pick(violated, hn::Add(qx, hn::Mul(where, dx)), x);
    y = pick(violated, hn::Add(qy, hn::Mul(where, dy)), y);
  }

  /// The lowest point of the plane of `entering` above the basis; the basis becomes what binds there.
  HWY_INLINE void lowest_on_plane(M moving) {
    const LineV top = entering;
    const LineV a = below(top, first), b = below(top, second), c = below(top, third);
    const V reach = hn::Div(disc, hn::Sqrt(product(top.x, top.y, top.x, top.y)));
    V x = hn::Mul(top.x, reach), y = hn::Mul(top.y, reach);
    M failed = hn::MaskFromVec(hn::Zero(d));
    M on_a, on_b, on_c, b_a, c_a, c_b, unused0, unused1;
    descend<0>(top, a, a, a, x, y, on_a, unused0, unused1, failed);
    descend<1>(top, b, a, a, x, y, on_b, b_a, unused0, failed);
    descend<2>(top, c, a, b, x, y, on_c, c_a, c_b, failed);
    LineV bind = pick(on_c, third, pick(on_b, second, pick(on_a, first, nothing())));
    LineV also = pick(c_a, first, pick(c_b, second, nothing()));
    also = pick(hn::AndNot(on_c, b_a), first, also);
    unsettled = hn::Or(unsettled, hn::And(moving, failed));
    vx = pick(moving, x, vx);
    vy = pick(moving, y, vy);
    level = pick(moving, excess(top, x, y), level);
    first = pick(moving, top, first);
    second = pick(moving, bind, second);
    third = pick(moving, also, third);
  }

  /// The witness as a first basis of the fallback: its soft line highest.
  HWY_INLINE void start_fallback() {
    entering = third;
    third = nothing();
    const M swap_first = hn::And(contradiction, hn::AndNot(entering.soft, first.soft));
    const M swap_second = hn::And(contradiction, hn::AndNot(hn::Or(entering.soft, swap_first), second.soft));
    const LineV was = entering;
    entering = pick(swap_first, first, pick(swap_second, second, entering));
    first = pick(swap_first, was, first);
    second = pick(swap_second, was, second);
    unsettled = hn::Or(unsettled, hn::AndNot(entering.soft, contradiction));
    without_slack(entering);
    without_slack(first);
    without_slack(second);
  }

  HWY_INLINE void without_slack(LineV& line) const { line.c = pick(line.soft, hn::Sub(line.c, slack), line.c); }

  HWY_INLINE void relax() {
    start_fallback();
    M moving = hn::AndNot(unsettled, contradiction);
    for (int round = 0; round < kMostLockstepRounds && !hn::AllFalse(d, moving); ++round) {
      lowest_on_plane(moving);
      price<true>();
      const M violated = hn::And(hn::AndNot(unsettled, moving), hn::Gt(worst, noise));
      unsettled = hn::Or(unsettled, hn::AndNot(entering.soft, violated));
      settle_violation(hn::AndNot(violated, moving));
      moving = hn::AndNot(unsettled, violated);
    }
    unsettled = hn::Or(unsettled, moving);
  }

  V violation;
  HWY_INLINE void settle_violation(M done) { violation = pick(done, largest_violation, violation); }

  HWY_INLINE V positive(V x) const { return hn::Max(x, hn::Zero(d)); }
  HWY_INLINE M names(const LineV& line) const { return hn::Ge(line.index, hn::Zero(d)); }
  HWY_INLINE V given_offset(const LineV& line, M slackened) const {
    return pick(slackened, hn::Sub(line.c, slack), line.c);
  }

  /// Inequality (4) of certificate.h in rounded arithmetic. Its error stays below kProofError u times the terms.
  HWY_INLINE M optimum_is_proven(V speed) const {
    const V one = hn::Set(d, T(1)), zero = hn::Zero(d);
    const V pull_x = hn::Sub(vx, px), pull_y = hn::Sub(vy, py);
    const V squared = product(vx, vy, vx, vy);
    const V limit = hn::Mul(speed, speed);
    const M at_disc = hn::AndNot(names(second), hn::Gt(squared, hn::Mul(limit, hn::Set(d, T(1) - T(0x1p-40)))));
    const M line = names(first), single = hn::AndNot(hn::Or(names(second), at_disc), line);
    const V yx = pick(at_disc, hn::Neg(vx), second.x), yy = pick(at_disc, hn::Neg(vy), second.y);
    const V turn = hn::Sub(hn::Mul(first.x, yy), hn::Mul(first.y, yx));
    V alpha = hn::Div(hn::Sub(hn::Mul(pull_x, yy), hn::Mul(pull_y, yx)), turn);
    V beta = hn::Div(hn::Sub(hn::Mul(first.x, pull_y), hn::Mul(first.y, pull_x)), turn);
    alpha = pick(single, product(pull_x, pull_y, first.x, first.y), alpha);
    beta = hn::IfThenZeroElse(single, beta);
    beta = pick(hn::AndNot(line, at_disc), hn::Div(hn::Neg(product(pull_x, pull_y, vx, vy)), squared), beta);
    alpha = positive(hn::IfThenElseZero(line, alpha));
    beta = positive(hn::IfThenElseZero(hn::Or(line, at_disc), beta));
    const V nu = hn::IfThenElseZero(at_disc, beta);
    const V second_share = hn::IfThenZeroElse(at_disc, beta);
    const V gx = hn::Add(px, hn::Add(hn::Mul(alpha, first.x), hn::Mul(second_share, second.x)));
    const V gy = hn::Add(py, hn::Add(hn::Mul(alpha, first.y), hn::Mul(second_share, second.y)));
    const V offsets = hn::Add(hn::Mul(alpha, hn::Sub(first.c, slack)), hn::Mul(second_share, hn::Sub(second.c, slack)));
    const V pulled = hn::Div(product(gx, gy, gx, gy), hn::Add(one, nu));
    const V own = product(px, py, px, py);
    const V lower = hn::Sub(hn::Sub(hn::Add(own, hn::Add(offsets, offsets)), hn::Mul(nu, limit)), pulled);
    const V gap = hn::Sub(product(pull_x, pull_y, pull_x, pull_y), lower);
    const V terms = hn::Add(hn::Add(own, pulled), hn::Add(hn::Mul(nu, limit), hn::Add(limit, hn::Abs(offsets))));
    const V widest = hn::Mul(hn::Set(d, T(kWidestGap)), hn::Add(limit, own));
    const V error = hn::Mul(hn::Set(d, T(kProofError * 0x1p-53)), terms);
    return hn::And(hn::Le(hn::Add(gap, error), widest), hn::Ge(squared, zero));
  }

  /// Inequalities (1) and (2) of certificate.h in rounded arithmetic.
  HWY_INLINE M relaxation_is_proven(V speed) const {
    const V zero = hn::Zero(d), one = hn::Set(d, T(1));
    const M two = names(second), three = names(third);
    const auto turn = [&](V ax, V ay, V bx, V by) { return hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx)); };
    const V zx = pick(three, third.x, hn::Neg(vx)), zy = pick(three, third.y, hn::Neg(vy));
    V wa = turn(second.x, second.y, zx, zy);
    V wb = turn(zx, zy, first.x, first.y);
    V wc = hn::IfThenElseZero(three, turn(first.x, first.y, second.x, second.y));
    const M flip = hn::Lt(hn::Add(hn::Add(wa, wb), wc), zero);
    wa = positive(pick(flip, hn::Neg(wa), wa));
    wb = positive(pick(flip, hn::Neg(wb), wb));
    wc = positive(pick(flip, hn::Neg(wc), wc));
    wa = pick(two, wa, one);
    wb = hn::IfThenElseZero(two, wb);
    const V gx = hn::Add(hn::Mul(wa, first.x), hn::Add(hn::Mul(wb, second.x), hn::Mul(wc, third.x)));
    const V gy = hn::Add(hn::Mul(wa, first.y), hn::Add(hn::Mul(wb, second.y), hn::Mul(wc, third.y)));
    const M hard_a = hn::AndNot(first.soft, names(first)), hard_b = hn::AndNot(second.soft, two),
            hard_c = hn::AndNot(third.soft, three);
    const V offsets =
        hn::Add(hn::Mul(wa, given_offset(first, hard_a)),
                hn::Add(hn::Mul(wb, given_offset(second, hard_b)), hn::Mul(wc, given_offset(third, hard_c))));
    const V giving = hn::Add(hn::IfThenZeroElse(hard_a, wa),
                             hn::Add(hn::IfThenZeroElse(hard_b, wb), hn::IfThenZeroElse(hard_c, wc)));
    const V all = hn::Add(wa, hn::Add(wb, wc));
    const V surplus = hn::Sub(offsets, hn::Mul(speed, hn::Sqrt(product(gx, gy, gx, gy))));
    const V scale = hn::Add(speed, violation);
    const V error = hn::Mul(hn::Mul(hn::Set(d, T(kProofError * 0x1p-53)), all), scale);
    const V most = hn::Add(violation, hn::Mul(hn::Set(d, T(8 * 0x1p-53)), scale));
    const V missing = hn::Sub(hn::Mul(most, giving), hn::Sub(surplus, error));
    const V widest = hn::Mul(hn::Mul(hn::Set(d, T(kWidestGap)), speed), giving);
    return hn::And(hn::Gt(surplus, error), hn::Le(missing, widest));
  }

  /// Lanes whose answer is certain. What must hold was priced with slack in the last round; the disc is looked at here.
  HWY_INLINE M proven() const {
    const V speed = hn::LoadU(d, in.disc + at);
    const V inside = hn::Mul(hn::Mul(speed, speed), hn::Set(d, T(1) - T(4 * 0x1p-53)));
    const M kept = hn::Le(product(vx, vy, vx, vy), inside);
    const M right = pick(contradiction, relaxation_is_proven(speed), optimum_is_proven(speed));
    return hn::And(kept, right);
  }

  HWY_INLINE void store(const BatchAnswers<T>& out) const {
    hn::StoreU(vx, d, out.velocity_x + at);
    hn::StoreU(vy, d, out.velocity_y + at);
    hn::StoreU(violation, d, out.violation + at);
    const V status = pick(contradiction, hn::Set(d, T(1)), hn::Zero(d));
    HWY_ALIGN T lanes[4 * HWY_MAX_BYTES / sizeof(T)];
    const std::size_t n = hn::Lanes(d);
    hn::Store(status, d, lanes);
    for (std::size_t lane = 0; lane < n; ++lane) out.status[at + lane] = static_cast<std::uint8_t>(lanes[lane]);
    if (!out.active) return;
    hn::Store(first.index, d, lanes);
    hn::Store(second.index, d, lanes + n);
    hn::Store(third.index, d, lanes + 2 * n);
    for (std::size_t slot = 0; slot < 3; ++slot)
      for (std::size_t lane = 0; lane < n; ++lane)
        out.active[slot * out.stride + at + lane] = static_cast<std::int32_t>(lanes[slot * n + lane]);
  }

  /// Lanes left to the scalar solver, as bits.
  HWY_INLINE std::uint64_t run(const BatchAnswers<T>& out) {
    violation = hn::Zero(d);
    nearest();
    if (!hn::AllFalse(d, contradiction)) relax();
    store(out);
    if (out.proven) {
      const M certain = hn::AndNot(unsettled, proven());
      unsettled = hn::Not(certain);
      for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) out.proven[at + lane] = 1;
    }
    if (hn::AllFalse(d, unsettled)) return 0;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, unsettled, bits);
    std::uint64_t lanes = 0;
    for (int k = 7; k >= 0; --k) lanes = lanes << 8 | bits[k];
    return lanes;
  }
};

}  // namespace exactvo::lp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
