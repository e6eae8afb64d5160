// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solve.h"
#include "lp/proof/certify.h"
#include "lp/proof/multipliers.h"

namespace exactvo::lp {
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
  return certified(problem, solve(problem));
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
