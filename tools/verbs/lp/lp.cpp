// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo lp: solves small linear programs from a file or stdin, a line of JSON each, and proves the answers.
#include <fmt/format.h>

#include <time.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/lp_problems.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/lp/solution.h"
#include "exactvo/vo/lp/solvers.h"
#include "readers/line_reader.h"
#include "support/json_layout.h"
#include "support/run.h"
#include "support/simulation_flags.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"

namespace exactvo::tools {

namespace {

/// What a solver says of a problem.
struct GivenAnswer {
  std::optional<lp::Status> status;        ///< nothing: the velocity alone counts
  std::optional<geometry::Vec2> velocity;  ///< m/s
};

enum class LpVerdict {
  optimal,             ///< satisfies what it must, and no velocity is better by more than the tolerance
  infeasible,          ///< rightly said to be: the hard constraints contradict each other
  violated,            ///< violates what can be satisfied
  not_optimal,         ///< satisfies it, and a better velocity does too
  wrongly_infeasible,  ///< said to be infeasible, and a velocity satisfies everything
  wrongly_feasible,    ///< given a velocity, and none satisfies the hard constraints
  wrong_status,        ///< said to be relaxed where everything can be satisfied, or the other way round
  missing              ///< no answer
};

struct JudgedAnswer {
  LpVerdict verdict = LpVerdict::missing;
  lp::Status truth = lp::Status::optimal;  ///< what the exact solver proves of the problem
  geometry::Vec2 best;                     ///< m/s, its velocity
  /// m/s times |n|: by how much the velocity violates what it must satisfy, the speed bound included; in a relaxed
  /// problem also by how much more than necessary it violates the soft constraints, where that is more.
  std::optional<double> violation;
  /// m/s: how much farther it is from the preferred velocity than the best one (farthest: how much less far along);
  /// below 0 where it is outside of what it must satisfy.
  std::optional<double> excess;
  /// In the unit of a certificate's gap: no velocity is better by more, proven by `lp::check`. Nothing where the
  /// velocity violates anything, by however little.
  std::optional<double> certified_gap;

  bool is_right() const { return verdict == LpVerdict::optimal || verdict == LpVerdict::infeasible; }
};

using datasets::DataCode;
using datasets::DataError;
using datasets::TableLines;
using geometry::Vec2;
using lp::Status;
using Tree = nlohmann::json;

// --- The file ---

constexpr const char* kStatusWords = "optimal, relaxed, infeasible or no-interior";

/// Collects answers by the numbers of their problems: those that say which one, by its number or name, and those that
/// come in the order of the problems.
class AnswersByNumber {
 public:
  /// `names`: of the problems; empty where they have numbers only. Must outlive this.
  AnswersByNumber(std::size_t count, const std::vector<std::string>& names) : all_(count), names_(&names) {}

  void put(const TableLines& at, std::optional<double> index, std::optional<std::string_view> name,
           GivenAnswer answer) {
    if (name) {
      const auto named = static_cast<double>(number_of(at, *name));
      if (index.value_or(named) != named)
        at.refuse(DataCode::out_of_range, fmt::format("index {} of problem \"{}\"", *index, *name),
                  fmt::format("{}, the index of that problem", named));
      index = named;
    }
    const double number = index.value_or(static_cast<double>(next_));
    if (!(number >= 0.0 && number < static_cast<double>(all_.size())) || number != std::floor(number))
      at.refuse(DataCode::out_of_range, fmt::format("an answer to problem {}", number),
                fmt::format("a problem of the file, 0 to {}", static_cast<double>(all_.size()) - 1.0));
    std::optional<GivenAnswer>& place = all_[static_cast<std::size_t>(number)];
    if (place)
      at.refuse(DataCode::wrong_count, fmt::format("a second answer to problem {}", number),
                "one answer to each problem");
    place = std::move(answer);
    next_ = static_cast<std::size_t>(number) + 1;
  }
  std::vector<std::optional<GivenAnswer>> take() { return std::move(all_); }

