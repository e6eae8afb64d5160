// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/exact/exact.h"

#include <algorithm>

#include "lp/exact/exact_search.h"
#include "lp/problem/exact_sign.h"
#include "lp/proof/certify.h"
#include "lp/proof/duality.h"
#include "lp/proof/multipliers.h"
#include "lp/scalar/inward.h"

namespace exactvo::lp {
namespace {

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
  for (const Term& term : certificate.bound) bindings.push_back(term.binding);
  bindings.insert(bindings.end(), tight.begin(), tight.end());
  name_active(bindings, s);
  set_multipliers(problem, certificate, s);
}

/// The optimum as doubles, or 0 where it lies beyond them.
Vec2 within_doubles(const ExactOptimum& optimum) {
  return is_finite(optimum.rounded) ? optimum.rounded : Vec2{};
}

/// The point of all that must hold that is nearest 0 is rational: it proves that there is one.
Proven no_interior(const Problem& problem, const ExactRegion& mandatory, const ExactOptimum& optimum,
                   const std::vector<Term>& contradiction) {
  Proven answer;
  answer.exact_stage = true;
  const Vec2 velocity = within_doubles(optimum);
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
  const auto& certificate = answer.certificate;
  if (certificate && is_tight(problem, *certificate) && !has_multipliers_of(problem, *certificate, answer.solution))
    take_from(*certificate, problem, tight, answer.solution);
  return answer;
}

}  // namespace

Proven solve_exactly(const Problem& problem) {
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

}  // namespace exactvo::lp
