// SPDX-License-Identifier: GPL-3.0-or-later
// The inequalities of certificate.h in lanes. Compiled once per SIMD target, hence the toggling guard.
#if defined(EXACTVO_BATCH_PROOF_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EXACTVO_BATCH_PROOF_H
#undef EXACTVO_BATCH_PROOF_H
#else
#define EXACTVO_BATCH_PROOF_H
#endif

#include "lp/lanes/pack.h"

HWY_BEFORE_NAMESPACE();
namespace exactvo::lp::HWY_NAMESPACE {

/// Roundings of a proof in units of u, of the terms before anything cancels. (4): a coordinate of p + w is wrong by 3 u
/// (|p| + sum of lambda), hence its square by 9 u |p + w| (|p| + sum of lambda); the offsets, with the slack put on and
/// taken off, by 4 u lambda |c|, twice; sums and squares add 4 u each, at most four deep. (1), (2): w and the offsets
/// likewise. Below 40 u in all.
inline constexpr double kProofError = 64.0;

/// What the square of an error adds to |p + w|, as a share of |p| + sum of lambda: above 3 u, doubled and rounded up.
inline constexpr double kSecondOrder = 0x1p-48;

template <class D>
class Proof {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using Line = LineV<D>;

 public:
  explicit HWY_INLINE Proof(const Pack<D>& pack) : p_(pack) {}

  /// Lanes of the feasibility phase whose answer is certain. What must hold was priced with slack in the last round;
  /// the disc is looked at here.
  HWY_INLINE M optimum() const { return hn::And(keeps_disc(), optimum_is_proven()); }

  /// The same for lanes of the relaxation phase.
  HWY_INLINE M relaxation() const { return hn::And(keeps_disc(), relaxation_is_proven()); }

 private:
  HWY_INLINE M keeps_disc() const {
    const V inside = hn::Mul(hn::Mul(p_.speed, p_.speed), hn::Set(p_.d, T(1) - T(4 * 0x1p-53)));
    return hn::Le(dot(p_.vx, p_.vy, p_.vx, p_.vy), inside);
  }
  HWY_INLINE V positive(V x) const { return hn::Max(x, hn::Zero(p_.d)); }
  HWY_INLINE M exists(const Line& line) const { return p_.exists(line); }
  HWY_INLINE V given_offset(const Line& line, M slackened) const {
    return pick(slackened, hn::Sub(line.c, p_.slack), line.c);
  }

  /// Inequality (4) of certificate.h in rounded arithmetic. Its error stays below kProofError u times the terms.
  HWY_INLINE M optimum_is_proven() const {
    const V one = hn::Set(p_.d, T(1)), zero = hn::Zero(p_.d);
    const V pull_x = hn::Sub(p_.vx, p_.px), pull_y = hn::Sub(p_.vy, p_.py);
    const V squared = dot(p_.vx, p_.vy, p_.vx, p_.vy);
    const V limit = hn::Mul(p_.speed, p_.speed);
    const M at_disc = hn::AndNot(exists(p_.second), hn::Gt(squared, hn::Mul(limit, hn::Set(p_.d, T(1) - T(kOnDisc)))));
    const M line = exists(p_.first), single = hn::AndNot(hn::Or(exists(p_.second), at_disc), line);
    const V yx = pick(at_disc, hn::Neg(p_.vx), p_.second.x), yy = pick(at_disc, hn::Neg(p_.vy), p_.second.y);
    const V turn = hn::Sub(hn::Mul(p_.first.x, yy), hn::Mul(p_.first.y, yx));
    V alpha = hn::Div(hn::Sub(hn::Mul(pull_x, yy), hn::Mul(pull_y, yx)), turn);
    V beta = hn::Div(hn::Sub(hn::Mul(p_.first.x, pull_y), hn::Mul(p_.first.y, pull_x)), turn);
    alpha = pick(single, dot(pull_x, pull_y, p_.first.x, p_.first.y), alpha);
    beta = hn::IfThenZeroElse(single, beta);
    beta = pick(hn::AndNot(line, at_disc), hn::Div(hn::Neg(dot(pull_x, pull_y, p_.vx, p_.vy)), squared), beta);
    alpha = positive(hn::IfThenElseZero(line, alpha));
    beta = positive(hn::IfThenElseZero(hn::Or(line, at_disc), beta));
    const V nu = hn::IfThenElseZero(at_disc, beta);
    const V second_share = hn::IfThenZeroElse(at_disc, beta);
    const V gx = hn::Add(p_.px, hn::Add(hn::Mul(alpha, p_.first.x), hn::Mul(second_share, p_.second.x)));
    const V gy = hn::Add(p_.py, hn::Add(hn::Mul(alpha, p_.first.y), hn::Mul(second_share, p_.second.y)));
    const V offsets =
        hn::Add(hn::Mul(alpha, hn::Sub(p_.first.c, p_.slack)), hn::Mul(second_share, hn::Sub(p_.second.c, p_.slack)));
    const V pulled = hn::Div(dot(gx, gy, gx, gy), hn::Add(one, nu));
    const V own = dot(p_.px, p_.py, p_.px, p_.py);
    const V lower = hn::Sub(hn::Sub(hn::Add(own, hn::Add(offsets, offsets)), hn::Mul(nu, limit)), pulled);
    const V gap = hn::Sub(dot(pull_x, pull_y, pull_x, pull_y), lower);
    const V shares = hn::Add(hn::Mul(alpha, hn::Abs(p_.first.c)), hn::Mul(second_share, hn::Abs(p_.second.c)));
    const V spread = hn::Add(hn::Add(hn::Abs(p_.px), hn::Abs(p_.py)), hn::Add(alpha, second_share));
    const V sum = hn::Add(hn::Add(hn::Abs(gx), hn::Abs(gy)), hn::Mul(hn::Set(p_.d, T(kSecondOrder)), spread));
    const V turned = hn::Div(hn::Mul(sum, spread), hn::Add(one, nu));
    const V terms = hn::Add(hn::Add(own, hn::Add(pulled, turned)), hn::Add(hn::Mul(nu, limit), hn::Add(limit, shares)));
    const V widest = hn::Mul(hn::Set(p_.d, T(kWidestGap)), hn::Add(limit, own));
    const V error = hn::Mul(hn::Set(p_.d, T(kProofError * 0x1p-53)), terms);
    return hn::And(hn::Le(hn::Add(gap, error), widest), hn::Ge(squared, zero));
  }

