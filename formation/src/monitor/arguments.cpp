// SPDX-License-Identifier: GPL-3.0-or-later
#include "monitor/arguments.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pieces.h"
#include "exactvo/geometry/validity.h"
#include "scene/number_text.h"

namespace exactvo::formation::monitored {

namespace {

std::string digits_of(Vec2 v) {
  return monitored::digits_of(v.x) + ", " + monitored::digits_of(v.y);
}

/// A finite number of less than kMostSize, of either sign.
void require_number(double x, const ArgumentPlace& place) {
  if (!std::isfinite(x)) refuse(MonitorProblem::not_finite, place, monitored::digits_of(x), "a finite number");
  if (!(std::fabs(x) < kMostSize))
    refuse(MonitorProblem::out_of_range, place, monitored::digits_of(x), "a number of less than 2^30");
}

geometry::Obstacle valid_shape(const SceneObstacle& obstacle, std::size_t index) {
  const ArgumentPlace place{"", "obstacles", index};
  for (const Vec2 v : geometry::vertices_of(obstacle.shape)) require_place(v, place);
  if (const auto* wall = std::get_if<geometry::Polyline>(&obstacle.shape)) {
    if (wall->points.size() < 2)
      refuse(MonitorProblem::out_of_range, place, "a wall of one point", "at least two points");
    return *wall;
  }
  const auto& polygon = std::get<geometry::Polygon>(obstacle.shape);
  std::vector<geometry::Ring> rings{polygon.outer};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  geometry::NormalizedPolygon normalized = geometry::normalize(rings);
  if (!normalized.ok())
    refuse(MonitorProblem::out_of_range, place, code_name(normalized.problems.front().code), "a valid polygon");
  return std::move(normalized.polygon);
}

}  // namespace

std::string ArgumentPlace::text() const {
  std::string text = list;
  if (!text.empty()) text += "/" + std::to_string(index);
  if (!text.empty() && *field != '\0') text += "/";
  return text + field;
}

std::string digits_of(double x) {
  return detail::number_text(x, 17);
}

void refuse(MonitorProblem problem, const ArgumentPlace& place, const std::string& found, const std::string& expected) {
  throw MonitorError(problem, place.text(), found, expected);
}

void require_within(double x, double least, const ArgumentPlace& place) {
  if (!std::isfinite(x)) refuse(MonitorProblem::not_finite, place, digits_of(x), "a finite number");
  if (!(x >= least && x < kMostSize))
    refuse(MonitorProblem::out_of_range, place, digits_of(x),
           "a number of at least " + digits_of(least) + " and less than 2^30");
}

void require_place(Vec2 v, const ArgumentPlace& place) {
  if (!geometry::is_finite(v)) refuse(MonitorProblem::not_finite, place, digits_of(v), "finite numbers");
  if (!(std::max(std::fabs(v.x), std::fabs(v.y)) < kMostSize))
    refuse(MonitorProblem::out_of_range, place, digits_of(v), "numbers of less than 2^30");
}

void require_setup(const MonitorSetup& setup) {
  require_within(setup.max_deceleration, kLeastDeceleration, {"max_deceleration"});
  require_within(setup.max_turn_deceleration, kLeastDeceleration, {"max_turn_deceleration"});
  require_within(setup.latency, 0.0, {"latency"});
  require_within(setup.period, 0.0, {"period"});
  require_within(setup.margin, 0.0, {"margin"});
  if (setup.footprint.empty()) refuse(MonitorProblem::out_of_range, {"footprint"}, "no parts", "at least one");
}

void require_command(const geometry::Pose& pose, const Command& command) {
  require_place(pose.at, {"pose"});
  require_number(pose.heading, {"pose"});
  require_place(command.twist.velocity, {"velocity"});
  require_number(command.twist.turn, {"turn"});
  if (command.in_world_axes && command.twist.turn != 0.0)
    refuse(MonitorProblem::out_of_range, {"turn"}, digits_of(command.twist.turn),
           "0, with a velocity in the world's axes");
}

void require_trajectory(const std::vector<TimedPose>& trajectory) {
  if (trajectory.size() < 2)
    refuse(MonitorProblem::no_trajectory, {"trajectory"},
           std::to_string(trajectory.size()) + (trajectory.size() == 1 ? " pose" : " poses"), "at least two");
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    const ArgumentPlace place{"", "trajectory", k};
    require_place(trajectory[k].pose.at, place);
    require_number(trajectory[k].time, place);
    require_number(trajectory[k].pose.heading, place);
    if (k > 0 && !(trajectory[k - 1].time < trajectory[k].time))
      refuse(MonitorProblem::no_trajectory, place, digits_of(trajectory[k].time) + " s",
             "a time of more than " + digits_of(trajectory[k - 1].time) + " s");
  }
}

void require_movers(const std::vector<Mover>& movers) {
  for (std::size_t k = 0; k < movers.size(); ++k) {
    const Mover& mover = movers[k];
    const char* corners = mover.shape.corners.size() == 1 ? "position" : "polygon";
    if (mover.shape.corners.empty())
      refuse(MonitorProblem::out_of_range, {corners, "movers", k}, "no corners", "at least one");
    for (const Vec2 v : mover.shape.corners) require_place(v, {corners, "movers", k});
    require_within(mover.shape.radius, 0.0, {"radius", "movers", k});
    require_within(mover.max_speed, 0.0, {"max_speed", "movers", k});
    require_within(mover.position_error, 0.0, {"position_error", "movers", k});
  }
}

std::vector<Vec2> hull_of_part(const geometry::RoundedPolygon& part, std::size_t index) {
  const ArgumentPlace place{"", "footprint", index};
  if (part.corners.empty()) refuse(MonitorProblem::out_of_range, place, "no corners", "at least one");
  for (const Vec2 v : part.corners) require_place(v, place);
  require_within(part.radius, 0.0, place);
  std::vector<Vec2> hull = geometry::convex_hull(part.corners).vertices;
  if (part.radius == 0.0 && hull.size() < 3)
    refuse(MonitorProblem::out_of_range, place, "a part without an area", "a radius above 0, or an area");
  return hull;
}

std::vector<std::vector<Vec2>> convex_pieces(const SceneObstacle& obstacle, std::size_t index) {
  std::vector<std::vector<Vec2>> pieces;
  for (const geometry::ConvexShape& piece : geometry::convex_cover(valid_shape(obstacle, index)))
    pieces.push_back(geometry::corners_of(piece));
  return pieces;
}

}  // namespace exactvo::formation::monitored
