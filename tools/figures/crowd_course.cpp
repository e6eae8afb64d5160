// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/crowd_course.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace exactvo::tools {

using datasets::CrowdRecordingHead;
using datasets::CrowdRecordingReader;
using datasets::CrowdRow;

namespace {

/// A way between two rows is divided among the cells in so many equal pieces at most.
constexpr std::size_t kMostPieces = 16;
/// m: robots that stand in one place are seen in a view of this size.
constexpr double kLeastView = 1.0;

Vec2 place(const CrowdRow& row, const CrowdRecordingHead& head, std::size_t i) {
  return {head.position_step * row.x[i], head.position_step * row.y[i]};
}

/// 1, 2 or 5 times a power of ten, not below.
double round_size(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least) return factor * power;
  return 10.0 * power;
}

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
    for (std::size_t i = 0; i < course.robots; ++i) course.view.add(place(row, head, i));
  }
  course.cut_off = reader.is_cut_off();
  if (course.view.empty()) course.view.add(Vec2{});
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
  CrowdRow before, now;
  std::vector<double> speeds;
  for (std::size_t k = 0; k < rows && reader.next(now); ++k) {
    if (k % stride == 0 || k + 1 == rows)
      for (std::size_t p = 0; p < course.paths.size(); ++p) course.paths[p].push_back(place(now, head, shown(p)));
    if (k > 0) {
      const double time = head.time_step * (now.step - before.step);
      speeds.clear();
      for (std::size_t i = 0; i < course.robots; ++i) {
        const Vec2 from = place(before, head, i), to = place(now, head, i);
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

}  // namespace exactvo::tools
