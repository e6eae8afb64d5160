// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <optional>
#include <string_view>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/geometry/counted.h"
#include "json/json_text.h"
#include "recordings/codec.h"

namespace exactvo::datasets {

namespace {

using formation::Step;

constexpr std::string_view kKind = "exactvo-recording";

void read_header(const JsonCursor& at, const std::string& name, RecordingFile& file) {
  if (at.at("kind").text() != kKind) at.at("kind").refuse("\"exactvo-recording\"", DataCode::not_an_option);
  if (at.at("format_version").integer() != kRecordingFormat)
    at.at("format_version").refuse(std::to_string(kRecordingFormat), DataCode::out_of_range);
  file.scenario = parse_scenario(at.at("scenario").json().dump(), name, {});
  file.info.scenario = file.scenario.name;
  members(at, file.info);
  file.info.provenance = parse_provenance(at.at("provenance").json().dump(), name);
  formation::Recording& recording = file.recording;
  if (file.scenario.formation) recording.controller_options.emplace();
  members(at, recording);
  if (recording.all_half_planes) file.info.decisions = "all";
  const std::size_t slots = file.scenario.formation ? file.scenario.robots.size() : 0;
  if (recording.offsets.size() != slots)
    at.at("offsets").refuse(geometry::counted(slots, "offset") + ", one for each robot of a formation",
                            DataCode::wrong_count);
  at.end_of_object();
}

void read_end(const JsonCursor& at, std::size_t rows, RecordingFile& file) {
  if (at.at("rows").count() != rows)
    at.at("rows").refuse(std::to_string(rows) + ", the rows above", DataCode::wrong_count);
  members(at, file);
  at.at("sha256").text();
  at.end_of_object();
}

/// Reads the lines after the header.
class RecordReader {
 public:
  /// Rows go to `take`.
  RecordReader(RecordingFile& file, const TakeRow& take) : file_(file), take_(take), bodies_(file.recording.bodies) {}

  bool is_at_end() const { return at_end_; }
  std::size_t rows() const { return rows_; }

  void read(const JsonCursor& at) {
    if (at_end_) at.refuse("nothing after the end", DataCode::wrong_count);
    read_member(at);
    at.end_of_object();
  }

 private:
  void read_member(const JsonCursor& at) {
    if (at.has("body")) return read_body(at.at("body"));
    if (at.has("goal_bodies")) return read_goal_bodies(at.at("goal_bodies"));
    if (at.has("plan")) return read_plan(at.at("plan"));
    if (at.has("row")) return read_row(at.at("row"));
    read_end(at.at("end"), rows_, file_);
    at_end_ = true;
  }

  void read_body(const JsonCursor& at) {
    constexpr std::size_t kMostBodies = std::size_t{1} << 28;
    const std::size_t number = at.at("number").count();
    if (number >= kMostBodies) at.at("number").refuse("a smaller number", DataCode::out_of_range);
    // Numbers may be left out, but no file of a few lines asks for much memory.
    if (number >= bodies_.size() + kMostBodies / 256)
      at.at("number").refuse("a smaller number", DataCode::out_of_range);
    if (number >= bodies_.size()) {
      bodies_.resize(number + 1);
      known_.resize(number + 1);
    }
    if (known_[number]) at.at("number").refuse("a number of no body above", DataCode::out_of_range);
    members(at, bodies_[number]);
    at.end_of_object();
    require_owners(at.at("owners"), bodies_[number]);
    if (bodies_[number].kind == vo::BodyKind::robot) {
      const formation::Robot& robot = file_.scenario.robots[bodies_[number].owners.front()];
      bodies_[number].shape = geometry::Disc{robot.position, robot.radius};
    }
    known_[number] = true;
  }

