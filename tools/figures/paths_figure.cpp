// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/run_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "exactvo/geometry/require.h"
#include "figures/figure.h"
#include "figures/panel_layers.h"

namespace exactvo::tools {

using datasets::RecordingFile;
using formation::Robot;
using formation::Step;

namespace {

/// m/s: slower than this nobody sees a robot move.
constexpr double kVisibleSpeed = 0.01;

PanelLayers drawn(const RecordingFile& run, const Box& view, DataFile& data, bool detailed) {
  PanelLayers panel(run, view, data, detailed);
  add_scene(panel);
  add_robots(panel);
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
  return std::min(longest, kLegendName);
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
  const std::string body = filled("paths", {{"title", quoted(fitted_title(run, view))},
                                            {"ranges", panel.origin.ranges(view)},
                                            {"x_label", markup(panel.origin.x_label())},
                                            {"y_label", markup(panel.origin.y_label())},
                                            {"plot", panel.plot.text()}});
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

/// The name of the i-th robot: its own where it is the same in all runs that have one.
std::string name_in_all(const std::vector<Panel>& panels, std::size_t i) {
  std::string name;
  for (const Panel& panel : panels) {
    const auto& robots = panel.run->scenario.robots;
    if (i >= robots.size()) continue;
    if (!name.empty() && name != robots[i].id) return fmt::format("robot {}", i + 1);
    name = robots[i].id;
  }
  return name;
}

/// What any panel has, in the styles of PanelLayers without details.
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
  for (std::size_t i = 0; i < robots; ++i) {
    const std::string entry = robot_in_legend(i, robots, name_in_all(panels, i), kLegendName);
    if (!entry.empty()) add(fmt::format("lines lw 1.5{} lc rgb '{}'", series_dash(i), series_colour(i)), entry);
  }
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
    const PanelLayers paths = drawn(*panels[i].run, views[i], data, false);
    collisions = collisions || paths.has_collisions;
    const std::string words = letter_of(i) + " " + panels[i].title + paths.origin.in_title();
    sheet.panels.push_back({quoted(shortened(words, kPanelTitle)), paths.origin.ranges(views[i]), paths.plot.text()});
  }
  sheet.legend = sheet_legend(panels, collisions);
  return sheet_figure(name, data.text(), title + ".", sheet);
}

}  // namespace exactvo::tools
