// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/obstacles/map_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "exactvo/geometry/require.h"
#include "figures/figure.h"
#include "figures/local_origin.h"

namespace exactvo::tools {

namespace {

// --- Maps ---

using geometry::ObstacleShapes;

/// Neighbouring pieces in different colours, as far as taking turns does that.
void draw_pieces(const std::vector<ObstacleShapes>& obstacles, MapLayers& map) {
  constexpr std::size_t kColours = 4;
  std::vector<std::vector<Points>> by_colour(kColours);
  for (const ObstacleShapes& shapes : obstacles) {
    std::size_t turn = 0;
    for (const geometry::ConvexShape& piece : shapes.pieces)
      if (const Points ring = outline(piece); ring.size() > 2) by_colour[turn++ % kColours].push_back(ring);
  }
  bool in_key = true;
  for (std::size_t k = 0; k < kColours; ++k) {
    map.curves("convex pieces", by_colour[k],
               fmt::format("with filledcurves closed fs transparent solid 0.22 border lc rgb '#8a919c' fc rgb '{}'",
                           series_colour(k + 1)),
               true, in_key);
    in_key = in_key && by_colour[k].empty();
  }
}

// --- Repairs ---

using geometry::Polygon;
using geometry::Ring;
using geometry::Vec2;

/// A square.
Box view_of(const RepairedPolygon& polygon) {
  Box box;
  for (const Ring& ring : polygon.before) {
    for (const Vec2 p : ring) box.add(p);
  }
  const double pad = 0.04;
  const double half = 0.5 * std::max(box.width(), box.height()) + std::max(pad * box.diagonal(), 1e-9);
  const Vec2 middle = 0.5 * (box.low + box.high);
  return {{middle.x - half, middle.y - half}, {middle.x + half, middle.y + half}};
}

constexpr double kSideOfPlot = 340.0;  // px of what the axes enclose
constexpr double kGapOfPlots = 60.0;   // px
/// "-1.2e+06", eight characters of 6 px, and a gap of two.
constexpr double kWidthOfTic = 60.0;  // px

/// The least of 1, 2, 5, 10, ... metres that is as wide as a label.
double distance_of_tics(const Box& view) {
  const double least = kWidthOfTic / kSideOfPlot * std::max(view.width(), view.height());
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * power >= least) return digit * power;
  return 10.0 * power;
}

constexpr const char* kProblemMark = "with points pt 6 ps 1.6 lw 2.5 lc rgb '#e00000'";

class Panels {
 public:
  void row(const RepairedPolygon& polygon) {
    LocalOrigin(view_of(polygon)).prepare(data_);
    before(polygon);
    after(polygon);
  }
  Figure figure() && {
    sheet_.title = "'Polygons before and after their repair'";
    sheet_.x_label = "'x [m]'";
    sheet_.y_label = "'y [m]'";
    sheet_.columns = 2;
    sheet_.panel_width = sheet_.panel_height = kSideOfPlot;
    sheet_.gap = kGapOfPlots;
    sheet_.legend = {
        {"keyentry with lines lw 2 lc rgb '#3f444d'", "outline"},
        {std::string("keyentry ") + kProblemMark, "problem"},
        {fmt::format("keyentry with boxes fs transparent solid 0.45 noborder fc rgb '{}'", series_colour(0)),
         "polygon, a colour each"}};
    return sheet_figure("repair", data_.text(), "Polygons before and after a repair.", sheet_);
  }

 private:
  void before(const RepairedPolygon& polygon) {
    const LocalOrigin origin(view_of(polygon));
    PlotCommand plot;
    plot.data(rings("before: " + polygon.title, polygon.before),
              origin.using_columns() + " with lines lw 2 lc rgb '#3f444d'");
    const int marks = data_.begin("problems", "x, y [m]");
    data_.rows(polygon.problems);
    plot.data(marks, origin.using_columns() + " " + kProblemMark);
    panel("before: " + polygon.title, view_of(polygon), plot);
  }

  /// Each polygon with its own holes: what lies in a hole of another keeps its colour.
  void after(const RepairedPolygon& polygon) {
    const LocalOrigin origin(view_of(polygon));
    PlotCommand plot;
    std::vector<Ring> all;
    for (std::size_t k = 0; k < polygon.after.size(); ++k) {
      const Polygon& part = polygon.after[k];
      const std::string fill =
          fmt::format(" with filledcurves closed fs transparent solid 0.45 noborder fc rgb '{}'", series_colour(k));
      plot.data(rings("polygon, its holes tied to it", {tied_together(part)}), origin.using_columns() + fill);
      all.push_back(part.outer);
      all.insert(all.end(), part.holes.begin(), part.holes.end());
    }
    plot.data(rings("rings after", all), origin.using_columns() + " with lines lw 1.5 lc rgb '#3f444d'");
    const std::size_t n = polygon.after.size();
    panel(n == 0 ? std::string("after: cannot be repaired") : fmt::format("after: {} polygon{}", n, n == 1 ? "" : "s"),
          view_of(polygon), plot);
  }

