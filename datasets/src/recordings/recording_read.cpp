// SPDX-License-Identifier: GPL-3.0-or-later
#include <string_view>

#include "exactvo/datasets/recording_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "json_cursor.h"
#include "recordings/recording_extras.h"
#include "recordings/recording_names.h"
#include "text_file.h"

namespace exactvo::datasets {
namespace {

using formation::RecordedConstraint;
using formation::RobotStep;
using formation::Step;

constexpr std::string_view kKind = "exactvo-recording";

geometry::ConvexShape to_shape(const JsonCursor& at) {
  if (at.has("disc")) return geometry::Disc{at.at("disc").at("center").point(), at.at("disc").at("radius").number()};
  if (at.has("segment")) {
    const std::vector<geometry::Vec2> ends = at.at("segment").points();
    if (ends.size() != 2) at.at("segment").refuse("two points", DataCode::wrong_count);
    return geometry::Segment{ends[0], ends[1]};
  }
  if (at.has("polygon")) return geometry::ConvexPolygon{at.at("polygon").points()};
  const JsonCursor e = at.at("ellipse");
  return geometry::Ellipse{e.at("center").point(), e.at("l11").number(), e.at("l21").number(), e.at("l22").number()};
}

std::vector<std::string> to_texts(const JsonCursor& at) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < at.size(); ++i) texts.push_back(at.at(i).text());
  return texts;
}

RecordedConstraint to_constraint(const JsonCursor& at) {
  RecordedConstraint c;
  c.half_plane = {at.at("normal").point(), at.at("offset").number()};
  c.source = enumerator<formation::ConstraintSource>(at.at("source"));
  c.index = at.at("index").count();
  if (at.has("piece")) c.piece = at.at("piece").count();
  c.certified = at.at("certified").truth();
  c.hard = at.at("hard").truth();
  c.active = at.at("active").truth();
  c.shape = to_shape(at.at("shape"));
  c.position = at.at("position").point();
  c.radius = at.at("radius").number();
  c.tau = at.at("tau").number();
  c.shape_velocity = at.at("shape_velocity").point();
  return c;
}

RobotStep to_robot_step(const JsonCursor& at) {
  RobotStep robot;
  robot.position = at.at("position").point();
  robot.velocity = at.at("velocity").point();
  robot.preferred = at.at("preferred").point();
  robot.chosen = at.at("chosen").point();
  robot.status = enumerator<lp::Status>(at.at("status"));
  robot.mode = enumerator<formation::Mode>(at.at("mode"));
  if (at.has("violation")) robot.violation = at.at("violation").number();
  if (at.has("side")) robot.side = at.at("side").integer();
  if (at.has("note")) robot.note = at.at("note").text();
  if (at.has("uncertified")) robot.uncertified = at.at("uncertified").count();
  if (!at.has("constraints")) return robot;
  const JsonCursor list = at.at("constraints");
  for (std::size_t i = 0; i < list.size(); ++i) robot.constraints.push_back(to_constraint(list.at(i)));
  return robot;
}

Step to_step(const JsonCursor& at, const formation::Scenario& scenario) {
  Step step;
  step.time = at.at("time").number();
  if (scenario.formation) {
    step.leader_position = at.at("leader").at("position").point();
    step.leader_velocity = at.at("leader").at("velocity").point();
  }
  const JsonCursor robots = at.at("robots");
  if (robots.size() != scenario.robots.size()) {
    robots.refuse(std::to_string(scenario.robots.size()) + " robots, as the scenario has", DataCode::wrong_count);
  }
  for (std::size_t i = 0; i < robots.size(); ++i) step.robots.push_back(to_robot_step(robots.at(i)));
  return step;
}

std::optional<std::string> optional_text(const JsonCursor& at) {
  if (at.is_null()) return std::nullopt;
  return at.text();
}

void read_enclosures(const JsonCursor& at, RecordingFile& file) {
  for (std::size_t i = 0; i < at.size(); ++i) {
    std::vector<geometry::ConvexShape>& of_robot = file.enclosures.emplace_back();
    for (std::size_t k = 0; k < at.at(i).size(); ++k) of_robot.push_back(to_shape(at.at(i).at(k)));
  }
}

