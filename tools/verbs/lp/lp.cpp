// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo lp: solves small linear programs from a file or stdin, a line of JSON each, and proves the answers.
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/lp_problems.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/vo/lp/solvers.h"
#include "support/terminal.h"
#include "support/unsigned_zero.h"
#include "support/usage.h"
#include "verb.h"

namespace exactvo::tools {
namespace {

using Json = nlohmann::ordered_json;

struct LpFlags {
  std::string file;
  std::string solver = "certified";
  bool certify = false;
  bool json = false;
};

double thread_nanoseconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

Json name_of(const lp::Binding& binding) {
  return is_speed_bound(binding) ? Json(name(binding.kind)) : Json(binding.index);
}

Json terms_json(const std::vector<lp::Term>& terms) {
  Json list = Json::array();
  for (const lp::Term& term : terms)
    list.push_back({{"constraint", name_of(term.binding)}, {"multiplier", term.multiplier}});
  return list;
}

Json certificate_json(const lp::Certificate& c) {
  Json out = {{"bound", terms_json(c.bound)}, {"contradiction", terms_json(c.contradiction)}, {"gap", c.gap}};
  if (c.status != lp::Status::no_interior) return out;
  out["vertex"] = Json::array();
  for (const lp::Binding& binding : c.vertex) out["vertex"].push_back(name_of(binding));
  return out;
}

/// One result as a line of JSON; numbers read back to the same doubles.
Json result_line(std::size_t index, const lp::Proven& answer) {
  const lp::Solution& s = answer.solution;
  Json out = {{"index", index},
              {"status", name(s.status)},
              {"velocity", {unsigned_zero(s.velocity.x), unsigned_zero(s.velocity.y)}},
              {"violation", s.violation},
              {"active", Json::array()}};
  for (std::size_t k = 0; k < s.active_count; ++k) out["active"].push_back(name_of(s.active[k].binding));
  out["multipliers"] = Json::array();
  for (std::size_t k = 0; k < s.active_count; ++k) out["multipliers"].push_back(s.active[k].multiplier);
  out["certificate"] = answer.certificate ? certificate_json(*answer.certificate) : Json();
  return out;
}

struct Summary {
  std::size_t problems = 0;
  std::array<std::size_t, 4> by_status{};
  std::vector<bool> is_proven;  ///< of each answer: by a certificate that `check` accepts and whose gap is rounding
  std::size_t certified = 0;
  std::optional<std::size_t> unproven;  ///< where proofs were asked for: answers without one
  std::size_t exact_fallbacks = 0;
  double worst_violation = 0.0;  ///< the largest `violation` of an answer
  double worst_breach = 0.0;     ///< m/s, of what an answer's status says must hold
  double ns_per_solve = 0.0;     ///< the solver alone
};

/// By how much an answer violates lines that must hold by its status: all where optimal, the hard ones where relaxed.
/// A certificate proves that to be 0; what a double would compute for it is rounding.
double broken_by(const lp::Problem& problem, const lp::Proven& answer) {
  const lp::Solution& s = answer.solution;
  double most = 0.0;
  if (answer.certificate) return most;
  for (const lp::Constraint& c : problem.constraints) {
    const bool must_hold =
        s.status == lp::Status::optimal || (s.status == lp::Status::relaxed && c.priority == lp::Priority::hard);
    if (must_hold) most = std::max(most, geometry::violation(c.half_plane, s.velocity));
  }
  return most;
}

bool is_proven(const lp::Problem& problem, const lp::Proven& answer) {
  return answer.certificate && check(problem, *answer.certificate) == lp::CertificateError::none &&
         is_tight(problem, *answer.certificate);
}

Summary summarise(const std::vector<lp::Problem>& problems, const std::vector<lp::Proven>& answers, bool with_proofs) {
  Summary summary;
  summary.problems = problems.size();
  for (std::size_t k = 0; k < problems.size(); ++k) {
    const lp::Proven& answer = answers[k];
    ++summary.by_status[static_cast<std::size_t>(answer.solution.status)];
    summary.is_proven.push_back(is_proven(problems[k], answer));
    summary.certified += summary.is_proven.back();
    summary.exact_fallbacks += answer.exact_stage;
    summary.worst_violation = std::max(summary.worst_violation, answer.solution.violation);
    summary.worst_breach = std::max(summary.worst_breach, broken_by(problems[k], answer));
  }
  if (with_proofs) summary.unproven = summary.problems - summary.certified;
  return summary;
}

nlohmann::ordered_json summary_json(const Summary& s) {
  nlohmann::ordered_json fields = {{"problems", s.problems}};
  for (std::size_t k = 0; k < s.by_status.size(); ++k) fields[name(static_cast<lp::Status>(k))] = s.by_status[k];
  fields["certified"] = s.certified;
  fields["unproven"] = s.unproven ? nlohmann::ordered_json(*s.unproven) : nlohmann::ordered_json();
  fields["exact_fallbacks"] = s.exact_fallbacks;
  fields["worst_violation"] = s.worst_violation;
  fields["worst_breach"] = s.worst_breach;
  fields["ns_per_solve"] = s.ns_per_solve;
  return {{"summary", fields}};
}

/// What the table says of an answer's proof.
std::string proof_words(const lp::Proven& answer, bool is_proven, bool is_asked_for) {
  if (is_proven) return "proven";
  if (answer.certificate) return fmt::format("NOT proven: within {:.2g}", answer.certificate->gap);
  return is_asked_for ? "NOT proven" : "";
}

void print_table(const std::vector<lp::Proven>& answers, const Summary& s) {
  ChunkedOutput out;
  out.add(fmt::format("{:>8} {:<11}{:>22}{:>24}{:>12}  {}\n", "problem", "status", "v_x [m/s]", "v_y [m/s]",
                      "violation", "certificate"));
  for (std::size_t k = 0; k < answers.size(); ++k) {
    const lp::Solution& a = answers[k].solution;
    out.add(fmt::format("{:>8} {:<11}{:>22.17g}{:>24.17g}{:>12.4g}  {}\n", k, name(a.status),
                        unsigned_zero(a.velocity.x), unsigned_zero(a.velocity.y), a.violation,
                        proof_words(answers[k], s.is_proven[k], s.unproven.has_value())));
  }
  out.add(
      fmt::format("{}: {} optimal, {} relaxed, {} infeasible, {} without interior; {} proven, {} by the exact stage\n",
                  geometry::counted(s.problems, "problem"), s.by_status[0], s.by_status[1], s.by_status[2],
                  s.by_status[3], s.certified, s.exact_fallbacks));
  out.add(fmt::format("worst violation {:.4g} m/s; solver alone {:.4g} ns per problem\n", s.worst_violation,
                      s.ns_per_solve));
  out.flush();
}

void print_lines(const std::vector<lp::Proven>& answers, const Summary& summary) {
  ChunkedOutput out;
  for (std::size_t k = 0; k < answers.size(); ++k) out.add(result_line(k, answers[k]).dump() + "\n");
  out.add(summary_json(summary).dump() + "\n");
  out.flush();
}

bool asks_for_proofs(lp::Solver solver, const LpFlags& flags) {
  return flags.certify || solver == lp::Solver::certified || solver == lp::Solver::exact;
}

ExitCode run(const LpFlags& flags) {
  const auto solver = parse_choice<lp::Solver>("--solver", flags.solver, lp::solver_names());
  const std::vector<lp::Problem> problems =
      datasets::parse_lp_problems(datasets::read_file_or_input(flags.file), datasets::name_of_input(flags.file));
  lp::Solving solving(solver, problems);
  const double before = thread_nanoseconds();
  solving.solve();
  const double spent = thread_nanoseconds() - before;
  std::vector<lp::Proven> answers = solving.answers();
  if (flags.certify)
    for (std::size_t k = 0; k < problems.size(); ++k) prove(problems[k], answers[k]);
  Summary summary = summarise(problems, answers, asks_for_proofs(solver, flags));
  summary.ns_per_solve = problems.empty() ? 0.0 : spent / static_cast<double>(problems.size());
  if (flags.json)
    print_lines(answers, summary);
  else
    print_table(answers, summary);
  if (summary.unproven.value_or(0) == 0) return ExitCode::success;
  message(
      fmt::format("warning: answers without a proof: {} of {}; their multipliers leave the range of doubles, or no "
                  "double near the best velocity satisfies what must hold",
                  *summary.unproven, summary.problems));
  return ExitCode::negative;
}

void declare_lp(CLI::App& app, LpFlags& flags) {
  app.add_option("file", flags.file, "Problems: JSON Lines, one JSON document or a binary instance file; - for stdin")
      ->required();
  app.add_option("--solver", flags.solver, "incremental, batch, certified or exact")->capture_default_str();
  app.add_flag("--certify", flags.certify, "Certify every answer; those that cannot be certified are solved exactly");
  app.add_flag("--json", flags.json, "One JSON result per line, then a summary");
}

}  // namespace

Verb lp_verb() {
  return {
      "lp", "Solve the small optimisation problems that turn half-planes into a velocity, with certificates",
      "  echo '{\"bound\": {\"disc\": 2}, \"preferred\": [2, 0], \"constraints\": [{\"normal\": [-1, 0], \"offset\": "
      "-0.5}]}' | exactvo lp - --json\n"
      "    (a violation is in m/s where the normals have length 1, else in m/s times |normal|. Status 1: an answer is "
      "not\n"
      "    proven although a proof was requested by `certified`, `exact` or --certify. The lines:\n"
      "    docs/guide/linear-program.md. ns_per_solve is the thread's processor time of the solver alone, one pass "
      "over\n"
      "    the file: not reading, laying out for `batch`, gathering, printing, nor what --certify adds. Of a file of "
      "few\n"
      "    problems it says little; to compare solvers run bench_lp --instances FILE)\n",
      with_flags(declare_lp, run)};
}

}  // namespace exactvo::tools
