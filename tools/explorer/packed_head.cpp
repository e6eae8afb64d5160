// SPDX-License-Identifier: GPL-3.0-or-later
#include "explorer/packed_run.h"

#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/notices.h"
#include "exactvo/geometry/names.h"
#include "support/routes_of_run.h"

namespace exactvo::tools {

using geometry::Vec2;
using Json = nlohmann::ordered_json;

namespace {

Json to_json(Vec2 p) {
  return Json::array({p.x, p.y});
}

Json flat(const std::vector<Vec2>& points) {
  Json all = Json::array();
  for (const Vec2 p : points) {
    all.push_back(p.x);
    all.push_back(p.y);
  }
  return all;
}

Json to_json(const geometry::Disc& d) {
  return {{"disc", {d.center.x, d.center.y, d.radius}}};
}
Json to_json(const geometry::Segment& s) {
  return {{"segment", {s.a.x, s.a.y, s.b.x, s.b.y}}};
}
Json to_json(const geometry::ConvexPolygon& p) {
  return {{"polygon", flat(p.vertices)}};
}
Json to_json(const geometry::Ellipse& e) {
  return {{"ellipse", {e.center.x, e.center.y, e.l11, e.l21, e.l22}}};
}

Json to_json(const std::string& id, const geometry::Obstacle& shape) {
  Json rings = Json::array();
  if (const auto* line = std::get_if<geometry::Polyline>(&shape)) {
    rings.push_back(flat(line->points));
  } else {
    const auto& polygon = std::get<geometry::Polygon>(shape);
    rings.push_back(flat(polygon.outer));
    for (const geometry::Ring& hole : polygon.holes) rings.push_back(flat(hole));
  }
  return {{"id", id}, {"solid", geometry::has_interior(shape)}, {"rings", std::move(rings)}};
}

constexpr geometry::Names<vo::BodyKind, 4> kBodyKinds{{{vo::BodyKind::enclosure, "enclosure"},
                                                       {vo::BodyKind::obstacle_edge, "edge"},
                                                       {vo::BodyKind::robot, "robot"},
                                                       {vo::BodyKind::moving_obstacle, "moving"}}};

Json to_json(const vo::Body& body) {
  Json json = {{"kind", geometry::name_in(kBodyKinds, body.kind)}, {"owners", body.owners}};
  const bool is_placed = body.kind == vo::BodyKind::enclosure || body.kind == vo::BodyKind::obstacle_edge;
  if (is_placed) json["shape"] = std::visit([](const auto& shape) { return to_json(shape); }, body.shape);
  return json;
}

Json robots_json(const formation::Scenario& scenario) {
  Json robots = Json::array();
  for (const formation::Robot& robot : scenario.robots) {
    robots.push_back({{"id", robot.id},
                      {"radius", robot.radius},
                      {"obstacle_radius", obstacle_radius(robot)},
                      {"max_speed", robot.max_speed},
                      {"goals", flat(robot.goals)},
                      {"cooperates", robot.cooperates}});
    if (const std::optional<formation::DifferentialDrive>& drive = robot.drive)
      robots.back()["on_wheels"] = {{"reference", drive->reference},
                                    {"wheel_separation", drive->wheel_separation},
                                    {"max_wheel_speed", drive->max_wheel_speed},
                                    {"body_radius", drive->body_radius},
                                    {"footprint", flat(drive->footprint)}};
    else if (robot.body_radius > 0.0)
      robots.back()["body_radius"] = robot.body_radius;
  }
  return robots;
}

Json scene_json(const formation::Scenario& scenario) {
  Json obstacles = Json::array(), moving = Json::array();
  for (const formation::SceneObstacle& o : scenario.obstacles) obstacles.push_back(to_json(o.id, o.shape));
  for (const formation::MovingObstacle& o : scenario.moving_obstacles) moving.push_back(to_json(o.id, o.shape));
  return {{"robots", robots_json(scenario)}, {"obstacles", std::move(obstacles)}, {"moving", std::move(moving)}};
}

template <class Text>
Json or_null(const std::optional<Text>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json about_json(const datasets::RecordingFile& file) {
  const formation::Scenario& scenario = file.scenario;
  const formation::Recording& run = file.recording;
  Json json = {{"name", scenario.name},
               {"description", scenario.description},
               {"method", file.info.method},
               {"controller", or_null(file.info.controller)},
               {"guidance", or_null(file.info.guidance)},
               {"liveness", or_null(file.info.liveness)},
               {"time_step", run.time_step},
               {"straight", run.motion == formation::MotionLaw::straight},
               {"relative_frame", run.relative_frame},
               {"all_half_planes", run.all_half_planes},
               {"change", scenario.acceleration ? scenario.acceleration->max * scenario.time_step : 0.0},
               {"speed_bound", scenario.speed_bound == formation::SpeedBoundKind::disc ? "disc" : "box"},
               {"arrival_tolerance", scenario.arrival_tolerance},
               {"version", file.info.provenance.version},
               {"commit", file.info.provenance.commit},
               {"outcome", file.outcome.empty() ? run.outcome : file.outcome},
               {"assumed", formation::assumed_words(scenario)},
               {"warnings", run.warnings}};
  if (scenario.formation)
    json["formation"] = {{"offsets", flat(run.offsets)}, {"path", flat(scenario.formation->leader.path)}};
  json["stuck"] = Json::array();
  for (const formation::StuckReport& report : file.stuck)
    json["stuck"].push_back({{"robot", report.robot}, {"text", report.text}});
  json["collisions"] = Json::array();
  for (const formation::Collision& c : file.collisions)
    json["collisions"].push_back({{"robot", c.robot},
                                  {"kind", name(c.kind)},
                                  {"with", c.with},
                                  {"from", c.from},
                                  {"until", c.until},
                                  {"at", c.deepest_at},
                                  {"depth", c.depth},
                                  {"place", to_json(c.place)}});
  return json;
}

Json bodies_json(const formation::Recording& run) {
  Json bodies = Json::array();
  for (const vo::Body& body : run.bodies) bodies.push_back(to_json(body));
  return bodies;
}

Json goal_bodies_json(const formation::Recording& run) {
  Json goal_bodies = Json::array();
  for (const formation::GoalBodies& o : run.goal_bodies)
    goal_bodies.push_back({{"time", o.time}, {"robot", o.robot}, {"goal", o.goal}, {"bodies", o.bodies}});
  return goal_bodies;
}

/// Places of all moves one after the other, as are those who make them.
Json plans_json(const formation::Recording& run) {
  Json plans = Json::array();
  for (const formation::JointPlan& plan : run.plans) {
    Json movers = Json::array();
    std::vector<Vec2> places;
    for (const formation::PlanMove& move : plan.moves) {
      movers.push_back(move.robot);
      places.push_back(move.to);
    }
    plans.push_back({{"time", static_cast<double>(plan.row) * run.time_step},
                     {"from", static_cast<double>(plan.from_row) * run.time_step},
                     {"robots", plan.robots},
                     {"starts", flat(plan.starts)},
                     {"movers", std::move(movers)},
                     {"places", flat(places)}});
  }
  return plans;
}

/// Planned again as the run did; null where it had none, or where that would take long.
Json routes_json(const datasets::RecordingFile& about, const PackedRunLimits& limits) {
  const auto planned = routes_of(about, limits.routed_robots, limits.routed_vertices);
  if (!planned) return nullptr;
  Json routes = Json::array();
  for (const formation::PlannedRoute& route : *planned)
    routes.push_back(
        {{"robot", route.robot}, {"goal", route.goal}, {"points", flat(route.points)}, {"why_not", route.why_not}});
  return routes;
}

/// Null where a name is no UTF-8.
Json scenario_json(const formation::Scenario& scenario) {
  Json json = Json::parse(datasets::write_scenario(scenario), nullptr, false);
  return json.is_discarded() ? Json(nullptr) : json;
}

}  // namespace

Json shown_metrics(const std::string& text) {
  Json metrics = Json::parse(text, nullptr, false);
  if (!metrics.is_object()) return nullptr;
  metrics.erase("wall_time");
  metrics.erase("provenance");
  return metrics;
}

Json packed_head(const datasets::RecordingFile& about, const PackedRunLimits& limits) {
  Json head = {{"run", about_json(about)}, {"scene", scene_json(about.scenario)}};
  if (limits.has_scenario) head["scenario"] = scenario_json(about.scenario);
  head["bodies"] = bodies_json(about.recording);
  head["goal_bodies"] = goal_bodies_json(about.recording);
  head["plans"] = plans_json(about.recording);
  head["routes"] = routes_json(about, limits);
  return head;
}

}  // namespace exactvo::tools
