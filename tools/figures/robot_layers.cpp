// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/geometry/pi.h"
#include "figures/label_places.h"
#include "figures/outlines.h"
#include "figures/panel_layers.h"
#include "figures/run_figures.h"
#include "figures/thinning.h"

namespace exactvo::tools {

using formation::Robot;
using formation::Step;

namespace {

/// With more robots than this, only the middle time and the last are written, and smaller.
constexpr int kFewRobots = 3;
/// With more robots than this, not even the last time is written over something else.
constexpr int kSomeRobots = 12;
/// Of a polygon that stands for a circle.
constexpr int kLeastCorners = 8;

class RobotLayers {
 public:
  explicit RobotLayers(PanelLayers& to) : to_(to), times_(to.view, scale_of(to.view)), marks_(time_marks(to.run)) {}

  void add() {
    if (to_.detailed) note_lines();
    add_leader();
    for (const std::vector<std::size_t>& alike : drawn_together(to_.run.scenario.robots.size(), kStyles)) {
      add_ways(alike);
      if (is_crowd()) add_outlines(alike);
      add_places(alike);
      add_bodies(alike);
    }
    if (to_.detailed) add_times_of_moving_obstacles();
    add_goals();
    add_collisions();
  }

 private:
  bool is_crowd() const { return to_.run.scenario.robots.size() > kMostInLegend; }
  int robot_count() const { return static_cast<int>(to_.run.scenario.robots.size()); }

  /// The rows whose places are drawn of a way, which has one for each.
  std::vector<std::size_t> drawn_rows(const Points& way) const {
    const std::size_t points = to_.run.recording.steps.size() * to_.run.scenario.robots.size();
    if (points <= kMostWholePoints) return all_points(way.size());
    Points in_pixels;
    for (const Vec2 p : way) in_pixels.push_back(scale_of(to_.view) * (p - to_.view.low));
    return drawn_points(in_pixels);
  }

  void add_leader() {
    if (!to_.run.scenario.formation) return;
    const int index = to_.data.begin("virtual leader", "x [m], y [m]");
    Points way;
    for (const Step& step : to_.run.recording.steps) way.push_back(step.leader_position);
    for (const std::size_t k : drawn_rows(way)) to_.data.row({way[k].x, way[k].y});
    to_.draw(index, "with lines lw 1.5 dt (2,4) lc rgb 'black'", to_.key("virtual leader"));
  }

  /// Where there is room, after the robots' times; the first and the last have theirs in any case.
  void add_times_of_moving_obstacles() {
    if (to_.run.scenario.moving_obstacles.empty()) return;
    const int index = to_.data.begin("times of the moving obstacles", "x [m], y [m], t");
    for (const auto& obstacle : to_.run.scenario.moving_obstacles) {
      for (std::size_t k = 0; k < marks_.size(); ++k) {
        const bool is_end = k == 0 || k + 1 == marks_.size();
        const Vec2 p = middle_at(obstacle, marks_[k]->time);
        if (!to_.is_drawable(p)) continue;
        double half_width = 0.0;
        for (const Vec2 q : vertices_at(obstacle, marks_[k]->time))
          half_width = std::max(half_width, std::fabs(q.x - p.x));
        if (const std::optional<Vec2> place = times_.place_at_side(p, half_width, is_end))
          to_.data.labelled_row({place->x, place->y}, fmt::format("{:.3g} s", marks_[k]->time));
      }
    }
    to_.plot.data(index, to_.origin.using_columns(1, 2, ":3") +
                             fmt::format(" with labels center font ',8' textcolor rgb '{}'", kObstacleLine));
  }

  std::string names(const std::vector<std::size_t>& robots) const {
    return names_of(robots, [&](std::size_t i) { return to_.run.scenario.robots[i].id; });
  }

  /// Of robots that look alike.
  void add_ways(const std::vector<std::size_t>& alike) {
    const std::size_t first = alike.front(), count = to_.run.scenario.robots.size();
    const int index = to_.data.begin("path of " + names(alike), "x [m], y [m], t [s]");
    for (const std::size_t i : alike) {
      to_.data.gap();
      Points way;
      for (const Step& step : to_.run.recording.steps) {
        if (!to_.is_drawable(step.robots[i].position)) break;
        way.push_back(step.robots[i].position);
      }
      for (const std::size_t k : drawn_rows(way)) to_.data.row({way[k].x, way[k].y, to_.run.recording.steps[k].time});
    }
    to_.draw(index,
             fmt::format("with lines lw {}{} lc rgb '{}'", to_.detailed ? 2.5 : 1.5, series_dash(first),
                         series_colour(first)),
             to_.key(robot_in_legend(first, count, to_.run.scenario.robots[first].id, kLegendName)));
  }

