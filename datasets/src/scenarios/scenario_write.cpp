// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/simulation.h"
#include "scenarios/scenario_json.h"

namespace exactvo::datasets {
namespace {

using formation::Scenario;

void append_shape(JsonWriter& json, const geometry::Polyline& line) {
  json.member("polyline", line.points);
}

void append_shape(JsonWriter& json, const geometry::Polygon& polygon) {
  json.member("polygon", polygon.outer).member_if(!polygon.holes.empty(), "holes", polygon.holes);
}

/// Either kind of obstacle: its id and shape.
template <class Obstacle>
void begin_obstacle(JsonWriter& json, const Obstacle& obstacle) {
  json.begin_object().member("id", obstacle.id);
  if (obstacle.disc)
    json.object("disc", [&](JsonWriter& disc) {
      disc.member("centre", obstacle.disc->center).member("radius", obstacle.disc->radius);
    });
  else
    std::visit([&](const auto& shape) { append_shape(json, shape); }, obstacle.shape);
}

void append_profile(JsonWriter& json, const std::vector<formation::SpeedKnot>& profile) {
  json.key("profile").begin_object().key("knots").begin_inline_array();
  for (const formation::SpeedKnot& knot : profile) json.value(geometry::Vec2{knot.time, knot.speed});
  json.end_array().end_object();
}

/// The profile where there is one, else the speed.
void append_speed(JsonWriter& json, const formation::TimedPath& leader) {
  if (leader.profile.empty()) {
    json.member("speed", leader.speed);
  } else {
    append_profile(json, leader.profile);
  }
}

void append_formation(JsonWriter& json, const formation::FormationSpec& spec) {
  json.object("topology", [&](JsonWriter& topology) {
    topology.member("adjacency", spec.topology.adjacency).member("pinning", spec.topology.pinning);
  });
  json.member("offsets", spec.offsets).member("recentre", spec.recentre);
  json.key("leader").begin_object().member("path", spec.leader.path);
  append_speed(json, spec.leader);
  json.end_object();
  members(json, spec);
}

void append_choices(JsonWriter& json, const Scenario& scenario) {
  if (!scenario.formation) {
    json.member("guidance", formation::name(scenario.guidance));
    if (scenario.unreachable != formation::Unreachable::stay)
      json.member("unreachable", formation::name(scenario.unreachable));
    json.member("liveness", formation::name(scenario.liveness));
    json.member_if(scenario.separate, "separate", true);
  }
  json.member("speed_bound", scenario.speed_bound == formation::SpeedBoundKind::box ? "box" : "disc");
}

}  // namespace

void append_scenario(JsonWriter& json, const Scenario& scenario) {
  json.begin_object().member("name", scenario.name).member("description", scenario.description);
  json.member("robots", scenario.robots);
  json.list("obstacles", scenario.obstacles, [&](const formation::SceneObstacle& obstacle) {
    begin_obstacle(json, obstacle);
    json.end_object();
  });
  json.list("moving_obstacles", scenario.moving_obstacles, [&](const formation::MovingObstacle& obstacle) {
    begin_obstacle(json, obstacle);
    json.member("path", obstacle.motion.path);
    append_speed(json, obstacle.motion);
    if (obstacle.max_speed) json.member("max_speed", *obstacle.max_speed);
    json.end_object();
  });
  if (scenario.formation) json.object("formation", [&](JsonWriter&) { append_formation(json, *scenario.formation); });
  append_choices(json, scenario);
  members(json, scenario);
  json.end_object();
}

void on_wheels(JsonWriter& json, const formation::Robot& robot, const formation::DifferentialDrive& drive) {
  json.member("id", robot.id).member("position", drive.axle).member("heading", drive.heading);
  if (drive.footprint.empty())
    json.member("radius", drive.body_radius);
  else
    json.object("footprint", [&](JsonWriter& footprint) { footprint.member("polygon", drive.footprint); });
  json.member("goals", robot.goals).member("cooperates", robot.cooperates);
  json.object("kinematics", [&](JsonWriter& kinematics) {
    kinematics.member("type", "differential");
    members(kinematics, drive);
  });
}

std::string write_scenario(const Scenario& scenario) {
  JsonWriter json(JsonWriter::Layout::indented);
  append_scenario(json, scenario);
  return json.take() + "\n";
}

}  // namespace exactvo::datasets
