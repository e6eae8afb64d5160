// SPDX-License-Identifier: GPL-3.0-or-later
// Paths of runs: what stands and moves in the plane, then what the robots did in it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "exactvo/datasets/recording_file.h"
#include "exactvo/formation/passing.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/require.h"
#include "figures/label_places.h"
#include "figures/outlines.h"
#include "figures/plane.h"
#include "figures/run_figures.h"
#include "support/routes_of_run.h"

namespace exactvo::tools {

using datasets::RecordingFile;
using formation::Robot;
using formation::Step;

double end_of_motion(const RecordingFile& run, std::size_t robot) {
  constexpr double kVisibleSpeed = 0.01;  // m/s: slower than this a robot is not seen to move
  const auto& steps = run.recording.steps;
  for (std::size_t k = steps.size(); k-- > 0;) {
    if (norm(steps[k].robots[robot].velocity) > kVisibleSpeed) return steps[k].time;
  }
  return 0.0;
}

double end_of_motion(const RecordingFile& run) {
  double end = 0.0;
  for (std::size_t i = 0; i < run.scenario.robots.size(); ++i) end = std::max(end, end_of_motion(run, i));
  return end;
}

namespace {

/// Characters of a name in a legend or before a title.
constexpr std::size_t kLegendName = 32;
constexpr std::size_t kTimeMarks = 6;
/// m: what is so far beyond the view leaves the picture anyway; larger numbers would only upset gnuplot.
constexpr double kFarAway = 1e6;

struct PanelLayers : Panel {
  PanelLayers(const RecordingFile& shown, const Box& box, DataFile& file, bool with_details)
      : Panel(box, file), run(shown), detailed(with_details) {}

  /// `text` where the panel has a legend of its own.
  std::string key(const std::string& text) const { return detailed ? text : ""; }
  /// Whether it lies no farther beyond the view than gnuplot can bear.
  bool is_drawable(Vec2 p) const { return is_finite(p) && view.grown(kFarAway).contains(p); }

  const RecordingFile& run;
  bool detailed;  ///< with a legend, enclosures, routes and times
  bool has_collisions = false, has_hits = false;
};

/// px a metre of the plane in the SVG.
double scale_of(const Box& view) {
  return std::min(760.0 / view.width(), 620.0 / view.height());
}

/// A few rows, evenly over the time in which robots move.
std::vector<const Step*> time_marks(const RecordingFile& run) {
  std::vector<const Step*> marks;
  const double end = end_of_motion(run);
  for (const Step& step : run.recording.steps) {
    const double due = end * static_cast<double>(marks.size()) / (kTimeMarks - 1);
    if (marks.size() < kTimeMarks && step.time >= due) marks.push_back(&step);
  }
  return marks;
}

Points vertices_at(const formation::MovingObstacle& obstacle, double time) {
  Points points = vertices_of(obstacle.shape);
  for (Vec2& p : points) p += displacement_at(obstacle, time);
  return points;
}

Vec2 middle_at(const formation::MovingObstacle& obstacle, double time) {
  const Points points = vertices_at(obstacle, time);
  Vec2 middle{};
  for (const Vec2 p : points) middle += p / static_cast<double>(points.size());
  return middle;
}

/// Ellipses only: a facade that stands for itself would be drawn over the obstacle.
void add_ellipses(const RecordingFile& run, const formation::GoalBodies& of_goal, std::vector<Points>& rings) {
  for (const std::size_t body : of_goal.bodies) {
    const geometry::ConvexShape& shape = run.recording.bodies[body].shape;
    if (std::holds_alternative<geometry::Ellipse>(shape)) rings.push_back(outline(shape));
  }
}

// --- The scene ---

/// Where they are at every time mark, and the way of their middle.
void add_moving_obstacles(PanelLayers& to) {
  const std::vector<const Step*> marks = time_marks(to.run);
  std::vector<Points> places, ways;
  for (const auto& obstacle : to.run.scenario.moving_obstacles) {
    ways.emplace_back();
    for (const Step* mark : marks) {
      places.push_back(vertices_at(obstacle, mark->time));
      ways.back().push_back(middle_at(obstacle, mark->time));
    }
  }
  to.rings("moving obstacles at the time marks", places, line_style(1.5, kObstacleLine, " dt (8,3)"),
           to.key("moving obstacle"));
  to.curves("paths of the moving obstacles", ways,
            fmt::format("with linespoints lw 1 pt 7 ps 0.5 dt (2,3) lc rgb '{}'", kObstacleLine));
}

/// Robots by the colour of what is drawn of them, and which set each is in.
struct ByColour {
  explicit ByColour(const RecordingFile& run)
      : sets(drawn_together(run.scenario.robots.size(), kColours)), set_of(run.scenario.robots.size()) {
    for (std::size_t s = 0; s < sets.size(); ++s)
      for (const std::size_t i : sets[s]) set_of[i] = s;
  }
  std::string names(const RecordingFile& run, std::size_t set) const {
    return names_of(sets[set], [&](std::size_t i) { return run.scenario.robots[i].id; });
  }
  const char* colour(std::size_t set) const { return series_colour(sets[set].front()); }

