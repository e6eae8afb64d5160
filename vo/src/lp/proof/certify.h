// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Finding multipliers. Heuristic in how (doubles, the smallest gap of the candidates), proven in what: nothing is
/// returned that `check` would not accept.

#include <optional>
#include <vector>

#include "exactvo/vo/lp/certificate.h"
#include "lp/proof/exact_points.h"
#include "lp/proof/rounded_gap.h"

namespace exactvo::lp {

/// What shows that a solution is right: multipliers that are a double each, of what it says binds.
struct ProofInDoubles {
  Claim claim;
  Multipliers bound;  ///< for (2), (3) or (4) and, where constraints gave, for (1)
  double gap = 0.0;   ///< as Certificate::gap
};
/// Nothing where the solution is not right, or its active set does not show why. Allocates only where doubles do not
/// decide. REQUIRES: a well-formed problem.
std::optional<ProofInDoubles> proof_in_doubles(const Problem& problem, const Solution& solution);

/// Whether the solution is right and its own multipliers show it, by rounding alone: true of nearly every answer of
/// `solve`, at a third of the cost of looking for the smallest gap. Certified where true; false says nothing.
/// REQUIRES: a well-formed problem.
bool own_multipliers_prove(const Problem& problem, const Solution& solution);

/// A proof written out.
Certificate certificate_of(const ProofInDoubles& proof, Status status);

/// A certificate for `solution` with a gap that `is_tight`, with exact multipliers where no doubles do. `candidates`
/// may bind: the multipliers are those of the best one, two or three of them. `contradiction` is used where the
/// multipliers of the bound do not contradict by themselves.
std::optional<Certificate> certificate_for(const Problem& problem, const Solution& solution,
                                           const std::vector<Binding>& candidates,
                                           const std::vector<Term>& contradiction);

/// The exact multipliers of a contradiction among at most three constraints or two and the disc, up to a common factor
/// that keeps them in the range of double. Empty where these do not contradict.
std::vector<Term> contradiction_of(const Problem& problem, const std::vector<Binding>& bindings);

/// The exact multipliers with which the normals of two or three lines cancel, up to a common factor as above. Empty
/// where there are none of one sign.
std::vector<Term> cancelling_terms(const Problem& problem, const std::vector<Binding>& lines);

}  // namespace exactvo::lp
