// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/obstacles/map_layers.h"

#include <fmt/format.h>

#include <algorithm>

#include "figures/local_origin.h"
#include "figures/template.h"

namespace exactvo::tools {

namespace {

using geometry::Polygon;
using geometry::Polyline;

struct Outlines {
  std::vector<Points> solids, rings, walls;

  void add(const geometry::Obstacle& obstacle) {
    if (const auto* line = std::get_if<Polyline>(&obstacle)) return walls.push_back(line->points);
    const auto& polygon = std::get<Polygon>(obstacle);
    solids.push_back(tied_together(polygon));
    rings.push_back(polygon.outer);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
};

std::string solid_fill() {
  return fmt::format("with filledcurves closed fs solid noborder fc rgb '{}'", kObstacleFill);
}

}  // namespace

std::string line_style(double width, const std::string& colour, const std::string& dash) {
  return fmt::format("with lines lw {} lc rgb '{}'{}", width, colour, dash);
}

void MapLayers::curves(const std::string& title, const std::vector<Points>& curves, const std::string& style,
                       bool closed, bool in_key) {
  if (curves.empty()) return;
  layers_.push_back({title, curves, {}, style, closed, in_key});
  for (const Points& curve : curves)
    for (const Vec2 p : curve) view_.add(p);
}

void MapLayers::labels(const std::string& title, const std::vector<Label>& labels, const std::string& style) {
  if (labels.empty()) return;
  layers_.push_back({title, {}, labels, style, false, false});
  for (const Label& label : labels) view_.add(label.place);
}

Figure MapLayers::figure(const std::string& title) const {
  const Box shown = axes();
  const LocalOrigin origin(shown);
  DataFile data;
  origin.prepare(data);
  PlotCommand plot;
  for (const Layer& layer : layers_)
    plot.data(write(layer, data), origin.using_columns(1, 2, layer.labels.empty() ? "" : ":3") + " " + layer.style,
              layer.in_key ? layer.title : "");
  const double scale = std::min(700.0 / shown.width(), 620.0 / shown.height());  // px a metre
  const Canvas canvas{static_cast<int>(scale * shown.width()) + 300, static_cast<int>(scale * shown.height()) + 100};
  const std::string body = filled("map", {{"title", quoted(shortened(title, characters_in(canvas.width - 200.0)))},
                                          {"ranges", origin.ranges(shown)},
                                          {"x_label", markup(origin.x_label())},
                                          {"y_label", markup(origin.y_label())},
                                          {"plot", plot.text()}});
  return {"map", data.text(), title + ".", canvas, body};
}

Box MapLayers::axes() const {
  const double half = 0.53 * std::max({view_.width(), view_.height(), 1e-6});
  const Vec2 middle = 0.5 * (view_.low + view_.high);
  const bool is_wide = view_.width() > view_.height();
  const double half_x = is_wide ? half : std::max(0.53 * view_.width(), 0.3 * half);
  const double half_y = is_wide ? std::max(0.53 * view_.height(), 0.3 * half) : half;
  return {{middle.x - half_x, middle.y - half_y}, {middle.x + half_x, middle.y + half_y}};
}

int MapLayers::write(const Layer& layer, DataFile& data) {
  const int index = data.begin(layer.title, layer.labels.empty() ? "x, y [m]" : "x, y [m], label");
  for (const Points& curve : layer.curves) layer.closed ? data.ring(curve) : data.curve(curve);
  for (const Label& label : layer.labels) data.labelled_row({label.place.x, label.place.y}, label.text);
  return index;
}

void add_obstacles(const std::vector<geometry::Obstacle>& obstacles, bool with_edges, MapLayers& map) {
  Outlines outlines;
  for (const geometry::Obstacle& obstacle : obstacles) outlines.add(obstacle);
  map.curves("obstacle", outlines.solids, solid_fill(), true);
  if (with_edges) map.curves("edges", outlines.rings, line_style(1, kObstacleLine), true, false);
  map.curves("wall", outlines.walls, line_style(2.5, kObstacleLine), false);
}

}  // namespace exactvo::tools
