// SPDX-License-Identifier: GPL-3.0-or-later
#include "explorer/packed_run.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <variant>
#include <vector>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/provenance.h"
#include "exactvo/geometry/pi.h"
#include "support/terminal.h"

namespace exactvo::tools {

using datasets::CrowdRecordingHead;
using datasets::CrowdRow;
using geometry::Vec2;

namespace {

/// Edges that follow one another as one wall.
std::vector<formation::SceneObstacle> walls_of(const std::vector<geometry::Segment>& edges) {
  std::vector<formation::SceneObstacle> walls;
  for (const geometry::Segment& edge : edges) {
    if (!walls.empty()) {
      std::vector<Vec2>& points = std::get<geometry::Polyline>(walls.back().shape).points;
      if (points.back() == edge.a) {
        points.push_back(edge.b);
        continue;
      }
    }
    walls.push_back({fmt::format("wall {}", walls.size() + 1), geometry::Polyline{{edge.a, edge.b}}});
  }
  return walls;
}

/// The image of the unit circle, for the picture.
std::vector<Vec2> corners_of(const geometry::Ellipse& e) {
  constexpr int kCorners = 48;
  std::vector<Vec2> outline;
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2.0 * geometry::kPi * k / kCorners, x = std::cos(angle), y = std::sin(angle);
    outline.push_back(e.center + Vec2{e.l11 * x, e.l21 * x + e.l22 * y});
  }
  return outline;
}
std::vector<Vec2> corners_of(const geometry::Disc& d) {
  return corners_of(geometry::Ellipse{d.center, d.radius, 0.0, d.radius});
}
std::vector<Vec2> corners_of(const geometry::Segment& s) {
  return {s.a, s.b};
}
std::vector<Vec2> corners_of(const geometry::ConvexPolygon& polygon) {
  return polygon.vertices;
}

geometry::Obstacle outline_of(const geometry::ConvexShape& shape) {
  const std::vector<Vec2> points = std::visit([](const auto& s) { return corners_of(s); }, shape);
  if (points.size() < 3) return geometry::Polyline{{points.front(), points.back()}};
  return geometry::Polygon{points, {}};
}

void add_bodies(const CrowdRecordingHead& head, formation::Scenario& scenario) {
  for (std::size_t k = 0; k < head.bodies.size(); ++k) {
    const std::string id = fmt::format("body {}", k + 1);
    if (head.bodies[k].moves)
      scenario.moving_obstacles.push_back({id, outline_of(head.bodies[k].shape), {{Vec2{}}, 0.0, {}}});
    else
      scenario.obstacles.push_back({id, outline_of(head.bodies[k].shape)});
  }
}

datasets::RecordingFile about_crowd(const CrowdRecordingHead& head) {
  datasets::RecordingFile about;
  about.info.scenario = about.scenario.name = head.scenario;
  about.info.method = "orca";
  about.info.decisions = "none";
  about.info.provenance = datasets::make_provenance({}, 0);
  about.scenario.time_step = about.recording.time_step = head.time_step;
  about.scenario.obstacles = walls_of(head.edges);
  add_bodies(head, about.scenario);
  for (std::size_t i = 0; i < head.kind_of.size(); ++i) {
    formation::Robot robot;
    robot.id = head.name_of(i);
    robot.radius = head.kinds[head.kind_of[i]].radius;
    robot.max_speed = head.kinds[head.kind_of[i]].max_speed;
    about.scenario.robots.push_back(std::move(robot));
  }
  return about;
}

/// The row as a step: of each robot its place, its mean velocity since the row before, and whether it kept its
/// half-planes.
void put(const CrowdRow& row, const CrowdRecordingHead& head, formation::Step& step) {
  const bool is_first = step.robots.empty();
  const double before = step.time;
  step.robots.resize(row.x.size());
  step.time = head.time_step * row.step;
  step.moving.clear();
  for (std::size_t k = 0; k < head.bodies.size(); ++k)
    if (head.bodies[k].moves)
      step.moving.push_back(
          {head.position_step * Vec2{static_cast<double>(row.body_x[k]), static_cast<double>(row.body_y[k])}, {}});
  for (std::size_t i = 0; i < row.x.size(); ++i) {
    formation::RobotStep& robot = step.robots[i];
    const Vec2 here{head.position_step * row.x[i], head.position_step * row.y[i]};
    robot.velocity = is_first || !(step.time > before) ? Vec2{} : (here - robot.position) / (step.time - before);
    robot.position = here;
    robot.status = is_first || row.kept[i] != 0 ? lp::Status::optimal : lp::Status::relaxed;
  }
}

}  // namespace

PackedCrowd packed_crowd(const std::filesystem::path& path, const PackedRunLimits& limits,
                         const std::string& metrics_json) {
  datasets::CrowdRecordingReader reader(path);
  datasets::RecordingFile about = about_crowd(reader.head());
  RunPacker packer(limits);
  CrowdRow row;
  formation::Step step;
  std::size_t rows = 0;
  for (; reader.next(row); ++rows) {
    if (interrupted()) throw Interrupted();
    put(row, reader.head(), step);
    packer.add_positions(step);
  }
  if (rows == 0)
    throw datasets::DataError(datasets::DataCode::format_syntax, path.string(), "", "no whole row",
                              "a recording of at least one row");
  const auto metrics = nlohmann::json::parse(metrics_json, nullptr, false);
  const std::string cadence = reader.head().every == 1 ? "step" : fmt::format("{} steps", reader.head().every);
  about.recording.outcome = metrics.is_object() && metrics.contains("outcome") && metrics["outcome"].is_string()
                                ? metrics["outcome"].get<std::string>()
                                : fmt::format("{} robots, {} rows, a row every {} of {:.4g} s",
                                              about.scenario.robots.size(), rows, cadence, reader.head().time_step);
  if (reader.is_cut_off()) about.recording.warnings.push_back("The recording was cut off after its last whole row.");
  return {reader.head().scenario, packer.finish(about, metrics_json), reader.is_cut_off()};
}

}  // namespace exactvo::tools