  /// As many corners as keep a polygon as near to the circle as thinned curves are kept to theirs.
  static int corners_of_circle(double pixels) {
    if (!(pixels > kThinning)) return kLeastCorners;
    return std::max(kLeastCorners, static_cast<int>(std::ceil(geometry::kPi / std::acos(1.0 - kThinning / pixels))));
  }

  Points circle(Vec2 centre, double radius) const {
    const int corners = corners_of_circle(scale_of(to_.view) * radius);
    Points ring;
    for (int k = 0; k < corners; ++k) {
      const double angle = 2.0 * geometry::kPi * k / corners;
      ring.push_back(centre + radius * Vec2{std::cos(angle), std::sin(angle)});
    }
    return ring;
  }

  /// Of many robots, small as they are: gnuplot writes several kilobytes a circle into an SVG.
  void add_outlines(const std::vector<std::size_t>& alike) {
    const int rings = to_.data.begin("outlines of " + names(alike), "x [m], y [m]");
    for (const std::size_t i : alike)
      for (const Step* step : places_of(i))
        to_.data.ring(circle(step->robots[i].position, to_.run.scenario.robots[i].radius));
    const char* const colour = series_colour(alike.front());
    to_.draw(rings, fmt::format("with filledcurves closed fc rgb '{}' fs transparent solid 0.25 noborder", colour));
    to_.draw(rings, fmt::format("with lines lw 1 lc rgb '{}'", colour));
  }

  /// The robots to scale: at every time mark that one has moved to and at its end. Without details, and of many robots,
  /// at its start and its end only.
  void add_places(const std::vector<std::size_t>& alike) {
    const int index =
        to_.data.begin("places of " + names(alike), "x [m], y [m], radius [m], where t is written [m], [m], t");
    for (const std::size_t i : alike) {
      const std::vector<const Step*> places = places_of(i);
      const double radius = to_.run.scenario.robots[i].radius;
      // The last one first: its label is always there, and the others give way.
      for (std::size_t k = places.size(); k-- > 0;) {
        const Vec2 p = places[k]->robots[i].position;
        const auto& [at, time] = label(p, radius, places[k]->time, k, places.size());
        to_.data.labelled_row({p.x, p.y, radius, at.x, at.y}, time);
      }
    }
    const char* const colour = series_colour(alike.front());
    if (!is_crowd())
      to_.plot.data(
          index, to_.origin.using_columns(1, 2, ":3") +
                     fmt::format(" with circles fc rgb '{0}' fs transparent solid 0.25 border lc rgb '{0}'", colour));
    if (!to_.detailed) return;
    to_.plot.data(
        index, to_.origin.using_columns(4, 5, ":6") + fmt::format(" with labels center font ',{}' textcolor rgb '{}'",
                                                                  robot_count() <= kFewRobots ? 10 : 8, colour));
  }

  /// Within the discs where these are larger: of those on wheels the body about the axle, and how far ahead the
  /// reference point is; of others the body without its tracking error.
  void add_bodies(const std::vector<std::size_t>& alike) {
    std::vector<std::size_t> smaller;
    for (const std::size_t i : alike)
      if (to_.run.scenario.robots[i].drive || to_.run.scenario.robots[i].body_radius > 0.0) smaller.push_back(i);
    if (smaller.empty()) return;
    const int index = to_.data.begin("bodies of " + names(smaller), "x [m], y [m]");
    for (const std::size_t i : smaller) {
      const formation::Robot& spec = to_.run.scenario.robots[i];
      for (const Step* step : places_of(i)) {
        const formation::RobotStep& robot = step->robots[i];
        if (!spec.drive) to_.data.ring(circle(robot.position, spec.body_radius));
        if (spec.drive && robot.wheels) add_on_wheels(*spec.drive, robot);
      }
    }
    to_.draw(index, fmt::format("with lines lw 1 lc rgb '{}'", series_colour(alike.front())));
  }

  void add_on_wheels(const formation::DifferentialDrive& drive, const formation::RobotStep& robot) {
    const Vec2 e = robot.wheels->heading, axle = robot.position - drive.reference * e;
    Points corners;
    for (const Vec2 c : drive.footprint) corners.push_back(axle + c.x * e + c.y * Vec2{-e.y, e.x});
    to_.data.ring(corners.empty() ? circle(axle, drive.body_radius) : corners);
    to_.data.curve({axle, robot.position});
  }

  /// The row at which the robot came to rest, or the last one that can be drawn.
  const Step* last_place(std::size_t i) const {
    const double end = end_of_motion(to_.run, i);
    const Step* last = nullptr;
    for (const Step& step : to_.run.recording.steps) {
      if (!to_.is_drawable(step.robots[i].position)) break;
      last = &step;
      if (step.time > end || end == 0.0) break;
    }
    return last;
  }