 private:
  std::size_t number_of(const TableLines& at, std::string_view name) {
    if (numbers_.empty())
      for (std::size_t k = 0; k < all_.size(); ++k) {
        const bool is_named = k < names_->size();
        const auto [place, is_first] = numbers_.try_emplace(is_named ? (*names_)[k] : std::to_string(k), k);
        if (!is_first) place->second.reset();
      }
    const auto found = numbers_.find(std::string(name));
    if (found == numbers_.end())
      at.refuse(DataCode::not_an_option, fmt::format("an answer to problem \"{}\"", name),
                names_->empty() ? "the number of a problem; these problems have no names"
                                : "the name of a problem of the file");
    if (!found->second)
      at.refuse(DataCode::wrong_count, fmt::format("\"{}\", the name of two problems", name),
                "a name of one problem, or answers by index");
    return *found->second;
  }

  std::vector<std::optional<GivenAnswer>> all_;
  const std::vector<std::string>* names_;
  std::map<std::string, std::optional<std::size_t>> numbers_;  ///< by name; nothing where two problems share it
  std::size_t next_ = 0;
};

std::optional<Status> status_of(const TableLines& at, std::string_view word) {
  if (word.empty()) return std::nullopt;
  for (const Status status : {Status::optimal, Status::relaxed, Status::infeasible, Status::no_interior})
    if (word == lp::name(status)) return status;
  at.refuse(DataCode::not_an_option, word, kStatusWords);
}

void require_velocity_or_status(const TableLines& at, const GivenAnswer& answer) {
  const bool needs_none = answer.status == Status::infeasible;
  if (!answer.velocity && !needs_none)
    at.refuse(DataCode::key_missing, "an answer without a velocity", "a velocity, or the status infeasible");
}

std::optional<Vec2> velocity_in(const TableLines& at, const Tree& value) {
  if (value.is_null()) return std::nullopt;
  const bool is_pair = value.is_array() && value.size() == 2 && value[0].is_number() && value[1].is_number();
  if (!is_pair) at.refuse(DataCode::wrong_type, value.dump(), "\"velocity\": [x, y] in m/s, or null");
  return Vec2{value[0].get<double>(), value[1].get<double>()};
}

void put_json_line(const TableLines& at, AnswersByNumber& answers) {
  const Tree line = Tree::parse(at.line(), nullptr, false);
  if (!line.is_object()) at.refuse(DataCode::json_syntax, at.line(), "an object of JSON on each line");
  if (line.contains("summary")) return;  // the last line of lp --json
  GivenAnswer answer;
  answer.velocity = velocity_in(at, line.value("velocity", Tree()));
  const Tree status = line.value("status", Tree());
  if (!status.is_null() && !status.is_string()) at.refuse(DataCode::wrong_type, status.dump(), kStatusWords);
  if (status.is_string()) answer.status = status_of(at, status.get<std::string>());
  require_velocity_or_status(at, answer);
  const Tree index = line.value("index", Tree());
  if (!index.is_null() && !index.is_number()) at.refuse(DataCode::wrong_type, index.dump(), "the number of a problem");
  answers.put(at, index.is_number() ? std::optional(index.get<double>()) : std::nullopt, std::nullopt, answer);
}

constexpr const char* kAnswerColumns = "the columns vx and vy and, where wanted, index, problem and status";

using AnswerTable = datasets::CsvTable<TableLines>;

void put_row(const AnswerTable& table, AnswersByNumber& answers) {
  const auto number = [&](const char* column) -> std::optional<double> {
    if (!table.has(column) || table.field(column).empty()) return std::nullopt;
    double value = 0.0;
    if (!datasets::parse_whole(table.field(column), value))
      table.refuse(DataCode::number, table.field(column), fmt::format("a number in column {}", column));
    return value;
  };
  GivenAnswer answer;
  const std::optional<double> x = number("vx"), y = number("vy");
  if (x && y) answer.velocity = Vec2{*x, *y};
  if (table.has("status")) answer.status = status_of(table, table.field("status"));
  require_velocity_or_status(table, answer);
  std::optional<std::string_view> name;
  if (table.has("problem")) name = table.field("problem");
  answers.put(table, number("index"), name, answer);
}

// --- The verdict ---

/// m/s times |n|: by how much the velocity violates the constraints of this priority; 0 or less where none.
double violation_of(const lp::Problem& problem, Vec2 v, lp::Priority priority) {
  double most = -std::numeric_limits<double>::infinity();
  for (const lp::Constraint& c : problem.constraints)
    if (c.priority == priority) most = std::max(most, geometry::violation(c.half_plane, v));
  return most;
}

/// m/s: how much worse than the best one, by the problem's objective.
double excess_over(const lp::Problem& problem, Vec2 v, Vec2 best) {
  if (problem.objective == lp::Objective::farthest) return dot(problem.preferred, best - v) / norm(problem.preferred);
  return norm(v - problem.preferred) - norm(best - problem.preferred);
}

/// What a certificate's gap counts: how much better than `v` the best velocity is.
double gain_of(const lp::Problem& problem, const lp::Certificate& best, Vec2 v, double violation) {
  if (best.status != Status::optimal) return violation - best.violation;
  if (problem.objective == lp::Objective::farthest) return dot(problem.preferred, best.velocity - v);
  const double to_best = norm(best.velocity - problem.preferred);
  return excess_over(problem, v, best.velocity) * (norm(v - problem.preferred) + to_best);
}

/// The proof of the best answer, of `v`: with the least gap, up to rounding, that `check` accepts.
std::optional<double> certified_gap_of(const lp::Problem& problem, const lp::Certificate& best, Vec2 v,
                                       double violation) {
  lp::Certificate claim = best;
  claim.velocity = v;
  if (best.status == Status::relaxed) claim.violation = std::max(violation, best.violation);
  const double gain = std::max(0.0, gain_of(problem, best, v, claim.violation));
  const double scale = norm(v) + norm(problem.preferred) + best.violation, stated = claim.violation;
  for (const double rounding : {0x1p-50, 0x1p-44, 0x1p-36}) {
    if (best.status == Status::relaxed) claim.violation = stated + rounding * scale;
    claim.gap = best.gap + gain + rounding * (gain + scale * scale + scale);
    if (lp::check(problem, claim) == lp::CertificateError::none) return claim.gap;
  }
  return std::nullopt;
}

/// "optimal", "infeasible", "violated", "not-optimal", "wrongly-infeasible", "wrongly-feasible", "wrong-status",
/// "missing".
const char* name(LpVerdict verdict) {
  constexpr const char* kNames[] = {"optimal",          "infeasible",   "violated", "not-optimal", "wrongly-infeasible",
                                    "wrongly-feasible", "wrong-status", "missing"};
  return kNames[static_cast<std::size_t>(verdict)];
}

/// One for each of `count` problems, in their order; nothing where the file has none. JSON Lines, such as `lp --json`
/// prints, or CSV with `kAnswerColumns`. `names`: of the problems, empty where they have none. Throws
/// datasets::DataError.
std::vector<std::optional<GivenAnswer>> read_lp_answers(const std::string& file, std::size_t count,
                                                        const std::vector<std::string>& names) {
  AnswerTable lines(file);
  AnswersByNumber answers(count, names);
  if (!lines.next_filled())
    throw DataError(DataCode::format_unknown, file, "", "no answer", "an object of JSON on each line, or CSV");
  if (lines.line().front() == '{') {
    do put_json_line(lines, answers);
    while (lines.next_filled());
    return answers.take();
  }
  lines.take_header({"vx", "vy", "index", "problem", "status"}, 2,
                    fmt::format("answers: an object of JSON on each line, or CSV with {}", kAnswerColumns),
                    AnswerTable::OtherColumns::refused);
  while (lines.next_row()) put_row(lines, answers);
  return answers.take();
}

/// `tolerance`: m/s, of violations (times |n|) and of the excess. REQUIRES: a well-formed problem.
JudgedAnswer judge(const lp::Problem& problem, const std::optional<GivenAnswer>& answer, double tolerance) {
  const lp::Proven proven = lp::solve_certified(problem);
  JudgedAnswer judged;
  judged.truth = proven.solution.status;
  judged.best = proven.solution.velocity;
  if (!answer) return judged;
  if (answer->status == Status::infeasible) {
    judged.verdict = judged.truth == Status::infeasible ? LpVerdict::infeasible
                     : judged.truth == Status::relaxed  ? LpVerdict::wrong_status
                                                        : LpVerdict::wrongly_infeasible;
    return judged;
  }
  const Vec2 v = *answer->velocity;
  const double soft = violation_of(problem, v, lp::Priority::soft);
  const lp::SpeedBound& bound = problem.bound;
  double violation = std::max({violation_of(problem, v, lp::Priority::hard), norm(v) - bound.disc,
                               std::fabs(v.x) - bound.box_x, std::fabs(v.y) - bound.box_y});
  const bool gives = judged.truth == Status::relaxed;
  violation = std::max({violation, gives ? soft - proven.solution.violation : soft, 0.0});
  if (!geometry::is_finite(v)) violation = std::numeric_limits<double>::infinity();
  judged.violation = violation;
  if (judged.truth == Status::infeasible) {
    judged.verdict = LpVerdict::wrongly_feasible;
    return judged;
  }
  if (!gives) judged.excess = excess_over(problem, v, judged.best);
  if (proven.certificate && judged.truth != Status::no_interior && std::isfinite(violation))
    judged.certified_gap = certified_gap_of(problem, *proven.certificate, v, soft);
  if (judged.certified_gap && !gives) judged.violation = violation = 0.0;  // what doubles say of it is their rounding
  constexpr double kRounding = lp::kWidestGap;  // of the speeds, as between doubles and the exact answer
  tolerance = std::max(tolerance, kRounding * (norm(judged.best) + norm(problem.preferred)));
  const bool says_relaxed = answer->status == Status::relaxed;
  if (violation > tolerance)
    judged.verdict = LpVerdict::violated;
  else if (answer->status && says_relaxed != gives && (says_relaxed || proven.solution.violation > tolerance))
    judged.verdict = LpVerdict::wrong_status;
  else if (judged.excess.value_or(0.0) > tolerance)
    judged.verdict = LpVerdict::not_optimal;
  else
    judged.verdict = LpVerdict::optimal;
  return judged;
}

using Json = nlohmann::ordered_json;

struct LpFlags {
  std::string file;
  std::string solver = "certified";
  bool certify = false;
  bool json = false;
  std::string out;
  std::string answers;
  double tolerance = 1e-6;
  const CLI::Option* solver_option = nullptr;
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

/// What CSV calls the problems; the other formats have numbers only.
class ProblemNames {
 public:
  std::vector<std::string>& all() { return names_; }
  const std::vector<std::string>& all() const { return names_; }
  Json line(std::size_t index) const {
    Json out = {{"index", index}};
    if (index < names_.size()) out["name"] = names_[index];
    return out;
  }
  std::string in_table(std::size_t index) const {
    return index < names_.size() ? names_[index] : std::to_string(index);
  }

