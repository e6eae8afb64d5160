// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The solvers behind one interface, chosen by name.

#include <memory>
#include <string>
#include <vector>

#include "exactvo/vo/lp/certificate.h"

namespace exactvo::lp {

/// A method of solution.
enum class Solver {
  batch,      ///< one problem in each SIMD lane, double (batch.h); problems it does not take go to `solve` (solve.h)
  certified,  ///< one problem at a time in doubles, proven; the exact stage behind it (certificate.h)
  exact       ///< every branch in exact arithmetic (certificate.h)
};

/// "batch" and so on.
const char* name(Solver solver);
/// Every name, in the order of Solver.
std::vector<std::string> solver_names();
/// False for an unknown name.
bool parse(const std::string& text, Solver& solver);

/// The answers in order. Certificates come with `certified` and `exact` only; for the others see `prove`.
/// REQUIRES: well-formed problems.
std::vector<Proven> solve_all(Solver solver, const std::vector<Problem>& problems);

/// The same in steps, to time the solver alone: `batch` lays problems out for its lanes first,
/// and gathers their answers afterwards, which takes longer than solving them. The others lay nothing out. Keeps a
/// reference to `problems`. REQUIRES: well-formed problems.
class Solving {
 public:
  /// Lays the problems out for the solver.
  Solving(Solver solver, const std::vector<Problem>& problems);
  ~Solving();
  Solving(const Solving&) = delete;
  Solving& operator=(const Solving&) = delete;

  /// Solves all of them.
  void solve();
  /// As from solve_all. REQUIRES: solve() was called, and this was not.
  std::vector<Proven> answers();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Adds the certificate; an answer that has none is replaced by the exact one (`exact_stage`).
void prove(const Problem& problem, Proven& answer);

}  // namespace exactvo::lp