void read_later_enclosures(const JsonCursor& at, formation::Recording& recording) {
  for (std::size_t i = 0; i < at.size(); ++i) {
    const JsonCursor one = at.at(i);
    formation::Outlook o{one.at("time").number(), one.at("robot").count(), one.at("goal").count(), {}};
    const JsonCursor shapes = one.at("shapes");
    for (std::size_t k = 0; k < shapes.size(); ++k) o.enclosures.push_back(to_shape(shapes.at(k)));
    recording.later_outlooks.push_back(std::move(o));
  }
}

/// Fills everything but the rows; says how many of these there should be.
std::size_t read_header(const JsonCursor& at, const std::string& name, RecordingFile& file) {
  if (at.at("kind").text() != kKind) at.at("kind").refuse("\"exactvo-recording\"", DataCode::not_an_option);
  if (at.at("format_version").integer() != 1) at.at("format_version").refuse("1", DataCode::out_of_range);
  file.scenario = parse_scenario(at.at("scenario").json().dump(), name, {});
  file.info.scenario = file.scenario.name;
  file.info.method = at.at("method").text();
  file.info.controller = optional_text(at.at("controller"));
  file.info.integrator = optional_text(at.at("integrator"));
  file.info.provenance = parse_provenance(at.at("provenance").json().dump(), name);
  formation::Recording& recording = file.recording;
  recording.time_step = at.at("time_step").number();
  recording.motion = enumerator<formation::MotionLaw>(at.at("motion"));
  recording.tracking_gain = at.at("tracking_gain").number();
  if (at.has("relative_frame")) recording.relative_frame = at.at("relative_frame").truth();
  recording.offsets = at.at("offsets").points();
  const std::size_t slots = file.scenario.formation ? file.scenario.robots.size() : 0;
  if (recording.offsets.size() != slots)
    at.at("offsets").refuse(std::to_string(slots) + " offsets, one a robot of a formation", DataCode::wrong_count);
  recording.diverged = at.at("diverged").truth();
  recording.outcome = at.at("outcome").text();
  if (at.has("warnings")) recording.warnings = to_texts(at.at("warnings"));
  recording.wall_time = at.at("wall_time").number();
  if (at.has("all_half_planes")) recording.all_half_planes = at.at("all_half_planes").truth();
  if (at.has("stuck")) read_stuck(at.at("stuck"), file);
  if (at.has("collisions")) file.collisions = to_collisions(at.at("collisions"));
  read_enclosures(at.at("enclosures"), file);
  if (at.has("later_enclosures")) read_later_enclosures(at.at("later_enclosures"), recording);
  return at.at("rows").count();
}

/// Takes the next line off `text`.
std::string_view next_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

/// A file of another kind is refused as a whole: what is wrong in its first line tells nobody anything.
void require_recording(std::string_view text, const std::string& name) {
  if (text.substr(0, text.find('\n')).find(kKind) != std::string_view::npos) return;
  throw DataError(DataCode::format_unknown, name, "", "no recording", "a recording.jsonl, as simulate --out writes it");
}

}  // namespace

RecordingFile read_recording(const std::filesystem::path& path) {
  const std::string text = read_text_file(path);
  const std::string name = path.string();
  require_recording(text, name);
  std::string_view rest = text;
  RecordingFile file;
  const Json header = parse_json_line(next_line(rest), name, 1);
  const std::size_t rows = read_header(JsonCursor(header, name, "line 1"), name, file);
  for (std::size_t number = 2; !rest.empty(); ++number) {
    const Json row = parse_json_line(next_line(rest), name, number);
    const JsonCursor at(row, name, "line " + std::to_string(number));
    file.recording.steps.push_back(to_step(at, file.scenario));
    if (at.has("lyapunov")) file.lyapunov.push_back(to_lyapunov(at.at("lyapunov"), file.recording.steps.back().time));
  }
  if (file.recording.steps.size() != rows) {
    throw DataError(DataCode::wrong_count, name, "line 1, /rows", std::to_string(file.recording.steps.size()) + " rows",
                    std::to_string(rows) + " rows");
  }
  return file;
}

}  // namespace exactvo::datasets
