// SPDX-License-Identifier: GPL-3.0-or-later
// Audits certificates in rationals: `audit_certificates [N = 1000000] [SEED = 1] [INSTANCES.bin...]`. About N problems
// of the generated sets, and all of each file, go through the solvers `batch`, `certified` and `exact`; `check` has
// to accept each certificate, to refuse it once it was tampered with, and the three to agree on what can be kept. Exit
// status 1 otherwise.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "exactvo/vo/lp/solvers.h"
#include "lp/sets/generated_sets.h"
#include "options/program_options.h"
#include "problem_file.h"

namespace exactvo::bench {
namespace {

using lp::Certificate;
using lp::CertificateError;
using lp::Problem;
using lp::Proven;
using lp::Solver;

struct Counts {
  unsigned long problems = 0, accepted = 0, unproven = 0, refused = 0, disagreeing = 0;
  unsigned long tampered = 0, overlooked = 0;

  bool is_clean() const { return unproven + refused + disagreeing + overlooked == 0; }
};

/// Each voids any certificate it applies to; false where it does not apply.
using Tampering = bool (*)(const Problem&, Certificate&);

/// What is no_interior claims nothing of its velocity.
bool beyond_the_bound(const Problem& problem, Certificate& c) {
  if (c.status == lp::Status::no_interior) return false;
  c.velocity.x += 3.0 * problem.bound.disc;
  return true;
}

bool violation_understated(const Problem&, Certificate& c) {
  c.violation *= 0.5;
  constexpr double kNotable = 1e-9;  // m/s: far above the gap within which a violation may be stated
  return c.violation > kNotable;
}

bool bound_by_another(const Problem& problem, Certificate& c) {
  if (c.bound.empty()) return false;
  c.bound.front().binding = lp::constraint_at(problem.constraints.size());
  return true;
}

bool another_vertex(const Problem& problem, Certificate& c) {
  if (c.status != lp::Status::no_interior) return false;
  c.vertex.assign(1, lp::constraint_at(problem.constraints.size()));
  return true;
}

bool feasible_after_all(const Problem&, Certificate& c) {
  if (c.contradiction.empty()) return false;
  c.status = lp::Status::optimal;
  return true;
}

void tamper(const Problem& problem, const Certificate& sound, Counts& counts) {
  for (const Tampering change :
       {beyond_the_bound, violation_understated, bound_by_another, another_vertex, feasible_after_all}) {
    Certificate changed = sound;
    if (!change(problem, changed)) continue;
    ++counts.tampered;
    if (check(problem, changed) == CertificateError::none) ++counts.overlooked;
  }
}

void audit(const Problem& problem, const Proven& answer, Counts& counts) {
  if (!answer.certificate) {
    ++counts.unproven;
  } else if (check(problem, *answer.certificate) != CertificateError::none) {
    ++counts.refused;
  } else {
    ++counts.accepted;
    tamper(problem, *answer.certificate, counts);
  }
}

/// Whether all soft and hard lines can be kept. `no_interior` says that no double was found that does, not which it is.
bool is_feasible(const Proven& answer) {
  return answer.certificate && answer.certificate->contradiction.empty();
}

void audit(const std::vector<Problem>& problems, Counts& counts) {
  std::vector<std::vector<Proven>> answers;
  for (const Solver solver : {Solver::batch, Solver::certified, Solver::exact})
    answers.push_back(lp::solve_all(solver, problems));
  for (std::size_t i = 0; i < problems.size(); ++i) {
    prove(problems[i], answers.front()[i]);
    for (const auto& of_solver : answers) {
      audit(problems[i], of_solver[i], counts);
      if (is_feasible(of_solver[i]) != is_feasible(answers.back()[i])) ++counts.disagreeing;
    }
  }
  counts.problems += problems.size();
}

std::vector<std::string> generated_sets() {
  std::vector<std::string> sets;
  for (const char* kind : {"RF", "RI"})
    for (const char* lines : {"5", "10", "20", "50"}) sets.push_back(std::string(kind) + lines);
  for (const std::string& family : lp::adversarial_families())
    for (const char* by : {"1e-2", "1e-6", "1e-10", "1e-13", "1e-15", "1e-17", "0"}) sets.push_back(family + ":" + by);
  return sets;
}

void say(const std::string& set, const Counts& c) {
  std::fprintf(stderr, "%s: %lu problems so far, %lu certificates accepted\n", set.c_str(), c.problems, c.accepted);
}

int run(unsigned long wanted, unsigned long seed, const std::vector<std::string>& files) {
  std::vector<std::vector<Problem>> of_files;  // read first: a file that is not there ends it before an hour of audits
  for (const std::string& file : files) of_files.push_back(read_problems(file));
  Counts counts;
  const std::vector<std::string> sets = generated_sets();
  const std::size_t each = std::max<std::size_t>(1, wanted / sets.size());
  constexpr std::size_t kAtOnce = 4096;  // problems held at a time
  for (const std::string& set : sets) {
    for (std::size_t first = 0; first < each; first += kAtOnce)
      audit(lp::generate(set, std::min(kAtOnce, each - first), seed, first), counts);
    say(set, counts);
  }
  for (std::size_t k = 0; k < files.size(); ++k) {
    audit(of_files[k], counts);
    say(files[k], counts);
  }
  std::printf("problems %lu\naccepted %lu\nunproven %lu\nrefused %lu\ndisagreeing %lu\ntampered %lu\noverlooked %lu\n",
              counts.problems, counts.accepted, counts.unproven, counts.refused, counts.disagreeing, counts.tampered,
              counts.overlooked);
  return counts.is_clean() ? 0 : 1;
}

}  // namespace
}  // namespace exactvo::bench

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("audit_certificates", [&] {
    std::uint64_t problems = 1000000, seed = 1;
    std::vector<std::string> files;
    tools::ProgramOptions options("audit_certificates", "Checks certificates of every solver in rationals.");
    options.whole_number("PROBLEMS", problems, 1, "Of all generated sets together");
    options.whole_number("SEED", seed, 1, "Of the generated sets");
    options.texts("FILE", files, "Problems, as `exactvo lp` reads them");
    return options.parse(argc, argv) ? bench::run(problems, seed, files) : 0;
  });
}