  void require_owners(const JsonCursor& at, const vo::Body& body) const {
    const formation::Scenario& s = file_.scenario;
    const std::size_t all = body.kind == vo::BodyKind::robot             ? s.robots.size()
                            : body.kind == vo::BodyKind::moving_obstacle ? s.moving_obstacles.size()
                                                                         : s.obstacles.size();
    const bool is_one = moves(body.kind);
    if (is_one && body.owners.size() != 1) at.refuse("one owner", DataCode::wrong_count);
    for (std::size_t k = 0; k < body.owners.size(); ++k)
      if (body.owners[k] >= all) at.at(k).refuse("a number below " + std::to_string(all), DataCode::out_of_range);
  }

  std::size_t known_body(const JsonCursor& at) const {
    const std::size_t number = at.count();
    if (number >= bodies_.size() || !known_[number]) at.refuse("a body of a line above", DataCode::out_of_range);
    return number;
  }

  void read_goal_bodies(const JsonCursor& at) {
    formation::GoalBodies of_goal{at.at("time").number(), robot_of_scenario(at.at("robot")), at.at("goal").count(), {}};
    if (rows_ > 0 && !(of_goal.time > last_time_))
      at.at("time").refuse("a time after that of the rows above", DataCode::out_of_range);
    const JsonCursor list = at.at("bodies");
    at.end_of_object();
    for (std::size_t k = 0; k < list.size(); ++k) of_goal.bodies.push_back(known_body(list.at(k)));
    file_.recording.goal_bodies.push_back(std::move(of_goal));
  }

  std::size_t robot_of_scenario(const JsonCursor& at) const {
    const std::size_t robot = at.count();
    if (robot >= file_.scenario.robots.size()) at.refuse("a robot of the scenario", DataCode::out_of_range);
    return robot;
  }

  void read_plan(const JsonCursor& at) {
    formation::JointPlan plan{at.at("row").count(), at.at("from_row").count(), {}, {}, {}};
    if (plan.row != rows_)
      at.at("row").refuse(std::to_string(rows_) + ", the row that follows", DataCode::out_of_range);
    if (plan.from_row > plan.row) at.at("from_row").refuse("a row up to that of the plan", DataCode::out_of_range);
    const JsonCursor robots = at.at("robots"), moves = at.at("moves");
    at.end_of_object();
    for (std::size_t k = 0; k < robots.size(); ++k) {
      const JsonCursor one = robots.at(k);
      const std::size_t robot = robot_of_scenario(one.at("robot"));
      if (!plan.robots.empty() && robot <= plan.robots.back())
        one.at("robot").refuse("robots in the order of the scenario, each once", DataCode::out_of_range);
      plan.robots.push_back(robot);
      plan.starts.push_back(one.at("start").point());
      one.end_of_object();
    }
    for (std::size_t k = 0; k < moves.size(); ++k) {
      read_value(moves.at(k), plan.moves.emplace_back());
      const std::size_t robot = robot_of_scenario(moves.at(k).at("robot"));
      if (!std::binary_search(plan.robots.begin(), plan.robots.end(), robot))
        moves.at(k).at("robot").refuse("a robot of the plan", DataCode::out_of_range);
    }
    file_.recording.plans.push_back(std::move(plan));
  }

  void read_row(const JsonCursor& at) {
    Step step;
    step.time = at.at("time").number();
    if (file_.scenario.formation) {
      at.object("leader", [&](const JsonCursor& leader) {
        step.leader_position = leader.at("position").point();
        step.leader_velocity = leader.at("velocity").point();
      });
    }
    if (at.has("moving") && at.at("moving").size() != file_.scenario.moving_obstacles.size())
      at.at("moving").refuse("a place for every moving obstacle", DataCode::wrong_count);
    at.optional("moving", step.moving);
    const JsonCursor robots = at.at("robots");
    if (robots.size() != file_.scenario.robots.size())
      robots.refuse(geometry::counted(file_.scenario.robots.size(), "robot") + ", as the scenario has",
                    DataCode::wrong_count);
    read_value(robots, step.robots);
    for (std::size_t i = 0; i < robots.size(); ++i)
      for (std::size_t k = 0; k < step.robots[i].constraints.size(); ++k)
        take_source(robots.at(i).at("constraints").at(k), step, step.robots[i].constraints[k]);
    std::optional<formation::LyapunovRow> lyapunov;
    at.optional("lyapunov", lyapunov);
    at.end_of_object();
    if (lyapunov) lyapunov->time = step.time;
    ++rows_;
    last_time_ = step.time;
    take_(file_, std::move(step), lyapunov ? &*lyapunov : nullptr);
  }

