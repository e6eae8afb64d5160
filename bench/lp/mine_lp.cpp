// SPDX-License-Identifier: GPL-3.0-or-later
// The disagreement miner: looks for problems on which the textbook float solver gives a wrong verdict by more than its
// inputs' rounding can excuse, and writes them as lines of JSON that `exactvo lp` reads.
#include <cmath>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/instances.h"
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
  return status == lp::Status::optimal || status == lp::Status::pinched;
}

double worst_violation(const lp::Problem& problem, const UsualVelocity& answer) {
  double worst = 0.0;
  for (const lp::Constraint& c : problem.constraints)
    worst = std::max(worst,
                     geometry::violation(c.half_plane, {static_cast<double>(answer.x), static_cast<double>(answer.y)}));
  return worst;
}

/// Nothing, or what is wrong, in words.
std::string disagreement(const lp::Problem& problem) {
  const UsualSet one({problem});
  const UsualVelocity answer = solve_usual(one.lines.data(), static_cast<int>(one.lines.size()), one.hard[0],
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

Flags read_flags(int argc, char** argv) {
  Flags flags;
  for (int k = 1; k + 1 < argc; k += 2) {
    const std::string option = argv[k];
    if (option == "--out") flags.out = argv[k + 1];
    if (option == "--seed") flags.seed = std::stoull(argv[k + 1]);
    if (option == "--count") flags.count = std::stoull(argv[k + 1]);
    if (option == "--most") flags.most = std::stoull(argv[k + 1]);
  }
  if (flags.out.empty()) throw std::runtime_error("--out FILE is missing");
  return flags;
}

}  // namespace
}  // namespace exactvo::bench

int main(int argc, char** argv) try {
  const auto flags = exactvo::bench::read_flags(argc, argv);
  std::ofstream out(flags.out);
  for (const std::string& family : exactvo::lp::adversarial_families()) exactvo::bench::mine_family(family, flags, out);
  return out ? 0 : 2;
} catch (const std::exception& e) {
  std::cerr << "mine_lp: " << e.what() << "\nusage: mine_lp --out FILE.jsonl [--seed N] [--count N] [--most N]\n";
  return 2;
}
