// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/plane.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

namespace exactvo::tools {

namespace {

/// gnuplot writes six digits a tick, and from 10^6 on with an exponent.
constexpr double kReadable = 1e5;
/// Two digits of the six go where neighbouring ticks are a fifth of the view apart; one is kept to spare.
constexpr double kMostViews = 100.0;
/// Strokes of a hatching over the width of the view.
constexpr int kHatchesAcross = 45;
/// And over a line, however short.
constexpr int kLeastHatches = 3;

bool are_empty(const std::vector<Points>& all) {
  return std::all_of(all.begin(), all.end(), [](const Points& points) { return points.empty(); });
}

}  // namespace

std::string axis_ranges(const Box& view) {
  return fmt::format("set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]", view.low.x, view.high.x, view.low.y,
                     view.high.y);
}

std::string line_style(double width, const std::string& colour, const std::string& dash) {
  return fmt::format("with lines lw {}{} lc rgb '{}'", width, dash, colour);
}

std::string solid_fill(const std::string& colour) {
  return fmt::format("with filledcurves closed fc rgb '{}' fs solid noborder", colour);
}

std::string clear_fill(const std::string& colour, double opacity) {
  return fmt::format("with filledcurves closed fs transparent solid {0} border lc rgb '{1}' fc rgb '{1}'", opacity,
                     colour);
}

Points footprint_at(const formation::DifferentialDrive& drive, Vec2 at, Vec2 heading) {
  const Vec2 axle = at - drive.reference * heading, left{-heading.y, heading.x};
  Points corners;
  for (const Vec2 c : drive.footprint) corners.push_back(axle + c.x * heading + c.y * left);
  return corners;
}

double round_size(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * power >= least) return digit * power;
  return 10.0 * power;
}

Box square_round(const Box& box, double share) {
  constexpr double kLeast = 1e-9;  // a range that gnuplot can still put tics on
  const double half = share * std::max({box.width(), box.height(), kLeast});
  const Vec2 middle = 0.5 * (box.low + box.high);
  return {middle - Vec2{half, half}, middle + Vec2{half, half}};
}

LocalOrigin::LocalOrigin(const Box& view) {
  const double extent = std::max(view.width(), view.height());
  if (view.is_empty() || !(extent > 0.0) || !std::isfinite(extent)) return;
  x_ = round_number_near(view.low.x, view.high.x, extent);
  y_ = round_number_near(view.low.y, view.high.y, extent);
}

/// A multiple of the power of ten above the view, so that the subtraction can be done in one's head.
LocalOrigin::Coordinate LocalOrigin::round_number_near(double low, double high, double extent) {
  const double farthest = std::max(std::abs(low), std::abs(high));
  const bool is_near = farthest <= 2.0 * extent || (farthest < kReadable && farthest <= kMostViews * extent);
  if (is_near) return {0.0, "0"};
  const int exponent = static_cast<int>(std::ceil(std::log10(extent)));
  const std::string text =
      fmt::format("{:.{}f}", std::round(0.5 * (low + high) / std::pow(10.0, exponent)) * std::pow(10.0, exponent),
                  std::max(0, -exponent));
  return {std::stod(text), text};
}

std::string LocalOrigin::using_columns(int x, int y, const std::string& more) const {
  return is_far() ? fmt::format("using (${} - x0):(${} - y0){}", x, y, more) : fmt::format("using {}:{}{}", x, y, more);
}

std::string LocalOrigin::ranges(const Box& view) const {
  const std::string settings = is_far() ? fmt::format("x0 = {:#}\ny0 = {:#}\n", x_.first, y_.first) : "";
  return settings + axis_ranges({view.low - place(), view.high - place()});
}

std::string LocalOrigin::in_title() const {
  return is_far() ? fmt::format(" - ({}, {})", x_.second, y_.second) : "";
}

std::string LocalOrigin::label(const char* axis, const Coordinate& c) {
  if (c.first == 0.0) return fmt::format("{} [m]", axis);
  return c.first < 0.0 ? fmt::format("{} + {} [m]", axis, c.second.substr(1))
                       : fmt::format("{} - {} [m]", axis, c.second);
}

void ChainLines::add(const std::vector<geometry::ChainPoint>& chain) {
  for (std::size_t k = 0; k < chain.size(); ++k)
    (chain[k].gap_follows ? across : along)
        .push_back({chain[k].point.rounded, chain[(k + 1) % chain.size()].point.rounded});
}

void Panel::curves(const std::string& title, const std::vector<Points>& curves, const std::string& style,
                   const std::string& key) {
  if (are_empty(curves)) return;
  const int index = data.begin(title, columns_);
  for (const Points& curve : curves) data.curve(curve);
  draw(index, style, key);
}

void Panel::rings(const std::string& title, const std::vector<Points>& rings, const std::string& style,
                  const std::string& key) {
  if (are_empty(rings)) return;
  const int index = data.begin(title, columns_);
  for (const Points& ring : rings) data.ring(ring);
  draw(index, style, key);
}

void Panel::points(const std::string& title, const Points& points, const std::string& style, const std::string& key) {
  curves(title, {points}, style, key);
}

