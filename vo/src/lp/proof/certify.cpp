// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/proof/certify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lp/problem/exact_sign.h"
#include "lp/problem/region.h"
#include "lp/problem/satisfaction.h"
#include "lp/proof/duality.h"
#include "lp/proof/multipliers.h"
#include "lp/proof/rounded_gap.h"

namespace exactvo::lp {
namespace {

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

Scope scope_of(Status status) {
  if (status == Status::relaxed) return Scope::soft_may_give;
  return status == Status::infeasible ? Scope::hard_may_give : Scope::all_must_hold;
}

/// What a gap is measured by: (V + |p|)^2 of (4), V |d| of (3), V of (2), V the largest speed in play.
double unit_of_gap(const Problem& problem, Scope scope) {
  const double speed = largest_speed(problem), p = norm(problem.preferred);
  if (scope != Scope::all_must_hold) return speed;
  return problem.objective == Objective::nearest ? (speed + p) * (speed + p) : speed * p;
}

/// The least gap tried first: rounding alone makes one as large.
double least_gap(const Problem& problem, Scope scope) {
  return std::max(kUnitRoundoff * unit_of_gap(problem, scope), std::numeric_limits<double>::min());
}

/// Finds the multipliers that prove the claim with the smallest gap.
class Search {
 public:
  Search(const Problem& problem, Scope scope, const Claim& claim, double widest)
      : problem_(problem), scope_(scope), claim_(claim), widest_(widest), least_(least_gap(problem, scope)) {}

  /// Tries the solution's own multipliers, then every choice of at most three candidates.
  void run(const Multipliers& own, const std::vector<Binding>& candidates) {
    if (own.count > 0) consider(own);
    if (!settled()) attempt({}, 0);
    for (std::size_t i = 0; i < candidates.size() && !settled(); ++i) {
      attempt({candidates[i]}, 1);
      for (std::size_t j = i + 1; j < candidates.size() && !settled(); ++j) {
        attempt({candidates[i], candidates[j]}, 2);
        for (std::size_t k = j + 1; k < candidates.size() && !settled() && scope_ != Scope::all_must_hold; ++k)
          attempt({candidates[i], candidates[j], candidates[k]}, 3);
      }
    }
  }

  bool found() const { return found_; }
  double gap() const { return gap_; }
  const Multipliers& best() const { return best_; }

 private:
  bool settled() const { return found_ && gap_ <= 64.0 * least_; }

  void attempt(const std::array<Binding, 3>& candidates, std::size_t count) {
    Chosen chosen;
    if (scope_ == Scope::all_must_hold) {
      chosen = {candidates, count};
      return consider(without_implied_disc(problem_, multipliers_of_optimum(problem_, claim_.velocity, chosen)));
    }
    for (std::size_t k = 0; k < count; ++k)
      if (candidates[k] != kDisc) chosen.binding[chosen.count++] = candidates[k];
    consider(weights_of_lines(problem_, claim_.velocity, chosen, false));
    if (chosen.count == 2) consider(weights_of_lines(problem_, claim_.velocity, chosen, true));
  }

  void consider(const Multipliers& m) {
    if (!usable(m)) return;
    const std::optional<double> gap = gap_within(m, found_ ? 0.5 * gap_ : widest_);
    if (!gap) return;
    found_ = true;
    gap_ = *gap;
    best_ = m;
  }

  /// A gap of at most `limit` with which m proves the claim: rounding settles nearly all.
  std::optional<double> gap_within(const Multipliers& m, double limit) const {
    if (is_preferred(m)) return 0.0;
    const auto rough = rounded_gap(problem_, m, scope_, claim_, Digits::of_double);
    if (rough && rough->low > limit) return std::nullopt;
    const auto fine = rounded_gap(problem_, m, scope_, claim_, Digits::twice);
    if (fine && fine->low > limit) return std::nullopt;
    if (!fine || !(fine->high <= limit) || std::isinf(fine->high)) return exact_gap_within(m, limit);
    const bool may_be_none = fine->low <= 0.0 && fine->high > 0.0;
    return may_be_none && bounds(combine(problem_, terms_of(m), scope_), 0.0) ? 0.0 : std::max(0.0, fine->high);
  }

  /// Nothing is nearer, and nothing is needed to prove that.
  bool is_preferred(const Multipliers& m) const {
    return m.count == 0 && scope_ == Scope::all_must_hold && problem_.objective == Objective::nearest &&
           claim_.velocity == problem_.preferred;
  }

