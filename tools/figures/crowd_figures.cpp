// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/crowd_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "exactvo/geometry/counted.h"
#include "figures/outlines.h"

namespace exactvo::tools {
namespace {

constexpr double kLongestSide = 760.0;  // px, of the plane
constexpr std::size_t kNameLength = 40;
/// Arrows along the longer side of the map.
constexpr std::size_t kMostArrows = 28;
/// Of the strongest flow: where less passes, there is no arrow.
constexpr double kLeastArrow = 0.03;
constexpr double kLeastRange = 1e-9;  // of values: gnuplot draws no empty range

using Value = std::function<double(const CellCourse&)>;

double area(const CrowdCourse& course) {
  return course.grid.cell * course.grid.cell;
}

std::string title_of(const CrowdCourse& course, const std::string& what) {
  return fmt::format("{}, {}, {:.4g} s: {}", shortened(course.name, kNameLength),
                     geometry::counted(course.robots, "robot"), course.duration, what);
}

/// What is drawn of the plane: all cells, and a rim.
Box plane_of(const CrowdCourse& course) {
  const CellGrid& g = course.grid;
  const Vec2 high = g.low + g.cell * Vec2{static_cast<double>(g.columns), static_cast<double>(g.rows)};
  return Box{g.low, high}.grown(0.02 * norm(high - g.low));
}

Canvas canvas_for(const Box& plane) {
  const double scale = kLongestSide / std::max(plane.width(), plane.height());
  const auto side = [&](double length, double least) { return static_cast<int>(std::max(scale * length, least)); };
  return {side(plane.width(), 300.0) + 180, side(plane.height(), 160.0) + 110};
}

std::string ranges(const Box& plane) {
  return fmt::format("set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]", plane.low.x, plane.high.x, plane.low.y,
                     plane.high.y);
}

/// Obstacles, and bodies where they stood at the start.
void add_obstacles(const CrowdCourse& course, const Box& plane, DataFile& data, PlotCommand& plot) {
  if (!course.edges.empty()) {
    const int index = data.begin("edges of obstacles", "x [m], y [m]");
    for (const geometry::Segment& edge : course.edges) data.curve(segment_within(plane, edge.a, edge.b));
    plot.data(index, fmt::format("using 1:2 with lines lw 1 lc rgb '{}'", kObstacleLine));
  }
  if (course.bodies.empty()) return;
  const int index = data.begin("bodies at the start", "x [m], y [m]");
  for (const geometry::ConvexShape& body : course.bodies) data.ring(outline(body));
  plot.data(index, fmt::format("using 1:2 with lines lw 1 dt (4,3) lc rgb '{}'", kObstacleLine));
}

/// Cells where nobody was stay white.
void add_cells(const CrowdCourse& course, const Value& value, DataFile& data, PlotCommand& plot) {
  const int index = data.begin("cells", "x [m], y [m] of the middle, value; NaN: nobody was there");
  for (std::size_t k = 0; k < course.cells.size(); ++k) {
    const Vec2 at = course.grid.centre(k);
    const bool is_empty = !(course.cells[k].time > 0.0);
    data.row({at.x, at.y, is_empty ? std::numeric_limits<double>::quiet_NaN() : value(course.cells[k])});
    if ((k + 1) % course.grid.columns == 0) data.gap();
  }
  plot.data(index, "using 1:2:3 with image");
}

double largest(const CrowdCourse& course, const Value& value) {
  double most = kLeastRange;
  for (const CellCourse& cell : course.cells)
    if (cell.time > 0.0) most = std::max(most, value(cell));
  return most;
}

/// The mean flow of blocks of cells; the strongest arrow is as long as a block.
void add_arrows(const CrowdCourse& course, DataFile& data, PlotCommand& plot) {
  const CellGrid& g = course.grid;
  const std::size_t block = std::max<std::size_t>(1, std::max(g.columns, g.rows) / kMostArrows);
  CellGrid blocks{g.low, g.cell * static_cast<double>(block), (g.columns + block - 1) / block,
                  (g.rows + block - 1) / block};
  std::vector<Vec2> flow(blocks.size());
  for (std::size_t k = 0; k < course.cells.size(); ++k) flow[blocks.at(g.centre(k))] += course.cells[k].moved;
  double most = 0.0;
  for (const Vec2 f : flow) most = std::max(most, norm(f));
  const int index = data.begin("flow of blocks of cells", "x [m], y [m] of the tail, then of the arrow");
  for (std::size_t k = 0; k < flow.size(); ++k) {
    if (!(norm(flow[k]) > kLeastArrow * most)) continue;
    const Vec2 arrow = 0.95 * blocks.cell / most * flow[k], tail = blocks.centre(k) - 0.5 * arrow;
    data.row({tail.x, tail.y, arrow.x, arrow.y});
  }
  plot.data(index, "using 1:2:3:4 with vectors head filled size screen 0.006,20 lw 1 lc rgb '#c1440e'");
}

Figure map_figure(const CrowdCourse& course, const std::string& name, const std::string& what, const std::string& unit,
                  const Value& value, bool has_arrows) {
  const Box plane = plane_of(course);
  const Canvas canvas = canvas_for(plane);
  DataFile data;
  PlotCommand plot;
  add_cells(course, value, data, plot);
  add_obstacles(course, plane, data, plot);
  if (has_arrows) add_arrows(course, data, plot);
  const std::string title = title_of(course, what);
  return {name, data.text(), title + fmt::format(". Cells of {:.3g} m.", course.grid.cell), canvas,
          filled("crowd_map", {{"title", quoted(shortened(title, characters_in(canvas.width - 60.0)))},
                               {"ranges", ranges(plane)},
                               {"value", markup(unit)},
                               {"most", fmt::format("{:.6g}", largest(course, value))},
                               {"plot", plot.text()}})};
}

Figure paths_of_some(const CrowdCourse& course) {
  const Box plane = plane_of(course);
  const Canvas canvas = canvas_for(plane);
  DataFile data;
  PlotCommand plot;
  add_obstacles(course, plane, data, plot);
  for (std::size_t p = 0; p < course.paths.size(); ++p) {
    const int index = data.begin("the way of a robot", "x [m], y [m]");
    data.rows(course.paths[p]);
    plot.data(index, fmt::format("using 1:2 with lines lw 1.2 lc rgb '{}'", series_colour(p)));
    if (course.paths[p].empty()) continue;
    const int last = data.begin("where it was at the end", "x [m], y [m]");
    data.rows({course.paths[p].back()});
    plot.data(last, fmt::format("using 1:2 with points pt 7 ps 0.4 lc rgb '{}'", series_colour(p)));
  }
  const std::string what = course.paths.size() == course.robots
                               ? "the ways of all"
                               : fmt::format("the ways of {} of them", course.paths.size());
  const std::string title = title_of(course, what);
  return {"paths", data.text(), title + ".", canvas,
          filled("paths", {{"title", quoted(shortened(title, characters_in(canvas.width - 60.0)))},
                           {"ranges", ranges(plane)},
                           {"x_label", "'x [m]'"},
                           {"y_label", "'y [m]'"},
                           {"plot", plot.text()}})};
}

Figure speeds_figure(const CrowdCourse& course) {
  constexpr Canvas kCanvas{960, 480};
  DataFile data;
  PlotCommand plot;
  double most = kLeastRange;
  const int index = data.begin("speeds", "t [s], a tenth is slower than, median, a tenth is faster than [m/s]");
  for (const SpeedsThen& then : course.speeds) {
    data.row({then.time, then.slow, then.median, then.fast});
    most = std::max(most, then.fast);
  }
  plot.data(index, "using 1:2:4 with filledcurves fc rgb '#b5d4e9' fs solid 1.0 noborder",
            "all but the slowest and fastest tenth");
  plot.data(index, fmt::format("using 1:3 with lines lw 2 lc rgb '{}'", series_colour(0)), "median");
  const std::string title = title_of(course, "speeds of the robots");
  return {"speeds", data.text(), title + ".", kCanvas,
          filled("series", {{"title", quoted(shortened(title, characters_in(kCanvas.width - 60.0)))},
                            {"end", fmt::format("{:.6g}", std::max(course.duration, 1e-6))},
                            {"y_label", markup("speed [m/s]")},
                            {"key_rows", "4"},
                            {"rest", "set key inside right top"},
                            {"y_axis", fmt::format("set yrange [0:{:.6g}]", 1.15 * most)},
                            {"plot", plot.text()}})};
}

}  // namespace

std::vector<Figure> crowd_figures(const CrowdCourse& course) {
  const double cell_time = area(course) * std::max(course.duration, kLeastRange);
  const Value density = [=](const CellCourse& c) { return c.time / cell_time; };
  const Value flow = [=](const CellCourse& c) { return norm(c.moved) / cell_time; };
  const Value speed = [](const CellCourse& c) { return c.way / c.time; };
  return {map_figure(course, "density", "density, on average", "robots / m^2", density, false),
          map_figure(course, "flow", "flow, on average", "robots / (m s)", flow, true),
          map_figure(course, "speed", "speed where they were", "m/s", speed, false), speeds_figure(course),
          paths_of_some(course)};
}

}  // namespace exactvo::tools