  int rings(const std::string& title, const std::vector<Ring>& rings) {
    const int index = data_.begin(title, "x, y [m]");
    for (const Ring& ring : rings) data_.ring(ring);
    return index;
  }

  void panel(const std::string& title, const Box& view, const PlotCommand& plot) {
    const LocalOrigin origin(view);
    const std::string from = origin.in_title();
    const std::size_t room = characters_in(1.3 * (kSideOfPlot + 0.5 * kGapOfPlots));
    const std::string words = letter_of(sheet_.panels.size()) + " " + title;
    sheet_.panels.push_back({quoted(shortened(words, room - std::min(from.size(), room / 2)) + from),
                             origin.ranges(view) + fmt::format("\nset xtics {:.9g}", distance_of_tics(view)),
                             plot.text()});
  }

  DataFile data_;
  Sheet sheet_;
};

}  // namespace

std::string solid_fill(const std::string& colour) {
  return fmt::format("with filledcurves closed fs solid noborder fc rgb '{}'", colour);
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
  std::vector<Points> solids, rings, walls;
  for (const geometry::Obstacle& obstacle : obstacles) {
    if (const auto* line = std::get_if<geometry::Polyline>(&obstacle)) {
      walls.push_back(line->points);
      continue;
    }
    const auto& polygon = std::get<Polygon>(obstacle);
    solids.push_back(tied_together(polygon));
    rings.push_back(polygon.outer);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  map.curves("obstacle", solids, solid_fill(kObstacleFill), true);
  if (with_edges) map.curves("edges", rings, line_style(1, kObstacleLine), true, false);
  map.curves("wall", walls, line_style(2.5, kObstacleLine), false);
}

Figure map_figure(const std::vector<formation::SceneObstacle>& obstacles, const std::string& title) {
  MapLayers map;
  std::vector<geometry::Obstacle> all;
  for (const formation::SceneObstacle& o : obstacles) all.push_back(o.shape);
  add_obstacles(all, true, map);
  return map.figure(title);
}

Figure shapes_figure(const std::vector<ObstacleShapes>& obstacles, const std::string& title) {
  MapLayers map;
  std::vector<geometry::Obstacle> all;
  for (const ObstacleShapes& shapes : obstacles) all.push_back(shapes.obstacle);
  constexpr std::size_t kMostDrawnBold = 40;
  const bool crowded = obstacles.size() > kMostDrawnBold;
  add_obstacles(all, false, map);
  draw_pieces(obstacles, map);
  std::vector<Points> of_facades, hulls, smallest, trap_free, facades;
  for (const ObstacleShapes& s : obstacles) {
    for (const geometry::FacadeEnclosure& e : s.facade_ellipses) of_facades.push_back(outline(e.ellipse));
    hulls.push_back(s.hull.vertices);
    smallest.push_back(outline(s.smallest_ellipse));
    if (s.trap_free.ellipse) trap_free.push_back(outline(*s.trap_free.ellipse));
    for (const geometry::Segment& f : s.facades.facades) facades.push_back({f.a, f.b});
  }
  map.curves("facade ellipses", of_facades, line_style(crowded ? 0.4 : 0.8, "#56B4E9"), true);
  map.curves("hulls", hulls, line_style(1.6, "#009E73", " dt (8,5)"), true);
  map.curves("smallest ellipses", smallest, line_style(1.8, "#0072B2"), true);
  map.curves("trap-free ellipses", trap_free, line_style(1.8, "#CC79A7", " dt (3,3)"), true);
  map.curves("facades", facades,
             crowded ? line_style(1.0, "#D55E00") : "with linespoints lw 2.2 pt 7 ps 0.35 lc rgb '#D55E00'", false);
  return map.figure(title);
}

Figure repair_figure(const std::vector<RepairedPolygon>& polygons) {
  EXACTVO_REQUIRE(!polygons.empty(), std::string("no polygon"));
  Panels panels;
  for (const RepairedPolygon& polygon : polygons) panels.row(polygon);
  return std::move(panels).figure();
}

}  // namespace exactvo::tools
