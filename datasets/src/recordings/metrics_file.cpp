// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/metrics_file.h"

#include <array>
#include <cstdio>
#include <utility>

#include "json/json_text.h"
#include "recordings/codec.h"

namespace exactvo::datasets {
namespace {

void append_robot(JsonWriter& json, const formation::RobotMetrics& robot) {
  json.begin_inline_object();
  json.member("id", robot.id).member("arrived", robot.arrived).member("arrival_time", robot.arrival_time);
  json.member("path_length", robot.path_length).member("min_obstacle_clearance", robot.min_obstacle_clearance);
  json.member("detour", robot.detour).member("largest_slot_error", robot.largest_slot_error);
  json.end_object();
}

void append(JsonWriter& json, const formation::FormationCourse& course) {
  json.begin_inline_object().member("largest_error", course.largest_error);
  json.member("largest_error_at", course.largest_error_at).member("largest_error_of", course.largest_error_of);
  json.member("first_formed", course.first_formed).member("formed_since", course.formed_since);
  json.member("share_formed", course.share_formed).member("rms_error", course.rms_error).end_object();
}

void append(JsonWriter& json, const formation::RobotMarginCourse& margin) {
  json.begin_inline_object().member("asked", margin.asked).member("pair_rows", margin.pair_rows);
  json.member("robots", margin.robots).end_object();
}

void append(JsonWriter& json, const formation::PlanMetrics& plans) {
  json.begin_inline_object().member("groups", plans.groups).member("largest", plans.largest);
  json.member("time_by_plan", plans.time_by_plan).member("time_back", plans.time_back);
  json.member("search_nodes", plans.search_nodes).end_object();
}

void append(JsonWriter& json, const formation::RoutesCourse& routes) {
  json.begin_inline_object().member("planned", routes.planned).member("pushed_off", routes.pushed_off);
  json.member("cut", routes.cut).member("nearest", routes.nearest).end_object();
}

/// What one way of making a run does not count is null.
void append_decisions(JsonWriter& json, const RunInfo& info, const formation::Metrics& m) {
  const formation::CrowdMetrics* crowd = m.crowd ? &*m.crowd : nullptr;
  const auto of_crowd = [&](const char* key, std::size_t formation::CrowdMetrics::*count) {
    json.member(key, crowd ? std::optional<std::size_t>(crowd->*count) : std::nullopt);
  };
  const auto of_recorded = [&](const char* key, std::size_t count) {
    json.member(key, crowd ? std::nullopt : std::optional<std::size_t>(count));
  };
  json.begin_object().member("recorded", info.decisions).member("count", m.robots.size() * m.steps);
  json.member("relaxed", m.relaxed_steps);
  of_recorded("active_set_switches", m.active_set_switches);
  of_recorded("uncertified_half_planes", m.uncertified_half_planes);
  of_crowd("cut_short", &formation::CrowdMetrics::cut_short);
  of_crowd("reserved", &formation::CrowdMetrics::reserved);
  of_crowd("stopped", &formation::CrowdMetrics::stopped);
  of_crowd("overlapping", &formation::CrowdMetrics::overlapping);
  of_crowd("touching", &formation::CrowdMetrics::touching);
  of_crowd("widened", &formation::CrowdMetrics::widened);
  of_crowd("against_robots", &formation::CrowdMetrics::against_robots);
  of_crowd("against_edges", &formation::CrowdMetrics::against_edges);
  of_crowd("against_bodies", &formation::CrowdMetrics::against_bodies);
  json.end_object();
}

std::optional<std::string> digest_of(const formation::Metrics& m) {
  if (!m.crowd) return std::nullopt;
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(m.crowd->digest));
  return digits.data();
}

void append_course(JsonWriter& json, const char* key, const formation::LyapunovCourse& c) {
  json.key(key).begin_inline_object().member("first", c.first).member("last", c.last).member("least", c.least);
  json.member("largest_rise", c.largest_rise).end_object();
}

void append(JsonWriter& json, const formation::LyapunovSummary& summary) {
  json.begin_object();
  append_course(json, "paper", summary.paper);
  append_course(json, "sound", summary.sound);
  json.end_object();
}

/// Every line but the first moved right, for an object inside a list.
std::string indented(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (i + 1 == text.size() && text[i] == '\n') break;
    result += text[i];
    if (text[i] == '\n') result += "  ";
  }
  return result;
}

}  // namespace

