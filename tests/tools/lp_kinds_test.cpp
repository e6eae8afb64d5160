// SPDX-License-Identifier: GPL-3.0-or-later
// Problems of every kind through the program: each solver's answers against those of `exact`.
//
// EXACTVO_LP_PROBLEMS=4000 tools_lp_kinds_test     # this many of every kind, some minutes
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "problem_kinds.h"
#include "problem_text.h"
#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;

/// As in tests/lp/kinds_test.cpp.
constexpr double kAlike = 1e-7;

std::size_t problems_per_kind() {
  const char* asked = std::getenv("EXACTVO_LP_PROBLEMS");
  return asked ? std::strtoull(asked, nullptr, 10) : 25;
}

json number_or_null(double x) {
  return std::isfinite(x) ? json(x) : json();
}

json line_of(const lp::Problem& problem) {
  json line = {{"preferred", {problem.preferred.x, problem.preferred.y}}, {"constraints", json::array()}};
  if (problem.objective == lp::Objective::farthest) line["objective"] = "farthest";
  const lp::SpeedBound& b = problem.bound;
  if (std::isfinite(b.disc)) line["bound"]["disc"] = b.disc;
  if (std::isfinite(b.box_x) || std::isfinite(b.box_y))
    line["bound"]["box"] = {number_or_null(b.box_x), number_or_null(b.box_y)};
  for (const lp::Constraint& c : problem.constraints)
    line["constraints"].push_back({{"normal", {c.half_plane.normal.x, c.half_plane.normal.y}},
                                   {"offset", c.half_plane.offset},
                                   {"priority", c.priority == lp::Priority::hard ? "hard" : "soft"}});
  return line;
}

lp::Status status_named(const std::string& text) {
  for (const lp::Status status :
       {lp::Status::optimal, lp::Status::relaxed, lp::Status::infeasible, lp::Status::no_interior})
    if (text == name(status)) return status;
  throw std::runtime_error("no status: " + text);
}

/// A violation that no velocity can undercut is claimed to be at most so much too large.
void expect_small_gap(const json& answer) {
  if (answer.at("certificate").is_null() || answer.at("status") == "optimal") return;
  const double scale = answer.at("violation").get<double>() +
                       std::hypot(answer.at("velocity")[0].get<double>(), answer.at("velocity")[1].get<double>());
  EXPECT_LE(answer.at("certificate").at("gap"), 1e-10 * (1.0 + scale)) << answer;
}

std::vector<lp::Solution> answers(const Workplace& here, const std::string& solver) {
  const Outcome outcome = here.run("lp problems.jsonl --json --solver " + solver);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  std::vector<lp::Solution> solutions;
  std::istringstream lines(outcome.out);
  for (std::string text; std::getline(lines, text);) {
    const json line = json::parse(text);
    if (line.contains("summary")) continue;
    expect_small_gap(line);
    lp::Solution s;
    s.velocity = {line.at("velocity")[0], line.at("velocity")[1]};
    s.status = status_named(line.at("status"));
    s.violation = line.at("violation");
    solutions.push_back(s);
  }
  return solutions;
}

TEST(LpKinds, EverySolverOfTheProgramIsAsGoodAsExact) {
  SeededRandom random(seed_of_run(71));
  std::vector<lp::Problem> problems;
  std::string text;
  for (const lp::ProblemKind& kind : lp::well_formed_kinds())
    for (std::size_t k = 0; k < problems_per_kind(); ++k) {
      problems.push_back(random_problem(kind, random));
      text += line_of(problems.back()).dump() + "\n";
    }
  const Workplace here;
  here.write("problems.jsonl", text);
  const std::vector<lp::Solution> exact = answers(here, "exact");
  ASSERT_EQ(exact.size(), problems.size());
  lp::DrawnPairs pairs;
  std::size_t wrong = 0;
  for (const std::string& name : lp::solver_names()) {
    lp::Solver solver{};
    ASSERT_TRUE(parse(name, solver));
    const std::vector<lp::Solution> given = answers(here, name);
    ASSERT_EQ(given.size(), problems.size());
    for (std::size_t k = 0; k < problems.size(); ++k) {
      pairs.add(problems[k], solver);
      const auto compared = solver == lp::Solver::batch ? lp::Compared::what_is_proven : lp::Compared::everything;
      const std::string why = why_worse(problems[k], given[k], exact[k], kAlike, compared);
      if (!why.empty() && ++wrong <= 10) ADD_FAILURE() << name << ": " << why << '\n' << text_of(problems[k]);
    }
  }
  EXPECT_EQ(wrong, 0U) << "of " << problems.size() << " problems";
  EXPECT_EQ(pairs.missing(), "") << pairs.table();
}

TEST(LpKinds, ABoxWithOneSideBoundsOneCoordinate) {
  const Workplace here;
  here.write("p.jsonl",
             "{\"bound\": {\"box\": [1, null]}, \"preferred\": [3, 5], \"constraints\": []}\n"
             "{\"bound\": {\"box\": [null, 2]}, \"preferred\": [3, 5], \"constraints\": []}\n");
  const Outcome outcome = here.run("lp p.jsonl --json");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("\"velocity\":[1.0,5.0]"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("\"velocity\":[3.0,2.0]"), std::string::npos) << outcome.out;
  here.write(
      "p.jsonl",
      "{\"bound\": {\"box\": [1, null]}, \"preferred\": [3, 5], \"objective\": \"farthest\", \"constraints\": []}\n");
  const Outcome refused = here.run("lp p.jsonl");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("a box with one side"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace exactvo::test
