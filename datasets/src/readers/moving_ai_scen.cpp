// SPDX-License-Identifier: GPL-3.0-or-later
// Moving AI tasks: "version 1", then one line per task: bucket, map, width, height, start x y, goal x y, optimal
// length.
#include "exactvo/datasets/moving_ai.h"
#include "exactvo/geometry/counted.h"
#include "files/text_file.h"
#include "readers/line_reader.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

constexpr std::size_t kFields = 9;

/// Fields are parted by tabs, so that a map's name may hold blanks; some files use blanks throughout.
std::vector<std::string_view> task_fields(std::string_view line) {
  std::vector<std::string_view> fields = fields_of(line, '\t');
  return fields.size() == kFields ? fields : words_of(line);
}

PathTask to_task(const LineReader& lines) {
  const std::vector<std::string_view> f = task_fields(lines.line());
  if (f.size() != kFields) {
    lines.refuse(DataCode::wrong_count, geometry::counted(f.size(), "field"), geometry::counted(kFields, "field"));
  }
  PathTask task;
  task.bucket = lines.to_integer(f[0]);
  task.map = std::string(f[1]);
  task.width = lines.to_integer(f[2]);
  task.height = lines.to_integer(f[3]);
  task.start = {lines.to_integer(f[4]), lines.to_integer(f[5])};
  task.goal = {lines.to_integer(f[6]), lines.to_integer(f[7])};
  task.optimal_length = lines.to_number(f[8]);
  return task;
}

bool is_version_line(std::string_view line) {
  const std::vector<std::string_view> words = words_of(line);
  return words.size() == 2 && words[0] == "version" && (words[1] == "1" || words[1] == "1.0");
}

}  // namespace

std::vector<PathTask> read_tasks(const std::filesystem::path& path) {
  const std::string text = read_text_file(path);
  const std::string name = path.string();
  LineReader lines(text, name);
  if (!lines.next() || !is_version_line(lines.line())) {
    lines.refuse(DataCode::format_syntax, excerpt(lines.line(), 0), "\"version 1\"");
  }
  std::vector<PathTask> tasks;
  while (lines.next()) {
    if (!trimmed(lines.line()).empty()) tasks.push_back(to_task(lines));
  }
  return tasks;
}

bool is_inside_its_map(const PathTask& task) {
  const auto inside = [&](GridCell c) {
    return c.column >= 0 && c.row >= 0 && c.column < task.width && c.row < task.height;
  };
  return inside(task.start) && inside(task.goal);
}

geometry::Vec2 middle_of(GridCell cell, std::int64_t height, double cell_size) {
  return {(static_cast<double>(cell.column) + 0.5) * cell_size,
          (static_cast<double>(height - 1 - cell.row) + 0.5) * cell_size};
}

bool looks_like_moving_ai_scen(const FormatProbe& probe) {
  return probe.extension == ".scen" && probe.beginning.rfind("version ", 0) == 0;
}

void read_moving_ai_scen(const std::filesystem::path& path, Collector& out) {
  const std::vector<PathTask> tasks = read_tasks(path);
  std::size_t outside = 0;
  for (std::size_t k = 0; k < tasks.size(); ++k) outside += is_inside_its_map(tasks[k]) ? 0 : 1;
  out.note("", std::to_string(tasks.size()) + " path-finding tasks, no obstacles: these are in the map");
  if (outside > 0) out.note("", geometry::counted(outside, "task") + " outside the size that they state");
}

}  // namespace exactvo::datasets
