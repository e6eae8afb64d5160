// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/proof/certify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "exactvo/geometry/infinity.h"
#include "lp/problem/exact_sign.h"
#include "lp/problem/region.h"
#include "lp/proof/duality.h"
#include "lp/proof/multipliers.h"

namespace exactvo::lp {
namespace {

using geometry::kInfinity;

/// What multipliers may be: a double each, chosen and proven in doubles, or the exact ones where no doubles do.
enum class Stage { doubles, exact };

bool usable(const Multipliers& m) {
  return std::all_of(m.value.begin(), m.value.begin() + m.count, [](double x) { return std::isfinite(x) && x >= 0.0; });
}

std::vector<Term> terms_of(const Multipliers& m) {
  std::vector<Term> terms;
  for (std::size_t k = 0; k < m.count; ++k)
    if (m.value[k] > 0.0) terms.push_back({m.binding[k], {m.value[k]}});
  return terms;
}

/// The disc's multiplier is part of the proof for the nearest velocity only.
Multipliers without_implied_disc(const Problem& problem, const Multipliers& all) {
  if (problem.objective == Objective::nearest) return all;
  Multipliers m;
  for (std::size_t k = 0; k < all.count; ++k)
    if (all.binding[k] != kDisc) m.add(all.binding[k], all.value[k]);
  return m;
}

/// The longest normal of the terms that may be violated: violations are in units of |n|.
double length_of_giving(const Problem& problem, Scope scope, const Multipliers& m) {
  double longest = 0.0;
  for (std::size_t k = 0; k < m.count; ++k)
    if (may_give(problem, m.binding[k], scope))
      longest = std::max(longest, norm(half_plane_at(problem, m.binding[k]).normal));
  return longest;
}

/// The unit of a claim's gap. V is the largest speed that occurs in the problem. Without a bound a vertex may lie far
/// beyond it, where it is |v| of the exact optimum; a velocity in doubles that lies there is more likely wrong.
class UnitOfGap {
 public:
  UnitOfGap(const Problem& problem, Scope scope, const Claim& claim, Stage stage)
      : problem_(problem), scope_(scope), violation_(claim.violation) {
    const double p = norm(problem.preferred), least = stage == Stage::exact ? norm(claim.velocity) : 0.0;
    const double speed = std::max(largest_speed(problem), least);
    if (scope != Scope::all_must_hold)
      unit_ = speed;
    else
      unit_ = problem.objective == Objective::nearest ? (speed + p) * (speed + p) : speed * p;
  }

  /// (V + |p|)^2 of (4), V |d| of (3), of (2) the violation or V |n|, whichever is more.
  double of(const Multipliers& m) const {
    if (scope_ == Scope::all_must_hold) return unit_;
    return std::max(violation_, unit_ * length_of_giving(problem_, scope_, m));
  }

 private:
  const Problem& problem_;
  Scope scope_;
  double violation_;
  double unit_;
};

/// Rounding alone makes a gap as large as this share of its unit.
double least_gap(double unit) {
  return std::max(kUnitRoundoff * unit, std::numeric_limits<double>::min());
}

bool bounds(const Problem& problem, Scope scope, const Claim& claim, const Combination& sum, double gap) {
  if (scope == Scope::all_must_hold) return bounds_objective(problem, sum, claim.velocity, gap);
  return bounds_violation(problem, sum, claim.violation, gap);
}

/// The least gap of `least`, 4 `least`, 16 `least`, ... with which the sum proves the claim, at most `limit`.
std::optional<double> exact_gap(const Problem& problem, Scope scope, const Claim& claim, const Combination& sum,
                                double least, double limit) {
  for (double gap = bounds(problem, scope, claim, sum, 0.0) ? 0.0 : least; gap <= limit && std::isfinite(gap);
       gap *= 4.0)
    if (bounds(problem, scope, claim, sum, gap)) return gap;
  return std::nullopt;
}

/// Nothing is nearer, and nothing is needed to prove that.
bool is_preferred(const Problem& problem, Scope scope, const Claim& claim, const Multipliers& m) {
  return m.count == 0 && scope == Scope::all_must_hold && problem.objective == Objective::nearest &&
         claim.velocity == problem.preferred;
}

/// Finds the multipliers that prove the claim with the smallest gap.
class Search {
 public:
  Search(const Problem& problem, Scope scope, const Claim& claim, Stage stage)
      : problem_(problem), scope_(scope), claim_(claim), stage_(stage), unit_(problem, scope, claim, stage) {}

