// SPDX-License-Identifier: GPL-3.0-or-later
// Plans of multi-agent path finding: the YAML of libMultiRobotPlanning, and paths as lines "Agent 0: (1,2)->(1,3)->".
// An agent is in the middle of a cell at each whole second.
#include <yaml-cpp/yaml.h>

#include <charconv>

#include "exactvo/datasets/input_text.h"
#include "files/text_file.h"
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
  out.file().in_cells = true;
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
      out.row(number, number_of(step, "t", out), {number_of(step, "x", out), number_of(step, "y", out)},
              static_cast<std::uint64_t>(step.Mark().line + 1));
  }
}

bool looks_like_mapf_paths(std::string_view beginning) {
  return beginning.rfind("Agent ", 0) == 0 && beginning.find("(") != std::string_view::npos;
}

void read_mapf_paths(const std::filesystem::path& path, TrajectorySink& out) {
  out.file().in_cells = true;
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
      out.row(agent, step, {column, row}, lines.number());
    }
  }
}

}  // namespace exactvo::datasets
