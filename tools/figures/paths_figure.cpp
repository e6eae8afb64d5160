// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/paths_figure.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

#include "figures/outlines.h"

namespace exactvo::tools {

using datasets::RecordingFile;
using formation::Robot;
using formation::Step;

namespace {

constexpr int kTimeMarks = 6;
/// m/s: slower than this nobody sees a robot move.
constexpr double kVisibleSpeed = 0.01;
/// m: a step that long leaves the picture anyway; larger numbers would only upset gnuplot.
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
  return box;
}

bool is_drawable(Vec2 p) {
  return is_finite(p) && std::abs(p.x) < kFarAway && std::abs(p.y) < kFarAway;
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

/// The layers of one panel: data sets and the plot items that draw them.
class PathsPanel {
 public:
  PathsPanel(const RecordingFile& run, DataFile& data, bool detailed) : run_(run), data_(data), detailed_(detailed) {
    add_obstacles();
    if (detailed_) add_enclosures();
    add_leader();
    for (std::size_t i = 0; i < run.scenario.robots.size(); ++i) add_way(i);
    add_goals();
  }
  std::string plot() const { return plot_.text(); }

 private:
  std::string key(const std::string& text) const { return detailed_ ? text : ""; }
  int robot_count() const { return static_cast<int>(run_.scenario.robots.size()); }

  void add_ring(const Points& ring) {
    for (const Vec2 p : ring) data_.row({p.x, p.y});
    data_.row({ring.front().x, ring.front().y});
    data_.gap();
  }

  void add_obstacles() {
    bool polygons = false;
    bool holes = false;
    bool walls = false;
    for (const auto& obstacle : run_.scenario.obstacles) {
      const auto* polygon = std::get_if<geometry::Polygon>(&obstacle.shape);
      polygons |= polygon != nullptr;
      holes |= polygon != nullptr && !polygon->holes.empty();
      walls |= polygon == nullptr;
    }
    if (polygons) add_polygons();
    if (holes) add_holes();
    if (walls) add_walls(!polygons);
  }

  void add_polygons() {
    const int index = data_.begin("obstacles with an inside", "x [m], y [m]");
    for (const auto& obstacle : run_.scenario.obstacles) {
      if (const auto* polygon = std::get_if<geometry::Polygon>(&obstacle.shape)) add_ring(polygon->outer);
    }
    plot_.data(index,
               fmt::format("using 1:2 with filledcurves closed fc rgb '{}' fs solid border lc rgb '{}'", kObstacleFill,
                           kObstacleLine),
               key("obstacle"));
  }

  void add_holes() {
    const int index = data_.begin("holes in them", "x [m], y [m]");
    for (const auto& obstacle : run_.scenario.obstacles) {
      const auto* polygon = std::get_if<geometry::Polygon>(&obstacle.shape);
      if (polygon == nullptr) continue;
      for (const geometry::Ring& hole : polygon->holes) add_ring(hole);
    }
    plot_.data(index, fmt::format("using 1:2 with filledcurves closed fc rgb 'white' fs solid border lc rgb '{}'",
                                  kObstacleLine));
  }

  void add_walls(bool in_legend) {
    const int index = data_.begin("walls", "x [m], y [m]");
    for (const auto& obstacle : run_.scenario.obstacles) {
      const auto* wall = std::get_if<geometry::Polyline>(&obstacle.shape);
      if (wall == nullptr) continue;
      for (const Vec2 p : wall->points) data_.row({p.x, p.y});
      data_.gap();
    }
    plot_.data(index, fmt::format("using 1:2 with lines lw {} lc rgb '{}'", detailed_ ? 4 : 2.5, kObstacleLine),
               key(in_legend ? "obstacle" : "wall"));
  }

  /// Ellipses only: a facade that stands for itself would be drawn over the obstacle.
  void add_enclosures() {
    bool any = false;
    for (std::size_t i = 0; i < run_.enclosures.size(); ++i) any |= add_enclosures_of(i);
    if (any) plot_.item("keyentry with lines lw 1.2 dt (6,5) lc rgb '#222222'", "enclosures");
  }

  bool add_enclosures_of(std::size_t i) {
    std::vector<Points> rings;
    for (const auto& shape : run_.enclosures[i]) {
      if (std::holds_alternative<geometry::Ellipse>(shape)) rings.push_back(outline(shape));
    }
    if (rings.empty()) return false;
    const int index = data_.begin("enclosures seen by " + run_.scenario.robots[i].id, "x [m], y [m]");
    for (const Points& ring : rings) add_ring(ring);
    plot_.data(index, fmt::format("using 1:2 with lines lw 1.2 dt (6,5) lc rgb '{}'", series_colour(i)));
    return true;
  }

  void add_leader() {
    if (!run_.scenario.formation) return;
    const int index = data_.begin("virtual leader", "x [m], y [m]");
    for (const Step& step : run_.recording.steps) data_.row({step.leader_position.x, step.leader_position.y});
    plot_.data(index, "using 1:2 with lines lw 1.5 dt (2,4) lc rgb 'black'", key("virtual leader"));
  }

  void add_way(std::size_t i) {
    const Robot& robot = run_.scenario.robots[i];
    const int way = data_.begin("way of " + robot.id, "x [m], y [m], t [s]");
    for (const Step& step : run_.recording.steps) {
      const Vec2 p = step.robots[i].position;
      if (!is_drawable(p)) break;
      data_.row({p.x, p.y, step.time});
    }
    plot_.data(way, fmt::format("using 1:2 with lines lw {} lc rgb '{}'", detailed_ ? 2.5 : 1.5, series_colour(i)),
               key(robot.id));
    add_places(i);
  }

  /// The robot to scale: at every time mark that it has moved to, else (without details) at its start and its end.
  void add_places(std::size_t i) {
    const Robot& robot = run_.scenario.robots[i];
    const int index = data_.begin("places of " + robot.id, "x [m], y [m], radius [m], t");
    for (const Step* step : places_of(i)) {
      const Vec2 p = step->robots[i].position;
      data_.labelled_row({p.x, p.y, robot.radius}, label(p, step->time));
    }
    plot_.data(index, fmt::format("using 1:2:3 with circles fc rgb '{0}' fs transparent solid 0.25 border lc rgb '{0}'",
                                  series_colour(i)));
    if (detailed_ && robot_count() <= 3) {
      plot_.data(index, "using 1:($2+$3):4 with labels font ',10' textcolor rgb '#222222' offset 0,0.6");
    }
  }

  std::vector<const Step*> places_of(std::size_t i) const {
    std::vector<const Step*> places;
    std::vector<const Step*> marks = time_marks(run_);
    if (!detailed_ && marks.size() > 2) marks = {marks.front(), marks.back()};
    for (const Step* step : marks) {
      const Vec2 p = step->robots[i].position;
      const bool moved = places.empty() || norm(p - places.back()->robots[i].position) > run_.scenario.robots[i].radius;
      if (is_drawable(p) && moved) places.push_back(step);
    }
    return places;
  }

  /// The time, or nothing where another one would be written over.
  std::string label(Vec2 p, double time) {
    const Box view = view_of(run_);
    for (const Vec2 other : labels_) {
      const bool beside = std::abs(p.x - other.x) < 0.055 * view.width();
      if (beside && std::abs(p.y - other.y) < 0.03 * view.height()) return "";
    }
    labels_.push_back(p);
    return fmt::format("{:.3g} s", time);
  }

  void add_goals() {
    bool any = false;
    for (std::size_t i = 0; i < run_.scenario.robots.size(); ++i) {
      const Robot& robot = run_.scenario.robots[i];
      if (robot.goals.empty()) continue;
      const int index = data_.begin("goals of " + robot.id, "x [m], y [m]");
      for (const Vec2 goal : robot.goals) data_.row({goal.x, goal.y});
      plot_.data(index, fmt::format("using 1:2 with points pt 2 ps {} lw 2.5 lc rgb '{}'", detailed_ ? 1.3 : 0.7,
                                    series_colour(i)));
      any = true;
    }
    if (any && detailed_) plot_.item("keyentry with points pt 2 ps 1.3 lw 2.5 lc rgb '#222222'", "goal");
  }

  const RecordingFile& run_;
  DataFile& data_;
  bool detailed_;
  PlotCommand plot_;
  std::vector<Vec2> labels_;  ///< where times are written, m
};

/// A box at least a third as wide as high and the other way round, so that no plot becomes a sliver.
Box without_slivers(Box box) {
  const double least = std::max({box.width(), box.height(), 1e-6}) / 3.0;
  const double missing_x = std::max(0.0, least - box.width()) / 2.0;
  const double missing_y = std::max(0.0, least - box.height()) / 2.0;
  return {{box.low.x - missing_x, box.low.y - missing_y}, {box.high.x + missing_x, box.high.y + missing_y}};
}

std::string ranges(const Box& view) {
  return fmt::format("  set xrange [{:.6g}:{:.6g}]\n  set yrange [{:.6g}:{:.6g}]\n", view.low.x, view.high.x,
                     view.low.y, view.high.y);
}

/// Room for the axes, the title and the legend round a plane drawn to scale.
Canvas canvas_for(const Box& view, std::size_t longest_key) {
  const double scale = std::min(760.0 / view.width(), 620.0 / view.height());  // px a metre
  const double legend = 80.0 + 8.0 * static_cast<double>(longest_key);
  return {static_cast<int>(scale * view.width() + 80.0 + legend), static_cast<int>(scale * view.height() + 100.0)};
}

std::size_t longest_key(const RecordingFile& run) {
  std::size_t longest = run.scenario.formation ? 14 : 10;  // "virtual leader", "enclosures"
  for (const Robot& robot : run.scenario.robots) longest = std::max(longest, robot.id.size());
  return longest;
}

}  // namespace

double end_of_motion(const RecordingFile& run) {
  const auto& steps = run.recording.steps;
  for (std::size_t k = steps.size(); k-- > 0;) {
    for (const auto& robot : steps[k].robots) {
      if (norm(robot.velocity) > kVisibleSpeed) return steps[k].time;
    }
  }
  return 0.0;
}

std::string run_title(const RecordingFile& run) {
  std::string title = run.info.scenario + ", " + run.info.method;
  if (run.info.controller) title += ", " + *run.info.controller + " controller";
  return title;
}

Box view_of(const RecordingFile& run) {
  const Box business = business_of_robots(run.scenario);
  const Box obstacles = box_of_obstacles(run.scenario);
  Box view = business;
  if (obstacles.diagonal() <= 4.0 * business.diagonal()) view.add(obstacles);
  const Box limit = view.grown(1.5 * view.diagonal());
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
  const PathsPanel panel(run, data, true);
  const Box view = view_of(run);
  const std::string body = fmt::format(
      "  set title {}\n"
      "  set size ratio -1\n"
      "{}"
      "  set xlabel 'x [m]'\n"
      "  set ylabel 'y [m]'\n"
      "  set grid lc rgb '#dcdcdc'\n"
      "  set key outside right top reverse Left\n"
      "{}",
      quoted(run_title(run)), ranges(view), panel.plot());
  const std::string shows = "Ways of the robots of " + run_title(run) + "; circles are the robots to scale.";
  return {"paths", data.text(), script_text("paths", shows, canvas_for(view, longest_key(run)), body)};
}

Figure paths_sheet(const std::string& name, const std::string& title, const std::vector<Panel>& panels, int columns) {
  DataFile data;
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  std::string body =
      fmt::format("  set multiplot layout {},{} title {}\n", rows, columns, quoted(title + " (axes in metres)"));
  body +=
      "  set size ratio -1\n  unset key\n  set tics font ',8'\n  set xtics offset 0,0.3\n"
      "  set lmargin 5\n  set rmargin 1\n  set tmargin 2.5\n  set bmargin 1.5\n";
  double tallest = 0.0;
  for (const Panel& panel : panels) {
    const PathsPanel paths(*panel.run, data, false);
    const Box view = view_of(*panel.run);
    tallest = std::max(tallest, view.height() / view.width());
    body += "  set title " + quoted(panel.title) + " font ',9' offset 0,-0.6\n" + ranges(view) + paths.plot();
  }
  body += "  unset multiplot\n";
  const int panel_width = 300;
  const int panel_height = static_cast<int>(250.0 * std::min(tallest, 1.2)) + 55;
  return {name, data.text(), script_text(name, title + ".", {panel_width * columns, panel_height * rows + 40}, body)};
}

}  // namespace exactvo::tools
