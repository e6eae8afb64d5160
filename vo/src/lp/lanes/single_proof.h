// SPDX-License-Identifier: GPL-3.0-or-later
// The inequalities (1), (2) and (4) of certificate.h for a problem in arrays and a solution's own multipliers, in
// doubles with a bound of their rounding errors. Certified where true; false says nothing.
//
// The gaps are written as sums of what is not negative, so that little cancels. With w = sum of lambda_i n_i, what line
// i has to spare s_i = n_i.v - c_i, and r = p + w - (1 + nu) v, inequality (4) leaves
//     2 sum of lambda_i s_i + nu (disc^2 - |v|^2) + |r|^2 / (1 + nu),
// and (2), for a violation t, with t_i = c_i - n_i.v of the soft lines,
//     (sum of lambda_i (t - t_i) over soft lines + sum of lambda_i s_i over hard ones + disc |w| - w.v) / sum over
//     soft.
// Compiled once per SIMD target, hence the toggling guard.
#if defined(EXACTVO_SINGLE_PROOF_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EXACTVO_SINGLE_PROOF_H
#undef EXACTVO_SINGLE_PROOF_H
#else
#define EXACTVO_SINGLE_PROOF_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace exactvo::lp::HWY_NAMESPACE {

/// A line, or none.
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

/// Error of a rounded c - n.v, in units of u V: two products and their sum, 2 u |n| |v| together, |n| <= 1 + 2^-10.
/// What the difference rounds is a share of itself.
inline constexpr double kViolationError = 4.0;

/// Error of each coordinate of r, in units of u of its terms, |p| + sum of lambda + (1 + nu) |v|: five sums of
/// products.
inline constexpr double kResidualError = 8.0;

/// Error of (2), in units of u (V + t) sum of lambda: t and t_i 14, w 5 and again times V 10, the root, products and
/// sums 16.
inline constexpr double kBoundError = 64.0;

/// What sums of a dozen terms that are not negative lose.
inline constexpr double kRoundedUp = 1.0 + 0x1p-40;

/// By how much lines are violated most, rounded; -infinity where there are none.
struct Worst {
  double hard = -HUGE_VAL, soft = -HUGE_VAL;
};

/// Whether the solution's multipliers prove it.
class SingleProof {
 public:
  HWY_INLINE SingleProof(const SingleProblem& problem, Vec2 velocity, Worst worst)
      : p_(problem), v_(velocity), worst_(worst), limit_(problem.disc * problem.disc) {}

  /// At most two lines bind, each with its multiplier, 0 or more; the disc is `as_line`, and its part of the gap counts
  /// twice.
  HWY_INLINE bool optimum(const Line& a, double of_a, const Line& b, double of_b) const {
    if (!(what_must_holds() & holds(worst_.soft))) return false;
    const double px = p_.preferred.x, py = p_.preferred.y, size = of_a * length(a) + of_b * length(b);
    const double residual = std::fabs((v_.x - px) - (of_a * a.x + of_b * b.x)) +
                            std::fabs((v_.y - py) - (of_a * a.y + of_b * b.y)) +
                            2.0 * kResidualError * kU * ((std::fabs(px) + std::fabs(py)) + (size + p_.disc));
    const double spare = of_a * spared(a) + of_b * spared(b) + kViolationError * kU * p_.disc * size;
    return (spare + spare + residual * residual) * kRoundedUp <= kWidestGap * (limit_ + (px * px + py * py));
  }

  /// The disc, whose normal is as long as the velocity.
  HWY_INLINE Line as_line() const { return {-v_.x, -v_.y, -limit_, -1}; }

  /// What binds by name.
  bool of(const Solution& s) const {
    const std::size_t count = s.active_count;
    for (std::size_t k = 0; k < count; ++k)
      if (!(s.active[k].multiplier >= 0.0)) return false;
    if (s.status == Status::relaxed) return least_violation(s);
    if (s.status != Status::optimal) return false;
    return optimum(count > 0 ? line_of(s.active[0].binding) : Line(), count > 0 ? s.active[0].multiplier : 0.0,
                   count > 1 ? line_of(s.active[1].binding) : Line(), count > 1 ? s.active[1].multiplier : 0.0);
  }

 private:
  static constexpr double kU = 0x1p-53;

  HWY_INLINE bool holds(double violation) const { return violation < -kViolationError * kU * p_.disc; }
  /// The disc: a product and a sum, three units of each side.
  HWY_INLINE bool what_must_holds() const {
    return (v_.x * v_.x + v_.y * v_.y <= limit_ * (1.0 - 4.0 * kU)) & holds(worst_.hard);
  }
  HWY_INLINE double length(const Line& line) const { return line.exists() ? 1.0 : p_.disc; }
  HWY_INLINE double spared(const Line& line) const { return (line.x * v_.x + line.y * v_.y) - line.c; }
  Line line_of(const Binding& binding) const {
    return binding == kDisc ? as_line() : given(p_, static_cast<std::ptrdiff_t>(binding.index));
  }

  bool least_violation(const Solution& s) const {
    double wx = 0.0, wy = 0.0, all = 0.0, giving = 0.0, spare = 0.0, violated = 0.0;
    for (std::size_t k = 0; k < s.active_count; ++k) {
      if (s.active[k].binding == kDisc) continue;
      const Line line = line_of(s.active[k].binding);
      const double multiplier = s.active[k].multiplier, by = multiplier * spared(line);
      wx += multiplier * line.x;
      wy += multiplier * line.y;
      all += multiplier;
      if (s.active[k].binding.index < p_.hard) {
        spare += by;
      } else {
        violated -= by;
        giving += multiplier;
      }
    }
    const double most = std::max(worst_.soft, 0.0),
                 across = p_.disc * std::sqrt(wx * wx + wy * wy) - (wx * v_.x + wy * v_.y);
    const double error = kBoundError * kU * (p_.disc + most) * all;
    const double missing = (most * giving - violated) + spare + across + error;
    return what_must_holds() && violated - spare - across > error &&
           missing * kRoundedUp <= kWidestGap * (1.0 - kUnitLength) * p_.disc * giving;
  }

  const SingleProblem& p_;
  Vec2 v_;
  Worst worst_;
  double limit_;
};

}  // namespace exactvo::lp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
