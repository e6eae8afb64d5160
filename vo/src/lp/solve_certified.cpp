// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solve.h"
#include "lp/exact/exact.h"
#include "lp/proof/certify.h"
#include "lp/proof/multipliers.h"

namespace exactvo::lp {

Proven solve_certified(const Problem& problem) {
  return certified(problem, solve(problem));
}

Proven certified(const Problem& problem, const Solution& solution) {
  Proven answer;
  answer.solution = solution;
  answer.certificate = certify(problem, answer.solution);
  if (!answer.certificate) return solve_exactly(problem, active_bindings(answer.solution));
  if (!has_multipliers_of(*answer.certificate, answer.solution))
    set_multipliers(problem, *answer.certificate, answer.solution);
  return answer;
}

Proven solve_exact(const Problem& problem) {
  require_well_formed(problem);
  return solve_exactly(problem, {});
}

}  // namespace exactvo::lp
