// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "duality.h"
#include "exact_sign.h"
#include "region.h"

namespace exactvo::lp {
namespace {

/// A choice of at most three of the candidates and a double each.
struct Multipliers {
  std::array<std::size_t, 3> constraint{};
  std::array<double, 3> value{};
  std::size_t count = 0;
  void add(std::size_t index, double multiplier) {
    constraint[count] = index;
    value[count++] = multiplier;
  }
};

bool usable(const Multipliers& m) {
  return std::all_of(m.value.begin(), m.value.begin() + m.count, [](double x) { return std::isfinite(x) && x >= 0.0; });
}

std::vector<Term> terms_of(const Multipliers& m) {
  std::vector<Term> terms;
  for (std::size_t k = 0; k < m.count; ++k)
    if (m.value[k] > 0.0) terms.push_back({m.constraint[k], {m.value[k]}});
  return terms;
}

/// Least (a, b) with a x + b y = sum; rounded.
std::array<double, 2> solve_pair(Vec2 x, Vec2 y, Vec2 sum) {
  const double determinant = cross(x, y);
  return {cross(sum, y) / determinant, cross(x, sum) / determinant};
}

/// Stationarity at the optimum: what the normals (and for the disc -v) must add up to.
Vec2 pull(const Problem& problem, Vec2 v) {
  return problem.objective == Objective::nearest ? v - problem.preferred : -problem.preferred;
}

Vec2 column(const Problem& problem, std::size_t index, Vec2 v) {
  return index == kSpeedBound ? -v : half_plane_at(problem, index).normal;
}

/// nu of (4), |p|/|v| - 1 where the disc binds alone. Beyond 1/u a larger one moves the bound by less than u |p|^2, the
/// least gap anyway; a disc of 0, or one whose square underflows, has no other.
double multiplier_of_disc(Vec2 sum, Vec2 towards_centre) {
  constexpr double kMost = 1.0 / kUnitRoundoff;
  const double nu = dot(sum, towards_centre) / squared_norm(towards_centre);
  return nu < kMost ? std::max(0.0, nu) : kMost;  // also where nu is 0/0
}

/// The disc's multiplier is part of the proof for the nearest velocity only.
void add_unless_implied(const Problem& problem, std::size_t index, double value, Multipliers& m) {
  if (index != kSpeedBound || problem.objective == Objective::nearest) m.add(index, value);
}

Multipliers of_optimum(const Problem& problem, Vec2 v, const std::vector<std::size_t>& chosen) {
  Multipliers m;
  const Vec2 sum = pull(problem, v);
  if (chosen.size() == 1) {
    const Vec2 x = column(problem, chosen[0], v);
    const bool is_disc = chosen[0] == kSpeedBound;
    const double multiplier = is_disc ? multiplier_of_disc(sum, x) : std::max(0.0, dot(sum, x) / squared_norm(x));
    add_unless_implied(problem, chosen[0], multiplier, m);
  } else if (chosen.size() == 2) {
    const auto pair = solve_pair(column(problem, chosen[0], v), column(problem, chosen[1], v), sum);
    add_unless_implied(problem, chosen[0], std::max(0.0, pair[0]), m);
    add_unless_implied(problem, chosen[1], std::max(0.0, pair[1]), m);
  }
  return m;
}

/// Weights whose sum of normals vanishes, or where the disc binds points along v.
Multipliers of_least_violation(const Problem& problem, Vec2 v, const std::vector<std::size_t>& chosen, bool on_disc) {
  Multipliers m;
  const auto normal = [&](std::size_t k) { return half_plane_at(problem, chosen[k]).normal; };
  if (chosen.size() == 1) {
    m.add(chosen[0], 1.0);
  } else if (chosen.size() == 2) {
    const Vec2 a = normal(0), b = normal(1);
    const double turn = std::copysign(1.0, cross(a, b));
    m.add(chosen[0], on_disc ? turn * cross(v, b) : norm(b));
    m.add(chosen[1], on_disc ? turn * cross(a, v) : norm(a));
  } else if (chosen.size() == 3) {
    const Vec2 a = normal(0), b = normal(1), c = normal(2);
    const std::array<double, 3> w = {cross(b, c), cross(c, a), cross(a, b)};
    const double turn = std::copysign(1.0, w[0] + w[1] + w[2]);
    for (std::size_t k = 0; k < 3; ++k) m.add(chosen[k], turn * w[k]);
  }
  return m;
}

Scope scope_of(Status status) {
  if (status == Status::relaxed) return Scope::soft_may_give;
  return status == Status::infeasible ? Scope::hard_may_give : Scope::all_must_hold;
}

double speed_of(const Problem& problem) {
  return region_of(problem).speed;
}

class Search {
 public:
  Search(const Problem& problem, const Solution& solution, double widest)
      : problem_(problem), solution_(solution), scope_(scope_of(solution.status)), widest_(widest) {
    const double speed = speed_of(problem);
    const double p = norm(problem.preferred);
    if (scope_ != Scope::all_must_hold)
      least_gap_ = kUnitRoundoff * speed;
    else
      least_gap_ = kUnitRoundoff * (problem.objective == Objective::nearest ? (speed + p) * (speed + p) : speed * p);
    least_gap_ = std::max(least_gap_, std::numeric_limits<double>::min());
  }