  /// Tries the solution's own multipliers, then every choice of at most three of `count` candidates.
  void run(const Multipliers& own, const Binding* candidates, std::size_t count) {
    if (own.count > 0) consider(own);
    if (!settled()) attempt({});
    for (std::size_t i = 0; i < count && !settled(); ++i) {
      attempt({candidates[i]});
      for (std::size_t j = i + 1; j < count && !settled(); ++j) {
        attempt({candidates[i], candidates[j]});
        for (std::size_t k = j + 1; k < count && !settled() && scope_ != Scope::all_must_hold; ++k)
          attempt({candidates[i], candidates[j], candidates[k]});
      }
    }
  }

  bool found() const { return found_; }
  bool is_tight() const { return found_ && gap_ <= kWidestGap * unit_.of(best_); }
  double gap() const { return gap_; }
  const Multipliers& best() const { return best_; }

 private:
  bool settled() const { return found_ && gap_ <= 64.0 * least_gap(unit_.of(best_)); }

  double widest(const Multipliers& m) const { return stage_ == Stage::exact ? kInfinity : kWidestGap * unit_.of(m); }

  void attempt(std::initializer_list<Binding> candidates) {
    Multipliers chosen;
    for (const Binding candidate : candidates)
      if (scope_ == Scope::all_must_hold || candidate != kDisc) chosen.add(candidate);
    if (scope_ == Scope::all_must_hold) {
      consider(without_implied_disc(problem_, multipliers_of_optimum(problem_, claim_.velocity, chosen)));
    } else {
      consider(weights_of_lines(problem_, claim_.velocity, chosen, false));
      if (chosen.count == 2) consider(weights_of_lines(problem_, claim_.velocity, chosen, true));
    }
    consider_touching(chosen);
  }

  /// A line that may touch the disc, and at the least violation what is violated there.
  void consider_touching(const Multipliers& chosen) {
    if (chosen.count != 2 || !std::isfinite(problem_.bound.disc) || settled()) return;
    for (std::size_t k = 0; k < 2; ++k) {
      const Binding line = chosen.binding[k], other = chosen.binding[1 - k];
      if (scope_ == Scope::all_must_hold) {
        if (line != kDisc && other == kDisc) consider(multipliers_where_touching(problem_, claim_.velocity, line));
      } else if (!may_give(problem_, line, scope_) && may_give(problem_, other, scope_)) {
        consider(weights_where_touching(problem_, line, other));
      }
    }
  }

  void consider(const Multipliers& m) {
    if (!usable(m)) return;
    const std::optional<double> gap = gap_within(m, found_ ? 0.5 * gap_ : widest(m));
    if (!gap) return;
    found_ = true;
    gap_ = *gap;
    best_ = m;
  }

  /// A gap of at most `limit` with which m proves the claim: rounding settles nearly all.
  std::optional<double> gap_within(const Multipliers& m, double limit) const {
    if (is_preferred(problem_, scope_, claim_, m)) return 0.0;
    const auto rough = rounded_gap(problem_, m, scope_, claim_, Digits::of_double);
    if (rough && rough->low > limit) return std::nullopt;
    const auto fine = rounded_gap(problem_, m, scope_, claim_, Digits::twice);
    if (fine && fine->low > limit) return std::nullopt;
    const auto sum = [&] { return combine(problem_, terms_of(m), scope_); };
    if (!fine || !(fine->high <= limit) || std::isinf(fine->high))
      return exact_gap(problem_, scope_, claim_, sum(), least_gap(unit_.of(m)), limit);
    const bool may_be_none = fine->low <= 0.0 && fine->high > 0.0;
    return may_be_none && bounds(problem_, scope_, claim_, sum(), 0.0) ? 0.0 : std::max(0.0, fine->high);
  }

