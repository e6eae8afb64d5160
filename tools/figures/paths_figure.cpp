// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/paths_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "exactvo/formation/metrics.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/geometry/require.h"
#include "figures/label_places.h"
#include "figures/local_origin.h"
#include "figures/outlines.h"
#include "figures/passing_area.h"
#include "figures/sheet.h"
#include "figures/template.h"
#include "support/routes_of_run.h"

namespace exactvo::tools {

using datasets::RecordingFile;
using formation::Robot;
using formation::Step;

namespace {

constexpr int kTimeMarks = 6;
/// With more robots than this, only the middle time and the last are written, and smaller.
constexpr int kFewRobots = 3;
/// With more robots than this, not even the last time is written over something else.
constexpr int kSomeRobots = 12;
/// Characters of a name in a legend or before a title.
constexpr std::size_t kNameLength = 32;
/// m/s: slower than this nobody sees a robot move.
constexpr double kVisibleSpeed = 0.01;
/// m: what is so far beyond the view leaves the picture anyway; larger numbers would only upset gnuplot.
constexpr double kFarAway = 1e6;

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

std::vector<const Step*> time_marks(const RecordingFile& run) {
  std::vector<const Step*> marks;
  const double end = end_of_motion(run);
  for (const Step& step : run.recording.steps) {
    const double due = end * static_cast<double>(marks.size()) / (kTimeMarks - 1);
    if (static_cast<int>(marks.size()) < kTimeMarks && step.time >= due) marks.push_back(&step);
  }
  return marks;
}

/// px a metre of the plane in the SVG.
double scale_of(const Box& view) {
  return std::min(760.0 / view.width(), 620.0 / view.height());
}

/// The layers of one panel: data sets and the plot items that draw them.
class PathsPanel {
 public:
  PathsPanel(const RecordingFile& run, const Box& view, DataFile& data, bool detailed)
      : run_(run), data_(data), detailed_(detailed), view_(view), origin_(view_), times_(view_, scale_of(view_)) {
    origin_.prepare(data_);
    if (detailed_) note_lines();
    add_obstacles();
    add_moving_obstacles();
    if (detailed_) add_enclosures();
    if (detailed_) add_routes();
    if (detailed_) add_passing_area();
    add_leader();
    for (std::size_t i = 0; i < run.scenario.robots.size(); ++i) add_way(i);
    if (detailed_) add_times_of_moving_obstacles();
    add_goals();
    add_collisions();
  }
  std::string plot() const { return plot_.text(); }
  const LocalOrigin& origin() const { return origin_; }
  bool has_collisions() const { return has_collisions_; }

 private:
  std::string key(const std::string& text) const { return detailed_ ? text : ""; }
  bool is_drawable(Vec2 p) const { return is_finite(p) && view_.grown(kFarAway).contains(p); }
  int robot_count() const { return static_cast<int>(run_.scenario.robots.size()); }

  void add_ring(const Points& ring) {
    if (ring.empty()) return;
    for (const Vec2 p : ring) data_.row({p.x, p.y});
    data_.row({ring.front().x, ring.front().y});
    data_.gap();
  }

  void add_obstacles() {
    bool polygons = false;
    bool walls = false;
    for (const auto& obstacle : run_.scenario.obstacles) {
      const auto* polygon = std::get_if<geometry::Polygon>(&obstacle.shape);
      polygons |= polygon != nullptr;
      walls |= polygon == nullptr;
    }
    if (polygons) add_polygons();
    if (walls) add_walls();
  }

  std::vector<const geometry::Polygon*> polygons() const {
    std::vector<const geometry::Polygon*> all;
    for (const auto& obstacle : run_.scenario.obstacles)
      if (const auto* polygon = std::get_if<geometry::Polygon>(&obstacle.shape)) all.push_back(polygon);
    return all;
  }

  /// gnuplot cuts lines at the axes but lets fillings run over the labels: those are cut here. Holes stay free, for
  /// what stands in them.
  void add_polygons() {
    bool in_view = false;
    const int inside = data_.begin("obstacles with an inside, as far as in view", "x [m], y [m]");
    for (const geometry::Polygon* polygon : polygons()) {
      const Points seen = clipped_to(tied_together(*polygon), view_);
      in_view |= !seen.empty();
      add_ring(seen);
    }
    const int border = data_.begin("obstacles with an inside: outlines", "x [m], y [m]");
    for (const geometry::Polygon* polygon : polygons()) {
      add_ring(polygon->outer);
      for (const geometry::Ring& hole : polygon->holes) add_ring(hole);
    }
    if (!in_view) return;
    plot_.data(inside,
               fmt::format("{} with filledcurves closed fc rgb '{}' fs solid noborder", origin_.using_columns(),
                           kObstacleFill),
               key("obstacle"));
    plot_.data(border, fmt::format("{} with lines lw 1 lc rgb '{}'", origin_.using_columns(), kObstacleLine));
  }

