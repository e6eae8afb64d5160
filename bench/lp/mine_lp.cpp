// SPDX-License-Identifier: GPL-3.0-or-later
// The disagreement miner: looks for problems on which the textbook float solver gives a wrong verdict by more than its
// inputs' rounding can excuse, and writes them as lines of JSON that `exactvo lp` reads.
#include <cmath>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "exactvo/vo/lp/certificate.h"
#include "lp/sets/generated_sets.h"
#include "options/program_options.h"
#include "sets.h"

namespace exactvo::bench {
namespace {

/// Points and directions in float carry 2^-24 of 2 m/s; a hundred times that is nobody's rounding but the solver's.
constexpr double kInexcusable = 1e-5;

constexpr const char* kPerturbations[] = {"1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "1e-7", "0"};

struct Flags {
  std::string out;
  std::uint64_t seed = 1;
  std::size_t count = 2000;  ///< problems a family and perturbation
  std::size_t most = 20;     ///< kept a family
};

bool feasible_when_shifted(lp::Problem problem, double by) {
  for (lp::Constraint& c : problem.constraints) c.half_plane.offset += by;
  const lp::Status status = lp::solve_certified(problem).solution.status;
  return status == lp::Status::optimal || status == lp::Status::no_interior;
}

double worst_violation(const lp::Problem& problem, const TextbookVelocity& answer) {
  double worst = 0.0;
  for (const lp::Constraint& c : problem.constraints)
    worst = std::max(worst,
                     geometry::violation(c.half_plane, {static_cast<double>(answer.x), static_cast<double>(answer.y)}));
  return worst;
}

/// Nothing, or what is wrong, in words.
std::string disagreement(const lp::Problem& problem) {
  const TextbookSet one({problem});
  const TextbookVelocity answer = solve_textbook(one.lines.data(), static_cast<int>(one.lines.size()), one.hard[0],
                                                 one.speed[0], one.preferred_x[0], one.preferred_y[0]);
  if (answer.feasible && !feasible_when_shifted(problem, -kInexcusable)) return "called feasible";
  if (answer.feasible && worst_violation(problem, answer) > kInexcusable) return "feasible, but its velocity is not";
  if (!answer.feasible && feasible_when_shifted(problem, kInexcusable)) return "called infeasible";
  return {};
}

nlohmann::ordered_json line_of(const lp::Problem& problem, const std::string& set, const std::string& what) {
  nlohmann::ordered_json out = {{"set", set},
                                {"disagreement", what},
                                {"bound", {{"disc", problem.bound.disc}}},
                                {"preferred", {problem.preferred.x, problem.preferred.y}},
                                {"constraints", nlohmann::ordered_json::array()}};
  for (const lp::Constraint& c : problem.constraints)
    out["constraints"].push_back({{"normal", {c.half_plane.normal.x, c.half_plane.normal.y}},
                                  {"offset", c.half_plane.offset},
                                  {"priority", c.priority == lp::Priority::hard ? "hard" : "soft"}});
  return out;
}

void mine_family(const std::string& family, const Flags& flags, std::ostream& out) {
  std::size_t looked_at = 0, wrong = 0;
  for (const char* perturbation : kPerturbations) {
    const std::string set = family + ":" + perturbation;
    for (const lp::Problem& problem : lp::generate(set, flags.count, flags.seed)) {
      ++looked_at;
      const std::string what = disagreement(problem);
      if (what.empty()) continue;
      if (++wrong <= flags.most) out << line_of(problem, set, what).dump() << '\n';
    }
  }
  std::cerr << family << ": " << wrong << " of " << looked_at << '\n';
}

int mine(const Flags& flags) {
  std::ofstream out(flags.out);
  if (!out) throw std::runtime_error("--out: found '" + flags.out + "', expected a file that can be written");
  for (const std::string& family : lp::adversarial_families()) mine_family(family, flags, out);
  return out.flush() ? 0 : 2;
}

}  // namespace
}  // namespace exactvo::bench

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("mine_lp", [&] {
    bench::Flags flags;
    tools::ProgramOptions options("mine_lp", "On which adversarial problems is the textbook's float solver wrong?");
    options.text("--out", flags.out, "A file for the problems, a line of JSON each", true);
    options.whole_number("--seed", flags.seed, 0, "Of the problems");
    options.whole_number("--count", flags.count, 1, "Problems per family and perturbation");
    options.whole_number("--most", flags.most, 1, "Problems written per family and perturbation");
    return options.parse(argc, argv) ? bench::mine(flags) : 0;
  });
}
