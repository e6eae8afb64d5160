// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/proof/multipliers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lp/problem/region.h"
#include "lp/proof/duality.h"

namespace exactvo::lp {
namespace {

/// Whether products of a normal with itself and others neither underflow nor overflow.
bool has_usual_length(Vec2 normal) {
  const double squared = squared_norm(normal);
  return squared > 0x1p-400 && squared < 0x1p400;
}

/// A multiplier of a normal that is `length` times as long, where doubles reach so far.
double for_length(double multiplier, double length) {
  return std::min(multiplier / length, std::numeric_limits<double>::max());
}

/// (a, b) with a x + b y = sum; rounded. Not finite where x and y are parallel.
std::array<double, 2> solve_pair(Vec2 x, Vec2 y, Vec2 sum) {
  if (!has_usual_length(x) || !has_usual_length(y)) {
    const double of_x = std::hypot(x.x, x.y), of_y = std::hypot(y.x, y.y);
    const Vec2 u = x / of_x, v = y / of_y;
    const double turn = cross(u, v);
    return {for_length(cross(sum, v) / turn, of_x), for_length(cross(u, sum) / turn, of_y)};
  }
  const double determinant = cross(x, y);
  return {cross(sum, y) / determinant, cross(x, sum) / determinant};
}

/// The share of `sum` along a normal.
double solve_one(Vec2 normal, Vec2 sum) {
  if (has_usual_length(normal)) return std::max(0.0, dot(sum, normal) / squared_norm(normal));
  const double length = std::hypot(normal.x, normal.y);
  return for_length(std::max(0.0, dot(sum, normal / length)), length);
}

/// What the normals, and for the disc -v, must add up to.
Vec2 pull(Objective objective, Vec2 preferred, Vec2 v) {
  return objective == Objective::nearest ? v - preferred : -preferred;
}

/// Beyond 1/u a larger nu moves the bound of (4) by less than u |p|^2, the least gap anyway.
constexpr double kMostOfDisc = 1.0 / kUnitRoundoff;

/// nu of (4), |p|/|v| - 1 where the disc binds alone. A disc of 0, or one whose square underflows, has no other than
/// the largest.
double multiplier_of_disc(Vec2 sum, Vec2 towards_centre) {
  const double nu = dot(sum, towards_centre) / squared_norm(towards_centre);
  return nu < kMostOfDisc ? std::max(0.0, nu) : kMostOfDisc;  // also where nu is 0/0
}

double multiplier_of_one(Binding binding, Vec2 column, Vec2 sum) {
  return binding == kDisc ? multiplier_of_disc(sum, column) : solve_one(column, sum);
}

/// Weights of the first `count` lines. `on_disc` matters only where there are two.
std::array<double, 3> weights_of(const Normals& n, std::size_t count, Vec2 v, bool on_disc) {
  if (count == 3) {
    const std::array<double, 3> w = {cross(n[1], n[2]), cross(n[2], n[0]), cross(n[0], n[1])};
    const double turn = std::copysign(1.0, w[0] + w[1] + w[2]);
    return {turn * w[0], turn * w[1], turn * w[2]};
  }
  if (count != 2) return {1.0, 0.0, 0.0};
  const double turn = std::copysign(1.0, cross(n[0], n[1]));
  return {on_disc ? turn * cross(v, n[1]) : norm(n[1]), on_disc ? turn * cross(n[0], v) : norm(n[0]), 0.0};
}

/// What is active, as vectors that add up to `wanted`.
class Stationarity {
 public:
  Stationarity(const Normals& normals, Objective objective, Vec2 preferred, Solution& s)
      : s_(s),
        columns_(normals),
        wanted_(s.status == Status::optimal ? pull(objective, preferred, s.velocity) : Vec2{}) {
    for (std::size_t k = 0; k < s.active_count; ++k)
      if (s.active[k].binding == kDisc) columns_[k] = -s.velocity;
  }

  /// Where two are listed as binding, one that pulls the wrong way binds in name only.
  void set_of_optimum() {
    if (s_.active_count == 0) return;
    if (s_.active_count == 1) return set_alone(0);
    const auto pair = solve_pair(columns_[0], columns_[1], wanted_);
    const bool both = std::isfinite(pair[0]) && std::isfinite(pair[1]);
    if (!both || pair[1] <= 0.0) return set_alone(0);
    if (pair[0] <= 0.0) return set_alone(1);
    s_.active[0].multiplier = pair[0];
    s_.active[1].multiplier = pair[1];
  }

  void set_of_least_violation() {
    std::array<std::size_t, 3> line{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < s_.active_count; ++k)
      if (s_.active[k].binding != kDisc) line[count++] = k;
    const Normals normals = {columns_[line[0]], columns_[line[1]], columns_[line[2]]};
    const std::array<double, 3> weight = weights_of(normals, count, s_.velocity, s_.active_count == 3);
    for (std::size_t k = 0; k < count; ++k)
      s_.active[line[k]].multiplier = weight[k] > 0.0 && std::isfinite(weight[k]) ? weight[k] : 0.0;
    set_of_disc();
  }

  /// nu, so that lines and disc add up. REQUIRES: the lines' multipliers.
  void set_of_disc() {
    Vec2 missing = wanted_;
    for (std::size_t k = 0; k < s_.active_count; ++k)
      if (s_.active[k].binding != kDisc) missing = missing - s_.active[k].multiplier * columns_[k];
    for (std::size_t k = 0; k < s_.active_count; ++k)
      if (s_.active[k].binding == kDisc) s_.active[k].multiplier = multiplier_of_disc(missing, columns_[k]);
  }