  void add_walls() {
    const int index = data_.begin("walls", "x [m], y [m]");
    for (const auto& obstacle : run_.scenario.obstacles) {
      const auto* wall = std::get_if<geometry::Polyline>(&obstacle.shape);
      if (wall == nullptr) continue;
      for (const Vec2 p : wall->points) data_.row({p.x, p.y});
      data_.gap();
    }
    plot_.data(
        index,
        fmt::format("{} with lines lw {} lc rgb '{}'", origin_.using_columns(), detailed_ ? 4 : 2.5, kObstacleLine),
        key("wall"));
  }

  static Points vertices_at(const formation::MovingObstacle& obstacle, double time) {
    Points points = vertices_of(obstacle.shape);
    for (Vec2& p : points) p += displacement_at(obstacle, time);
    return points;
  }

  static Vec2 middle_at(const formation::MovingObstacle& obstacle, double time) {
    const Points points = vertices_at(obstacle, time);
    Vec2 middle{};
    for (const Vec2 p : points) middle += p / static_cast<double>(points.size());
    return middle;
  }

  /// Where they are at every time mark, and the way of their middle.
  void add_moving_obstacles() {
    if (run_.scenario.moving_obstacles.empty()) return;
    const std::vector<const Step*> marks = time_marks(run_);
    const int index = data_.begin("moving obstacles at the time marks", "x [m], y [m]");
    for (const auto& obstacle : run_.scenario.moving_obstacles)
      for (const Step* mark : marks) add_ring(vertices_at(obstacle, mark->time));
    const int ways = data_.begin("paths of the moving obstacles", "x [m], y [m]");
    for (const auto& obstacle : run_.scenario.moving_obstacles) {
      for (const Step* mark : marks) {
        const Vec2 p = middle_at(obstacle, mark->time);
        data_.row({p.x, p.y});
      }
      data_.gap();
    }
    plot_.data(index, fmt::format("{} with lines lw 1.5 dt (8,3) lc rgb '{}'", origin_.using_columns(), kObstacleLine),
               key("moving obstacle"));
    plot_.data(ways, fmt::format("{} with linespoints lw 1 pt 7 ps 0.5 dt (2,3) lc rgb '{}'", origin_.using_columns(),
                                 kObstacleLine));
  }

  /// Where there is room, after the robots' times; the first and the last have theirs in any case.
  void add_times_of_moving_obstacles() {
    if (run_.scenario.moving_obstacles.empty()) return;
    const std::vector<const Step*> marks = time_marks(run_);
    const int index = data_.begin("times of the moving obstacles", "x [m], y [m], t");
    for (const auto& obstacle : run_.scenario.moving_obstacles) {
      for (std::size_t k = 0; k < marks.size(); ++k) {
        const bool is_end = k == 0 || k + 1 == marks.size();
        const Vec2 p = middle_at(obstacle, marks[k]->time);
        if (!is_drawable(p)) continue;
        double half_width = 0.0;
        for (const Vec2 q : vertices_at(obstacle, marks[k]->time))
          half_width = std::max(half_width, std::fabs(q.x - p.x));
        if (const std::optional<Vec2> place = times_.place_at_side(p, half_width, is_end))
          data_.labelled_row({place->x, place->y}, fmt::format("{:.3g} s", marks[k]->time));
      }
    }
    plot_.data(index, origin_.using_columns(1, 2, ":3") +
                          fmt::format(" with labels center font ',8' textcolor rgb '{}'", kObstacleLine));
  }

  /// Ellipses only: a facade that stands for itself would be drawn over the obstacle.
  void add_enclosures() {
    bool any = false;
    for (std::size_t i = 0; i < run_.scenario.robots.size(); ++i) any |= add_enclosures_of(i);
    if (any) plot_.item("keyentry with lines lw 1.2 dt (6,5) lc rgb '#222222'", "enclosures");
  }

  void add_ellipses(const formation::Outlook& outlook, std::vector<Points>& rings) const {
    for (const std::size_t body : outlook.bodies) {
      const geometry::ConvexShape& shape = run_.recording.bodies[body].shape;
      if (std::holds_alternative<geometry::Ellipse>(shape)) rings.push_back(outline(shape));
    }
  }