  /// From its body, which must have a place in the row.
  void take_source(const JsonCursor& at, const Step& step, formation::DecisionConstraint& c) const {
    c.source = bodies_[known_body(at.at("body"))].kind;
    if (c.source == vo::BodyKind::moving_obstacle && step.moving.empty())
      at.refuse("no half-plane against what moves in a row without its place");
  }

  RecordingFile& file_;
  const TakeRow& take_;
  std::vector<vo::Body>& bodies_;
  std::size_t rows_ = 0;
  double last_time_ = 0.0;  ///< s, of the rows so far
  std::vector<bool> known_;
  bool at_end_ = false;
};

/// It ends before its last line: before line `number`, or within it. `rows`: above.
DataError cut_off(const std::string& name, std::size_t number, std::size_t rows, bool within_line) {
  return {DataCode::cut_off, name, "line " + std::to_string(number),
          "the end of the file after " + geometry::counted(rows, "row") + (within_line ? ", within a line" : ""),
          "a last line \"end\": the recording ends early"};
}

/// A line of JSON. Where the last line ends amid it, whoever wrote it did not get further; another one is damaged.
Json line_of_recording(std::string_view line, const NextLine& next_line, const std::string& name, std::size_t number,
                       std::size_t rows) {
  try {
    return parse_json_line(line, name, number);
  } catch (const DataError& error) {
    const std::string end = "line " + std::to_string(number) + ", column " + std::to_string(line.size() + 1);
    if (error.code() != DataCode::json_syntax || error.place() != end) throw;
    std::string_view further;
    if (next_line(further)) throw;
    throw cut_off(name, number, rows, true);
  }
}

/// How a recording begins, as the writer has it.
constexpr std::string_view kBeginningOfHeader = R"({"header":{"kind":"exactvo-recording")";

/// What is packed, by its first bytes: a name, and the command that unpacks it to its stdout.
struct Packing {
  std::string_view magic;
  const char *name, *command;
};
constexpr Packing kPackings[] = {{"\x28\xb5\x2f\xfd", "zstd", "zstd -dc"},
                                 {"\x1f\x8b", "gzip", "gzip -dc"},
                                 {"\xfd"
                                  "7zXZ",
                                  "xz", "xz -dc"},
                                 {"BZh", "bzip2", "bzip2 -dc"},
                                 {"\x04\x22\x4d\x18", "lz4", "lz4 -dc"}};

/// Whether bytes are those of a text in UTF-8, as far as control characters tell.
bool is_text(std::string_view bytes) {
  return std::none_of(bytes.begin(), bytes.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\r' && c != '\n';
  });
}

/// The first lines of a file, 1 MiB or all.
std::string beginning_of(std::string_view first_line, const NextLine& next_line) {
  constexpr std::size_t kBeginning = 1 << 20;
  std::string text(first_line);
  std::string_view line;
  while (text.size() < kBeginning && next_line(line)) text.append("\n").append(line);
  return text;
}

/// What a file is that is no recording, as far as that is seen in its beginning.
std::string kind_of(const std::string& beginning) {
  if (!is_text(beginning)) return "no text";
  try {
    const Json tree = parse_json(beginning, "");
    if (tree.is_object() && tree.contains("name") && tree.contains("robots")) return "a scenario, which is no run yet";
    if (tree.is_object() && tree.contains("provenance") && tree.contains("outcome")) return "the metrics of a run";
  } catch (const DataError&) {  // not JSON
  }
  return "no recording";
}

/// A file of another kind is refused as a whole: what is wrong in its first line tells nobody anything.
void require_recording(std::string_view first_line, const NextLine& next_line, const std::string& name) {
  const std::string recording = "a recording.jsonl, as simulate --out writes it";
  if (first_line.find(kKind) != std::string_view::npos) return;
  if (begins_crowd_recording(first_line))
    throw DataError(DataCode::format_unknown, name, "", "the recording of a crowd (.evr), which has no decisions",
                    recording + " with --decisions binding; audit, convert, draw and view read recordings of crowds");
  for (const Packing& packing : kPackings)
    if (first_line.substr(0, packing.magic.size()) == packing.magic)
      throw DataError(DataCode::format_unknown, name, "", std::string("what ") + packing.name + " has packed",
                      "a recording.jsonl: unpack it, into a file or into the audit, " + std::string(packing.command) +
                          " FILE | exactvo audit -");
  const std::string beginning = beginning_of(first_line, next_line);
  if (beginning.empty())
    throw DataError(DataCode::cut_off, name, "", "an empty file",
                    recording + ": whoever was to write it has not begun");
  if (beginning == kBeginningOfHeader.substr(0, beginning.size())) throw cut_off(name, 1, 0, true);
  throw DataError(DataCode::format_unknown, name, "", kind_of(beginning), recording);
}

/// The lines of a text that must outlive the result.
NextLine lines_of(std::string_view text) {
  return [rest = text](std::string_view& line) mutable {
    if (rest.empty()) return false;
    const std::size_t end = rest.find('\n');
    line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    return true;
  };
}

/// What `read` reads, with all rows that it gives its argument.
template <class Read>
RecordingFile with_all_rows(const Read& read) {
  std::vector<Step> steps;
  std::vector<formation::LyapunovRow> lyapunov;
  RecordingFile file = read([&](const RecordingFile&, Step row, const formation::LyapunovRow* values) {
    steps.push_back(std::move(row));
    if (values) lyapunov.push_back(*values);
  });
  file.recording.steps = std::move(steps);
  file.lyapunov = std::move(lyapunov);
  return file;
}

}  // namespace