void Panel::labels(const std::string& title, const std::vector<Label>& labels, const std::string& style) {
  if (labels.empty()) return;
  const int index = data.begin(title, std::string(columns_) + ", label");
  for (const Label& label : labels) data.labelled_row({label.place.x, label.place.y}, label.text);
  draw(index, style, "", ":3");
}

void Panel::arrow(const std::string& title, Vec2 from, Vec2 by, const std::string& style, const std::string& key) {
  const int index = data.begin(title, std::string(columns_) + " of the tail, then of the arrow");
  data.row({from.x, from.y, by.x, by.y});
  draw(index, "with vectors " + style, key, ":3:4");
}

void Panel::obstacles(const std::vector<formation::SceneObstacle>& obstacles, double wall_width, bool has_key) {
  std::vector<Points> inside, outlines, walls;
  for (const formation::SceneObstacle& obstacle : obstacles) {
    if (const auto* wall = std::get_if<geometry::Polyline>(&obstacle.shape)) {
      walls.push_back(wall->points);
      continue;
    }
    const auto& polygon = std::get<geometry::Polygon>(obstacle.shape);
    inside.push_back(clipped_to(tied_together(polygon), view));
    outlines.push_back(polygon.outer);
    outlines.insert(outlines.end(), polygon.holes.begin(), polygon.holes.end());
  }
  if (!are_empty(inside)) {
    rings("obstacles with an inside, as far as in view", inside, solid_fill(kObstacleFill), has_key ? "obstacle" : "");
    rings("obstacles with an inside: outlines", outlines, line_style(1, kObstacleLine));
  }
  curves("walls", walls, line_style(wall_width, kObstacleLine), has_key ? "wall" : "");
}

void Panel::half_planes(const std::string& title, const std::vector<geometry::HalfPlane>& all, const std::string& style,
                        const std::string& hatching, const std::string& key,
                        const std::vector<geometry::HalfPlane>& others) {
  std::vector<Points> lines, strokes;
  for (const geometry::HalfPlane& h : all) {
    const Points line = stretch_within(others, boundary_within(view, h));
    if (line.empty()) continue;
    lines.push_back(line);
    const double gap = std::min(view.width() / kHatchesAcross, norm(line[1] - line[0]) / kLeastHatches);
    for (const Points& stroke : tools::hatching(line, h.normal, gap)) strokes.push_back(stroke);
  }
  curves(title + ": boundaries", lines, style, key);
  curves(title + ": hatching on the forbidden side", strokes, hatching);
}

std::string Panel::body(const std::string& quoted_title) const {
  return filled("paths", {{"title", quoted_title},
                          {"ranges", origin.ranges(view)},
                          {"x_label", markup(origin.x_label())},
                          {"y_label", markup(origin.y_label())},
                          {"plot", plot.text()}});
}

SheetPanel Panel::on_sheet(const std::string& title) const {
  return {title, "set clip two\n" + origin.ranges(view), plot.text()};
}

std::string velocity_plane(const std::string& title, const Box& view, const std::string& plot) {
  return filled("velocity_plane", {{"title", title}, {"ranges", axis_ranges(view)}, {"plot", plot}});
}

void MapLayers::curves(const std::string& title, const std::vector<Points>& curves, const std::string& style,
                       bool closed, bool in_key) {
  layers_.emplace_back([=](Panel& panel) {
    closed ? panel.rings(title, curves, style, in_key ? title : "")
           : panel.curves(title, curves, style, in_key ? title : "");
  });
  for (const Points& curve : curves)
    for (const Vec2 p : curve) view_.add(p);
}

void MapLayers::labels(const std::string& title, const std::vector<Label>& labels, const std::string& style) {
  layers_.emplace_back([=](Panel& panel) { panel.labels(title, labels, style); });
  for (const Label& label : labels) view_.add(label.place);
}

void MapLayers::obstacles(const std::vector<formation::SceneObstacle>& obstacles) {
  layers_.emplace_back([=](Panel& panel) { panel.obstacles(obstacles, 2.5, true); });
  for (const formation::SceneObstacle& obstacle : obstacles)
    for (const Vec2 p : vertices_of(obstacle.shape)) view_.add(p);
}

Figure MapLayers::figure(const std::string& title) const {
  const Box shown = axes();
  DataFile data;
  Panel panel(shown, data);
  for (const auto& draw : layers_) draw(panel);
  const double scale = std::min(700.0 / shown.width(), 620.0 / shown.height());  // px a metre
  const Canvas canvas{static_cast<int>(scale * shown.width()) + 300, static_cast<int>(scale * shown.height()) + 100};
  return {"map", data.text(), title + ".", canvas,
          panel.body(quoted(shortened(title, characters_in(canvas.width - 200.0))))};
}

/// At least three tenths as wide as high, and the other way round.
Box MapLayers::axes() const {
  const double least = 0.3 * std::max({view_.width(), view_.height(), 1e-6});
  const Vec2 half = 0.53 * Vec2{std::max(view_.width(), least), std::max(view_.height(), least)};
  const Vec2 middle = 0.5 * (view_.low + view_.high);
  return {middle - half, middle + half};
}

}  // namespace exactvo::tools