  const Problem& problem_;
  Scope scope_;
  Claim claim_;
  Stage stage_;
  UnitOfGap unit_;
  bool found_ = false;
  double gap_ = 0.0;
  Multipliers best_;
};

/// What products may lose below the normal range.
constexpr double kUnderflow = 0x1p-1060;

/// A solver's violation is rounded; the certificate's must not be too small. Infinite or no number where a product
/// leaves the range of double.
double violation_not_less(const Problem& problem, const Solution& s) {
  const Priority gives = s.status == Status::infeasible ? Priority::hard : Priority::soft;
  double most = 0.0;
  for (const Constraint& c : problem.constraints) {
    if (c.priority != gives) continue;
    const HalfPlane& h = c.half_plane;
    const double terms = std::abs(h.offset) + std::abs(h.normal.x * s.velocity.x) + std::abs(h.normal.y * s.velocity.y);
    const double by = geometry::violation(h, s.velocity) + 4.0 * kUnitRoundoff * terms + kUnderflow;
    if (!(by <= most)) most = by;  // also where it is no number
  }
  return most;
}

/// What a certificate of the solution claims; nothing where it is not so.
std::optional<Claim> claim_that_holds(const Problem& problem, const Solution& s) {
  if (s.status == Status::no_interior || !is_finite(s.velocity)) return std::nullopt;
  if (!holds(problem, s.status, s.velocity)) return std::nullopt;
  const bool gives = s.status != Status::optimal;
  const Claim claim{s.velocity, gives ? violation_not_less(problem, s) : 0.0};
  return std::isfinite(claim.violation) ? std::optional<Claim>(claim) : std::nullopt;
}

std::vector<Binding> usable_candidates(const Problem& problem, std::vector<Binding> candidates, Scope scope) {
  const auto unusable = [&](const Binding& b) { return !can_be_used(problem, b, scope); };
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(), unusable), candidates.end());
  return candidates;
}

/// Whether they contradict by (1): rounding settles nearly all.
bool proves_contradiction(const Problem& problem, const Multipliers& m, Scope scope) {
  Multipliers positive;
  for (std::size_t k = 0; k < m.count; ++k)
    if (m.value[k] > 0.0) positive.add(m.binding[k], m.value[k]);
  if (const auto surplus = rounded_surplus(problem, positive, scope)) {
    if (surplus->low > 0.0) return true;
    if (surplus->high <= 0.0) return false;
  }
  return contradicts(problem, combine(problem, terms_of(positive), scope));
}

bool proves_contradiction(const Problem& problem, const std::vector<Term>& terms, Scope scope) {
  const std::optional<Multipliers> m = in_doubles(terms);
  return m ? proves_contradiction(problem, *m, scope) : contradicts(problem, combine(problem, terms, scope));
}

/// Terms of (2), (3) or (4), and the gap with which they prove a claim.
struct Bound {
  std::vector<Term> terms;
  double gap = 0.0;
};

/// The gap of (2) where the normals of `sum` cancel: violation - offset / giving, rounded up. Infinite or no number
/// where that leaves the range of double.
double gap_where_cancelling(const Claim& claim, const Combination& sum) {
  constexpr double kUp = 1.0 + 8.0 * kUnitRoundoff;  // of two conversions, a division and this product
  return kUp * ((Exact(claim.violation) * sum.giving - sum.offset).to_double() / sum.giving.to_double());
}

/// Multipliers in double leave a sum of normals of about u, which an unbounded velocity multiplies by more than any
/// number. With exact multipliers the sum of two or three lines is 0.
std::optional<Bound> exact_bound(const Problem& problem, Scope scope, const Claim& claim,
                                 const std::vector<Binding>& lines) {
  const UnitOfGap unit(problem, scope, claim, Stage::exact);
  std::optional<Bound> best;
  const auto consider = [&](const std::vector<Binding>& chosen) {
    Multipliers names;
    for (const Binding& line : chosen) names.add(line);
    const double least = least_gap(unit.of(names)), limit = best ? 0.5 * best->gap : kInfinity;
    if (best && best->gap <= 64.0 * least) return;
    const std::vector<Term> terms = cancelling_terms(problem, chosen);
    const Combination sum = combine(problem, terms, scope);
    if (terms.empty() || sign_of(sum.giving) <= 0) return;
    const double estimate = gap_where_cancelling(claim, sum);
    const double first = estimate > least && estimate < kInfinity ? estimate : least;
    if (const auto gap = exact_gap(problem, scope, claim, sum, first, limit)) best = Bound{terms, *gap};
  };
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      consider({lines[i], lines[j]});
      for (std::size_t k = j + 1; k < lines.size(); ++k) consider({lines[i], lines[j], lines[k]});
    }
  return best;
}

std::optional<Bound> bound_of(const Problem& problem, Scope scope, const Claim& claim, const Multipliers& own,
                              std::vector<Binding> candidates) {
  Search search(problem, scope, claim, Stage::exact);
  search.run(own, candidates.data(), candidates.size());
  std::optional<Bound> bound;
  if (search.found()) bound = Bound{terms_of(search.best()), search.gap()};
  if (scope == Scope::all_must_hold || search.is_tight()) return bound;
  candidates.erase(std::remove(candidates.begin(), candidates.end(), kDisc), candidates.end());
  std::optional<Bound> exact = exact_bound(problem, scope, claim, candidates);
  return exact && !(bound && bound->gap <= exact->gap) ? exact : bound;
}

}  // namespace

