// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Finding multipliers. Heuristic in how (doubles, the smallest gap of the candidates), proven in what: nothing is
/// returned that `check` would not accept.

#include <optional>
#include <vector>

#include "exactvo/vo/lp/certificate.h"
#include "lp/proof/exact_number.h"

namespace exactvo::lp {

/// What multipliers may be: a double each, chosen and proven in doubles, or the exact ones where no doubles do.
enum class Stage { doubles, exact };

/// A certificate for `solution` with a gap that `is_tight`. `candidates` may bind: the multipliers are those of the
/// best one, two or three of them. `contradiction` is used where the multipliers of the bound do not contradict by
/// themselves.
std::optional<Certificate> certificate_for(const Problem& problem, const Solution& solution,
                                           const std::vector<Binding>& candidates,
                                           const std::vector<Term>& contradiction, Stage stage);

/// What the solution says binds.
std::vector<Binding> active_bindings(const Solution& solution);

/// The exact multipliers of a contradiction among at most three constraints or two and the disc, up to a common factor
/// that keeps them in the range of double. Empty where these do not contradict.
std::vector<Term> contradiction_of(const Problem& problem, const std::vector<Binding>& bindings);

/// The exact multipliers with which the normals of two or three lines cancel, up to a common factor as above. Empty
/// where there are none of one sign.
std::vector<Term> cancelling_terms(const Problem& problem, const std::vector<Binding>& lines);

}  // namespace exactvo::lp