void read_recording_lines(const NextLine& next_line, const std::string& name, const TakeRow& take, RecordingFile& run) {
  std::string_view line;
  if (!next_line(line)) line = {};
  require_recording(line, next_line, name);
  {
    const Json header = line_of_recording(line, next_line, name, 1, 0);
    const JsonCursor first(header, name, "line 1", JsonCursor::OtherKeys::refused);
    // A header of format 1 has no name: its version is what is wrong with it.
    read_header(first.has("header") ? first.at("header") : first, name, run);
    first.end_of_object();
  }
  RecordReader reader(run, take);
  std::size_t number = 2;
  for (; next_line(line); ++number) {
    const Json content = line_of_recording(line, next_line, name, number, reader.rows());
    reader.read(JsonCursor(content, name, "line " + std::to_string(number), JsonCursor::OtherKeys::refused));
  }
  if (!reader.is_at_end()) throw cut_off(name, number, reader.rows(), false);
}

RecordingFile read_recording(const std::filesystem::path& path, const TakeRow& take) {
  TextLines lines(path);
  RecordingFile run;
  read_recording_lines([&](std::string_view& line) { return lines.next(line); }, path.string(), take, run);
  return run;
}

RecordingFile read_recording(const std::filesystem::path& path) {
  return with_all_rows([&](const TakeRow& take) { return read_recording(path, take); });
}

RecordingFile parse_recording(const std::string& text, const std::string& name) {
  return with_all_rows([&](const TakeRow& take) {
    RecordingFile run;
    read_recording_lines(lines_of(text), name, take, run);
    return run;
  });
}

}  // namespace exactvo::datasets