  std::vector<const Step*> places_of(std::size_t i) const {
    std::vector<const Step*> places;
    std::vector<const Step*> marks = marks_;
    const Step* last = last_place(i);
    if (last == nullptr) return {};
    if ((!to_.detailed || is_crowd()) && marks.size() > 1) marks.resize(1);
    const double apart = to_.run.scenario.robots[i].radius;
    const auto moved = [&](const Step* from, const Step* to) {
      return norm(to->robots[i].position - from->robots[i].position) > apart;
    };
    for (const Step* step : marks) {
      if (step->time < last->time && moved(step, last) && (places.empty() || moved(places.back(), step)))
        places.push_back(step);
    }
    places.push_back(last);
    return places;
  }

  /// What no time may be written on.
  void note_lines() {
    for (const auto& obstacle : to_.run.scenario.obstacles)
      for (const geometry::Segment& edge : edges_of(obstacle.shape)) times_.keep_off({edge.a, edge.b}, false);
    std::vector<Points> rings;
    for (const formation::GoalBodies& of_goal : to_.run.recording.goal_bodies)
      if (of_goal.goal == 0) add_ellipses(to_.run, of_goal, rings);
    for (const Points& ring : rings) times_.keep_off(ring, true);
    for (std::size_t i = 0; i < to_.run.scenario.robots.size(); ++i) {
      Points way;
      for (const Step& step : to_.run.recording.steps)
        if (to_.is_drawable(step.robots[i].position)) way.push_back(step.robots[i].position);
      times_.keep_off(way, false);
      for (const Vec2 goal : to_.run.scenario.robots[i].goals) times_.keep_off({goal}, false);
    }
    if (to_.run.scenario.formation) {
      Points way;
      for (const Step& step : to_.run.recording.steps)
        if (to_.is_drawable(step.leader_position)) way.push_back(step.leader_position);
      times_.keep_off(way, false);
    }
    for (const auto& obstacle : to_.run.scenario.moving_obstacles)
      for (const Step* mark : marks_) times_.keep_off(vertices_at(obstacle, mark->time), true);
  }

  /// Where, and what: the time; nothing where it would lie on something, unless it is the robot's last.
  std::pair<Vec2, std::string> label(Vec2 p, double radius, double time, std::size_t k, std::size_t count) {
    const bool last = k + 1 == count;
    const bool middle = k == count / 2;
    if (!to_.detailed || (robot_count() > kFewRobots && !last && !middle)) return {p, ""};
    const std::optional<Vec2> place = times_.place_beside(p, radius, last && robot_count() <= kSomeRobots);
    if (!place) return {p, ""};
    return {*place, fmt::format("{:.3g} s", time)};
  }

  void add_collisions() {
    Points marks;
    for (const formation::Collision& c : to_.run.collisions)
      if (to_.is_drawable(c.place)) marks.push_back(c.place);
    to_.has_collisions = !marks.empty();
    if (marks.empty()) return;
    const int index = to_.data.begin("collisions: where they were deepest", "x [m], y [m]");
    to_.data.rows(marks);
    to_.draw(index,
             fmt::format("with points pt 1 ps {} lw {} lc rgb '{}'", to_.detailed ? 2.5 : 1.2, to_.detailed ? 4 : 2,
                         kCollisionColour),
             to_.key("collision"));
  }

  void add_goals() {
    bool any = false;
    for (const std::vector<std::size_t>& alike : drawn_together(to_.run.scenario.robots.size(), kColours)) {
      Points goals;
      for (const std::size_t i : alike)
        goals.insert(goals.end(), to_.run.scenario.robots[i].goals.begin(), to_.run.scenario.robots[i].goals.end());
      if (goals.empty()) continue;
      const int index = to_.data.begin("goals of " + names(alike), "x [m], y [m]");
      to_.data.rows(goals);
      to_.draw(index, fmt::format("with points pt 2 ps {} lw {} lc rgb '{}'", to_.detailed ? 1.3 : 0.8,
                                  to_.detailed ? 2.5 : 1.5, series_colour(alike.front())));
      any = true;
    }
    if (any && to_.detailed) to_.plot.item("keyentry with points pt 2 ps 1.3 lw 2.5 lc rgb '#222222'", "goal");
  }

  PanelLayers& to_;
  LabelPlaces times_;
  std::vector<const Step*> marks_;
};

}  // namespace

void add_robots(PanelLayers& to) {
  RobotLayers(to).add();
}

}  // namespace exactvo::tools