RunInfo run_info(const formation::Scenario& scenario, formation::SimulationOptions options, Provenance provenance,
                 bool has_decisions) {
  if (!has_decisions) options.method = formation::Method::orca;
  RunInfo info{scenario.name, name(options.method), std::nullopt, std::nullopt, std::move(provenance)};
  if (scenario.formation) {
    info.controller = name(options.controller);
    info.integrator = name(options.integrator);
  }
  const formation::Guidance guidance = guidance_of(scenario, options);
  const formation::Liveness liveness =
      has_decisions ? liveness_of(scenario, options) : crowd_liveness(scenario, options);
  if (guidance != formation::Guidance::none) info.guidance = name(guidance);
  if (liveness != formation::Liveness::off) info.liveness = name(liveness);
  if (!has_decisions)
    info.decisions = "none";
  else if (options.record_all)
    info.decisions = "all";
  return info;
}

std::string metrics_json(const RunInfo& info, const formation::Metrics& m) {
  JsonWriter json(JsonWriter::Layout::indented);
  const auto appended = [&json](const auto& part) { append(json, part); };
  json.begin_object();
  json.member("scenario", info.scenario).member("method", info.method).member("controller", info.controller);
  json.optional("guidance", info.guidance).optional("liveness", info.liveness);
  json.member("arrived", m.arrived).member("all_arrived", m.all_arrived);
  json.member("median_arrival_time", m.median_arrival_time).member("last_arrival_time", m.last_arrival_time);
  json.member("min_obstacle_clearance", m.min_obstacle_clearance).member("min_robot_clearance", m.min_robot_clearance);
  json.member("robot_margin", m.robot_margin, appended).member("collisions", m.collisions);
  json.member("formation_position_error", m.formation_position_error);
  json.member("formation_velocity_error", m.formation_velocity_error);
  json.member("leader_arrival_time", m.leader_arrival_time);
  json.member("formation_course", m.formation_course, appended);
  json.member("jitter", m.jitter);
  json.member("velocity_variation", m.velocity_variation).member("peak_acceleration", m.peak_acceleration);
  json.member("heading_reversals", m.heading_reversals);
  append_decisions(json.key("decisions"), info, m);
  json.member("steps", m.steps).member("time", m.time).member("wall_time", m.wall_time);
  json.member("digest", digest_of(m)).member("outcome", m.outcome).member("not_measured", m.not_measured);
  json.member("warnings", m.warnings).member("plans", m.plans, appended).member("routes", m.routes, appended);
  if (m.deadlock.empty())
    json.key("deadlock").null();
  else
    json.member("deadlock", m.deadlock);
  json.member("stands_still", m.crowd ? std::optional<bool>(m.crowd->stands_still) : std::nullopt);
  json.member("stuck", m.stuck).member("lyapunov", m.lyapunov, appended);
  json.list("robots", m.robots, [&](const formation::RobotMetrics& robot) { append_robot(json, robot); });
  json.key("provenance").raw(to_json(info.provenance));
  return json.end_object().take() + "\n";
}

std::string summary_json(const std::vector<std::string>& metrics_objects) {
  std::string text = "[";
  for (std::size_t i = 0; i < metrics_objects.size(); ++i) {
    text += (i > 0 ? ",\n  " : "\n  ") + indented(metrics_objects[i]);
  }
  return text + "\n]\n";
}

}  // namespace exactvo::datasets
