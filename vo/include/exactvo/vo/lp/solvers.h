// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The solvers behind one interface, chosen by name.

#include <string>
#include <vector>

#include "exactvo/vo/lp/certificate.h"

namespace exactvo::lp {

enum class Solver {
  incremental,  ///< one problem at a time, double (solve.h)
  batch,        ///< a problem a SIMD lane, double (batch.h); problems it does not take go to `incremental`
  certified,    ///< incremental, proven, the exact stage behind it (certificate.h)
  exact         ///< every branch in exact arithmetic (certificate.h)
};

/// "incremental" and so on.
const char* name(Solver solver);
std::vector<std::string> solver_names();
/// False for an unknown name.
bool parse(const std::string& text, Solver& solver);

/// The answers in order. Certificates come with `certified` and `exact` only; for the others see `prove`.
/// REQUIRES: well-formed problems.
std::vector<Proven> solve_all(Solver solver, const std::vector<Problem>& problems);

/// Adds the certificate; an answer that has none is replaced by the exact one (`exact_stage`).
void prove(const Problem& problem, Proven& answer);

}  // namespace exactvo::lp
