// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// As JSON, both ways: shapes, bodies, half-planes and decisions, which lines of recordings are made of; and what a
/// recording says beside its rows: the Lyapunov functions term by term, who collided, and why robots stopped.

#include <cmath>
#include <functional>
#include <string>
#include <string_view>

#include "exactvo/datasets/recording_file.h"
#include "json/json_text.h"
#include "recordings/recording_names.h"

namespace exactvo::datasets {

// --- Bodies ---

template <class Codec>
void members(Codec& json, For<Codec, geometry::Disc>& disc) {
  json.member("center", disc.center).member("radius", disc.radius);
}

template <class Codec>
void members(Codec& json, For<Codec, geometry::Ellipse>& e) {
  json.member("center", e.center).member("l11", e.l11).member("l21", e.l21).member("l22", e.l22);
}

/// {"disc": ...}, {"segment": ...}, {"polygon": ...} or {"ellipse": ...}.
void append_value(JsonWriter& json, const geometry::ConvexShape& shape);
void read_value(const JsonCursor& at, geometry::ConvexShape& shape);

inline bool moves(vo::BodyKind kind) {
  return kind == vo::BodyKind::robot || kind == vo::BodyKind::moving_obstacle;
}

/// The shape of a robot or moving obstacle is left out: its place changes, and rows have it.
template <class Codec>
void members(Codec& json, For<Codec, vo::Body>& body) {
  json.member("kind", body.kind);
  if (!moves(body.kind)) json.member("shape", body.shape);
  json.member("owners", body.owners);
}

// --- Rows ---

template <class Codec>
void members(Codec& json, For<Codec, formation::MovedObstacle>& moved) {
  json.member("displacement", moved.displacement).member("velocity", moved.velocity);
}

template <class Codec>
void members(Codec& json, For<Codec, lp::ActiveConstraint>& part) {
  json.member("part", part.binding.kind).member("multiplier", part.multiplier);
}

/// The source is not here: the reader takes it from the body.
template <class Codec>
void members(Codec& json, For<Codec, formation::DecisionConstraint>& c) {
  json.member("body", c.body).member("index", c.index).member_if(c.piece != 0, "piece", c.piece);
  json.member("normal", c.half_plane.normal).member("offset", c.half_plane.offset);
  json.member("certified", c.certified).member("hard", c.hard).member("active", c.active);
  json.member_if(c.fell_back, "fell_back", c.fell_back).member_if(c.multiplier != 0.0, "multiplier", c.multiplier);
  json.member("clearance", c.clearance).member("time_horizon", c.time_horizon);
}

/// The same double, -0 and 0 told apart.
inline bool is_same(geometry::Vec2 a, geometry::Vec2 b) {
  return a == b && std::signbit(a.x) == std::signbit(b.x) && std::signbit(a.y) == std::signbit(b.y);
}

/// Multipliers that are no doubles and follow from the half-planes: instead of them stands a word.
inline void exact_multipliers(JsonWriter& json, bool are_exact) {
  json.member_if(are_exact, "multipliers", "exact");
}
inline void exact_multipliers(const JsonCursor& json, bool& are_exact) {
  are_exact = json.has("multipliers");
  if (are_exact && json.at("multipliers").text() != "exact") json.at("multipliers").refuse("\"exact\"");
}

template <>
inline constexpr bool kOnOneLine<formation::OwnConstraint> = true;
/// What a user asked for.
template <class Codec>
void members(Codec& json, For<Codec, formation::OwnConstraint>& c) {
  json.member("normal", c.half_plane.normal).member("offset", c.half_plane.offset);
  json.member("hard", c.hard).member("active", c.active).member_if(c.multiplier != 0.0, "multiplier", c.multiplier);
}

template <class Codec>
void members(Codec& json, For<Codec, formation::OnWheels>& wheels) {
  json.member("heading", wheels.heading).member("left", wheels.speeds.left).member("right", wheels.speeds.right);
}

template <>
inline constexpr bool kOnOneLine<formation::MeasuredRobot> = true;
template <class Codec>
void members(Codec& json, For<Codec, formation::MeasuredRobot>& seen) {
  json.member("robot", seen.robot).member("position", seen.position).member("velocity", seen.velocity);
  json.member("age", seen.age);
}

/// One robot's part of a row. What is empty or as usual is left out.
template <class Codec>
void members(Codec& json, For<Codec, formation::RobotStep>& robot) {
  json.member("position", robot.position).member("velocity", robot.velocity);
  if constexpr (Codec::kReads) {  // as usual, where they are left out
    robot.anchor = robot.position;
    robot.anchor_velocity = robot.velocity;
  }
  json.member_if(!is_same(robot.anchor, robot.position), "anchor", robot.anchor);
  json.member_if(!is_same(robot.anchor_velocity, robot.velocity), "anchor_velocity", robot.anchor_velocity);
  json.optional("wheels", robot.wheels);
  json.member_if(!robot.measured.empty(), "measured", robot.measured);
  json.member("preferred", robot.preferred).member("chosen", robot.chosen).member("status", robot.status);
  json.member_if(!robot.bound.empty(), "bound", robot.bound);
  json.member_if(robot.violation != 0.0, "violation", robot.violation);
  exact_multipliers(json, robot.exact_multipliers);
  json.member("mode", robot.mode).member_if(robot.side != 0, "side", robot.side);
  json.member_if(robot.turned_right != 0.0, "turned_right", robot.turned_right);
  json.member_if(!robot.note.empty(), "note", robot.note);
  json.member_if(robot.lacks_room_to_turn, "lacks_room_to_turn", robot.lacks_room_to_turn);
  json.member_if(robot.stopping_steps != 0, "stopping_steps", robot.stopping_steps);
  json.member_if(robot.uncertified != 0, "uncertified", robot.uncertified);
  json.member_if(!robot.constraints.empty(), "constraints", robot.constraints);
  json.member_if(robot.own_stage != formation::OwnStage::none, "own_stage", robot.own_stage);
  json.member_if(!robot.own.empty(), "own", robot.own);
}

template <class Codec>
void members(Codec& json, For<Codec, formation::PlanMove>& move) {
  json.member("robot", move.robot).member("to", move.to);
}

// --- Lyapunov functions ---

template <class Codec>
void members(Codec& json, For<Codec, formation::PaperTerms>& terms) {
  json.member("kinetic", terms.kinetic).member("consensus", terms.consensus);
  json.member("pinning", terms.pinning).member("integral", terms.integral);
}

/// The last row of a run has no decision, so no derivatives.
template <class Codec>
void members(Codec& json, For<Codec, formation::LyapunovRow>& row) {
  if constexpr (Codec::kReads) row.has_rates = json.has("paper_rates");
  json.member("paper", row.paper);
  if (row.has_rates)
    json.object("paper_rates", [&](auto& rates) {
      members(rates, row.paper_rates);
      rates.member("claimed", row.paper_rate);
    });
  json.object("sound", [&](auto& terms) {
    terms.member("kinetic", row.sound.kinetic).member("consensus", row.sound.consensus);
    terms.member("slots", row.sound.slots);
  });
  if (!row.has_rates) return;
  json.object("sound_rates", [&](auto& rates) {
    rates.member("consensus", row.sound_rates.consensus).member("tracking", row.sound_rates.tracking);
    rates.member("intervention", row.sound_rates.intervention).member("bound", row.rate_bound);
  });
}

// --- The header and the end ---

/// What was run.
template <class Codec>
void members(Codec& json, For<Codec, RunInfo>& info) {
  json.member("method", info.method).member("controller", info.controller).member("integrator", info.integrator);
  json.optional("guidance", info.guidance).optional("liveness", info.liveness);
}

template <class Codec>
void members(Codec& json, For<Codec, formation::ControllerOptions>& options) {
  for (const formation::ControllerSwitch& s : formation::controller_switches()) json.member(s.name, options.*s.on);
  json.member("acceleration_bound", options.acceleration_bound);
}

/// What is known before a run. REQUIRES: `run.controller_options` has a value already where there are any, which the
/// scenario says.
template <class Codec>
void members(Codec& json, For<Codec, formation::Recording>& run) {
  json.member("time_step", run.time_step).member("motion", run.motion);
  json.member("tracking_gain", run.tracking_gain).member("relative_frame", run.relative_frame);
  if (run.controller_options) json.member("controller_options", *run.controller_options);
  json.member("offsets", run.offsets).member("all_half_planes", run.all_half_planes);
}

template <>
inline constexpr bool kOnOneLine<formation::Collision> = true;
template <class Codec>
void members(Codec& json, For<Codec, formation::Collision>& c) {
  json.member("robot", c.robot).member("kind", c.kind).member("with", c.with);
  json.member("from", c.from).member("until", c.until).member("deepest_at", c.deepest_at).member("depth", c.depth);
  json.member("place", c.place).member("relaxed", c.relaxed);
  json.member_if(c.standing, "standing", c.standing);
}

template <class Codec>
void members(Codec& json, For<Codec, formation::BindingConstraint>& b) {
  json.member("source", b.constraint.source).member("index", b.constraint.index).member("piece", b.constraint.piece);
  json.member("normal", b.normal).member("clearance", b.clearance);
  json.member("radius_of_curvature", b.radius_of_curvature).optional("pressing", b.pressing);
}

template <class Codec>
void members(Codec& json, For<Codec, formation::Equilibrium>& e) {
  json.member("position", e.position).member("normal", e.normal).member("radius_of_curvature", e.radius_of_curvature);
  json.member("distance", e.distance).member("stable", e.stable);
}

template <class Codec>
void members(Codec& json, For<Codec, formation::StuckReport>& r) {
  json.member("robot", r.robot).member("position", r.position).member("goal_distance", r.goal_distance);
  json.member("speed", r.speed).member("binding", r.binding).member("equilibrium", r.equilibrium);
  json.member("text", r.text).optional("rest_time", r.rest_time);
}

/// How the run went.
template <class Codec>
void members(Codec& json, For<Codec, RecordingFile>& file) {
  auto& run = file.recording;
  auto& outcome = Codec::kReads || !file.outcome.empty() ? file.outcome : run.outcome;  // what is read is the file's
  json.member("diverged", run.diverged).member("outcome", outcome);
  json.member("ended", run.outcome).member("warnings", run.warnings).member("stuck", file.stuck);
  json.optional("collisions", file.collisions).member("wall_time", run.wall_time);
  json.member("written_at", file.info.provenance.written_at);
}

// --- Line by line, from a file, a pipe or a text ---

/// Gives the next line without its \n, valid until the next call; false at the end.
using NextLine = std::function<bool(std::string_view& line)>;

/// `read_recording` of these lines into `run`, which is empty: rows go to `take`. `name` is used in messages.
void read_recording_lines(const NextLine& next_line, const std::string& name, const TakeRow& take, RecordingFile& run);

}  // namespace exactvo::datasets
