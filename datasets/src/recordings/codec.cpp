// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/codec.h"

#include <cmath>

#include "recordings/recording_names.h"
#include "scenarios/scenario_json.h"

namespace exactvo::datasets {
namespace {

using formation::ConstraintSource;
using formation::RecordedConstraint;
using formation::RobotStep;

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

/// Of multipliers that are no doubles and follow from the half-planes.
constexpr const char* kExact = "exact";

bool is_exact(const JsonCursor& at) {
  if (at.text() != kExact) at.refuse("\"exact\"");
  return true;
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
  for (std::size_t i = 0; i < list.size(); ++i) robot.constraints.push_back(to_constraint(list.at(i)));
  return robot;
}

}  // namespace exactvo::datasets