  /// Inequalities (1) and (2) of certificate.h in rounded arithmetic.
  HWY_INLINE M relaxation_is_proven() const {
    const V violation = positive(p_.level);
    const V zero = hn::Zero(p_.d), one = hn::Set(p_.d, T(1));
    const M two = exists(p_.second), three = exists(p_.third);
    const V zx = pick(three, p_.third.x, hn::Neg(p_.vx)), zy = pick(three, p_.third.y, hn::Neg(p_.vy));
    V wa = cross(p_.second.x, p_.second.y, zx, zy);
    V wb = cross(zx, zy, p_.first.x, p_.first.y);
    V wc = hn::IfThenElseZero(three, cross(p_.first, p_.second));
    const M flip = hn::Lt(hn::Add(hn::Add(wa, wb), wc), zero);
    wa = positive(pick(flip, hn::Neg(wa), wa));
    wb = positive(pick(flip, hn::Neg(wb), wb));
    wc = positive(pick(flip, hn::Neg(wc), wc));
    wa = pick(two, wa, one);
    wb = hn::IfThenElseZero(two, wb);
    const V gx = hn::Add(hn::Mul(wa, p_.first.x), hn::Add(hn::Mul(wb, p_.second.x), hn::Mul(wc, p_.third.x)));
    const V gy = hn::Add(hn::Mul(wa, p_.first.y), hn::Add(hn::Mul(wb, p_.second.y), hn::Mul(wc, p_.third.y)));
    const M hard_a = hn::AndNot(p_.is_soft(p_.first), exists(p_.first)),
            hard_b = hn::AndNot(p_.is_soft(p_.second), two), hard_c = hn::AndNot(p_.is_soft(p_.third), three);
    const V offsets =
        hn::Add(hn::Mul(wa, given_offset(p_.first, hard_a)),
                hn::Add(hn::Mul(wb, given_offset(p_.second, hard_b)), hn::Mul(wc, given_offset(p_.third, hard_c))));
    const V giving = hn::Add(hn::IfThenZeroElse(hard_a, wa),
                             hn::Add(hn::IfThenZeroElse(hard_b, wb), hn::IfThenZeroElse(hard_c, wc)));
    const V all = hn::Add(wa, hn::Add(wb, wc));
    const V surplus = hn::Sub(offsets, hn::Mul(p_.speed, hn::Sqrt(dot(gx, gy, gx, gy))));
    const V scale = hn::Add(p_.speed, violation);
    const V error = hn::Mul(hn::Mul(hn::Set(p_.d, T(kProofError * 0x1p-53)), all), scale);
    const V most = hn::Add(violation, hn::Mul(hn::Set(p_.d, T(16 * 0x1p-53)), scale));  // others: noise and rounding
    const V missing = hn::Sub(hn::Mul(most, giving), hn::Sub(surplus, error));
    const V widest = hn::Mul(hn::Mul(hn::Set(p_.d, T(kWidestGap)), p_.speed), giving);
    return hn::And(hn::Gt(surplus, error), hn::Le(missing, widest));
  }

  const Pack<D>& p_;
};

}  // namespace exactvo::lp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