  bool add_enclosures_of(std::size_t i) {
    std::vector<Points> rings;
    for (const formation::Outlook& outlook : run_.recording.outlooks)
      if (outlook.robot == i) add_ellipses(outlook, rings);
    if (rings.empty()) return false;
    const int index = data_.begin("enclosures seen by " + run_.scenario.robots[i].id, "x [m], y [m]");
    for (const Points& ring : rings) add_ring(ring);
    plot_.data(index,
               fmt::format("{} with lines lw 1.2 dt (6,5) lc rgb '{}'", origin_.using_columns(), series_colour(i)));
    return true;
  }

  /// Wide and pale, under the paths; and what separates goals out of reach.
  void add_routes() {
    const std::vector<formation::PlannedRoute> routes =
        routes_of(run_).value_or(std::vector<formation::PlannedRoute>{});
    bool any = false;
    for (std::size_t i = 0; i < run_.scenario.robots.size(); ++i) any |= add_routes_of(i, routes);
    if (any) plot_.item("keyentry with lines lw 7 lc rgb '#c0222222'", "route");
    add_chains(routes);
  }

  bool add_routes_of(std::size_t i, const std::vector<formation::PlannedRoute>& routes) {
    bool any = false;
    for (const formation::PlannedRoute& route : routes) any |= route.robot == i && !route.points.empty();
    if (!any) return false;
    const int index = data_.begin("routes of " + run_.scenario.robots[i].id, "x [m], y [m]");
    for (const formation::PlannedRoute& route : routes) {
      if (route.robot != i) continue;
      for (const Vec2 p : route.points) data_.row({p.x, p.y});
      data_.gap();
    }
    const std::string pale = std::string("#c0") + (series_colour(i) + 1);
    plot_.data(index, fmt::format("{} with lines lw 7 lc rgb '{}'", origin_.using_columns(), pale));
    return true;
  }

  /// Solid along obstacles, dashed across gaps.
  void add_chains(const std::vector<formation::PlannedRoute>& routes) {
    for (const bool across : {false, true}) {
      bool any = false;
      for (const formation::PlannedRoute& route : routes)
        for (const geometry::ChainPoint& p : route.chain) any |= p.gap_follows == across;
      if (!any) continue;
      const int index = data_.begin(across ? "gaps that are too narrow" : "closed chains", "x [m], y [m]");
      for (const formation::PlannedRoute& route : routes)
        for (std::size_t k = 0; k < route.chain.size(); ++k) {
          if (route.chain[k].gap_follows != across) continue;
          for (const std::size_t end : {k, (k + 1) % route.chain.size()})
            data_.row({route.chain[end].point.rounded.x, route.chain[end].point.rounded.y});
          data_.gap();
        }
      plot_.data(index,
                 fmt::format("{} with lines lw {}{} lc rgb '{}'", origin_.using_columns(), across ? 2.5 : 3.5,
                             across ? " dt (4,3)" : "", kSeparatorColour),
                 across ? "gap, too narrow" : "closed chain");
    }
  }

  void add_passing_area() {
    const std::vector<Points> area = passing_area(run_);
    if (area.empty()) return;
    const int index = data_.begin("no room to pass: where robots can be that would have to", "x [m], y [m]");
    for (const Points& rectangle : area) add_ring(rectangle);
    plot_.data(index,
               fmt::format("{} with filledcurves closed fc rgb '{}' fs transparent solid 0.15 noborder",
                           origin_.using_columns(), kSeparatorColour),
               "no room to pass");
  }

  void add_leader() {
    if (!run_.scenario.formation) return;
    const int index = data_.begin("virtual leader", "x [m], y [m]");
    for (const Step& step : run_.recording.steps) data_.row({step.leader_position.x, step.leader_position.y});
    plot_.data(index, origin_.using_columns() + " with lines lw 1.5 dt (2,4) lc rgb 'black'", key("virtual leader"));
  }

  void add_way(std::size_t i) {
    const Robot& robot = run_.scenario.robots[i];
    const int way = data_.begin("path of " + robot.id, "x [m], y [m], t [s]");
    for (const Step& step : run_.recording.steps) {
      const Vec2 p = step.robots[i].position;
      if (!is_drawable(p)) break;
      data_.row({p.x, p.y, step.time});
    }
    plot_.data(way,
               fmt::format("{} with lines lw {}{} lc rgb '{}'", origin_.using_columns(), detailed_ ? 2.5 : 1.5,
                           series_dash(i), series_colour(i)),
               key(shortened(robot.id, kNameLength)));
    add_places(i);
  }

