// SPDX-License-Identifier: GPL-3.0-or-later
#include "exact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "certify.h"
#include "duality.h"
#include "exact_search.h"
#include "inward.h"

namespace exactvo::lp {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::size_t> indices_of(const ExactRegion& region, const ExactOptimum& o) {
  std::vector<std::size_t> indices;
  for (const std::size_t k : o.tight) indices.push_back(region.lines[k].index);
  if (o.on_disc) indices.push_back(kSpeedBound);
  return indices;
}

std::vector<std::size_t> positions_of(const ExactRegion& region, const std::vector<std::size_t>& indices) {
  std::vector<std::size_t> positions;
  for (std::size_t k = 0; k < region.lines.size(); ++k)
    if (std::find(indices.begin(), indices.end(), region.lines[k].index) != indices.end()) positions.push_back(k);
  return positions;
}

void name_active(const std::vector<std::size_t>& tight, const std::optional<Certificate>& certificate, Solution& s) {
  const std::size_t most = s.status == Status::optimal ? 2 : 3;
  const auto add = [&](std::size_t index) {
    const auto end = s.active.begin() + s.active_count;
    if (s.active_count < most && std::find(s.active.begin(), end, index) == end) s.active[s.active_count++] = index;
  };
  if (certificate)
    for (const Term& term : certificate->bound) add(term.constraint);
  const bool terms_tell = certificate && s.status == Status::optimal && s.active_count > 0;
  for (const std::size_t index : tight)
    if (!terms_tell || index == kSpeedBound) add(index);  // the disc of a linear objective is in no term
}

/// The optimum as doubles, or 0 where it lies beyond them.
Vec2 within_doubles(const ExactOptimum& optimum) {
  return is_finite(optimum.rounded) ? optimum.rounded : Vec2{};
}

/// The point of all that must hold that is nearest 0 is rational: it proves that there is one.
Proven pinched(const Problem& problem, const ExactRegion& musts, const ExactOptimum& optimum,
               const std::vector<Term>& contradiction) {
  Proven answer;
  answer.exact_stage = true;
  const Vec2 velocity = within_doubles(optimum);
  answer.solution.velocity = velocity;
  answer.solution.status = Status::pinched;
  for (const auto& member : musts.lines)
    answer.solution.violation = std::max(answer.solution.violation, geometry::violation(member.half_plane, velocity));
  const ExactOptimum nearest_zero = exact_best(musts, {}, {});
  Certificate c{Status::pinched, velocity, answer.solution.violation, contradiction, {}, 0.0, {}};
  const std::vector<std::size_t>& tight = nearest_zero.tight;
  const auto accepted = [&](std::vector<std::size_t> vertex) {
    c.vertex = std::move(vertex);
    return check(problem, c) == Flaw::none;
  };
  bool proven = accepted({});
  for (std::size_t i = 0; i < tight.size() && !proven; ++i) {
    proven = accepted({musts.lines[tight[i]].index});
    for (std::size_t j = i + 1; j < tight.size() && !proven; ++j)
      proven = accepted({musts.lines[tight[i]].index, musts.lines[tight[j]].index});
  }
  if (proven) answer.certificate = c;
  return answer;
}

Proven rounded_inward(const Problem& problem, Status status, const ExactRegion& region, const ExactRegion& musts,
                      const ExactOptimum& optimum, const std::vector<Term>& contradiction) {
  const std::optional<Vec2> velocity = nearest_double_inside(problem, status, optimum.rounded);
  if (!velocity) return pinched(problem, musts, optimum, contradiction);
  Proven answer;
  answer.exact_stage = true;
  answer.solution.velocity = *velocity;
  answer.solution.status = status;
  answer.solution.violation = violation_that_counts(problem, status, *velocity);
  const std::vector<std::size_t> tight = indices_of(region, optimum);
  answer.certificate = certificate_for(problem, answer.solution, tight, contradiction, kInfinity);
  name_active(tight, answer.certificate, answer.solution);
  return answer;
}

}  // namespace

Proven solve_exactly(const Problem& problem, const std::vector<std::size_t>& guess) {
  const ExactRegion region = exact_region(problem);
  const Aim aim = aim_of(problem);
  const ExactOptimum best = exact_best(region, aim, positions_of(region, guess));
  if (best.feasible) return rounded_inward(problem, Status::optimal, region, region, best, {});

  const ExactRegion hard = hard_part(region);
  const ExactOptimum kept = exact_best(hard, {}, positions_of(hard, guess));
  if (kept.feasible) {
    const std::vector<Term> contradiction = contradiction_of(problem, indices_of(region, best));
    const ExactOptimum least = exact_least_violation(region, aim, positions_of(region, guess));
    return rounded_inward(problem, Status::relaxed, region, hard, least, contradiction);
  }
  const std::vector<Term> contradiction = contradiction_of(problem, indices_of(hard, kept));
  const ExactRegion soft = softened(hard);
  const ExactOptimum least = exact_least_violation(soft, aim, positions_of(soft, guess));
  return rounded_inward(problem, Status::infeasible, soft, soft, least, contradiction);
}

}  // namespace exactvo::lp
