// SPDX-License-Identifier: GPL-3.0-or-later
#include "adversarial.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "competitor.h"
#include "exactvo/vo/lp/certificate.h"
#include "lp/sets/generated_sets.h"
#include "violation.h"

namespace exactvo::bench {
namespace {

constexpr const char* kPerturbations[] = {"1e-2",  "1e-3",  "1e-5",  "1e-7",  "1e-9",
                                          "1e-11", "1e-13", "1e-15", "1e-17", "0"};

/// What one solver did on problems whose exact verdicts are known.
struct Tally {
  std::size_t problems = 0, false_infeasible = 0, false_feasible = 0;
  double violation = 0.0;  ///< m/s, worst of answers rightly called feasible
  double excess = 0.0;     ///< worst |v| / v_max - 1

  void add(const lp::Problem& problem, bool feasible, const Answer& answer) {
    ++problems;
    false_infeasible += feasible && !answer.feasible;
    false_feasible += !feasible && answer.feasible;
    const double speed = norm(answer.velocity);
    excess = std::max(excess, std::isfinite(speed) ? speed / problem.bound.disc - 1.0 : HUGE_VAL);
    if (!feasible || !answer.feasible) return;
    violation = std::max(violation, worst_violation(problem.constraints, answer.velocity));
  }
  void add(const Tally& t) {
    problems += t.problems;
    false_infeasible += t.false_infeasible;
    false_feasible += t.false_feasible;
    violation = std::max(violation, t.violation);
    excess = std::max(excess, t.excess);
  }
};

std::vector<char> exact_verdicts(const std::vector<lp::Problem>& problems) {
  std::vector<char> feasible;
  for (const lp::Problem& p : problems) {
    const lp::Proven proven = lp::solve_exact(p);
    const bool contradiction = proven.certificate && !proven.certificate->contradiction.empty();
    feasible.push_back(proven.solution.status == lp::Status::optimal ||
                       (proven.solution.status == lp::Status::no_interior && !contradiction));
  }
  return feasible;
}

Tally tally(const Entry& entry, const std::vector<lp::Problem>& problems, const std::vector<char>& feasible) {
  const auto competitor = entry.build(problems);
  competitor->run();
  Tally t;
  for (std::size_t i = 0; i < problems.size(); ++i) t.add(problems[i], feasible[i] != 0, competitor->answer(i));
  return t;
}

void print(const std::string& family, const std::string& solver, const Tally& t) {
  std::printf("%-12s %-18s %8zu %8.3f %8.3f %12.2g %12.2g\n", family.c_str(), solver.c_str(), t.problems,
              100.0 * static_cast<double>(t.false_infeasible) / static_cast<double>(t.problems),
              100.0 * static_cast<double>(t.false_feasible) / static_cast<double>(t.problems), t.violation,
              std::max(t.excess, 0.0));
}

nlohmann::json json_of(const std::string& family, const std::string& perturbation, const std::string& solver,
                       const Tally& t) {
  return {{"family", family},
          {"perturbation", perturbation},
          {"solver", solver},
          {"problems", t.problems},
          {"false_infeasible", t.false_infeasible},
          {"false_feasible", t.false_feasible},
          {"violation", t.violation},
          {"excess_speed", std::min(t.excess, std::numeric_limits<double>::max())}};
}

}  // namespace

nlohmann::json run_adversarial(std::size_t count, std::uint64_t seed, bool& wrong) {
  nlohmann::json out = nlohmann::json::array();
  std::vector<Entry> solvers;
  for (Entry& e : entries())
    if (!e.rules.feasible_only && e.target.empty()) solvers.push_back(std::move(e));
  std::printf("%-12s %-18s %8s %8s %8s %12s %12s\n", "family", "solver", "problems", "false i%", "false f%",
              "violation", "speed - 1");
  for (const std::string& family : lp::adversarial_families()) {
    std::vector<Tally> sums(solvers.size());
    for (const char* perturbation : kPerturbations) {
      const std::vector<lp::Problem> problems = lp::generate(family + ":" + perturbation, count, seed);
      const std::vector<char> feasible = exact_verdicts(problems);
      for (std::size_t k = 0; k < solvers.size(); ++k) {
        const Tally t = tally(solvers[k], problems, feasible);
        sums[k].add(t);
        out.push_back(json_of(family, perturbation, solvers[k].name, t));
      }
    }
    for (std::size_t k = 0; k < solvers.size(); ++k) {
      print(family, solvers[k].name, sums[k]);
      wrong = wrong || (solvers[k].rules.exact && sums[k].false_infeasible + sums[k].false_feasible > 0);
    }
  }
  return out;
}

}  // namespace exactvo::bench
