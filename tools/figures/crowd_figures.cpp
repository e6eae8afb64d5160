// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/crowd_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "exactvo/geometry/counted.h"
#include "figures/plane.h"
#include "recordings/crowd_headings.h"

namespace exactvo::tools {

using datasets::CrowdHeadings;
using datasets::CrowdRecordingHead;
using datasets::CrowdRecordingReader;
using datasets::CrowdRow;

namespace {

// --- What the crowd did ---

/// A way between two rows is divided among the cells in this many equal pieces at most.
constexpr std::size_t kMostPieces = 16;
/// m: robots that stand in one place are seen in a view of this size.
constexpr double kLeastView = 1.0;

CellGrid grid_over(const Box& view) {
  CellGrid grid;
  grid.cell = round_size(std::max({view.width(), view.height(), kLeastView}) / static_cast<double>(kMostCells));
  grid.low = {grid.cell * std::floor(view.low.x / grid.cell), grid.cell * std::floor(view.low.y / grid.cell)};
  grid.columns = static_cast<std::size_t>((view.high.x - grid.low.x) / grid.cell) + 1;
  grid.rows = static_cast<std::size_t>((view.high.y - grid.low.y) / grid.cell) + 1;
  return grid;
}

/// First pass: where robots are, and how many rows there are.
std::size_t look_over(const std::filesystem::path& recording, CrowdCourse& course) {
  CrowdRecordingReader reader(recording);
  const CrowdRecordingHead& head = reader.head();
  course.name = head.scenario;
  course.robots = head.kind_of.size();
  course.edges = head.edges;
  for (const datasets::CrowdBodyRecord& body : head.bodies) course.bodies.push_back(body.shape);
  CrowdRow row;
  std::size_t rows = 0;
  for (; reader.next(row); ++rows) {
    course.duration = head.time_step * row.step;
    for (std::size_t i = 0; i < course.robots; ++i) course.view.add(head.place(row, i));
  }
  course.cut_off = reader.is_cut_off();
  if (course.view.is_empty()) course.view.add(Vec2{});
  return rows;
}

void add_way(Vec2 from, Vec2 to, double time, const CellGrid& grid, std::vector<CellCourse>& cells) {
  const Vec2 way = to - from;
  const double length = norm(way), wanted = std::ceil(length / grid.cell);
  const auto pieces = static_cast<std::size_t>(std::clamp(wanted, 1.0, static_cast<double>(kMostPieces)));
  const double share = 1.0 / static_cast<double>(pieces);
  for (std::size_t k = 0; k < pieces; ++k) {
    CellCourse& cell = cells[grid.at(from + share * (static_cast<double>(k) + 0.5) * way)];
    cell.time += share * time;
    cell.way += share * length;
    cell.moved += share * way;
  }
}

SpeedsThen speeds_at(double time, std::vector<double>& speeds) {
  SpeedsThen then;
  then.time = time;
  const auto quantile = [&](double share) {
    const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(speeds.size() - 1));
    std::nth_element(speeds.begin(), speeds.begin() + k, speeds.end());
    return speeds[static_cast<std::size_t>(k)];
  };
  then.slow = quantile(0.1);
  then.median = quantile(0.5);
  then.fast = quantile(0.9);
  return then;
}

// --- Figures ---

constexpr double kLongestSide = 760.0;  // px, of the plane
constexpr std::size_t kNameLength = 40;
/// Arrows along the longer side of the map.
constexpr std::size_t kMostArrows = 28;
/// A share of the strongest flow: where less passes, there is no arrow.
constexpr double kLeastArrow = 0.03;
constexpr double kLeastValueRange = 1e-9;  // of values: gnuplot draws no empty range

using Value = std::function<double(const CellCourse&)>;

std::string title_of(const CrowdCourse& course, const std::string& what) {
  return fmt::format("{}, {}, {:.4g} s: {}", shortened(course.name, kNameLength),
                     geometry::counted(course.robots, "robot"), course.duration, what);
}

/// A body is drawn whole unless that makes a picture so many times as large as all cells.
constexpr double kMostForABody = 2.0;

/// What is drawn of the plane: all cells, bodies at the start, and a rim.
Box plane_of(const CrowdCourse& course) {
  const CellGrid& g = course.grid;
  const Vec2 high = g.low + g.cell * Vec2{static_cast<double>(g.columns), static_cast<double>(g.rows)};
  const Box cells{g.low, high};
  Box plane = cells;
  for (const geometry::ConvexShape& body : course.bodies) {
    Box with_body = cells;
    with_body.add(geometry::box_of(body));
    if (with_body.diagonal() <= kMostForABody * cells.diagonal()) plane.add(with_body);
  }
  return plane.grown(0.02 * norm(plane.high - plane.low));
}

/// px a metre of the plane.
double pixels_a_metre(const Box& plane) {
  return kLongestSide / std::max(plane.width(), plane.height());
}

Canvas canvas_for(const Box& plane) {
  const double scale = pixels_a_metre(plane);
  const auto side = [&](double length, double least) { return static_cast<int>(std::max(scale * length, least)); };
  return {side(plane.width(), 300.0) + 180, side(plane.height(), 160.0) + 110};
}

/// Obstacles, and bodies where they stood at the start.
void add_obstacles(const CrowdCourse& course, Panel& panel) {
  std::vector<Points> edges, bodies;
  for (const geometry::Segment& edge : course.edges) edges.push_back(segment_within(panel.view, edge.a, edge.b));
  for (const geometry::ConvexShape& body : course.bodies) bodies.push_back(outline(body));
  panel.curves("edges of obstacles", edges, line_style(1, kObstacleLine));
  panel.rings("bodies at the start", bodies, line_style(1, kObstacleLine, " dt (4,3)"));
}

/// Cells that were always empty stay white.
void add_cells(const CrowdCourse& course, const Value& value, Panel& panel) {
  const int index = panel.data.begin("cells", "x [m], y [m] of the middle, value; NaN: always empty");
  for (std::size_t k = 0; k < course.cells.size(); ++k) {
    const Vec2 at = course.grid.centre(k);
    const bool is_empty = !(course.cells[k].time > 0.0);
    panel.data.row({at.x, at.y, is_empty ? std::numeric_limits<double>::quiet_NaN() : value(course.cells[k])});
    if ((k + 1) % course.grid.columns == 0) panel.data.gap();
  }
  panel.draw(index, "with image", "", ":3");
}

double largest(const CrowdCourse& course, const Value& value) {
  double most = kLeastValueRange;
  for (const CellCourse& cell : course.cells)
    if (cell.time > 0.0) most = std::max(most, value(cell));
  return most;
}

/// The mean flow of blocks of cells; the strongest arrow is as long as a block.
void add_arrows(const CrowdCourse& course, Panel& panel) {
  const CellGrid& g = course.grid;
  const std::size_t block = std::max<std::size_t>(1, std::max(g.columns, g.rows) / kMostArrows);
  CellGrid blocks{g.low, g.cell * static_cast<double>(block), (g.columns + block - 1) / block,
                  (g.rows + block - 1) / block};
  std::vector<Vec2> flow(blocks.size());
  for (std::size_t k = 0; k < course.cells.size(); ++k) flow[blocks.at(g.centre(k))] += course.cells[k].moved;
  double most = 0.0;
  for (const Vec2 f : flow) most = std::max(most, norm(f));
  const int index = panel.data.begin("flow of blocks of cells", "x [m], y [m] of the tail, then of the arrow");
  for (std::size_t k = 0; k < flow.size(); ++k) {
    if (!(norm(flow[k]) > kLeastArrow * most)) continue;
    const Vec2 arrow = 0.95 * blocks.cell / most * flow[k], tail = blocks.centre(k) - 0.5 * arrow;
    panel.data.row({tail.x, tail.y, arrow.x, arrow.y});
  }
  panel.draw(index, "with vectors head filled size screen 0.006,20 lw 1 lc rgb '#c1440e'", "", ":3:4");
}

Figure map_figure(const CrowdCourse& course, const std::string& name, const std::string& what, const std::string& unit,
                  const Value& value, bool has_arrows) {
  DataFile data;
  Panel panel(plane_of(course), data);
  add_cells(course, value, panel);
  add_obstacles(course, panel);
  if (has_arrows) add_arrows(course, panel);
  const Canvas canvas = canvas_for(panel.view);
  const std::string title = title_of(course, what);
  return {name, data.text(), title + fmt::format(". Cells of {:.3g} m.", course.grid.cell), canvas,
          filled("crowd_map", {{"value", markup(unit)},
                               {"most", fmt::format("{:.6g}", largest(course, value))},
                               {"plane", panel.body(quoted(shortened(title, characters_in(canvas.width - 60.0))))}})};
}

/// Bodies along a path, at most; each farther from the one before than its disc is wide.
constexpr std::size_t kMostHeadings = 6;
/// px: shorter arrows are not seen to point anywhere.
constexpr double kLeastArrowLength = 9.0;

/// The body of a robot on wheels at some points of its path, the last among them, and an arrow ahead from its axle.
void add_headings(const CrowdCourse& course, std::size_t p, Panel& panel) {
  if (!course.drives[p]) return;
  const formation::DifferentialDrive& drive = *course.drives[p];
  const std::vector<Vec2>& path = course.paths[p];
  const double least = kLeastArrowLength / pixels_a_metre(panel.view);
  std::vector<Points> bodies;
  const int index = panel.data.begin("where it headed", "x [m], y [m] of the axle, then of the arrow");
  std::optional<Vec2> before;
  for (std::size_t k = 0; k < kMostHeadings && !path.empty(); ++k) {
    const std::size_t at = (path.size() - 1) * (kMostHeadings - 1 - k) / (kMostHeadings - 1);
    if (before && norm(path[at] - *before) < std::max(least, 2.0 * (drive.reference + drive.body_radius))) continue;
    before = path[at];
    const Vec2 e = course.headings[p][at], axle = path[at] - drive.reference * e;
    const Vec2 arrow = std::max(drive.reference, least) * e;
    bodies.push_back(outline(geometry::Disc{axle, drive.body_radius}));
    panel.data.row({axle.x, axle.y, arrow.x, arrow.y});
  }
  panel.draw(index, fmt::format("with vectors head filled size screen 0.005,20 lw 1.2 lc rgb '{}'", series_colour(p)),
             "", ":3:4");
  panel.rings("its body there", bodies, line_style(0.8, series_colour(p)));
}

Figure paths_of_some(const CrowdCourse& course) {
  DataFile data;
  Panel panel(plane_of(course), data);
  add_obstacles(course, panel);
  for (std::size_t p = 0; p < course.paths.size(); ++p) {
    const std::vector<Vec2>& path = course.paths[p];
    panel.curves("the way of a robot", {path}, line_style(1.2, series_colour(p)));
    add_headings(course, p, panel);
    if (!path.empty() && !course.drives[p])
      panel.points("where it was at the end", {path.back()},
                   fmt::format("with points pt 7 ps 0.4 lc rgb '{}'", series_colour(p)));
  }
  const Canvas canvas = canvas_for(panel.view);
  const std::string what = course.paths.size() == course.robots
                               ? "the ways of all"
                               : fmt::format("the ways of {} of them", course.paths.size());
  const std::string title = title_of(course, what);
  return {"paths", data.text(), title + ".", canvas,
          panel.body(quoted(shortened(title, characters_in(canvas.width - 60.0))))};
}

Figure speeds_figure(const CrowdCourse& course) {
  constexpr Canvas kCanvas{960, 480};
  DataFile data;
  PlotCommand plot;
  double most = kLeastValueRange;
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

std::size_t CellGrid::at(Vec2 p) const {
  const auto index = [&](double x, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(std::floor(x / cell), 0.0, static_cast<double>(count - 1)));
  };
  return index(p.y - low.y, rows) * columns + index(p.x - low.x, columns);
}

Vec2 CellGrid::centre(std::size_t number) const {
  const auto column = static_cast<double>(number % columns), row = static_cast<double>(number / columns);
  return low + cell * Vec2{column + 0.5, row + 0.5};
}

CrowdCourse course_of(const std::filesystem::path& recording) {
  CrowdCourse course;
  const std::size_t rows = look_over(recording, course);
  course.grid = grid_over(course.view);
  course.cells.resize(course.grid.size());
  const std::size_t stride = (rows + kMostRowsOver - 1) / kMostRowsOver;
  course.paths.resize(std::min(course.robots, kMostPaths));
  const auto shown = [&](std::size_t k) { return k * course.robots / course.paths.size(); };

  CrowdRecordingReader reader(recording);
  const CrowdRecordingHead& head = reader.head();
  CrowdHeadings headings(head);
  course.headings.resize(course.paths.size());
  for (std::size_t p = 0; p < course.paths.size(); ++p)
    course.drives.push_back(headings.has(shown(p)) ? std::optional(headings.drive(shown(p))) : std::nullopt);
  CrowdRow before, now;
  std::vector<double> speeds;
  for (std::size_t k = 0; k < rows && reader.next(now); ++k) {
    headings.follow(now);
    if (k % stride == 0 || k + 1 == rows)
      for (std::size_t p = 0; p < course.paths.size(); ++p) {
        course.paths[p].push_back(head.place(now, shown(p)));
        if (course.drives[p]) course.headings[p].push_back(headings.of(shown(p)).heading);
      }
    if (k > 0) {
      const double time = head.time_step * (now.step - before.step);
      speeds.clear();
      for (std::size_t i = 0; i < course.robots; ++i) {
        const Vec2 from = head.place(before, i), to = head.place(now, i);
        add_way(from, to, time, course.grid, course.cells);
        speeds.push_back(norm(to - from) / time);
      }
      if (!speeds.empty() && (k - 1) % stride == 0)
        course.speeds.push_back(speeds_at(head.time_step * before.step + 0.5 * time, speeds));
    }
    std::swap(before, now);
  }
  return course;
}

std::vector<Figure> crowd_figures(const CrowdCourse& course) {
  const double cell_time = course.grid.cell * course.grid.cell * std::max(course.duration, kLeastValueRange);
  const Value density = [=](const CellCourse& c) { return c.time / cell_time; };
  const Value flow = [=](const CellCourse& c) { return norm(c.moved) / cell_time; };
  const Value speed = [](const CellCourse& c) { return c.way / c.time; };
  return {map_figure(course, "density", "density, on average", "robots / m^2", density, false),
          map_figure(course, "flow", "flow, on average", "robots / (m s)", flow, true),
          map_figure(course, "speed", "speed where they were", "m/s", speed, false), speeds_figure(course),
          paths_of_some(course)};
}

}  // namespace exactvo::tools
