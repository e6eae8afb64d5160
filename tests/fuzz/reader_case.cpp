// SPDX-License-Identifier: GPL-3.0-or-later
#include "reader_case.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <limits>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/datasets/trajectory_file.h"
#include "exactvo/geometry/validity.h"

namespace exactvo::datasets::test {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

/// Files that stand beside the one that is read: what follows the mark in a case, under each of the names.
struct Companions {
  std::string format;
  std::string mark;
  std::vector<const char*> names;
};

const Companions* companions_of(const FuzzedFormat& format) {
  static const std::vector<Companions> kCompanions{
      {"ros-map", "\n%picture%\n", {"map.pgm", "map.png", "map.bmp"}},
      {"scenario", "\n%obstacles%\n", {"obstacles.wkt", "obstacles.geojson", "obstacles.geojsonl", "obstacles.csv"}}};
  for (const Companions& companions : kCompanions) {
    if (companions.format == format.name) return &companions;
  }
  return nullptr;
}

/// Returns the file to read. Without a mark there are no companions, nor those of another case.
fs::path put(const FuzzedFormat& format, const std::string& bytes, const fs::path& folder) {
  const fs::path path = folder / (std::string("case") + format.extension);
  const Companions* companions = companions_of(format);
  const std::size_t at = companions == nullptr ? std::string::npos : bytes.find(companions->mark);
  write(path, at == std::string::npos ? bytes : bytes.substr(0, at + 1));
  if (companions == nullptr) return path;
  for (const char* name : companions->names) {
    if (at == std::string::npos)
      fs::remove(folder / name);
    else
      write(folder / name, bytes.substr(at + companions->mark.size()));
  }
  return path;
}

bool is_valid(const geometry::Obstacle& shape) {
  if (const auto* line = std::get_if<geometry::Polyline>(&shape))
    return geometry::normalize_polyline(line->points).problems.empty();
  const auto& polygon = std::get<geometry::Polygon>(shape);
  std::vector<geometry::Ring> rings{polygon.outer};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  for (const geometry::RingProblem& problem : geometry::normalize(rings).problems) {
    if (problem.code != geometry::RingProblemCode::unclosed) return false;
  }
  return true;
}

std::string judged(const ObstacleFile& file) {
  const ReadCounts& n = file.counts;
  if (n.read != n.done + n.repaired + n.passed_over + n.rejected) return "the books do not balance";
  if (n.rejected != file.rejected.size()) return "a refusal is not listed";
  for (const formation::SceneObstacle& obstacle : file.obstacles) {
    if (!is_valid(obstacle.shape)) return "an invalid obstacle, " + obstacle.id;
  }
  return {};
}

/// Reads the file twice: rows of known agents, finite, in time, and the same again.
std::string read_trajectories(const fs::path& path) {
  TrajectoryReader reader(path.string());
  std::vector<double> last;
  std::string wrong;
  std::size_t rows = 0;
  const auto take = [&](const TrajectoryRow& row) {
    last.resize(std::max(last.size(), reader.file().agents.size()), -std::numeric_limits<double>::infinity());
    if (row.agent >= reader.file().agents.size()) return void(wrong = "a row of an agent that has no name");
    if (!std::isfinite(row.time) || !is_finite(row.at)) wrong = "a row that is not finite";
    if (row.time <= last[row.agent]) wrong = "a time that does not rise";
    last[row.agent] = row.time;
    ++rows;
  };
  const TrajectoryFile first = reader.read(take);
  const std::size_t count = rows;
  last.clear();
  rows = 0;
  if (reader.read(take).agents != first.agents || rows != count) return "another content when it is read again";
  if (!first.radii.empty() && first.radii.size() != first.agents.size()) return "agents without a radius";
  return wrong;
}

std::string read_crowd(const fs::path& path) {
  CrowdRecordingReader reader(path);
  CrowdRow row;
  std::uint32_t step = 0;
  for (bool is_first = true; reader.next(row); is_first = false) {
    if (row.x.size() != reader.head().kind_of.size() || row.y.size() != row.x.size()) return "a row without all robots";
    if (!is_first && row.step <= step) return "a step that does not rise";
    step = row.step;
  }
  return {};
}

std::string read_run(const fs::path& path) {
  std::size_t wrong = 0;
  read_recording(path, [&](const RecordingFile& so_far, const formation::Step& row, const formation::LyapunovRow*) {
    wrong += row.robots.size() != so_far.scenario.robots.size();
  });
  return wrong == 0 ? "" : "a row without all robots";
}

std::string read(const FuzzedFormat& format, const fs::path& path, bool with_repair) {
  const std::string name = format.name;
  if (name == "trajectories") return read_trajectories(path);
  if (name == "crowd-recording") return read_crowd(path);
  if (name == "recording") return read_run(path);
  if (name == "scenario") {
    load_scenario(path);
    return {};
  }
  ReadOptions options;
  options.format = format.reader == nullptr ? format.name : format.reader;
  options.keep_going = true;
  options.keep_properties = true;
  options.repair = with_repair;
  return judged(read_obstacles(path, options));
}

const FuzzedFormat& format_named(const std::string& name) {
  for (const FuzzedFormat& format : fuzzed_formats()) {
    if (name == format.name) return format;
  }
  throw std::logic_error("no fuzzed format " + name);
}

}  // namespace

const std::vector<FuzzedFormat>& fuzzed_formats() {
  static const std::vector<FuzzedFormat> kFormats{
      {"wkt", ".wkt"},
      {"jupedsim-wkt", ".wkt"},
      {"gdal", ".geojson"},
      {"ros-map", ".yaml"},
      {"movingai-map", ".map"},
      {"carmen-log", ".log"},
      {"csm-log", ".log"},
      {"points-csv", ".csv"},
      {"jupedsim-xml", ".xml"},
      {"menge-xml", ".xml"},
      {"sumo-poly", ".poly.xml"},
      {"barn-world", ".world"},
      {"rings-json", ".json"},
      {"jts-xml", ".xml"},
      {"opentraj-xml", ".xml"},
      {"graphml", ".graphml"},
      {"counted-rings", ".line"},
      {"pslg", ".txt"},
      {"ompl-circles", ".txt"},
      {"ompl-grid", ".txt"},
      {"scenario", ".json"},
      {"geojson-sequence", ".geojsonl", "gdal"},
      {"gdal-csv", ".csv", "gdal"},
      {"trajectories", ".txt"},
      {"recording", ".jsonl"},
      {"crowd-recording", ".evr"},
  };
  return kFormats;
}

std::string read_case(const std::string& name, const std::string& bytes, const fs::path& folder) {
  const FuzzedFormat& format = format_named(name);
  const fs::path path = put(format, bytes, folder);
  try {
    return read(format, path, bytes.size() % 2 == 1);
  } catch (const DataError& error) {
    return std::string(code_name(error.code())) == "E_UNKNOWN" ? "a refusal without a code" : "";
  } catch (const std::exception& error) {
    return std::string("an exception of another kind: ") + error.what();
  }
}

}  // namespace exactvo::datasets::test