std::optional<Certificate> certificate_for(const Problem& problem, const Solution& solution,
                                           const std::vector<Binding>& candidates,
                                           const std::vector<Term>& contradiction) {
  const std::optional<Claim> claim = claim_that_holds(problem, solution);
  if (!claim) return std::nullopt;
  const Scope scope = scope_of(solution.status);
  const auto bound = bound_of(problem, scope, *claim, own_multipliers(problem, solution),
                              usable_candidates(problem, candidates, scope));
  if (!bound) return std::nullopt;
  Certificate c{solution.status, claim->velocity, claim->violation, {}, bound->terms, bound->gap, {}};
  if (scope == Scope::all_must_hold) return c;
  const bool by_itself = proves_contradiction(problem, c.bound, scope);
  if (!by_itself && !contradicts(problem, combine(problem, contradiction, scope))) return std::nullopt;
  c.contradiction = by_itself ? c.bound : contradiction;
  return c;
}

bool is_tight(const Problem& problem, const Certificate& c) {
  constexpr double kWidestOfOptimum = 0x1p-20;
  const Scope scope = scope_of(c.status);
  Multipliers names;
  for (const Term& term : c.bound) names.add(term.binding);
  const double unit = UnitOfGap(problem, scope, {c.velocity, c.violation}, Stage::exact).of(names);
  return c.gap <= (scope == Scope::all_must_hold ? kWidestOfOptimum : kWidestGap) * unit;
}

Certificate claim_of(const Problem& problem, const Solution& solution) {
  require_well_formed(problem);
  Certificate claim;
  claim.status = solution.status;
  claim.velocity = solution.velocity;
  if (solution.status == Status::no_interior) return claim;
  const Scope scope = scope_of(solution.status);
  const Multipliers own = own_multipliers(problem, solution);
  claim.bound = terms_of(own);
  if (scope != Scope::all_must_hold) {
    claim.violation = violation_not_less(problem, solution);
    claim.contradiction = claim.bound;
  }
  claim.gap = kWidestGap * UnitOfGap(problem, scope, {claim.velocity, claim.violation}, Stage::doubles).of(own);
  return claim;
}

bool own_multipliers_prove(const Problem& problem, const Solution& solution) {
  const Scope scope = scope_of(solution.status);
  const std::optional<Claim> claim = claim_that_holds(problem, solution);
  if (!claim) return false;
  const Multipliers own = own_multipliers(problem, solution);
  if (!usable(own)) return false;
  if (is_preferred(problem, scope, *claim, own)) return true;
  const auto gap = rounded_gap(problem, own, scope, *claim, Digits::of_double);
  if (!gap || !(gap->high <= kWidestGap * UnitOfGap(problem, scope, *claim, Stage::doubles).of(own))) return false;
  return scope == Scope::all_must_hold || proves_contradiction(problem, own, scope);
}

std::optional<ProofInDoubles> proof_in_doubles(const Problem& problem, const Solution& solution) {
  const Scope scope = scope_of(solution.status);
  const std::optional<Claim> claim = claim_that_holds(problem, solution);
  if (!claim) return std::nullopt;
  std::array<Binding, 3> candidates{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < solution.active_count; ++k)
    if (can_be_used(problem, solution.active[k].binding, scope)) candidates[count++] = solution.active[k].binding;
  Search search(problem, scope, *claim, Stage::doubles);
  search.run(own_multipliers(problem, solution), candidates.data(), count);
  const bool gives = scope != Scope::all_must_hold;
  if (!search.found() || (gives && !proves_contradiction(problem, search.best(), scope))) return std::nullopt;
  return ProofInDoubles{*claim, search.best(), search.gap()};
}

Certificate certificate_of(const ProofInDoubles& proof, Status status) {
  Certificate c{status, proof.claim.velocity, proof.claim.violation, {}, terms_of(proof.bound), proof.gap, {}};
  if (scope_of(status) != Scope::all_must_hold) c.contradiction = c.bound;
  return c;
}

std::optional<Certificate> certify(const Problem& problem, const Solution& solution) {
  require_well_formed(problem);
  const std::optional<ProofInDoubles> proof = proof_in_doubles(problem, solution);
  if (!proof) return std::nullopt;
  return certificate_of(*proof, solution.status);
}

}  // namespace exactvo::lp
