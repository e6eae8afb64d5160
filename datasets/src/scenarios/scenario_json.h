// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What stands in scenarios under the same keys as in memory.

#include "exactvo/formation/scenario.h"
#include "json/json_text.h"

namespace exactvo::datasets {

/// The scenario as one JSON value, where a writer stands: recordings carry it in their header.
void append_scenario(JsonWriter& json, const formation::Scenario& scenario);

/// Also takes points in braces: `append_points(json, {a, b})`.
inline void append_points(JsonWriter& json, const std::vector<geometry::Vec2>& points) {
  append_value(json, points);
}

void on_wheels(JsonWriter& json, const formation::Robot& robot, const formation::DifferentialDrive& drive);

template <>
inline constexpr bool kOnOneLine<formation::DifferentialDrive> = true;
/// What stands in `kinematics`; infinite limits are left out.
template <class Codec>
void members(Codec& json, For<Codec, formation::DifferentialDrive>& drive) {
  json.member("wheel_separation", drive.wheel_separation).member("max_wheel_speed", drive.max_wheel_speed);
  json.member("max_wheel_acceleration", drive.max_wheel_acceleration);
  json.member_if(drive.max_angular_speed < geometry::kInfinity, "max_angular_speed", drive.max_angular_speed);
  json.member_if(drive.max_backward_speed < geometry::kInfinity, "max_backward_speed", drive.max_backward_speed);
  json.member_if(drive.reference > 0.0, "reference", drive.reference);
}

/// What a scenario writes as `radius` of a robot that moves in any direction: it leaves out the tracking error.
inline double body_radius_of(const formation::Robot& robot) {
  return robot.body_radius > 0.0 ? robot.body_radius : robot.radius;
}

/// A robot on wheels is written with the position of its axle and the radius of its body, which stand in its drive.
template <class Codec>
void members(Codec& json, For<Codec, formation::Robot>& robot) {
  if constexpr (!Codec::kReads) {
    if (robot.drive) return on_wheels(json, robot, *robot.drive);
  }
  json.member("id", robot.id).member("position", robot.position).optional("velocity", robot.velocity);
  if constexpr (Codec::kReads)
    json.optional("radius", robot.radius);
  else
    json.member("radius", body_radius_of(robot));
  json.optional("max_speed", robot.max_speed).optional("goals", robot.goals);
  json.optional("cooperates", robot.cooperates);
}

template <>
inline constexpr bool kOnOneLine<formation::Gains> = true;
template <class Codec>
void members(Codec& json, For<Codec, formation::Gains>& gains) {
  json.optional("k1", gains.k1).optional("k2", gains.k2).optional("k3", gains.k3).optional("kappa", gains.kappa);
}

template <>
inline constexpr bool kOnOneLine<formation::AskedControllerOptions> = true;
template <class Codec>
void members(Codec& json, For<Codec, formation::AskedControllerOptions>& asked) {
  for (const formation::ControllerSwitch& s : formation::controller_switches()) json.optional(s.name, asked.*s.asked);
  json.optional("acceleration_bound", asked.acceleration_bound);
}

/// All but the topology, the offsets, `recentre` and the leader.
template <class Codec>
void members(Codec& json, For<Codec, formation::FormationSpec>& spec) {
  json.optional("gains", spec.gains).optional("catch_up_speed", spec.catch_up_speed);
  json.optional("controller_options", spec.controller_options);
}

template <>
inline constexpr bool kOnOneLine<formation::Horizons> = true;
template <class Codec>
void members(Codec& json, For<Codec, formation::Horizons>& horizons) {
  json.optional("least", horizons.least).optional("most", horizons.most);
  json.optional("speed_floor", horizons.speed_floor).optional("orca", horizons.orca);
  json.optional("robots", horizons.robots);
}

template <>
inline constexpr bool kOnOneLine<formation::Margins> = true;
template <class Codec>
void members(Codec& json, For<Codec, formation::Margins>& margins) {
  json.optional("obstacle", margins.obstacle).optional("robot", margins.robot);
}

template <>
inline constexpr bool kOnOneLine<formation::Acceleration> = true;
template <class Codec>
void members(Codec& json, For<Codec, formation::Acceleration>& acceleration) {
  json.member("max", acceleration.max);
}

template <class Codec>
void members(Codec& json, For<Codec, formation::Measurements>& bounds) {
  json.member("position", bounds.position).member("velocity", bounds.velocity).member("age", bounds.age);
}

template <>
inline constexpr bool kOnOneLine<formation::Uncertainty> = true;
template <class Codec>
void members(Codec& json, For<Codec, formation::Uncertainty>& uncertainty) {
  json.optional("tracking", uncertainty.tracking).optional("measurements", uncertainty.measurements);
}

/// Its numbers: horizons, margins, times, distances.
template <class Codec>
void members(Codec& json, For<Codec, formation::Scenario>& scenario) {
  json.optional("horizons", scenario.horizons).optional("margins", scenario.margins);
  json.optional("time_step", scenario.time_step).optional("time_limit", scenario.time_limit);
  json.optional("arrival_tolerance", scenario.arrival_tolerance);
  json.optional("neighbour_distance", scenario.neighbour_distance);
  json.optional("acceleration", scenario.acceleration).optional("braking_time", scenario.braking_time);
  json.optional("uncertainty", scenario.uncertainty);
}

}  // namespace exactvo::datasets
