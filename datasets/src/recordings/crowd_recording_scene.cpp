// SPDX-License-Identifier: GPL-3.0-or-later
// The scene of a recording of a crowd, as other recordings have it.
#include <cmath>
#include <utility>
#include <variant>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/geometry/pi.h"

namespace exactvo::datasets {

using geometry::Vec2;

namespace {

/// Edges that follow one another as one wall; long ones in parts, of which few are near to a robot. `id`: of all; where
/// it is empty each has a number.
void add_walls(const geometry::Segment* edge, const geometry::Segment* end, const std::string& id,
               std::vector<formation::SceneObstacle>& walls) {
  constexpr std::size_t kMostPoints = 33;
  const std::size_t before = walls.size();
  for (; edge != end; ++edge) {
    if (walls.size() > before) {
      std::vector<Vec2>& points = std::get<geometry::Polyline>(walls.back().shape).points;
      if (points.back() == edge->a && points.size() < kMostPoints) {
        points.push_back(edge->b);
        continue;
      }
    }
    const std::string name = id.empty() ? "wall " + std::to_string(walls.size() + 1) : id;
    walls.push_back({name, geometry::Polyline{{edge->a, edge->b}}});
  }
}

std::vector<formation::SceneObstacle> walls_of(const CrowdRecordingHead& head) {
  std::vector<formation::SceneObstacle> walls;
  const geometry::Segment* edge = head.edges.data();
  const geometry::Segment* end = edge + head.edges.size();
  for (const CrowdObstacleRecord& obstacle : head.obstacles) {
    add_walls(edge, edge + obstacle.edges, obstacle.id, walls);
    edge += obstacle.edges;
  }
  add_walls(edge, end, "", walls);  // all, where no ids are known
  return walls;
}

/// A polygon round the ellipse: the image of one round the unit circle, with room for rounding.
std::vector<Vec2> corners_of(const geometry::Ellipse& e) {
  constexpr int kCorners = 48;
  const double beyond = (1.0 + 1e-9) / std::cos(geometry::kPi / kCorners);
  std::vector<Vec2> outline;
  for (int k = 0; k < kCorners; ++k) {
    const double angle = 2.0 * geometry::kPi * k / kCorners, x = beyond * std::cos(angle), y = beyond * std::sin(angle);
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
  std::vector<Vec2> points = std::visit([](const auto& s) { return corners_of(s); }, shape);
  if (points.size() < 3) return geometry::Polyline{std::move(points)};
  return geometry::Polygon{std::move(points), {}};
}

void add_bodies(const CrowdRecordingHead& head, formation::Scenario& scenario) {
  for (std::size_t k = 0; k < head.bodies.size(); ++k) {
    const CrowdBodyRecord& body = head.bodies[k];
    const std::string id = head.body_name(k);
    std::optional<geometry::Disc> disc;
    if (const auto* d = std::get_if<geometry::Disc>(&body.shape)) disc = *d;
    if (body.moves)
      scenario.moving_obstacles.push_back({id, outline_of(body.shape), {{Vec2{}}, 0.0, {}}, disc});
    else
      scenario.obstacles.push_back({id, outline_of(body.shape), disc});
  }
}

}  // namespace

std::string CrowdRecordingHead::body_name(std::size_t body) const {
  return bodies[body].id.empty() ? "body " + std::to_string(body + 1) : bodies[body].id;
}

std::string CrowdRecordingHead::name_of(std::size_t robot) const {
  return ids.empty() ? "#" + std::to_string(robot + 1) : ids[robot];
}

Vec2 CrowdRecordingHead::place(const CrowdRow& row, std::size_t robot) const {
  return {position_step * row.x[robot], position_step * row.y[robot]};
}

Vec2 CrowdRecordingHead::displacement(const CrowdRow& row, std::size_t body) const {
  return position_step * Vec2{static_cast<double>(row.body_x[body]), static_cast<double>(row.body_y[body])};
}

RecordingFile scene_of(const CrowdRecordingHead& head) {
  RecordingFile file;
  file.info.scenario = file.scenario.name = head.scenario;
  file.info.method = "orca";
  file.info.decisions = "none";
  file.info.provenance = make_provenance({}, 0);
  file.scenario.time_step = file.recording.time_step = head.time_step;
  file.scenario.obstacles = walls_of(head);
  if (head.tracking > 0.0) file.scenario.uncertainty = formation::Uncertainty{head.tracking};
  add_bodies(head, file.scenario);
  for (std::size_t i = 0; i < head.kind_of.size(); ++i) {
    formation::Robot& robot = file.scenario.robots.emplace_back();
    robot.id = head.name_of(i);
    const CrowdKindRecord& kind = head.kinds[head.kind_of[i]];
    robot.radius = kind.radius;
    robot.max_speed = kind.max_speed;
    if (head.tracking > 0.0 && !kind.wheels) robot.body_radius = kind.body_radius;
  }
  return file;
}

bool is_crowd_recording(const std::filesystem::path& path) {
  return path.extension() == ".evr";
}

}  // namespace exactvo::datasets