  /// The robot to scale: at every time mark that it has moved to (without details at its start only) and at its end.
  void add_places(std::size_t i) {
    const Robot& robot = run_.scenario.robots[i];
    const int index = data_.begin("places of " + robot.id, "x [m], y [m], radius [m], where t is written [m], [m], t");
    const std::vector<const Step*> places = places_of(i);
    // The last one first: its label is always there, and the others give way.
    for (std::size_t k = places.size(); k-- > 0;) {
      const Vec2 p = places[k]->robots[i].position;
      const Label time = label(p, robot.radius, places[k]->time, k, places.size());
      data_.labelled_row({p.x, p.y, robot.radius, time.place.x, time.place.y}, time.text);
    }
    plot_.data(index, origin_.using_columns(1, 2, ":3") +
                          fmt::format(" with circles fc rgb '{0}' fs transparent solid 0.25 border lc rgb '{0}'",
                                      series_colour(i)));
    if (!detailed_) return;
    plot_.data(index,
               origin_.using_columns(4, 5, ":6") + fmt::format(" with labels center font ',{}' textcolor rgb '{}'",
                                                               robot_count() <= kFewRobots ? 10 : 8, series_colour(i)));
  }

  /// The row at which the robot came to rest, or the last one that can be drawn.
  const Step* last_place(std::size_t i) const {
    const double end = end_of_motion(run_, i);
    const Step* last = nullptr;
    for (const Step& step : run_.recording.steps) {
      if (!is_drawable(step.robots[i].position)) break;
      last = &step;
      if (step.time > end || end == 0.0) break;
    }
    return last;
  }

  std::vector<const Step*> places_of(std::size_t i) const {
    std::vector<const Step*> places;
    std::vector<const Step*> marks = time_marks(run_);
    const Step* last = last_place(i);
    if (last == nullptr) return {};
    if (!detailed_ && marks.size() > 1) marks.resize(1);
    const double apart = run_.scenario.robots[i].radius;
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
    for (const auto& obstacle : run_.scenario.obstacles)
      for (const geometry::Segment& edge : edges_of(obstacle.shape)) times_.keep_off({edge.a, edge.b}, false);
    std::vector<Points> rings;
    for (const formation::Outlook& outlook : run_.recording.outlooks)
      if (outlook.goal == 0) add_ellipses(outlook, rings);
    for (const Points& ring : rings) times_.keep_off(ring, true);
    for (std::size_t i = 0; i < run_.scenario.robots.size(); ++i) {
      Points way;
      for (const Step& step : run_.recording.steps)
        if (is_drawable(step.robots[i].position)) way.push_back(step.robots[i].position);
      times_.keep_off(way, false);
      for (const Vec2 goal : run_.scenario.robots[i].goals) times_.keep_off({goal}, false);
    }
    if (run_.scenario.formation) {
      Points way;
      for (const Step& step : run_.recording.steps)
        if (is_drawable(step.leader_position)) way.push_back(step.leader_position);
      times_.keep_off(way, false);
    }
    for (const auto& obstacle : run_.scenario.moving_obstacles)
      for (const Step* mark : time_marks(run_)) times_.keep_off(vertices_at(obstacle, mark->time), true);
  }

  struct Label {
    Vec2 place;
    std::string text;
  };
  /// The time; nothing where it would lie on something, unless it is the robot's last.
  Label label(Vec2 p, double radius, double time, std::size_t k, std::size_t count) {
    const bool last = k + 1 == count;
    const bool middle = k == count / 2;
    if (!detailed_ || (robot_count() > kFewRobots && !last && !middle)) return {p, ""};
    const std::optional<Vec2> place = times_.place_beside(p, radius, last && robot_count() <= kSomeRobots);
    if (!place) return {p, ""};
    return {*place, fmt::format("{:.3g} s", time)};
  }

  void add_collisions() {
    Points marks;
    for (const formation::Collision& c : run_.collisions)
      if (is_drawable(c.place)) marks.push_back(c.place);
    has_collisions_ = !marks.empty();
    if (marks.empty()) return;
    const int index = data_.begin("collisions: where they were deepest", "x [m], y [m]");
    for (const Vec2 p : marks) data_.row({p.x, p.y});
    plot_.data(index,
               fmt::format("{} with points pt 1 ps {} lw {} lc rgb '{}'", origin_.using_columns(),
                           detailed_ ? 2.5 : 1.2, detailed_ ? 4 : 2, kCollisionColour),
               key("collision"));
  }

