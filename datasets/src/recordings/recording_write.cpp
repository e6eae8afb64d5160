// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/recording_file.h"
#include "recordings/recording_extras.h"
#include "recordings/recording_names.h"
#include "scenarios/scenario_json.h"
#include "sha256.h"

namespace exactvo::datasets {
namespace {

using formation::RecordedConstraint;
using formation::RobotStep;
using formation::Step;

void append_shape(JsonWriter& json, const geometry::Disc& disc) {
  json.key("disc").begin_object().member("center", disc.center).member("radius", disc.radius).end_object();
}

void append_shape(JsonWriter& json, const geometry::Segment& segment) {
  json.key("segment").begin_array().value(segment.a).value(segment.b).end_array();
}

void append_shape(JsonWriter& json, const geometry::ConvexPolygon& polygon) {
  json.key("polygon");
  append_points(json, polygon.vertices);
}

void append_shape(JsonWriter& json, const geometry::Ellipse& ellipse) {
  json.key("ellipse").begin_object().member("center", ellipse.center);
  json.member("l11", ellipse.l11).member("l21", ellipse.l21).member("l22", ellipse.l22).end_object();
}

void append_convex(JsonWriter& json, const geometry::ConvexShape& shape) {
  json.begin_object();
  std::visit([&](const auto& kind) { append_shape(json, kind); }, shape);
  json.end_object();
}

void append_constraint(JsonWriter& json, const RecordedConstraint& c) {
  json.begin_object();
  json.member("normal", c.half_plane.normal).member("offset", c.half_plane.offset);
  json.member("source", word_for(c.source)).member("index", c.index);
  if (c.piece != 0) json.member("piece", c.piece);
  json.member("certified", c.certified).member("hard", c.hard).member("active", c.active);
  json.key("shape");
  append_convex(json, c.shape);
  json.member("position", c.position).member("radius", c.radius).member("tau", c.tau);
  json.member("shape_velocity", c.shape_velocity);
  json.end_object();
}

/// What is empty or zero in nearly every row is left out of it.
void append_robot(JsonWriter& json, const RobotStep& robot) {
  json.begin_object();
  json.member("position", robot.position).member("velocity", robot.velocity);
  json.member("preferred", robot.preferred).member("chosen", robot.chosen);
  json.member("status", word_for(robot.status));
  if (robot.violation != 0.0) json.member("violation", robot.violation);
  json.member("mode", word_for(robot.mode));
  if (robot.side != 0) json.member("side", robot.side);
  if (!robot.note.empty()) json.member("note", robot.note);
  if (robot.uncertified != 0) json.member("uncertified", robot.uncertified);
  if (!robot.constraints.empty()) {
    json.key("constraints").begin_array();
    for (const RecordedConstraint& constraint : robot.constraints) append_constraint(json, constraint);
    json.end_array();
  }
  json.end_object();
}

void append_step(JsonWriter& json, const RecordingFile& file, std::size_t k) {
  const Step& step = file.recording.steps[k];
  const bool has_leader = file.scenario.formation.has_value();
  json.begin_object().member("time", step.time);
  if (has_leader) {
    json.key("leader").begin_object();
    json.member("position", step.leader_position).member("velocity", step.leader_velocity).end_object();
  }
  json.key("robots").begin_array();
  for (const RobotStep& robot : step.robots) append_robot(json, robot);
  json.end_array();
  if (k < file.lyapunov.size()) append_lyapunov(json, file.lyapunov[k]);
  json.end_object();
}

void append_enclosures(JsonWriter& json, const std::vector<std::vector<geometry::ConvexShape>>& enclosures) {
  json.key("enclosures").begin_array();
  for (const std::vector<geometry::ConvexShape>& of_robot : enclosures) {
    json.begin_array();
    for (const geometry::ConvexShape& shape : of_robot) append_convex(json, shape);
    json.end_array();
  }
  json.end_array();
}

/// Only where a robot had more than one goal.
void append_later_enclosures(JsonWriter& json, const std::vector<formation::Outlook>& outlooks) {
  if (outlooks.empty()) return;
  json.key("later_enclosures").begin_array();
  for (const formation::Outlook& o : outlooks) {
    json.begin_object().member("time", o.time).member("robot", o.robot).member("goal", o.goal);
    json.key("shapes").begin_array();
    for (const geometry::ConvexShape& shape : o.enclosures) append_convex(json, shape);
    json.end_array().end_object();
  }
  json.end_array();
}

void append_header(JsonWriter& json, const RecordingFile& file, const std::string& rows_digest) {
  const formation::Recording& recording = file.recording;
  json.begin_object().member("kind", "exactvo-recording").member("format_version", 1);
  json.member("method", file.info.method).member("controller", file.info.controller);
  json.member("integrator", file.info.integrator);
  json.member("time_step", recording.time_step).member("motion", word_for(recording.motion));
  json.member("tracking_gain", recording.tracking_gain).member("diverged", recording.diverged);
  json.member("relative_frame", recording.relative_frame);
  json.key("offsets");
  append_points(json, recording.offsets);
  json.member("outcome", recording.outcome).member("rows", recording.steps.size());
  json.key("warnings").begin_array();
  for (const std::string& warning : recording.warnings) json.value(warning);
  json.end_array();
  append_stuck(json, file);
  append_collisions(json, file.collisions);
  json.member("all_half_planes", recording.all_half_planes);
  json.member("rows_sha256", rows_digest);
  json.member("wall_time", recording.wall_time);
  json.key("provenance").raw(to_json(file.info.provenance));
  json.key("scenario");
  append_scenario(json, file.scenario);
  append_enclosures(json, file.enclosures);
  append_later_enclosures(json, recording.later_outlooks);
  json.end_object();
}

/// Every row with its newline, one after the other: a run of any length needs no more than a row of memory.
template <class Take>
void for_each_row(const RecordingFile& file, const Take& take) {
  JsonWriter json(JsonWriter::Layout::compact);
  for (std::size_t k = 0; k < file.recording.steps.size(); ++k) {
    append_step(json, file, k);
    take(json.text() + "\n");
    json.clear();
  }
}

}  // namespace

void write_recording(const std::filesystem::path& path, const RecordingFile& file) {
  Sha256 rows;
  for_each_row(file, [&](const std::string& row) { rows.add(row); });
  AtomicFile out(path);
  JsonWriter json(JsonWriter::Layout::compact);
  append_header(json, file, rows.digest());
  out.write(json.text() + "\n");
  for_each_row(file, [&](const std::string& row) { out.write(row); });
  out.commit();
}

}  // namespace exactvo::datasets