  /// Tries every choice of at most three candidates.
  void run(const std::vector<std::size_t>& candidates) {
    attempt({});
    for (std::size_t i = 0; i < candidates.size() && !settled(); ++i) {
      attempt({candidates[i]});
      for (std::size_t j = i + 1; j < candidates.size() && !settled(); ++j) {
        attempt({candidates[i], candidates[j]});
        for (std::size_t k = j + 1; k < candidates.size() && !settled() && scope_ != Scope::all_must_hold; ++k)
          attempt({candidates[i], candidates[j], candidates[k]});
      }
    }
  }

  bool found() const { return found_; }
  double gap() const { return best_gap_; }
  const std::vector<Term>& terms() const { return best_; }

 private:
  bool settled() const { return found_ && best_gap_ <= 64.0 * least_gap_; }

  void attempt(const std::vector<std::size_t>& chosen) {
    if (scope_ == Scope::all_must_hold) {
      consider(of_optimum(problem_, solution_.velocity, chosen));
      return;
    }
    std::vector<std::size_t> lines;
    for (const std::size_t k : chosen)
      if (k != kSpeedBound) lines.push_back(k);
    consider(of_least_violation(problem_, solution_.velocity, lines, false));
    if (lines.size() == 2) consider(of_least_violation(problem_, solution_.velocity, lines, true));
  }

  void consider(const Multipliers& m) {
    if (!usable(m)) return;
    const std::vector<Term> terms = terms_of(m);
    const Combination sum = combine(problem_, terms, scope_);
    if (!sum.well_formed) return;
    const double limit = found_ ? 0.5 * best_gap_ : widest_;
    for (double gap = bounds(sum, 0.0) ? 0.0 : least_gap_; gap <= limit && std::isfinite(gap); gap *= 4.0) {
      if (bounds(sum, gap)) {
        found_ = true;
        best_gap_ = gap;
        best_ = terms;
        return;
      }
    }
  }

  bool bounds(const Combination& sum, double gap) const {
    if (scope_ == Scope::all_must_hold) return bounds_objective(problem_, sum, solution_.velocity, gap);
    return bounds_violation(problem_, sum, solution_.violation, gap);
  }

  const Problem& problem_;
  const Solution& solution_;
  Scope scope_;
  double widest_;
  double least_gap_ = 0.0;
  bool found_ = false;
  double best_gap_ = 0.0;
  std::vector<Term> best_;
};

/// A solver's violation is rounded; the certificate's must not be too small.
double violation_not_less(const Problem& problem, const Solution& s) {
  const Priority gives = s.status == Status::infeasible ? Priority::hard : Priority::soft;
  double most = 0.0;
  for (const Constraint& c : problem.constraints) {
    if (c.priority != gives) continue;
    const HalfPlane& h = c.half_plane;
    const double terms = std::abs(h.offset) + std::abs(h.normal.x * s.velocity.x) + std::abs(h.normal.y * s.velocity.y);
    most = std::max(most, geometry::violation(h, s.velocity) + 4.0 * kUnitRoundoff * terms);
  }
  return most;
}

}  // namespace

double widest_gap_of_doubles(const Problem& problem, Status status) {
  const double speed = speed_of(problem);
  if (status != Status::optimal) return kWidestGap * speed;
  const double p = norm(problem.preferred);
  return kWidestGap * (problem.objective == Objective::nearest ? (speed + p) * (speed + p) : speed * p);
}

std::optional<Certificate> certificate_for(const Problem& problem, const Solution& given,
                                           const std::vector<std::size_t>& candidates,
                                           const std::vector<Term>& contradiction, double widest_gap) {
  Solution solution = given;
  const bool gives = given.status == Status::relaxed || given.status == Status::infeasible;
  if (gives) solution.violation = violation_not_less(problem, given);
  Search search(problem, solution, widest_gap);
  search.run(candidates);
  if (!search.found()) return std::nullopt;
  Certificate c{given.status, given.velocity, gives ? solution.violation : 0.0, {}, search.terms(), search.gap(), {}};
  if (gives) {
    c.contradiction = search.terms();
    if (!contradicts(problem, combine(problem, c.contradiction, scope_of(given.status))))
      c.contradiction = contradiction;
  }
  if (check(problem, c) != Flaw::none) return std::nullopt;
  return c;
}

std::optional<Certificate> certify(const Problem& problem, const Solution& solution) {
  require_well_formed(problem);
  if (solution.status == Status::pinched || !is_finite(solution.velocity)) return std::nullopt;
  const std::vector<std::size_t> active(solution.active.begin(), solution.active.begin() + solution.active_count);
  return certificate_for(problem, solution, active, {}, widest_gap_of_doubles(problem, solution.status));
}

}  // namespace exactvo::lp