  void add_goals() {
    bool any = false;
    for (std::size_t i = 0; i < run_.scenario.robots.size(); ++i) {
      const Robot& robot = run_.scenario.robots[i];
      if (robot.goals.empty()) continue;
      const int index = data_.begin("goals of " + robot.id, "x [m], y [m]");
      for (const Vec2 goal : robot.goals) data_.row({goal.x, goal.y});
      plot_.data(index, fmt::format("{} with points pt 2 ps {} lw {} lc rgb '{}'", origin_.using_columns(),
                                    detailed_ ? 1.3 : 0.8, detailed_ ? 2.5 : 1.5, series_colour(i)));
      any = true;
    }
    if (any && detailed_) plot_.item("keyentry with points pt 2 ps 1.3 lw 2.5 lc rgb '#222222'", "goal");
  }

  const RecordingFile& run_;
  DataFile& data_;
  bool detailed_;
  Box view_;
  LocalOrigin origin_;
  PlotCommand plot_;
  LabelPlaces times_;
  bool has_collisions_ = false;
};

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

/// A title stands over the middle of the axes and may go as far to the left as they and their labels do.
std::string fitted_title(const RecordingFile& run, const Box& view) {
  return shortened(run_title(run), characters_in(scale_of(view) * view.width() + 100.0));
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
  return std::min(longest, kNameLength);
}

}  // namespace

double end_of_motion(const RecordingFile& run, std::size_t robot) {
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

std::string run_title(const RecordingFile& run) {
  std::string title = shortened(run.info.scenario, kNameLength) + ", method " + run.info.method;
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
  const PathsPanel panel(run, view, data, true);
  const std::string body = filled("paths", {{"title", quoted(fitted_title(run, view))},
                                            {"ranges", panel.origin().ranges(view)},
                                            {"x_label", markup(panel.origin().x_label())},
                                            {"y_label", markup(panel.origin().y_label())},
                                            {"plot", panel.plot()}});
  const std::string shows = "Paths of the robots of " + run_title(run) + "; circles are the robots to scale.";
  return {"paths", data.text(), shows, canvas_for(view, longest_key(run)), body};
}

namespace {

/// One width and one height for all panels, m: the same scale. Every panel keeps its own middle.
std::vector<Box> equal_views(const std::vector<Panel>& panels) {
  std::vector<Box> views;
  double width = 0.0, height = 0.0;
  for (const Panel& panel : panels) {
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

/// The name of the i-th robot in the legend: its own where it is the same in all runs that have one.
std::string robot_in_legend(const std::vector<Panel>& panels, std::size_t i) {
  std::string name;
  for (const Panel& panel : panels) {
    const auto& robots = panel.run->scenario.robots;
    if (i >= robots.size()) continue;
    if (!name.empty() && name != robots[i].id) return fmt::format("robot {}", i + 1);
    name = robots[i].id;
  }
  return shortened(name, kNameLength);
}

/// What any panel has, in the styles of PathsPanel without details.
std::vector<std::pair<std::string, std::string>> sheet_legend(const std::vector<Panel>& panels, bool collisions) {
  std::size_t robots = 0;
  bool polygons = false, walls = false, moving = false, leader = false, goals = false;
  for (const Panel& panel : panels) {
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
  for (std::size_t i = 0; i < robots; ++i)
    add(fmt::format("lines lw 1.5{} lc rgb '{}'", series_dash(i), series_colour(i)), robot_in_legend(panels, i));
  if (leader) add("lines lw 1.5 dt (2,4) lc rgb 'black'", "virtual leader");
  add("points pt 6 ps 1.3 lc rgb '#222222'", "start, end");
  if (goals) add("points pt 2 ps 0.8 lw 1.5 lc rgb '#222222'", "goal");
  if (collisions) add(fmt::format("points pt 1 ps 1.2 lw 2 lc rgb '{}'", kCollisionColour), "collision");
  return all;
}

}  // namespace

Figure paths_sheet(const std::string& name, const std::string& title, const std::vector<Panel>& panels, int columns) {
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
  bool collisions = false;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const PathsPanel paths(*panels[i].run, views[i], data, false);
    collisions = collisions || paths.has_collisions();
    const std::string words = letter_of(i) + " " + panels[i].title + paths.origin().in_title();
    sheet.panels.push_back({quoted(shortened(words, kPanelTitle)), paths.origin().ranges(views[i]), paths.plot()});
  }
  sheet.legend = sheet_legend(panels, collisions);
  return sheet_figure(name, data.text(), title + ".", sheet);
}

}  // namespace exactvo::tools