  std::vector<std::vector<std::size_t>> sets;
  std::vector<std::size_t> set_of;
};

void add_enclosures(PanelLayers& to) {
  const ByColour robots(to.run);
  std::vector<std::vector<Points>> rings(robots.sets.size());
  for (const formation::GoalBodies& of_goal : to.run.recording.goal_bodies)
    add_ellipses(to.run, of_goal, rings[robots.set_of[of_goal.robot]]);
  bool any = false;
  for (std::size_t s = 0; s < rings.size(); ++s) {
    any = any || !rings[s].empty();
    to.rings("enclosures seen by " + robots.names(to.run, s), rings[s], line_style(1.2, robots.colour(s), " dt (6,5)"));
  }
  if (any) to.plot.item("keyentry " + line_style(1.2, "#222222", " dt (6,5)"), "enclosures");
}

/// Wide and pale, under the paths; and what separates goals out of reach: solid along obstacles, dashed across gaps.
void add_routes(PanelLayers& to) {
  const std::vector<formation::PlannedRoute> routes =
      routes_of(to.run).value_or(std::vector<formation::PlannedRoute>{});
  const ByColour robots(to.run);
  std::vector<std::vector<Points>> ways(robots.sets.size());
  ChainLines chains;
  for (const formation::PlannedRoute& route : routes) {
    if (!route.points.empty()) ways[robots.set_of[route.robot]].push_back(route.points);
    chains.add(route.chain);
  }
  bool any = false;
  for (std::size_t s = 0; s < ways.size(); ++s) {
    any = any || !ways[s].empty();
    to.curves("routes of " + robots.names(to.run, s), ways[s],
              line_style(7, std::string("#c0") + (robots.colour(s) + 1)));
  }
  if (any) to.plot.item("keyentry " + line_style(7, "#c0222222"), "route");
  to.curves("closed chains", chains.along, line_style(3.5, kSeparatorColour), "closed chain");
  to.curves("gaps that are too narrow", chains.across, line_style(2.5, kSeparatorColour, " dt (4,3)"),
            "gap, too narrow");
}

bool all_arrived(const RecordingFile& run) {
  const std::vector<formation::RobotStep>& last = run.recording.steps.back().robots;
  return std::all_of(last.begin(), last.end(),
                     [](const formation::RobotStep& r) { return r.mode == formation::Mode::arrived; });
}

/// Where robots of a run that did not all arrive are proven to have no room to pass each other, proven again from the
/// scenario: rectangles, m, that cover the places of a robot of the first pair; empty where nothing is proven.
std::vector<Points> passing_area(const RecordingFile& run) {
  if (run.recording.steps.empty() || all_arrived(run)) return {};
  const std::vector<formation::NoPassing> proofs = formation::robots_without_passing(run.scenario);
  if (proofs.empty()) return {};
  const double side = proofs[0].side;
  std::vector<Vec2> corners = proofs[0].squares;
  std::sort(corners.begin(), corners.end(), [](Vec2 a, Vec2 b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  std::vector<Points> rectangles;  // squares side by side are one
  for (std::size_t from = 0, to = 0; from < corners.size(); from = to) {
    for (to = from + 1;
         to < corners.size() && corners[to].y == corners[from].y && corners[to].x == corners[to - 1].x + side;)
      ++to;
    const Vec2 low = corners[from], high{corners[to - 1].x + side, low.y + side};
    rectangles.push_back({low, {high.x, low.y}, high, {low.x, high.y}});
  }
  return rectangles;
}

/// Obstacles, moving ones at the time marks, and with details enclosures, routes and where there is no room to pass.
void add_scene(PanelLayers& to) {
  to.obstacles(to.run.scenario.obstacles, to.detailed ? 4 : 2.5, to.detailed);
  add_moving_obstacles(to);
  if (!to.detailed) return;
  add_enclosures(to);
  add_routes(to);
  to.rings("no room to pass: where robots can be that would have to", passing_area(to.run),
           fmt::format("with filledcurves closed fc rgb '{}' fs transparent solid 0.15 noborder", kSeparatorColour),
           "no room to pass");
}

std::string collision_style(bool detailed) {
  return fmt::format("with points pt 1 ps {} lw {} lc rgb '{}'", detailed ? 2.5 : 1.2, detailed ? 4 : 2,
                     kCollisionColour);
}

std::string hit_style(bool detailed) {
  return fmt::format("with points pt 8 ps {} lw {} lc rgb '{}'", detailed ? 2.5 : 1.2, detailed ? 2.5 : 1.5,
                     kHitColour);
}

constexpr const char* kHitKey = "hit, it stood";

/// With more robots than this, only the middle time and the last are written, and smaller.
constexpr int kFewRobots = 3;
/// With more robots than this, not even the last time is written over something else.
constexpr int kSomeRobots = 12;
/// For a polygon that stands for a circle.
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
    Points way, drawn;
    for (const Step& step : to_.run.recording.steps) way.push_back(step.leader_position);
    for (const std::size_t k : drawn_rows(way)) drawn.push_back(way[k]);
    to_.curves("virtual leader", {drawn}, line_style(1.5, "black", " dt (2,4)"), to_.key("virtual leader"));
  }

  /// Where there is room, after the robots' times; the first and the last have theirs in any case.
  void add_times_of_moving_obstacles() {
    std::vector<Label> times;
    for (const auto& obstacle : to_.run.scenario.moving_obstacles) {
      for (std::size_t k = 0; k < marks_.size(); ++k) {
        const bool is_end = k == 0 || k + 1 == marks_.size();
        const Vec2 p = middle_at(obstacle, marks_[k]->time);
        if (!to_.is_drawable(p)) continue;
        Vec2 half{};
        for (const Vec2 q : vertices_at(obstacle, marks_[k]->time))
          half = {std::max(half.x, std::fabs(q.x - p.x)), std::max(half.y, std::fabs(q.y - p.y))};
        if (const std::optional<Vec2> place = times_.place_at_side(p, half, is_end))
          times.push_back({*place, fmt::format("{:.3g} s", marks_[k]->time)});
      }
    }
    to_.labels("times of the moving obstacles", times,
               fmt::format("with labels center font ',8' textcolor rgb '{}'", kObstacleLine));
  }

  std::string names(const std::vector<std::size_t>& robots) const {
    return names_of(robots, [&](std::size_t i) { return to_.run.scenario.robots[i].id; });
  }

  /// Draws the ways of robots that look alike.
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
    to_.draw(index, line_style(to_.detailed ? 2.5 : 1.5, series_colour(first), series_dash(first)),
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

  /// The outlines of many robots, small as they are: gnuplot writes several kilobytes a circle into an SVG.
  void add_outlines(const std::vector<std::size_t>& alike) {
    std::vector<Points> rings;
    for (const std::size_t i : alike)
      for (const Step* step : places_of(i))
        rings.push_back(circle(step->robots[i].position, to_.run.scenario.robots[i].radius));
    to_.rings("outlines of " + names(alike), rings, clear_fill(series_colour(alike.front()), 0.25));
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
      to_.draw(index, fmt::format("with circles fc rgb '{0}' fs transparent solid 0.25 border lc rgb '{0}'", colour),
               "", ":3");
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
    const Points corners = footprint_at(drive, robot.position, e);
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
    for (const auto& obstacle : to_.run.scenario.moving_obstacles) {
      Points way;
      for (const Step* mark : marks_) {
        times_.keep_off(vertices_at(obstacle, mark->time), true);
        way.push_back(middle_at(obstacle, mark->time));
      }
      times_.keep_off(way, false);
    }
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

  /// Hits of robots that stood, which nothing promises against, have a mark of their own.
  void add_collisions() {
    Points collisions, hits;
    for (const formation::Collision& c : to_.run.collisions)
      if (to_.is_drawable(c.place)) (c.standing ? hits : collisions).push_back(c.place);
    to_.has_collisions = !collisions.empty();
    to_.has_hits = !hits.empty();
    to_.points("collisions: where they were deepest", collisions, collision_style(to_.detailed), to_.key("collision"));
    to_.points("hits of robots that stood: where they were deepest", hits, hit_style(to_.detailed), to_.key(kHitKey));
  }

  void add_goals() {
    bool any = false;
    for (const std::vector<std::size_t>& alike : drawn_together(to_.run.scenario.robots.size(), kColours)) {
      Points goals;
      for (const std::size_t i : alike)
        goals.insert(goals.end(), to_.run.scenario.robots[i].goals.begin(), to_.run.scenario.robots[i].goals.end());
      to_.points("goals of " + names(alike), goals,
                 fmt::format("with points pt 2 ps {} lw {} lc rgb '{}'", to_.detailed ? 1.3 : 0.8,
                             to_.detailed ? 2.5 : 1.5, series_colour(alike.front())));
      any = any || !goals.empty();
    }
    if (any && to_.detailed) to_.plot.item("keyentry with points pt 2 ps 1.3 lw 2.5 lc rgb '#222222'", "goal");
  }

  PanelLayers& to_;
  LabelPlaces times_;
  std::vector<const Step*> marks_;
};

// --- Figures ---

PanelLayers drawn(const RecordingFile& run, const Box& view, DataFile& data, bool detailed) {
  PanelLayers panel(run, view, data, detailed);
  add_scene(panel);
  RobotLayers(panel).add();
  return panel;
}

Box business_of_robots(const formation::Scenario& scenario) {
  Box box;
  for (const Robot& robot : scenario.robots) {
    box.add(Box{robot.position, robot.position}.grown(robot.radius));
    for (const Vec2 goal : robot.goals) box.add(Box{goal, goal}.grown(robot.radius));
  }
  if (scenario.formation) {
    for (const Vec2 p : scenario.formation->leader.path) box.add(p);
  }
  return box;
}

Box box_of_obstacles(const formation::Scenario& scenario) {
  Box box;
  for (const auto& obstacle : scenario.obstacles) {
    for (const Vec2 p : vertices_of(obstacle.shape)) box.add(p);
  }
  for (const auto& obstacle : scenario.moving_obstacles) {
    for (const Vec2 p : vertices_of(obstacle.shape)) box.add(p);
  }
  return box;
}

/// Characters in 10 points over a panel of 250 px and the gap beside it.
constexpr std::size_t kPanelTitle = 42;
/// What is so far beyond the business of the robots is cut off in a sheet, of its diagonal: a run that diverges must
/// not shrink all panels.
constexpr double kSheetRunaway = 0.25;

/// A box at least a third as wide as high and the other way round, so that no plot becomes a sliver.
Box without_slivers(Box box) {
  const double least = std::max({box.width(), box.height(), 1e-6}) / 3.0;
  const double missing_x = std::max(0.0, least - box.width()) / 2.0;
  const double missing_y = std::max(0.0, least - box.height()) / 2.0;
  return {{box.low.x - missing_x, box.low.y - missing_y}, {box.high.x + missing_x, box.high.y + missing_y}};
}

/// Room for the axes, the title and the legend round a plane drawn to scale.
Canvas canvas_for(const Box& view, std::size_t longest_key) {
  const double scale = scale_of(view);
  const double legend = 80.0 + 8.0 * static_cast<double>(longest_key);
  return {static_cast<int>(scale * view.width() + 80.0 + legend), static_cast<int>(scale * view.height() + 100.0)};
}

std::size_t longest_key(const RecordingFile& run) {
  std::size_t longest = run.scenario.formation ? 14 : 10;  // "virtual leader", "enclosures"
  if (run.info.guidance) longest = 15;                     // "gap, too narrow"
  if (!run.scenario.moving_obstacles.empty()) longest = std::max<std::size_t>(longest, 15);  // "moving obstacle"
  for (const Robot& robot : run.scenario.robots) longest = std::max(longest, robot.id.size());
  return std::min(longest, kLegendName);
}

}  // namespace

std::string run_title(const RecordingFile& run) {
  std::string title = shortened(run.info.scenario, kLegendName) + ", method " + run.info.method;
  if (run.info.guidance) title += ", along a " + *run.info.guidance;
  if (run.info.controller) title += ", " + *run.info.controller + " controller";
  return title;
}

Box view_of(const RecordingFile& run, double runaway) {
  const Box business = business_of_robots(run.scenario);
  const Box obstacles = box_of_obstacles(run.scenario);
  Box view = business;
  if (obstacles.diagonal() <= 4.0 * business.diagonal()) view.add(obstacles);
  const Box limit = view.grown(runaway * view.diagonal());
  for (const Step& step : run.recording.steps) {
    for (std::size_t i = 0; i < step.robots.size(); ++i) {
      const Vec2 p = step.robots[i].position;
      if (limit.contains(p)) view.add(Box{p, p}.grown(run.scenario.robots[i].radius));
    }
  }
  return without_slivers(view.grown(0.05 * view.diagonal()));
}

Figure paths_figure(const RecordingFile& run) {
  DataFile data;
  const Box view = view_of(run);
  const PanelLayers panel = drawn(run, view, data, true);
  // A title stands over the middle of the axes and may go as far to the left as they and their labels do.
  const std::string title = shortened(run_title(run), characters_in(scale_of(view) * view.width() + 100.0));
  const std::string body = panel.body(quoted(title));
  const std::string shows = "Paths of the robots of " + run_title(run) + "; circles are the robots to scale.";
  return {"paths", data.text(), shows, canvas_for(view, longest_key(run)), body};
}

namespace {

/// One width and one height for all panels, m: the same scale. Every panel keeps its own middle.
std::vector<Box> equal_views(const std::vector<PathsPanel>& panels) {
  std::vector<Box> views;
  double width = 0.0, height = 0.0;
  for (const PathsPanel& panel : panels) {
    views.push_back(view_of(*panel.run, kSheetRunaway));
    width = std::max(width, views.back().width());
    height = std::max(height, views.back().height());
  }
  for (Box& view : views) {
    const Vec2 middle = 0.5 * (view.low + view.high), half{0.5 * width, 0.5 * height};
    view = {middle - half, middle + half};
  }
  return views;
}

/// The name of the i-th robot: its own where it is the same in all runs that have one.
std::string name_in_all(const std::vector<PathsPanel>& panels, std::size_t i) {
  std::string name;
  for (const PathsPanel& panel : panels) {
    const auto& robots = panel.run->scenario.robots;
    if (i >= robots.size()) continue;
    if (!name.empty() && name != robots[i].id) return fmt::format("robot {}", i + 1);
    name = robots[i].id;
  }
  return name;
}

/// What any panel has, in the styles of PanelLayers without details.
std::vector<std::pair<std::string, std::string>> sheet_legend(const std::vector<PathsPanel>& panels, bool collisions,
                                                              bool hits) {
  std::size_t robots = 0;
  bool polygons = false, walls = false, moving = false, leader = false, goals = false;
  for (const PathsPanel& panel : panels) {
    const formation::Scenario& s = panel.run->scenario;
    robots = std::max(robots, s.robots.size());
    for (const auto& o : s.obstacles) (std::holds_alternative<geometry::Polygon>(o.shape) ? polygons : walls) = true;
    moving = moving || !s.moving_obstacles.empty();
    leader = leader || s.formation.has_value();
    for (const Robot& robot : s.robots) goals = goals || !robot.goals.empty();
  }
  std::vector<std::pair<std::string, std::string>> all;
  const auto add = [&](const std::string& what, const std::string& words) {
    all.emplace_back("keyentry with " + what, words);
  };
  if (polygons) add(fmt::format("boxes fs solid noborder fc rgb '{}'", kObstacleFill), "obstacle");
  if (walls) add(fmt::format("lines lw 2.5 lc rgb '{}'", kObstacleLine), "wall");
  if (moving) add(fmt::format("lines lw 1.5 dt (8,3) lc rgb '{}'", kObstacleLine), "moving obstacle");
  for (std::size_t i = 0; i < robots; ++i) {
    const std::string entry = robot_in_legend(i, robots, name_in_all(panels, i), kLegendName);
    if (!entry.empty()) add(fmt::format("lines lw 1.5{} lc rgb '{}'", series_dash(i), series_colour(i)), entry);
  }
  if (leader) add("lines lw 1.5 dt (2,4) lc rgb 'black'", "virtual leader");
  add("points pt 6 ps 1.3 lc rgb '#222222'", "start, end");
  if (goals) add("points pt 2 ps 0.8 lw 1.5 lc rgb '#222222'", "goal");
  if (collisions) all.emplace_back("keyentry " + collision_style(false), "collision");
  if (hits) all.emplace_back("keyentry " + hit_style(false), kHitKey);
  return all;
}

}  // namespace

Figure paths_sheet(const std::string& name, const std::string& title, const std::vector<PathsPanel>& panels,
                   int columns) {
  EXACTVO_REQUIRE(!panels.empty(), std::string("no panel"));
  const std::vector<Box> views = equal_views(panels);
  Sheet sheet;
  sheet.title = quoted(title);
  sheet.x_label = "'x [m]'";
  sheet.y_label = "'y [m]'";
  sheet.columns = columns;
  sheet.panel_width = columns > 2 ? 250.0 : 380.0;
  sheet.panel_height = sheet.panel_width * views.front().height() / views.front().width();
  DataFile data;
  bool collisions = false, hits = false;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const PanelLayers paths = drawn(*panels[i].run, views[i], data, false);
    collisions = collisions || paths.has_collisions;
    hits = hits || paths.has_hits;
    const std::string words = letter_of(i) + " " + panels[i].title + paths.origin.in_title();
    sheet.panels.push_back(paths.on_sheet(quoted(shortened(words, kPanelTitle))));
  }
  sheet.legend = sheet_legend(panels, collisions, hits);
  return sheet_figure(name, data.text(), title + ".", sheet);
}

}  // namespace exactvo::tools
