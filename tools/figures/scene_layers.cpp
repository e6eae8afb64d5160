// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/panel_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "exactvo/formation/passing.h"
#include "exactvo/formation/speed_profile.h"
#include "figures/outlines.h"
#include "figures/run_figures.h"
#include "support/routes_of_run.h"

namespace exactvo::tools {

using datasets::RecordingFile;
using formation::Step;

namespace {

std::vector<const geometry::Polygon*> polygons_of(const RecordingFile& run) {
  std::vector<const geometry::Polygon*> all;
  for (const auto& obstacle : run.scenario.obstacles)
    if (const auto* polygon = std::get_if<geometry::Polygon>(&obstacle.shape)) all.push_back(polygon);
  return all;
}

/// gnuplot cuts lines at the axes but lets fillings run over the labels: those are cut here. Holes stay free, for
/// what stands in them.
void add_polygons(PanelLayers& to) {
  bool in_view = false;
  const int inside = to.data.begin("obstacles with an inside, as far as in view", "x [m], y [m]");
  for (const geometry::Polygon* polygon : polygons_of(to.run)) {
    const Points seen = clipped_to(tied_together(*polygon), to.view);
    in_view |= !seen.empty();
    to.data.ring(seen);
  }
  const int border = to.data.begin("obstacles with an inside: outlines", "x [m], y [m]");
  for (const geometry::Polygon* polygon : polygons_of(to.run)) {
    to.data.ring(polygon->outer);
    for (const geometry::Ring& hole : polygon->holes) to.data.ring(hole);
  }
  if (!in_view) return;
  to.draw(inside, fmt::format("with filledcurves closed fc rgb '{}' fs solid noborder", kObstacleFill),
          to.key("obstacle"));
  to.draw(border, fmt::format("with lines lw 1 lc rgb '{}'", kObstacleLine));
}

void add_walls(PanelLayers& to) {
  const int index = to.data.begin("walls", "x [m], y [m]");
  for (const auto& obstacle : to.run.scenario.obstacles) {
    const auto* wall = std::get_if<geometry::Polyline>(&obstacle.shape);
    if (wall != nullptr) to.data.curve(wall->points);
  }
  to.draw(index, fmt::format("with lines lw {} lc rgb '{}'", to.detailed ? 4 : 2.5, kObstacleLine), to.key("wall"));
}

void add_obstacles(PanelLayers& to) {
  const std::size_t polygons = polygons_of(to.run).size();
  if (polygons > 0) add_polygons(to);
  if (polygons < to.run.scenario.obstacles.size()) add_walls(to);
}

/// Where they are at every time mark, and the way of their middle.
void add_moving_obstacles(PanelLayers& to) {
  if (to.run.scenario.moving_obstacles.empty()) return;
  const std::vector<const Step*> marks = time_marks(to.run);
  const int index = to.data.begin("moving obstacles at the time marks", "x [m], y [m]");
  for (const auto& obstacle : to.run.scenario.moving_obstacles)
    for (const Step* mark : marks) to.data.ring(vertices_at(obstacle, mark->time));
  const int ways = to.data.begin("paths of the moving obstacles", "x [m], y [m]");
  for (const auto& obstacle : to.run.scenario.moving_obstacles) {
    for (const Step* mark : marks) to.data.rows({middle_at(obstacle, mark->time)});
    to.data.gap();
  }
  to.draw(index, fmt::format("with lines lw 1.5 dt (8,3) lc rgb '{}'", kObstacleLine), to.key("moving obstacle"));
  to.draw(ways, fmt::format("with linespoints lw 1 pt 7 ps 0.5 dt (2,3) lc rgb '{}'", kObstacleLine));
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
    if (rings[s].empty()) continue;
    any = true;
    const int index = to.data.begin("enclosures seen by " + robots.names(to.run, s), "x [m], y [m]");
    for (const Points& ring : rings[s]) to.data.ring(ring);
    to.draw(index, fmt::format("with lines lw 1.2 dt (6,5) lc rgb '{}'", robots.colour(s)));
  }
  if (any) to.plot.item("keyentry with lines lw 1.2 dt (6,5) lc rgb '#222222'", "enclosures");
}

/// Solid along obstacles, dashed across gaps.
void add_chains(PanelLayers& to, const std::vector<formation::PlannedRoute>& routes) {
  for (const bool across : {false, true}) {
    bool any = false;
    for (const formation::PlannedRoute& route : routes)
      for (const geometry::ChainPoint& p : route.chain) any |= p.gap_follows == across;
    if (!any) continue;
    const int index = to.data.begin(across ? "gaps that are too narrow" : "closed chains", "x [m], y [m]");
    for (const formation::PlannedRoute& route : routes)
      for (std::size_t k = 0; k < route.chain.size(); ++k)
        if (route.chain[k].gap_follows == across)
          to.data.curve({route.chain[k].point.rounded, route.chain[(k + 1) % route.chain.size()].point.rounded});
    to.draw(
        index,
        fmt::format("with lines lw {}{} lc rgb '{}'", across ? 2.5 : 3.5, across ? " dt (4,3)" : "", kSeparatorColour),
        across ? "gap, too narrow" : "closed chain");
  }
}

/// Wide and pale, under the paths; and what separates goals out of reach.
void add_routes(PanelLayers& to) {
  const std::vector<formation::PlannedRoute> routes =
      routes_of(to.run).value_or(std::vector<formation::PlannedRoute>{});
  const ByColour robots(to.run);
  std::vector<std::vector<const Points*>> ways(robots.sets.size());
  for (const formation::PlannedRoute& route : routes)
    if (!route.points.empty()) ways[robots.set_of[route.robot]].push_back(&route.points);
  bool any = false;
  for (std::size_t s = 0; s < ways.size(); ++s) {
    if (ways[s].empty()) continue;
    any = true;
    const int index = to.data.begin("routes of " + robots.names(to.run, s), "x [m], y [m]");
    for (const Points* way : ways[s]) to.data.curve(*way);
    const std::string pale = std::string("#c0") + (robots.colour(s) + 1);
    to.draw(index, fmt::format("with lines lw 7 lc rgb '{}'", pale));
  }
  if (any) to.plot.item("keyentry with lines lw 7 lc rgb '#c0222222'", "route");
  add_chains(to, routes);
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

void add_passing_area(PanelLayers& to) {
  const std::vector<Points> area = passing_area(to.run);
  if (area.empty()) return;
  const int index = to.data.begin("no room to pass: where robots can be that would have to", "x [m], y [m]");
  for (const Points& rectangle : area) to.data.ring(rectangle);
  to.draw(index,
          fmt::format("with filledcurves closed fc rgb '{}' fs transparent solid 0.15 noborder", kSeparatorColour),
          "no room to pass");
}

constexpr std::size_t kTimeMarks = 6;
/// m: what is so far beyond the view leaves the picture anyway; larger numbers would only upset gnuplot.
constexpr double kFarAway = 1e6;

}  // namespace

void add_scene(PanelLayers& to) {
  add_obstacles(to);
  add_moving_obstacles(to);
  if (!to.detailed) return;
  add_enclosures(to);
  add_routes(to);
  add_passing_area(to);
}

PanelLayers::PanelLayers(const RecordingFile& shown, const Box& box, DataFile& file, bool with_details)
    : run(shown), data(file), detailed(with_details), view(box), origin(box) {
  origin.prepare(data);
}

bool PanelLayers::is_drawable(Vec2 p) const {
  return is_finite(p) && view.grown(kFarAway).contains(p);
}

double scale_of(const Box& view) {
  return std::min(760.0 / view.width(), 620.0 / view.height());
}

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

void add_ellipses(const RecordingFile& run, const formation::GoalBodies& of_goal, std::vector<Points>& rings) {
  for (const std::size_t body : of_goal.bodies) {
    const geometry::ConvexShape& shape = run.recording.bodies[body].shape;
    if (std::holds_alternative<geometry::Ellipse>(shape)) rings.push_back(outline(shape));
  }
}

}  // namespace exactvo::tools
