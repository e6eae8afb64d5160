// SPDX-License-Identifier: GPL-3.0-or-later
// Answers with their proofs (certificate.h): by exact arithmetic, or by multipliers in doubles where these do.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "exactvo/geometry/require.h"
#include "exactvo/vo/lp/certificate.h"
#include "lp/exact/exact_search.h"
#include "lp/exact/inward.h"
#include "lp/kernel.h"
#include "lp/problem/exact_sign.h"
#include "lp/proof/certify.h"
#include "lp/proof/duality.h"
#include "lp/proof/multipliers.h"

namespace exactvo::lp {
namespace {

/// Every constraint and every finite side of the box.
ExactRegion exact_region(const Problem& problem) {
  ExactRegion region;
  region.lines.reserve(problem.constraints.size() + 4);
  for (std::size_t k = 0; k < problem.constraints.size(); ++k) {
    const Constraint& c = problem.constraints[k];
    region.lines.push_back({c.half_plane, constraint_at(k), c.priority == Priority::soft});
  }
  for (const Binding side : kBoxSides) {
    const HalfPlane h = half_plane_at(problem, side);
    if (std::isfinite(h.offset)) region.lines.push_back({h, side, false});
  }
  region.has_disc = std::isfinite(problem.bound.disc);
  if (region.has_disc) region.disc = Exact(problem.bound.disc);
  return region;
}

/// The lines that may not give.
ExactRegion hard_part(const ExactRegion& region) {
  ExactRegion hard;
  hard.has_disc = region.has_disc;
  hard.disc = region.disc;
  for (const auto& member : region.lines)
    if (!member.soft) hard.lines.push_back(member);
  return hard;
}

/// The constraints may give, the sides of the box may not.
ExactRegion softened(ExactRegion region) {
  for (auto& member : region.lines) member.soft = !is_speed_bound(member.binding);
  return region;
}

Aim aim_of(const Problem& problem) {
  if (problem.objective == Objective::nearest) return {{}, problem.preferred};
  return {{problem.preferred}, {}};
}

std::vector<Binding> bindings_of(const ExactRegion& region, const ExactOptimum& o) {
  std::vector<Binding> bindings;
  for (const std::size_t k : o.tight) bindings.push_back(region.lines[k].binding);
  if (o.on_disc) bindings.push_back(kDisc);
  return bindings;
}

/// The first of `bindings` that fit: two where optimal, else three.
void name_active(const std::vector<Binding>& bindings, Solution& s) {
  const std::size_t most = s.status == Status::optimal ? 2 : 3;
  s.active = {};
  s.active_count = 0;
  for (const Binding binding : bindings) {
    const auto end = s.active.begin() + s.active_count;
    const bool known = std::any_of(s.active.begin(), end, [&](const auto& a) { return a.binding == binding; });
    if (s.active_count < most && !known) s.active[s.active_count++].binding = binding;
  }
}

/// What the certificate names, then what else is tight: ties leave more of that than bind.
void take_from(const Certificate& certificate, const Problem& problem, const std::vector<Binding>& tight, Solution& s) {
  std::vector<Binding> bindings;
  Multipliers rounded;
  EXACTVO_REQUIRE(certificate.bound.size() <= rounded.binding.size(), std::to_string(certificate.bound.size()));
  for (const Term& term : certificate.bound) {
    bindings.push_back(term.binding);
    rounded.add(term.binding, std::accumulate(term.multiplier.begin(), term.multiplier.end(), 0.0));
  }
  bindings.insert(bindings.end(), tight.begin(), tight.end());
  name_active(bindings, s);
  set_multipliers(problem, rounded, s);
}

/// The point of all that must hold that is nearest 0 is rational: it proves that there is one.
Proven no_interior(const Problem& problem, const ExactRegion& mandatory, const ExactOptimum& optimum,
                   const std::vector<Term>& contradiction) {
  Proven answer;
  answer.exact_stage = true;
  const Vec2 velocity = is_finite(optimum.rounded) ? optimum.rounded : Vec2{};  // which may lie beyond the doubles
  answer.solution.velocity = velocity;
  answer.solution.status = Status::no_interior;
  for (const auto& member : mandatory.lines)
    answer.solution.violation = std::max(answer.solution.violation, geometry::violation(member.half_plane, velocity));
  const ExactOptimum nearest_zero = exact_best(mandatory, {});
  Certificate c{Status::no_interior, velocity, answer.solution.violation, contradiction, {}, 0.0, {}};
  const std::vector<std::size_t>& tight = nearest_zero.tight;
  const auto accepted = [&](std::vector<Binding> vertex) {
    c.vertex = std::move(vertex);
    return check(problem, c) == CertificateError::none;
  };
  bool proven = accepted({});
  for (std::size_t i = 0; i < tight.size() && !proven; ++i) {
    proven = accepted({mandatory.lines[tight[i]].binding});
    for (std::size_t j = i + 1; j < tight.size() && !proven; ++j)
      proven = accepted({mandatory.lines[tight[i]].binding, mandatory.lines[tight[j]].binding});
  }
  if (proven) answer.certificate = c;
  return answer;
}

Proven rounded_inward(const Problem& problem, Status status, const ExactRegion& region, const ExactRegion& mandatory,
                      const ExactOptimum& optimum, const std::vector<Term>& contradiction) {
  const std::optional<Vec2> velocity = nearest_double_inside(problem, status, optimum.rounded);
  if (!velocity) return no_interior(problem, mandatory, optimum, contradiction);
  Proven answer;
  answer.exact_stage = true;
  answer.solution.velocity = *velocity;
  answer.solution.status = status;
  answer.solution.violation = violation_that_counts(problem, status, *velocity);
  const std::vector<Binding> tight = bindings_of(region, optimum);
  name_active(tight, answer.solution);
  set_multipliers(problem, answer.solution);
  answer.certificate = certificate_for(problem, answer.solution, tight, contradiction);
  if (!answer.certificate || !is_tight(problem, *answer.certificate)) return answer;
  const std::optional<Multipliers> proof = in_doubles(answer.certificate->bound);
  if (!proof || !has_multipliers_of(problem, *proof, answer.solution))
    take_from(*answer.certificate, problem, tight, answer.solution);
  return answer;
}

}  // namespace

Proven solve_exact(const Problem& problem) {
  require_well_formed(problem);
  const ExactRegion region = exact_region(problem);
  const Aim aim = aim_of(problem);
  const ExactOptimum best = exact_best(region, aim);
  if (best.feasible) return rounded_inward(problem, Status::optimal, region, region, best, {});

  const ExactRegion hard = hard_part(region);
  const ExactOptimum kept = exact_best(hard, {});
  if (kept.feasible) {
    const std::vector<Term> contradiction = contradiction_of(problem, bindings_of(region, best));
    const ExactOptimum least = exact_least_violation(region, aim);
    return rounded_inward(problem, Status::relaxed, region, hard, least, contradiction);
  }
  const std::vector<Term> contradiction = contradiction_of(problem, bindings_of(hard, kept));
  const ExactRegion soft = softened(hard);
  const ExactOptimum least = exact_least_violation(soft, aim);
  return rounded_inward(problem, Status::infeasible, soft, soft, least, contradiction);
}

namespace {

/// The proof of a solution, which then has its multipliers.
std::optional<ProofInDoubles> proven_with_multipliers(const Problem& problem, Solution& solution) {
  require_well_formed(problem);
  std::optional<ProofInDoubles> proof = proof_in_doubles(problem, solution);
  if (proof && !has_multipliers_of(problem, proof->bound, solution)) set_multipliers(problem, proof->bound, solution);
  return proof;
}

}  // namespace

Proven solve_certified(const Problem& problem) {
  require_well_formed(problem);
  Solution solution;
  return find_candidate(problem, memory_of_thread(), solution) ? certified(problem, solution) : solve_exact(problem);
}

Proven certified(const Problem& problem, const Solution& solution) {
  Proven answer;
  answer.solution = solution;
  const std::optional<ProofInDoubles> proof = proven_with_multipliers(problem, answer.solution);
  if (!proof) return solve_exact(problem);
  answer.certificate = certificate_of(*proof, answer.solution.status);
  return answer;
}

bool is_proven_by_multipliers(const Problem& problem, Solution& solution) {
  require_well_formed(problem);
  return own_multipliers_prove(problem, solution) || proven_with_multipliers(problem, solution).has_value();
}

}  // namespace exactvo::lp
