// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/simulation.h"
#include "scenarios/scenario_json.h"

namespace exactvo::datasets {
namespace {

using formation::Scenario;

void append_robot(JsonWriter& json, const formation::Robot& robot) {
  json.begin_object();
  json.member("id", robot.id).member("position", robot.position).member("velocity", robot.velocity);
  json.member("radius", robot.radius).member("max_speed", robot.max_speed);
  json.key("goals");
  append_points(json, robot.goals);
  json.member("cooperates", robot.cooperates);
  json.end_object();
}

void append_shape(JsonWriter& json, const geometry::Polyline& line) {
  json.key("polyline");
  append_points(json, line.points);
}

void append_shape(JsonWriter& json, const geometry::Polygon& polygon) {
  json.key("polygon");
  append_points(json, polygon.outer);
  if (polygon.holes.empty()) return;
  json.list("holes", polygon.holes, [&](const geometry::Ring& hole) { append_points(json, hole); });
}

void append_obstacle(JsonWriter& json, const formation::SceneObstacle& obstacle) {
  json.begin_object().member("id", obstacle.id);
  std::visit([&](const auto& shape) { append_shape(json, shape); }, obstacle.shape);
  json.end_object();
}

void append_profile(JsonWriter& json, const std::vector<formation::SpeedKnot>& profile) {
  json.key("profile").begin_object().key("knots").begin_inline_array();
  for (const formation::SpeedKnot& knot : profile) json.value(geometry::Vec2{knot.time, knot.speed});
  json.end_array().end_object();
}

/// The profile where there is one, else the speed.
void append_speed(JsonWriter& json, const formation::Leader& leader) {
  if (leader.profile.empty()) {
    json.member("speed", leader.speed);
  } else {
    append_profile(json, leader.profile);
  }
}

void append_moving(JsonWriter& json, const formation::MovingObstacle& obstacle) {
  json.begin_object().member("id", obstacle.id);
  std::visit([&](const auto& shape) { append_shape(json, shape); }, obstacle.shape);
  json.key("path");
  append_points(json, obstacle.motion.path);
  append_speed(json, obstacle.motion);
  json.end_object();
}

void append_numbers(JsonWriter& json, const std::vector<double>& numbers) {
  json.begin_inline_array();
  for (const double number : numbers) json.value(number);
  json.end_array();
}

void append_topology(JsonWriter& json, const formation::Topology& topology) {
  json.key("topology").begin_object();
  json.list("adjacency", topology.adjacency, [&](const std::vector<double>& row) { append_numbers(json, row); });
  json.key("pinning");
  append_numbers(json, topology.pinning);
  json.end_object();
}

/// Only what is asked for.
void append_switches(JsonWriter& json, const formation::RemedySwitches& asked) {
  json.key("remedies").begin_inline_object();
  for (const formation::RemedySwitch& s : formation::remedy_switches())
    if (asked.*s.asked) json.member(s.name, *(asked.*s.asked));
  if (asked.acceleration_bound) json.member("acceleration_bound", *asked.acceleration_bound);
  json.end_object();
}

void append_formation(JsonWriter& json, const formation::FormationSpec& spec) {
  json.key("formation").begin_object();
  append_topology(json, spec.topology);
  json.key("offsets");
  append_points(json, spec.offsets);
  json.member("recentre", spec.recentre);
  json.key("leader").begin_object().key("path");
  append_points(json, spec.leader.path);
  append_speed(json, spec.leader);
  json.end_object();
  json.key("gains").begin_inline_object();
  json.member("k1", spec.gains.k1).member("k2", spec.gains.k2);
  json.member("k3", spec.gains.k3).member("kappa", spec.gains.kappa).end_object();
  json.member("catch_up_speed", spec.catch_up_speed);
  append_switches(json, spec.remedies);
  json.end_object();
}

void append_figures(JsonWriter& json, const Scenario& scenario) {
  if (!scenario.formation) {
    json.member("guidance", formation::name(scenario.guidance));
    if (scenario.unreachable != formation::Unreachable::stay)
      json.member("unreachable", formation::name(scenario.unreachable));
    json.member("liveness", formation::name(scenario.liveness));
  }
  json.member("speed_bound", scenario.speed_bound == formation::SpeedBoundKind::box ? "box" : "disc");
  const formation::Horizons& horizons = scenario.horizons;
  json.key("horizons").begin_inline_object();
  json.member("least", horizons.least).member("most", horizons.most).member("speed_floor", horizons.speed_floor);
  json.member("orca", horizons.orca).member("robots", horizons.robots).end_object();
  json.key("margins").begin_inline_object();
  json.member("obstacle", scenario.margins.obstacle).member("robot", scenario.margins.robot).end_object();
  json.member("time_step", scenario.time_step).member("time_limit", scenario.time_limit);
  json.member("arrival_tolerance", scenario.arrival_tolerance);
  json.member("neighbour_distance", scenario.neighbour_distance);
}

}  // namespace

void append_points(JsonWriter& json, const std::vector<geometry::Vec2>& points) {
  json.begin_inline_array();
  for (const geometry::Vec2 point : points) json.value(point);
  json.end_array();
}

void append_scenario(JsonWriter& json, const Scenario& scenario) {
  json.begin_object().member("name", scenario.name).member("description", scenario.description);
  json.list("robots", scenario.robots, [&](const formation::Robot& robot) { append_robot(json, robot); });
  json.list("obstacles", scenario.obstacles,
            [&](const formation::SceneObstacle& obstacle) { append_obstacle(json, obstacle); });
  json.list("moving_obstacles", scenario.moving_obstacles,
            [&](const formation::MovingObstacle& obstacle) { append_moving(json, obstacle); });
  if (scenario.formation) append_formation(json, *scenario.formation);
  append_figures(json, scenario);
  json.end_object();
}

std::string write_scenario(const Scenario& scenario) {
  JsonWriter json(JsonWriter::Layout::indented);
  append_scenario(json, scenario);
  return json.take() + "\n";
}

}  // namespace exactvo::datasets
