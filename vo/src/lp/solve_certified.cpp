// SPDX-License-Identifier: GPL-3.0-or-later
#include "exact.h"
#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solve.h"

namespace exactvo::lp {

Proven solve_certified(const Problem& problem) {
  Proven answer;
  answer.solution = solve(problem);
  answer.certificate = certify(problem, answer.solution);
  if (answer.certificate) return answer;
  const Solution& s = answer.solution;
  return solve_exactly(problem, {s.active.begin(), s.active.begin() + s.active_count});
}

Proven solve_exact(const Problem& problem) {
  require_well_formed(problem);
  return solve_exactly(problem, {});
}

}  // namespace exactvo::lp