  std::optional<double> exact_gap_within(const Multipliers& m, double limit) const {
    const Combination sum = combine(problem_, terms_of(m), scope_);
    for (double gap = bounds(sum, 0.0) ? 0.0 : least_; gap <= limit && std::isfinite(gap); gap *= 4.0)
      if (bounds(sum, gap)) return gap;
    return std::nullopt;
  }

  bool bounds(const Combination& sum, double gap) const {
    if (scope_ == Scope::all_must_hold) return bounds_objective(problem_, sum, claim_.velocity, gap);
    return bounds_violation(problem_, sum, claim_.violation, gap);
  }

  const Problem& problem_;
  Scope scope_;
  Claim claim_;
  double widest_;
  double least_;
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

std::vector<Binding> usable_candidates(const Problem& problem, std::vector<Binding> candidates, Scope scope) {
  const auto unusable = [&](const Binding& b) { return !can_be_used(problem, b, scope); };
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(), unusable), candidates.end());
  return candidates;
}

/// Those that count in (2), (3) or (4); none where one can't be used.
Multipliers own_multipliers(const Problem& problem, const Solution& s, Scope scope) {
  const bool disc_counts = scope == Scope::all_must_hold && problem.objective == Objective::nearest;
  Multipliers m;
  for (std::size_t k = 0; k < s.active_count; ++k) {
    const ActiveConstraint& a = s.active[k];
    if (!can_be_used(problem, a.binding, scope)) return {};
    if (a.multiplier > 0.0 && (disc_counts || a.binding != kDisc)) m.add(a.binding, a.multiplier);
  }
  return m;
}

bool proves_contradiction(const Problem& problem, const Multipliers& m, Scope scope) {
  if (const auto surplus = rounded_surplus(problem, m, scope)) {
    if (surplus->low > 0.0) return true;
    if (surplus->high <= 0.0) return false;
  }
  return contradicts(problem, combine(problem, terms_of(m), scope));
}

}  // namespace

double widest_gap_of_doubles(const Problem& problem, Status status) {
  return kWidestGap * unit_of_gap(problem, scope_of(status));
}

std::optional<Certificate> certificate_for(const Problem& problem, const Solution& solution,
                                           const std::vector<Binding>& candidates,
                                           const std::vector<Term>& contradiction, double widest_gap) {
  if (!holds(problem, solution.status, solution.velocity)) return std::nullopt;
  const Scope scope = scope_of(solution.status);
  const bool gives = scope != Scope::all_must_hold;
  const Claim claim{solution.velocity, gives ? violation_not_less(problem, solution) : 0.0};
  if (!std::isfinite(claim.violation)) return std::nullopt;
  Search search(problem, scope, claim, widest_gap);
  search.run(own_multipliers(problem, solution, scope), usable_candidates(problem, candidates, scope));
  if (!search.found()) return std::nullopt;
  Certificate c{solution.status, claim.velocity, claim.violation, {}, terms_of(search.best()), search.gap(), {}};
  if (!gives) return c;
  const bool by_itself = proves_contradiction(problem, search.best(), scope);
  if (!by_itself && !contradicts(problem, combine(problem, contradiction, scope))) return std::nullopt;
  c.contradiction = by_itself ? c.bound : contradiction;
  return c;
}

std::vector<Binding> active_bindings(const Solution& solution) {
  std::vector<Binding> bindings;
  for (std::size_t k = 0; k < solution.active_count; ++k) bindings.push_back(solution.active[k].binding);
  return bindings;
}

Certificate claim_of(const Problem& problem, const Solution& solution) {
  require_well_formed(problem);
  Certificate claim;
  claim.status = solution.status;
  claim.velocity = solution.velocity;
  if (solution.status == Status::no_interior) return claim;
  const bool gives = solution.status != Status::optimal;
  claim.bound = terms_of(own_multipliers(problem, solution, scope_of(solution.status)));
  claim.gap = widest_gap_of_doubles(problem, solution.status);
  if (!gives) return claim;
  claim.violation = violation_not_less(problem, solution);
  claim.contradiction = claim.bound;
  return claim;
}

std::optional<Certificate> certify(const Problem& problem, const Solution& solution) {
  require_well_formed(problem);
  if (solution.status == Status::no_interior || !is_finite(solution.velocity)) return std::nullopt;
  return certificate_for(problem, solution, active_bindings(solution), {},
                         widest_gap_of_doubles(problem, solution.status));
}

}  // namespace exactvo::lp
