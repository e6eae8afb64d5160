// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/lp/solvers.h"

#include <gtest/gtest.h>

#include "lp/sets/generated_sets.h"
#include "problem_text.h"

namespace exactvo::lp {
namespace {

TEST(Solvers, AreChosenByName) {
  for (const std::string& text : solver_names()) {
    Solver solver{};
    ASSERT_TRUE(parse(text, solver));
    EXPECT_EQ(name(solver), text);
  }
  Solver solver{};
  EXPECT_FALSE(parse("simplex", solver));
}

TEST(Solvers, AllAgreeAndAllAreProven) {
  std::vector<Problem> problems = generate("RF10", 200, 31);
  for (const Problem& p : generate("RI10", 200, 32)) problems.push_back(p);
  for (std::size_t k = 0; k < problems.size(); k += 5) problems[k].bound.box_x = 0.75;  // not for the lanes
  for (std::size_t k = 1; k < problems.size(); k += 7) problems[k].constraints.resize(k % 10);
  for (std::size_t k = 2; k < problems.size(); k += 3)
    if (!problems[k].constraints.empty()) problems[k].constraints[0].priority = Priority::hard;
  const std::vector<Proven> exact = solve_all(Solver::exact, problems);
  for (const std::string& text : solver_names()) {
    Solver solver{};
    ASSERT_TRUE(parse(text, solver));
    std::vector<Proven> answers = solve_all(solver, problems);
    for (std::size_t k = 0; k < problems.size(); ++k) {
      prove(problems[k], answers[k]);
      ASSERT_TRUE(answers[k].certificate.has_value()) << text << '\n' << text_of(problems[k]);
      EXPECT_EQ(check(problems[k], *answers[k].certificate), CertificateError::none) << text_of(problems[k]);
      EXPECT_EQ(answers[k].solution.status, exact[k].solution.status) << text << '\n' << text_of(problems[k]);
    }
  }
}

TEST(Solvers, NoProblemsAndProblemsThatNoLaneTakesAreSolved) {
  EXPECT_TRUE(solve_all(Solver::batch, {}).empty());
  Problem unbounded;
  unbounded.preferred = {3.0, 4.0};
  EXPECT_EQ(solve_all(Solver::batch, {unbounded}).front().solution.velocity, unbounded.preferred);
}

}  // namespace
}  // namespace exactvo::lp
