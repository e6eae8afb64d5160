// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "exactvo/datasets/crowd_recording.h"
#include "explorer/packed_run.h"
#include "recordings/crowd_headings.h"
#include "support/terminal.h"

namespace exactvo::tools {

using datasets::CrowdHeadings;
using datasets::CrowdRow;
using geometry::Vec2;

namespace {

/// The row as a step: of each robot its place, its mean velocity since the row before, where it heads, and whether it
/// kept its half-planes.
void put(const CrowdRow& row, const datasets::CrowdRecordingHead& head, const CrowdHeadings& headings,
         formation::Step& step) {
  const bool is_first = step.robots.empty();
  const double before = step.time;
  step.robots.resize(row.x.size());
  step.time = head.time_step * row.step;
  step.moving.clear();
  for (std::size_t k = 0; k < head.bodies.size(); ++k)
    if (head.bodies[k].moves) step.moving.push_back({head.displacement(row, k), {}});
  for (std::size_t i = 0; i < row.x.size(); ++i) {
    formation::RobotStep& robot = step.robots[i];
    const Vec2 here = head.place(row, i);
    robot.velocity = is_first || !(step.time > before) ? Vec2{} : (here - robot.position) / (step.time - before);
    robot.position = here;
    robot.status = is_first || row.kept[i] != 0 ? lp::Status::optimal : lp::Status::relaxed;
    if (headings.has(i)) robot.wheels = headings.of(i);
  }
}

}  // namespace

PackedCrowd packed_crowd(const std::filesystem::path& path, const PackedRunLimits& limits,
                         const std::string& metrics_json) {
  datasets::CrowdRecordingReader reader(path);
  datasets::RecordingFile about = scene_of(reader.head());
  CrowdHeadings headings(reader.head());
  for (std::size_t i = 0; i < about.scenario.robots.size(); ++i)
    if (headings.has(i)) about.scenario.robots[i].drive = headings.drive(i);
  RunPacker packer(limits);
  CrowdRow row;
  formation::Step step;
  std::size_t rows = 0;
  for (; reader.next(row); ++rows) {
    if (interrupted()) throw Interrupted();
    headings.follow(row);
    put(row, reader.head(), headings, step);
    packer.add_positions(step);
  }
  if (rows == 0)
    throw datasets::DataError(datasets::DataCode::format_syntax, path.string(), "", "no whole row",
                              "a recording of at least one row");
  const auto metrics = nlohmann::json::parse(metrics_json, nullptr, false);
  const std::string cadence = reader.head().every == 1 ? "step" : fmt::format("{} steps", reader.head().every);
  about.recording.outcome = metrics.is_object() && metrics.contains("outcome") && metrics["outcome"].is_string()
                                ? metrics["outcome"].get<std::string>()
                                : fmt::format("{} robots, {} rows, a row every {} of {:.4g} s",
                                              about.scenario.robots.size(), rows, cadence, reader.head().time_step);
  if (reader.is_cut_off()) about.recording.warnings.push_back("The recording was cut off after its last whole row.");
  return {reader.head().scenario, packer.finish(about, metrics_json), reader.is_cut_off()};
}

}  // namespace exactvo::tools
