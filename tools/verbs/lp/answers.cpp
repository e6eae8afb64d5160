// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/lp/answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "exactvo/datasets/data_error.h"
#include "exactvo/vo/lp/certificate.h"
#include "support/fields.h"

namespace exactvo::tools {
namespace {

using datasets::DataCode;
using datasets::DataError;
using geometry::Vec2;
using lp::Status;
using Tree = nlohmann::json;

// --- The file ---

constexpr const char* kStatusWords = "optimal, relaxed, infeasible or no-interior";

/// Collects answers by their numbers: those that name theirs, and those that come in the order of the problems.
class AnswersByNumber {
 public:
  explicit AnswersByNumber(std::size_t count) : all_(count) {}

  void put(const TableLines& at, std::optional<double> index, GivenAnswer answer) {
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
  std::vector<std::optional<GivenAnswer>> all_;
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
  answers.put(at, index.is_number() ? std::optional(index.get<double>()) : std::nullopt, answer);
}

/// Which column is which, by the first line.
class AnswerColumns {
 public:
  explicit AnswerColumns(const TableLines& at) {
    const std::vector<std::string_view> names = fields_of(at.line());
    for (std::size_t k = 0; k < names.size(); ++k) column_[std::string(names[k])] = k;
    width_ = names.size();
    if (column_.count("vx") == 0 || column_.count("vy") == 0)
      at.refuse(
          DataCode::format_unknown, at.line(),
          "answers: an object of JSON on each line, or CSV with the columns vx and vy and, where wanted, index and "
          "status");
  }

  void put(const TableLines& at, AnswersByNumber& answers) const {
    const std::vector<std::string_view> fields = fields_of(at.line());
    if (fields.size() != width_)
      at.refuse(DataCode::wrong_count, at.line(), fmt::format("{} fields, as many as the header has", width_));
    GivenAnswer answer;
    const std::optional<double> x = number(at, fields, "vx"), y = number(at, fields, "vy");
    if (x && y) answer.velocity = Vec2{*x, *y};
    if (const auto status = column_.find("status"); status != column_.end())
      answer.status = status_of(at, fields[status->second]);
    require_velocity_or_status(at, answer);
    answers.put(at, number(at, fields, "index"), answer);
  }

 private:
  std::optional<double> number(const TableLines& at, const std::vector<std::string_view>& fields,
                               const char* column) const {
    const auto found = column_.find(column);
    if (found == column_.end() || fields[found->second].empty()) return std::nullopt;
    const std::optional<double> value = number_in(fields[found->second]);
    if (!value) at.refuse(DataCode::wrong_type, fields[found->second], fmt::format("a number in column {}", column));
    return value;
  }

  std::map<std::string, std::size_t> column_;
  std::size_t width_ = 0;
};

// --- The verdict ---

/// m/s times |n|: by how much the velocity violates the constraints of this priority; 0 or less where none.
double violation_of(const lp::Problem& problem, Vec2 v, lp::Priority priority) {
  double most = -std::numeric_limits<double>::infinity();
  for (const lp::Constraint& c : problem.constraints)
    if (c.priority == priority) most = std::max(most, geometry::violation(c.half_plane, v));
  return most;
}

double beyond_bound(const lp::SpeedBound& bound, Vec2 v) {
  return std::max({norm(v) - bound.disc, std::fabs(v.x) - bound.box_x, std::fabs(v.y) - bound.box_y});
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

LpVerdict verdict_on_infeasible(Status truth) {
  if (truth == Status::infeasible) return LpVerdict::infeasible;
  return truth == Status::relaxed ? LpVerdict::wrong_status : LpVerdict::wrongly_infeasible;
}

}  // namespace

const char* name(LpVerdict verdict) {
  constexpr const char* kNames[] = {"optimal",          "infeasible",   "violated", "not-optimal", "wrongly-infeasible",
                                    "wrongly-feasible", "wrong-status", "missing"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::vector<std::optional<GivenAnswer>> read_lp_answers(const std::string& file, std::size_t count) {
  TableLines lines(file);
  AnswersByNumber answers(count);
  if (!lines.next())
    throw DataError(DataCode::format_unknown, file, "", "no answer", "an object of JSON on each line, or CSV");
  if (lines.line().front() == '{') {
    do put_json_line(lines, answers);
    while (lines.next());
    return answers.take();
  }
  const AnswerColumns columns(lines);
  while (lines.next()) columns.put(lines, answers);
  return answers.take();
}

JudgedAnswer judge(const lp::Problem& problem, const std::optional<GivenAnswer>& answer, double tolerance) {
  const lp::Proven proven = lp::solve_certified(problem);
  JudgedAnswer judged;
  judged.truth = proven.solution.status;
  judged.best = proven.solution.velocity;
  if (!answer) return judged;
  if (answer->status == Status::infeasible) {
    judged.verdict = verdict_on_infeasible(judged.truth);
    return judged;
  }
  const Vec2 v = *answer->velocity;
  const double soft = violation_of(problem, v, lp::Priority::soft);
  double violation = std::max(violation_of(problem, v, lp::Priority::hard), beyond_bound(problem.bound, v));
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

}  // namespace exactvo::tools