 private:
  void set_alone(std::size_t k) {
    s_.active[k].multiplier = multiplier_of_one(s_.active[k].binding, columns_[k], wanted_);
  }

  Solution& s_;
  Normals columns_;
  Vec2 wanted_;
};

Normals normals_of(const Problem& problem, const Solution& s) {
  Normals normals{};
  for (std::size_t k = 0; k < s.active_count; ++k)
    if (s.active[k].binding != kDisc) normals[k] = half_plane_at(problem, s.active[k].binding).normal;
  return normals;
}

/// But for those that are 0.
bool are_among(const Multipliers& some, const Multipliers& all) {
  const auto is_there = [&](Binding binding, double value) {
    for (std::size_t k = 0; k < all.count; ++k)
      if (all.binding[k] == binding && all.value[k] == value) return true;
    return value == 0.0;
  };
  for (std::size_t k = 0; k < some.count; ++k)
    if (!is_there(some.binding[k], some.value[k])) return false;
  return true;
}

}  // namespace

Multipliers multipliers_of_optimum(const Problem& problem, Vec2 v, Multipliers m) {
  const Vec2 sum = pull(problem.objective, problem.preferred, v);
  const auto column = [&](std::size_t k) {
    return m.binding[k] == kDisc ? -v : half_plane_at(problem, m.binding[k]).normal;
  };
  if (m.count == 1) m.value[0] = multiplier_of_one(m.binding[0], column(0), sum);
  if (m.count == 2) {
    const auto pair = solve_pair(column(0), column(1), sum);
    m.value = {std::max(0.0, pair[0]), std::max(0.0, pair[1]), 0.0};
  }
  return m;
}

Multipliers weights_of_lines(const Problem& problem, Vec2 v, Multipliers m, bool on_disc) {
  Normals normals{};
  for (std::size_t k = 0; k < m.count; ++k) normals[k] = half_plane_at(problem, m.binding[k]).normal;
  m.value = weights_of(normals, m.count, v, on_disc);
  return m;
}

Multipliers multipliers_where_touching(const Problem& problem, Vec2 v, Binding line) {
  const Vec2 normal = half_plane_at(problem, line).normal;
  Multipliers m;
  if (problem.objective == Objective::farthest) {
    m.add(line, for_length(norm(problem.preferred) / kUnitRoundoff, norm(normal)));
    return m;
  }
  m.add(line, solve_one(normal, (1.0 + kMostOfDisc) * v - problem.preferred));
  m.add(kDisc, kMostOfDisc);
  return m;
}

Multipliers weights_where_touching(const Problem& problem, Binding line, Binding gives) {
  const double length = norm(half_plane_at(problem, gives).normal);
  Multipliers m;
  m.add(line, for_length(length / kUnitRoundoff, norm(half_plane_at(problem, line).normal)));
  m.add(gives, 1.0);
  return m;
}

void set_multipliers(const Normals& normals, Objective objective, Vec2 preferred, Solution& s) {
  if (s.status == Status::no_interior) return;
  Stationarity stationarity(normals, objective, preferred, s);
  if (s.status == Status::optimal)
    stationarity.set_of_optimum();
  else
    stationarity.set_of_least_violation();
}

void set_multipliers(const Problem& problem, Solution& s) {
  set_multipliers(normals_of(problem, s), problem.objective, problem.preferred, s);
}

Multipliers own_multipliers(const Problem& problem, const Solution& s) {
  const Scope scope = scope_of(s.status);
  const bool disc_counts = scope == Scope::all_must_hold && problem.objective == Objective::nearest;
  Multipliers m;
  for (std::size_t k = 0; k < s.active_count; ++k) {
    const ActiveConstraint& a = s.active[k];
    if (!can_be_used(problem, a.binding, scope)) return {};
    if (a.multiplier > 0.0 && (disc_counts || a.binding != kDisc)) m.add(a.binding, a.multiplier);
  }
  return m;
}

bool has_multipliers_of(const Problem& problem, const Multipliers& proof, const Solution& s) {
  const Multipliers own = own_multipliers(problem, s);
  return are_among(own, proof) && are_among(proof, own);
}

std::optional<Multipliers> in_doubles(const std::vector<Term>& terms) {
  Multipliers m;
  for (const Term& term : terms) {
    if (m.count == m.binding.size() || term.multiplier.size() != 1) return std::nullopt;
    m.add(term.binding, term.multiplier.front());
  }
  return m;
}

void set_multipliers(const Problem& problem, const Multipliers& proof, Solution& s) {
  for (std::size_t k = 0; k < s.active_count; ++k) {
    s.active[k].multiplier = 0.0;
    for (std::size_t i = 0; i < proof.count; ++i)
      if (proof.binding[i] == s.active[k].binding) s.active[k].multiplier += proof.value[i];
  }
  // (2) and (3) need no multiplier of the disc: it follows from the others.
  if (s.status == Status::optimal && problem.objective == Objective::nearest) return;
  if (s.status != Status::no_interior)
    Stationarity(normals_of(problem, s), problem.objective, problem.preferred, s).set_of_disc();
}

}  // namespace exactvo::lp
