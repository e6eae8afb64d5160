// SPDX-License-Identifier: GPL-3.0-or-later
// Plans of multi-agent path finding: the YAML of libMultiRobotPlanning, and paths as lines "Agent 0: (1,2)->(1,3)->".
// An agent is in the middle of a cell at each whole second. One that has arrived rests at its goal until the plan ends,
// as planners have it: their files say nothing of these steps.
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

#include "exactvo/datasets/input_text.h"
#include "files/text_file.h"
#include "json/json_text.h"
#include "readers/line_reader.h"
#include "trajectories/trajectory_readers.h"

namespace exactvo::datasets {
namespace {

double number_of(const YAML::Node& step, const char* key, TrajectorySink& out) {
  const auto line = static_cast<std::uint64_t>(step.Mark().line + 1);
  const YAML::Node value = step.IsMap() ? step[key] : YAML::Node();
  if (!value || !value.IsScalar())
    out.refuse(DataCode::key_missing, line, std::string("no key ") + key, "x, y and t of a step");
  return out.number(value.Scalar(), key, static_cast<std::uint64_t>(value.Mark().line + 1));
}

/// The steps of all agents, those at the goals included.
class PlanRows {
 public:
  explicit PlanRows(TrajectorySink& out) : out_(out) { out_.file().in_cells = true; }

  void add(std::size_t agent, double time, geometry::Vec2 at, std::uint64_t line) {
    out_.row(agent, time, at, line);
    if (agent >= last_.size()) last_.resize(agent + 1);
    last_[agent] = {time, at, line};
    if (time > end_) end_ = time, end_line_ = line;
    rows_ += 1.0;
  }

  /// A row for each step that an agent rests at its goal. REQUIRES: all steps have been added.
  void rest() {
    const double most = std::max(0x1p21, 16.0 * rows_);  // each is kept in memory
    double rests = 0.0;
    for (const Step& last : last_)
      if (last.line > 0) rests += std::ceil(end_ - last.time);
    if (rests == 0.0) return;
    if (rests > most)
      out_.refuse(DataCode::size, end_line_, number_text(rests) + " steps at goals until the plan ends",
                  "at most " + number_text(most));
    for (std::size_t agent = 0; agent < last_.size(); ++agent) {
      const Step& last = last_[agent];
      if (last.line == 0) continue;
      for (double step = 1.0; last.time + step < end_; step += 1.0)
        out_.row(agent, last.time + step, last.at, last.line);
      if (last.time < end_) out_.row(agent, end_, last.at, last.line);
    }
    out_.file().notes.push_back("agents that have arrived rest at their goals until the plan ends, at " +
                                number_text(end_) + " s");
  }

 private:
  struct Step {
    double time = 0.0;
    geometry::Vec2 at;
    std::uint64_t line = 0;  ///< 0: the agent has no step
  };
  TrajectorySink& out_;
  std::vector<Step> last_;  ///< of each agent
  double end_ = -std::numeric_limits<double>::infinity();
  std::uint64_t end_line_ = 0;
  double rows_ = 0.0;  ///< of the file
};

/// The number at the beginning of a text, which is taken off.
double taken_number(std::string_view& text, std::uint64_t line, TrajectorySink& out) {
  const std::size_t end = std::min(text.find_first_of(",)"), text.size());
  const double number = out.number(trimmed(text.substr(0, end)), "a row or a column", line);
  text.remove_prefix(std::min(end + 1, text.size()));
  return number;
}

}  // namespace

bool looks_like_mapf_yaml(std::string_view beginning) {
  return beginning.rfind("schedule:", 0) == 0 || beginning.find("\nschedule:") != std::string_view::npos;
}

void read_mapf_yaml(const std::filesystem::path& path, TrajectorySink& out) {
  PlanRows rows(out);
  YAML::Node root;
  try {
    root = YAML::Load(read_text_file(path));
  } catch (const YAML::Exception& error) {
    out.refuse(DataCode::format_syntax, static_cast<std::uint64_t>(error.mark.line + 1), error.msg, "YAML");
  }
  const YAML::Node schedule = root.IsMap() ? root["schedule"] : YAML::Node();
  if (!schedule || !schedule.IsMap())
    out.refuse(DataCode::key_missing, 1, "no schedule", "schedule: with the steps of each agent");
  for (const auto& agent : schedule) {
    if (!agent.first.IsScalar() || !agent.second.IsSequence())
      out.refuse(DataCode::wrong_type, static_cast<std::uint64_t>(agent.first.Mark().line + 1), "no list of steps",
                 "an agent with a list of steps");
    const std::size_t number = out.agent(agent.first.Scalar());
    for (const YAML::Node& step : agent.second)
      rows.add(number, number_of(step, "t", out), {number_of(step, "x", out), number_of(step, "y", out)},
               static_cast<std::uint64_t>(step.Mark().line + 1));
  }
  rows.rest();
}

bool looks_like_mapf_paths(std::string_view beginning) {
  return beginning.rfind("Agent ", 0) == 0 && beginning.find("(") != std::string_view::npos;
}

void read_mapf_paths(const std::filesystem::path& path, TrajectorySink& out) {
  PlanRows rows(out);
  constexpr std::size_t kLongestPath = std::size_t{1} << 24;  // a line is the whole way of an agent
  TextLines lines(path.string(), kLongestPath);
  for (std::string_view line; lines.next(line);) {
    line = trimmed(line);
    if (line.empty()) continue;
    const std::size_t colon = line.find(':');
    constexpr std::string_view kAgent = "Agent ";
    if (line.substr(0, kAgent.size()) != kAgent || colon == std::string_view::npos)
      out.refuse(DataCode::format_syntax, lines.number(), excerpt(line, 0, 40), "Agent NUMBER: (row,column)->...");
    const std::size_t agent = out.agent(trimmed(line.substr(kAgent.size(), colon - kAgent.size())));
    std::string_view rest = line.substr(colon + 1);
    double step = 0.0;
    for (std::size_t open = 0; (open = rest.find('(')) != std::string_view::npos; step += 1.0) {
      rest.remove_prefix(open + 1);
      const double row = taken_number(rest, lines.number(), out), column = taken_number(rest, lines.number(), out);
      rows.add(agent, step, {column, row}, lines.number());
    }
  }
  rows.rest();
}

}  // namespace exactvo::datasets