 private:
  std::vector<std::string> names_;
};

/// One result as a line of JSON; numbers read back to the same doubles.
Json result_line(Json out, const lp::Proven& answer) {
  const lp::Solution& s = answer.solution;
  out["status"] = name(s.status);
  out["velocity"] = {unsigned_zero(s.velocity.x), unsigned_zero(s.velocity.y)};
  out["violation"] = s.violation;
  out["active"] = Json::array();
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

void print_table(const std::vector<lp::Proven>& answers, const ProblemNames& names, const Summary& s) {
  ChunkedOutput out;
  out.add(fmt::format("{:>8} {:<11}{:>22}{:>24}{:>12}  {}\n", "problem", "status", "v_x [m/s]", "v_y [m/s]",
                      "violation", "certificate"));
  for (std::size_t k = 0; k < answers.size(); ++k) {
    const lp::Solution& a = answers[k].solution;
    out.add(fmt::format("{:>8} {:<11}{:>22.17g}{:>24.17g}{:>12.4g}  {}\n", names.in_table(k), name(a.status),
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

void print_lines(const std::vector<lp::Proven>& answers, const ProblemNames& names, const Summary& summary) {
  ChunkedOutput out;
  for (std::size_t k = 0; k < answers.size(); ++k) out.add(result_line(names.line(k), answers[k]).dump() + "\n");
  out.add(summary_json(summary).dump() + "\n");
  out.flush();
}

// --- Answers of other solvers ---

Json null_or(const std::optional<double>& value) {
  return value ? Json(*value) : Json();
}

Json judged_line(Json out, const JudgedAnswer& j) {
  out["verdict"] = name(j.verdict);
  out["right"] = j.is_right();
  out["status"] = name(j.truth);
  out["best"] = {unsigned_zero(j.best.x), unsigned_zero(j.best.y)};
  out["violation"] = null_or(j.violation);
  out["excess"] = null_or(j.excess);
  out["certified_gap"] = null_or(j.certified_gap);
  return out;
}

struct JudgedSummary {
  std::size_t right = 0, certified = 0;
  std::array<std::size_t, 8> by_verdict{};
  double worst_violation = 0.0, worst_excess = 0.0;
};

JudgedSummary summary_of(const std::vector<JudgedAnswer>& all) {
  JudgedSummary s;
  for (const JudgedAnswer& j : all) {
    s.right += j.is_right();
    s.certified += j.certified_gap.has_value();
    ++s.by_verdict[static_cast<std::size_t>(j.verdict)];
    s.worst_violation = std::max(s.worst_violation, j.violation.value_or(0.0));
    s.worst_excess = std::max(s.worst_excess, j.excess.value_or(0.0));
  }
  return s;
}

void print_judged_lines(const std::vector<JudgedAnswer>& all, const ProblemNames& names, const JudgedSummary& s) {
  ChunkedOutput out;
  for (std::size_t k = 0; k < all.size(); ++k) out.add(judged_line(names.line(k), all[k]).dump() + "\n");
  Json fields = {{"problems", all.size()}, {"right", s.right}, {"wrong", all.size() - s.right}};
  for (std::size_t k = 0; k < s.by_verdict.size(); ++k) fields[name(static_cast<LpVerdict>(k))] = s.by_verdict[k];
  fields["certified"] = s.certified;
  fields["worst_violation"] = s.worst_violation;
  fields["worst_excess"] = s.worst_excess;
  out.add(Json({{"summary", fields}}).dump() + "\n");
  out.flush();
}

void print_judged_table(const std::vector<JudgedAnswer>& all, const ProblemNames& names, const JudgedSummary& s) {
  const auto cell = [](const std::optional<double>& value) { return value ? fmt::format("{:.4g}", *value) : "-"; };
  ChunkedOutput out;
  out.add(fmt::format("{:>8} {:<19}{:<12}{:>12}{:>12}{:>14}\n", "problem", "verdict", "is", "violation", "excess",
                      "proven within"));
  for (std::size_t k = 0; k < all.size(); ++k)
    out.add(fmt::format("{:>8} {:<19}{:<12}{:>12}{:>12}{:>14}\n", names.in_table(k), name(all[k].verdict),
                        name(all[k].truth), cell(all[k].violation), cell(all[k].excess), cell(all[k].certified_gap)));
  std::string counts;
  for (std::size_t k = 0; k < s.by_verdict.size(); ++k)
    if (s.by_verdict[k] > 0) counts += fmt::format(", {} {}", s.by_verdict[k], name(static_cast<LpVerdict>(k)));
  out.add(fmt::format("{}: {} right, {} wrong{}; worst violation {:.4g} m/s, worst excess {:.4g} m/s\n",
                      geometry::counted(all.size(), "answer"), s.right, all.size() - s.right, counts, s.worst_violation,
                      s.worst_excess));
  out.flush();
}

ExitCode check_answers(const std::vector<lp::Problem>& problems, const ProblemNames& names, const LpFlags& flags) {
  const std::vector<std::optional<GivenAnswer>> answers = read_lp_answers(flags.answers, problems.size(), names.all());
  std::vector<JudgedAnswer> all;
  for (std::size_t k = 0; k < problems.size(); ++k) {
    if (interrupted()) throw Interrupted();
    all.push_back(judge(problems[k], answers[k], flags.tolerance));
  }
  const JudgedSummary s = summary_of(all);
  flags.json ? print_judged_lines(all, names, s) : print_judged_table(all, names, s);
  return s.right == all.size() ? ExitCode::success : ExitCode::negative;
}

// --- Problems ---

/// The recording that is meant: a folder of a run, or a file that begins as one.
std::optional<std::filesystem::path> recording_meant(const std::string& file) {
  std::error_code unknown;
  const bool is_folder = std::filesystem::is_directory(file, unknown);
  const std::filesystem::path meant = is_folder ? *recording_at(file) : std::filesystem::path(file);
  if (!std::filesystem::is_regular_file(meant, unknown)) return std::nullopt;
  if (datasets::is_crowd_recording(meant))
    throw datasets::DataError(datasets::DataCode::format_unknown, meant.string(), "", "a recording without decisions",
                              "the recording.jsonl of a run with --decisions binding or all");
  if (is_folder) return meant;
  std::ifstream in(file, std::ios::binary);
  std::string beginning(200, '\0');
  in.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  return beginning.find("exactvo-recording") == std::string::npos ? std::nullopt
                                                                  : std::optional<std::filesystem::path>(file);
}

lp::Problem problem_of(const formation::Scenario& scenario, const formation::RobotStep& robot, double max_speed) {
  lp::Problem problem;
  problem.preferred = robot.preferred;
  if (scenario.speed_bound == formation::SpeedBoundKind::disc)
    problem.bound.disc = max_speed;
  else
    problem.bound.box_x = problem.bound.box_y = max_speed;
  problem.constraints = formation::problem_of(robot, robot.constraints);
  for (std::size_t k = 0; k < robot.constraints.size(); ++k)
    problem.constraints[k].label = static_cast<int>(robot.constraints[k].body);
  return problem;
}

/// The decisions of a run, row by row and robot by robot; the last row has none.
void for_each_decision(const std::filesystem::path& recording, const std::function<void(lp::Problem)>& take) {
  std::optional<formation::Step> row;
  datasets::read_recording(
      recording, [&](const datasets::RecordingFile& about, const formation::Step& next, const formation::LyapunovRow*) {
        if (interrupted()) throw Interrupted();
        for (std::size_t i = 0; row && i < row->robots.size(); ++i)
          take(problem_of(about.scenario, row->robots[i], about.scenario.robots[i].max_speed));
        row = next;
      });
}

Json json_of(const lp::Problem& problem) {
  Json bound = Json::object();
  if (std::isfinite(problem.bound.disc)) bound["disc"] = problem.bound.disc;
  const auto side = [](double length) { return std::isfinite(length) ? Json(length) : Json(); };
  if (std::isfinite(problem.bound.box_x) || std::isfinite(problem.bound.box_y))
    bound["box"] = {side(problem.bound.box_x), side(problem.bound.box_y)};
  Json constraints = Json::array();
  for (const lp::Constraint& c : problem.constraints) {
    Json one = {{"normal", {c.half_plane.normal.x, c.half_plane.normal.y}}, {"offset", c.half_plane.offset}};
    if (c.priority == lp::Priority::soft) one["priority"] = "soft";
    if (c.label != -1) one["label"] = c.label;
    constraints.push_back(std::move(one));
  }
  Json json = {{"bound", bound},
               {"preferred", {problem.preferred.x, problem.preferred.y}},
               {"constraints", std::move(constraints)}};
  if (problem.objective == lp::Objective::farthest) json["objective"] = "farthest";
  return json;
}

void for_each_problem(const std::string& file, std::vector<std::string>& names,
                      const std::function<void(lp::Problem)>& take) {
  if (const auto recording = recording_meant(file)) return for_each_decision(*recording, take);
  for (lp::Problem& problem :
       datasets::parse_lp_problems(datasets::read_file_or_input(file), datasets::name_of_input(file), &names))
    take(std::move(problem));
}

ExitCode write_problems(const LpFlags& flags) {
  datasets::AtomicFile out(flags.out);
  std::size_t count = 0;
  std::vector<std::string> names;
  for_each_problem(flags.file, names, [&](const lp::Problem& problem) {
    out.write(json_of(problem).dump() + "\n");
    ++count;
  });
  out.commit();
  message(fmt::format("wrote {}: {}", flags.out, geometry::counted(count, "problem")));
  return ExitCode::success;
}

void check_option_conflicts(const LpFlags& flags) {
  const bool checks = !flags.answers.empty(), writes = !flags.out.empty();
  refuse_both(checks && writes, "--check", "--out");
  for (const auto& [is_there, option] :
       {std::pair(flags.certify, "--certify"), std::pair(flags.solver_option->count() > 0, "--solver")}) {
    refuse_both(checks && is_there, option, "--check", "answers are compared with the certified ones");
    refuse_both(writes && is_there, option, "--out", "--out writes problems, not answers");
  }
  refuse_both(writes && flags.json, "--json", "--out", "--out writes JSON Lines in any case");
  refuse_both(checks && flags.answers == "-" && flags.file == "-", "--check -", "- for the problems",
              "there is one standard input");
  require(flags.tolerance >= 0.0 && std::isfinite(flags.tolerance), "--tolerance", fmt::format("{}", flags.tolerance),
          "a number of m/s, at least 0");
}

ExitCode solve_or_check(const LpFlags& flags) {
  const auto solver = parse_choice<lp::Solver>("--solver", flags.solver, lp::solver_names());
  check_option_conflicts(flags);
  if (!flags.out.empty()) return write_problems(flags);
  std::vector<lp::Problem> problems;
  ProblemNames names;
  for_each_problem(flags.file, names.all(), [&](lp::Problem problem) { problems.push_back(std::move(problem)); });
  if (!flags.answers.empty()) return check_answers(problems, names, flags);
  lp::Solving solving(solver, problems);
  const double before = thread_nanoseconds();
  solving.solve();
  const double spent = thread_nanoseconds() - before;
  std::vector<lp::Proven> answers = solving.answers();
  if (flags.certify)
    for (std::size_t k = 0; k < problems.size(); ++k) prove(problems[k], answers[k]);
  const bool is_proven = flags.certify || solver == lp::Solver::certified || solver == lp::Solver::exact;
  Summary summary = summarise(problems, answers, is_proven);
  summary.ns_per_solve = problems.empty() ? 0.0 : spent / static_cast<double>(problems.size());
  if (flags.json)
    print_lines(answers, names, summary);
  else
    print_table(answers, names, summary);
  if (summary.unproven.value_or(0) == 0) return ExitCode::success;
  message(
      fmt::format("warning: answers without a proof: {} of {}; their multipliers leave the range of doubles, or no "
                  "double near the best velocity satisfies what must hold",
                  *summary.unproven, summary.problems));
  return ExitCode::negative;
}

void declare_lp(CLI::App& app, LpFlags& flags) {
  app.add_option(
         "file", flags.file,
         "Problems: JSON Lines, one JSON document or a binary instance file, - for stdin; or a run (its folder or "
         "recording.jsonl), whose decisions are the problems")
      ->required();
  flags.solver_option = app.add_option("--solver", flags.solver, "batch, certified or exact")->capture_default_str();
  app.add_flag("--certify", flags.certify, "Certify every answer; those that cannot be certified are solved exactly");
  app.add_flag("--json", flags.json, "One JSON result per line, then a summary");
  app.add_option(
      "--check", flags.answers,
      "FILE, or - for stdin: answers of another solver, JSON Lines (such as --json prints) or CSV with the "
      "columns vx, vy and, where wanted, index, problem (the name of one) and status; each is judged by a proof, and "
      "status 1 says that one is wrong");
  app.add_option("--tolerance", flags.tolerance,
                 "With --check: m/s, by which an answer may violate a constraint or be worse than the best one")
      ->capture_default_str();
  declare_out(app, flags.out, "FILE: write the problems as JSON Lines instead of solving them");
}

}  // namespace

Verb lp_verb() {
  return {
      "lp", "Solve the small optimisation problems that turn half-planes into a velocity, with certificates",
      "  echo '{\"bound\": {\"disc\": 2}, \"preferred\": [2, 0], \"constraints\": [{\"normal\": [-1, 0], \"offset\": "
      "-0.5}]}' | exactvo lp - --json\n"
      "  exactvo lp problems.jsonl --check answers.csv\n"
      "  exactvo simulate datasets/data/paper/A7.json --decisions all --out out/A7 && exactvo lp out/A7 --out "
      "A7.jsonl\n"
      "    (a violation is in m/s where the normals have length 1, else in m/s times |normal|. Status 1: an answer is "
      "not\n"
      "    proven although a proof was requested by `certified`, `exact` or --certify. The lines:\n"
      "    docs/guide/linear-program.md. ns_per_solve is the thread's processor time of the solver alone, one pass "
      "over\n"
      "    the file: not reading, laying out for `batch`, gathering, printing, nor what --certify adds. Of a file of "
      "few\n"
      "    problems it says little; to compare solvers run bench_lp --instances FILE)\n",
      with_flags(declare_lp, solve_or_check)};
}

}  // namespace exactvo::tools
