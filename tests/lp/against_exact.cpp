// SPDX-License-Identifier: GPL-3.0-or-later
// Every solver against exact arithmetic: `lp_against_exact [PROBLEMS = 1000000] [SEED = 1]` draws problems of every
// kind in turn (bound, objective, priorities), half of them at random, half from small integers, where lines are
// parallel and meet in one point. `certified` and `exact` have to be right, each with a certificate that `check`
// accepts. `batch` may err where the region is as thin as a rounding error, but then nothing must prove its answer, and
// in the choice among velocities of least violation where lines are opposite to each other, which nothing proves. Exit
// status 1 otherwise, and where a pair of kind and solver was not drawn.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "exactvo/vo/lp/solvers.h"
#include "options/program_options.h"
#include "problem_kinds.h"
#include "problem_text.h"

namespace exactvo::lp {
namespace {

/// m/s, of the objective or of the violation: the region of a random problem is seldom thinner.
constexpr double kAlike = 1e-7;

struct Counts {
  std::size_t problems = 0, answers = 0, wrong = 0, unproven = 0, refused = 0, doubtful = 0;
  bool is_clean() const { return wrong + unproven + refused == 0; }
};

void show(const char* what, Solver solver, const Problem& problem, const std::string& why) {
  std::printf("%s: %s, %s\n%s\n", what, name(solver), why.c_str(), text_of(problem).c_str());
}

void require_proof(const Problem& problem, const Proven& answer, Solver solver, Counts& counts) {
  if (!answer.certificate) {
    ++counts.unproven;
    show("unproven", solver, problem, "no certificate");
  } else if (check(problem, *answer.certificate) != CertificateError::none) {
    ++counts.refused;
    show("refused", solver, problem, "its certificate does not hold");
  }
}

void judge(const Problem& problem, const Proven& answer, const Solution& exact, Solver solver, Counts& counts) {
  ++counts.answers;
  const bool promises_proof = solver == Solver::certified || solver == Solver::exact;
  if (promises_proof) require_proof(problem, answer, solver, counts);
  const std::string why = why_worse(problem, answer.solution, exact, kAlike);
  if (why.empty()) return;
  const bool is_what_proofs_leave =
      why_worse(problem, answer.solution, exact, kAlike, Compared::what_is_proven).empty();
  if (!promises_proof && (is_what_proofs_leave || !certify(problem, answer.solution))) {
    ++counts.doubtful;
    return;
  }
  ++counts.wrong;
  show("wrong", solver, problem, why);
}

std::vector<Problem> draw(std::size_t first, std::size_t count, test::SeededRandom& random) {
  const std::vector<ProblemKind>& kinds = well_formed_kinds();
  std::vector<Problem> problems;
  for (std::size_t k = first; k < first + count; ++k) {
    const ProblemKind& kind = kinds[k % kinds.size()];
    problems.push_back(k / kinds.size() % 2 == 0 ? random_problem(kind, random) : grid_problem(kind, random));
  }
  return problems;
}

int run(std::size_t wanted, std::uint64_t seed) {
  test::SeededRandom random(seed);
  Counts counts;
  DrawnPairs drawn;
  constexpr std::size_t kAtOnce = 4096;  // problems held at a time
  for (std::size_t first = 0; first < wanted; first += kAtOnce) {
    const std::vector<Problem> problems = draw(first, std::min(kAtOnce, wanted - first), random);
    const std::vector<Proven> exact = solve_all(Solver::exact, problems);
    for (const Solver solver : {Solver::batch, Solver::certified, Solver::exact}) {
      const std::vector<Proven> answers = solver == Solver::exact ? exact : solve_all(solver, problems);
      for (std::size_t k = 0; k < problems.size(); ++k) {
        judge(problems[k], answers[k], exact[k].solution, solver, counts);
        drawn.add(problems[k], solver);
      }
    }
    counts.problems += problems.size();
  }
  std::printf("problems %zu\nanswers %zu\nwrong %zu\nunproven %zu\nrefused %zu\ndoubtful %zu\n", counts.problems,
              counts.answers, counts.wrong, counts.unproven, counts.refused, counts.doubtful);
  const std::string missing = drawn.missing();
  if (!missing.empty()) std::printf("not drawn:\n%s\n", missing.c_str());
  return counts.is_clean() && missing.empty() ? 0 : 1;
}

}  // namespace
}  // namespace exactvo::lp

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("lp_against_exact", [&] {
    std::size_t problems = 1000000;
    std::uint64_t seed = 1;
    tools::ProgramOptions options("lp_against_exact",
                                  "Compares every solver with exact arithmetic on every kind of problem.");
    options.whole_number("PROBLEMS", problems, 1, "Of all kinds together");
    options.whole_number("SEED", seed, 1, "Of the problems");
    return options.parse(argc, argv) ? lp::run(problems, seed) : 0;
  });
}
