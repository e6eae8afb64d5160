// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/codec.h"

#include <cmath>

#include "recordings/recording_names.h"
#include "scenarios/scenario_json.h"

namespace exactvo::datasets {
namespace {

using formation::BindingConstraint;
using formation::ConstraintSource;
using formation::LyapunovRow;
using formation::RecordedConstraint;
using formation::RobotStep;
using formation::StuckReport;

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

bool moves(const vo::Body& body) {
  return body.kind == vo::BodyKind::robot || body.kind == vo::BodyKind::moving_obstacle;
}

void append_constraint(JsonWriter& json, const RecordedConstraint& c) {
  json.begin_object();
  json.member("body", c.body).member("index", c.index);
  if (c.piece != 0) json.member("piece", c.piece);
  json.member("normal", c.half_plane.normal).member("offset", c.half_plane.offset);
  json.member("certified", c.certified).member("hard", c.hard).member("active", c.active);
  if (c.multiplier != 0.0) json.member("multiplier", c.multiplier);
  json.member("clearance", c.clearance).member("tau", c.tau);
  json.end_object();
}

RecordedConstraint to_constraint(const JsonCursor& at) {
  RecordedConstraint c;
  c.body = at.at("body").count();
  c.index = at.at("index").count();
  if (at.has("piece")) c.piece = at.at("piece").count();
  c.half_plane = {at.at("normal").point(), at.at("offset").number()};
  c.certified = at.at("certified").truth();
  c.hard = at.at("hard").truth();
  c.active = at.at("active").truth();
  if (at.has("multiplier")) c.multiplier = at.at("multiplier").number();
  c.clearance = at.at("clearance").number();
  c.tau = at.at("tau").number();
  return c;
}

/// The same double, -0 and 0 told apart.
bool is_same(geometry::Vec2 a, geometry::Vec2 b) {
  return a == b && std::signbit(a.x) == std::signbit(b.x) && std::signbit(a.y) == std::signbit(b.y);
}

/// Of multipliers that are no doubles and follow from the half-planes.
constexpr const char* kExact = "exact";

bool is_exact(const JsonCursor& at) {
  if (at.text() != kExact) at.refuse("\"exact\"");
  return true;
}

// --- What is said beside the rows ---

/// The numbers of a row under their names, for writing and for reading alike: `take(group, key, number)`.
template <class Row, class Take>
void for_each_term(Row& row, const Take& take) {
  take("paper", "kinetic", row.paper.kinetic);
  take("paper", "consensus", row.paper.consensus);
  take("paper", "pinning", row.paper.pinning);
  take("paper", "integral", row.paper.integral);
  take("paper_rates", "kinetic", row.paper_rates.kinetic);
  take("paper_rates", "consensus", row.paper_rates.consensus);
  take("paper_rates", "pinning", row.paper_rates.pinning);
  take("paper_rates", "integral", row.paper_rates.integral);
  take("paper_rates", "claimed", row.paper_rate);
  take("sound", "kinetic", row.sound.kinetic);
  take("sound", "consensus", row.sound.consensus);
  take("sound", "slots", row.sound.slots);
  take("sound_rates", "consensus", row.sound_rates.consensus);
  take("sound_rates", "tracking", row.sound_rates.tracking);
  take("sound_rates", "intervention", row.sound_rates.intervention);
  take("sound_rates", "bound", row.rate_bound);
}

/// The last row of a run has no decision, so no derivatives.
bool is_rate(const std::string& group) {
  return group == "paper_rates" || group == "sound_rates";
}

void append_binding(JsonWriter& json, const BindingConstraint& b) {
  json.begin_object().member("source", word_for(b.constraint.source)).member("index", b.constraint.index);
  json.member("piece", b.constraint.piece).member("normal", b.normal).member("clearance", b.clearance);
  json.member("radius_of_curvature", b.radius_of_curvature).member("pressing", b.pressing).end_object();
}

void append_equilibrium(JsonWriter& json, const formation::Equilibrium& e) {
  json.begin_object().member("position", e.position).member("normal", e.normal);
  json.member("radius_of_curvature", e.radius_of_curvature).member("distance", e.distance);
  json.member("stable", e.stable).end_object();
}

void append_report(JsonWriter& json, const StuckReport& r) {
  json.begin_object().member("robot", r.robot).member("position", r.position);
  json.member("goal_distance", r.goal_distance).member("speed", r.speed);
  json.list("binding", r.binding, [&](const BindingConstraint& b) { append_binding(json, b); });
  json.member("equilibrium", r.equilibrium, [&](const auto& e) { append_equilibrium(json, e); });
  json.member("text", r.text).member("rest_time", r.rest_time).end_object();
}

BindingConstraint to_binding(const JsonCursor& at) {
  BindingConstraint b;
  b.constraint.source = enumerator<formation::ConstraintSource>(at.at("source"));
  b.constraint.index = at.at("index").count();
  b.constraint.piece = at.at("piece").count();
  b.normal = at.at("normal").point();
  b.clearance = at.at("clearance").number();
  b.radius_of_curvature = at.at("radius_of_curvature").number();
  if (at.has("pressing")) b.pressing = at.at("pressing").truth();
  return b;
}

formation::Equilibrium to_equilibrium(const JsonCursor& at) {
  return {at.at("position").point(), at.at("normal").point(), at.at("radius_of_curvature").number(),
          at.at("distance").number(), at.at("stable").truth()};
}

StuckReport to_report(const JsonCursor& at) {
  StuckReport r;
  r.robot = at.at("robot").count();
  r.position = at.at("position").point();
  r.goal_distance = at.at("goal_distance").number();
  r.speed = at.at("speed").number();
  const JsonCursor binding = at.at("binding");
  for (std::size_t k = 0; k < binding.size(); ++k) r.binding.push_back(to_binding(binding.at(k)));
  if (!at.at("equilibrium").is_null()) r.equilibrium = to_equilibrium(at.at("equilibrium"));
  r.text = at.at("text").text();
  if (at.has("rest_time")) r.rest_time = at.at("rest_time").number();
  return r;
}

}  // namespace

void append_convex(JsonWriter& json, const geometry::ConvexShape& shape) {
  json.begin_object();
  std::visit([&](const auto& kind) { append_shape(json, kind); }, shape);
  json.end_object();
}

geometry::ConvexShape to_convex(const JsonCursor& at) {
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

void append_body(JsonWriter& json, std::size_t number, const vo::Body& body) {
  json.begin_object().member("number", number).member("kind", word_for(body.kind));
  if (!moves(body)) {
    json.key("shape");
    append_convex(json, body.shape);
  }
  json.list("owners", body.owners).end_object();
}

vo::Body to_body(const JsonCursor& at) {
  vo::Body body;
  body.kind = enumerator<ConstraintSource>(at.at("kind"));
  if (!moves(body)) body.shape = to_convex(at.at("shape"));
  const JsonCursor owners = at.at("owners");
  for (std::size_t k = 0; k < owners.size(); ++k) body.owners.push_back(owners.at(k).count());
  if (moves(body) && body.owners.size() != 1) owners.refuse("one owner", DataCode::wrong_count);
  return body;
}

void append_robot(JsonWriter& json, const RobotStep& robot) {
  json.begin_object();
  json.member("position", robot.position).member("velocity", robot.velocity);
  if (!is_same(robot.anchor, robot.position)) json.member("anchor", robot.anchor);
  if (!is_same(robot.anchor_velocity, robot.velocity)) json.member("anchor_velocity", robot.anchor_velocity);
  json.member("preferred", robot.preferred).member("chosen", robot.chosen);
  json.member("status", word_for(robot.status));
  if (!robot.bound.empty()) {
    json.key("bound").begin_array();
    for (const lp::ActiveConstraint& part : robot.bound)
      json.begin_object()
          .member("part", word_for(part.binding.kind))
          .member("multiplier", part.multiplier)
          .end_object();
    json.end_array();
  }
  if (robot.violation != 0.0) json.member("violation", robot.violation);
  if (robot.exact_multipliers) json.member("multipliers", kExact);
  json.member("mode", word_for(robot.mode));
  if (robot.side != 0) json.member("side", robot.side);
  if (!robot.note.empty()) json.member("note", robot.note);
  if (robot.uncertified != 0) json.member("uncertified", robot.uncertified);
  if (!robot.constraints.empty()) {
    json.list("constraints", robot.constraints,
              [&](const RecordedConstraint& constraint) { append_constraint(json, constraint); });
  }
  json.end_object();
}

RobotStep to_robot(const JsonCursor& at) {
  RobotStep robot;
  robot.position = at.at("position").point();
  robot.velocity = at.at("velocity").point();
  robot.anchor = at.has("anchor") ? at.at("anchor").point() : robot.position;
  robot.anchor_velocity = at.has("anchor_velocity") ? at.at("anchor_velocity").point() : robot.velocity;
  robot.preferred = at.at("preferred").point();
  robot.chosen = at.at("chosen").point();
  robot.status = enumerator<lp::Status>(at.at("status"));
  robot.mode = enumerator<formation::Mode>(at.at("mode"));
  for (std::size_t k = 0; at.has("bound") && k < at.at("bound").size(); ++k) {
    const JsonCursor part = at.at("bound").at(k);
    robot.bound.push_back({{enumerator<lp::BindingKind>(part.at("part")), 0}, part.at("multiplier").number()});
  }
  if (at.has("violation")) robot.violation = at.at("violation").number();
  if (at.has("multipliers")) robot.exact_multipliers = is_exact(at.at("multipliers"));
  if (at.has("side")) robot.side = at.at("side").integer();
  if (at.has("note")) robot.note = at.at("note").text();
  if (at.has("uncertified")) robot.uncertified = at.at("uncertified").count();
  if (!at.has("constraints")) return robot;
  const JsonCursor list = at.at("constraints");
  robot.constraints.reserve(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) robot.constraints.push_back(to_constraint(list.at(i)));
  return robot;
}

void append_lyapunov(JsonWriter& json, const LyapunovRow& row) {
  std::string_view open;
  json.key("lyapunov").begin_object();
  for_each_term(row, [&](const char* group, const char* key, double number) {
    if (!row.has_rates && is_rate(group)) return;
    if (open != group) {
      if (!open.empty()) json.end_object();
      json.key(group).begin_object();
      open = group;
    }
    json.member(key, number);
  });
  json.end_object().end_object();
}

LyapunovRow to_lyapunov(const JsonCursor& at, double time) {
  LyapunovRow row;
  row.time = time;
  row.has_rates = at.has("paper_rates");
  for_each_term(row, [&](const char* group, const char* key, double& number) {
    if (row.has_rates || !is_rate(group)) number = at.at(group).at(key).number();
  });
  return row;
}

void append_collisions(JsonWriter& json, const std::vector<formation::Collision>& all) {
  json.key("collisions").begin_array();
  for (const formation::Collision& c : all) {
    json.begin_inline_object().member("robot", c.robot).member("kind", word_for(c.kind)).member("with", c.with);
    json.member("from", c.from).member("until", c.until).member("deepest_at", c.deepest_at).member("depth", c.depth);
    json.member("place", c.place).member("relaxed", c.relaxed).end_object();
  }
  json.end_array();
}

std::vector<formation::Collision> to_collisions(const JsonCursor& at) {
  std::vector<formation::Collision> all;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const JsonCursor c = at.at(k);
    all.push_back({c.at("robot").text(), enumerator<formation::CollisionKind>(c.at("kind")), c.at("with").text(),
                   c.at("from").number(), c.at("until").number(), c.at("deepest_at").number(), c.at("depth").number(),
                   c.at("place").point(), c.at("relaxed").truth()});
  }
  return all;
}

void append_stuck(JsonWriter& json, const RecordingFile& file) {
  json.list("stuck", file.stuck, [&](const StuckReport& report) { append_report(json, report); });
}

void read_stuck(const JsonCursor& at, RecordingFile& file) {
  for (std::size_t k = 0; k < at.size(); ++k) file.stuck.push_back(to_report(at.at(k)));
}

}  // namespace exactvo::datasets
