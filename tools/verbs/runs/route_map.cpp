// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/runs/route_map.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "figures/label_places.h"
#include "figures/outlines.h"
#include "figures/style.h"
#include "verbs/obstacles/map_layers.h"

namespace exactvo::tools {
namespace {

constexpr const char* kRobotColour = "#009E73";

void add_chain(const std::vector<geometry::ChainPoint>& chain, MapLayers& map) {
  std::vector<Points> along, across;
  std::pair<double, Vec2> widest{0.0, {}};
  for (std::size_t k = 0; k < chain.size(); ++k) {
    const Vec2 from = chain[k].point.rounded, to = chain[(k + 1) % chain.size()].point.rounded;
    (chain[k].gap_follows ? across : along).push_back({from, to});
    if (chain[k].gap_follows && norm(to - from) > widest.first) widest = {norm(to - from), 0.5 * (from + to)};
  }
  map.curves("closed chain", along, line_style(3.0, kSeparatorColour), false);
  map.curves("gap, too narrow", across, line_style(3.0, kSeparatorColour, " dt (4,3)"), false);
  if (across.empty()) return;
  map.labels("the widest gap", {{widest.second, fmt::format("{:.3g} m", widest.first)}},
             fmt::format("with labels left offset 0.6,0.6 font ',11' tc rgb '{}'", kSeparatorColour));
}

/// In tenths of a millimetre: the rounding error of a 0 is no number to read.
std::string printed(Vec2 v) {
  const auto rounded = [](double x) { return std::nearbyint(1e4 * x) / 1e4 + 0.0; };
  return fmt::format("({}, {})", rounded(v.x), rounded(v.y));
}

}  // namespace

Figure route_map_figure(const Decision& decision, const formation::RouteAhead& ahead) {
  std::vector<geometry::Obstacle> shapes;
  for (const formation::SceneObstacle& o : decision.scenario.obstacles) shapes.push_back(o.shape);
  const formation::Robot& robot = decision.who();
  const Vec2 here = decision.step.position;
  MapLayers map;
  add_obstacles(shapes, true, map);
  add_chain(ahead.route.chain, map);
  if (!ahead.route.points.empty())
    map.curves("route from here", {ahead.route.points}, line_style(2.2, kRouteColour), false);
  map.curves(robot.id, {outline(geometry::Disc{here, robot.radius})}, line_style(2.0, kRobotColour), true);
  if (ahead.heads_for) {
    map.curves("heads for", {{here, *ahead.heads_for}}, line_style(1.2, kRobotColour, " dt (4,3)"), false);
    map.curves("", {{*ahead.heads_for}}, fmt::format("with points pt 6 ps 1.2 lw 2 lc rgb '{}'", kRobotColour), false,
               false);
  }
  map.curves("goal", {{robot.goals[ahead.route.goal]}},
             fmt::format("with points pt 2 ps 1.3 lw 2.5 lc rgb '{}'", kGoalColour), false);
  return map.figure(fmt::format("{} of {} at t = {:.2f} s", robot.id, decision.scenario.name, decision.time));
}

std::string route_words(const Decision& decision, const formation::RouteAhead& ahead) {
  if (ahead.route.points.empty()) return "Route: none, out of reach: " + ahead.route.why_not + ".\n";
  std::string text = fmt::format("Route: {:.4g} m to {}", ahead.length, printed(ahead.route.points.back()));
  if (!ahead.route.why_not.empty()) text += ", as near to the goal as it can get";
  if (ahead.heads_for)
    text += fmt::format("; it heads for {}, {:.3g} m away, the farthest point of it in sight",
                        printed(*ahead.heads_for), norm(*ahead.heads_for - decision.step.position));
  return text + " (planned from here; a run keeps the route that it has).\n";
}

}  // namespace exactvo::tools
