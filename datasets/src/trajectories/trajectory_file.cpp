// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/trajectory_file.h"

#include <algorithm>
#include <boost/algorithm/string/join.hpp>
#include <cmath>
#include <optional>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/require.h"
#include "files/text_file.h"
#include "json/json_text.h"
#include "readers/line_reader.h"
#include "trajectories/trajectory_readers.h"

namespace exactvo::datasets {
namespace {

constexpr std::size_t kProbe = 4096;

const TrajectoryFormat& format_named(const std::string& name, const std::string& file) {
  for (const TrajectoryFormat& format : trajectory_readers())
    if (name == format.name) return format;
  throw DataError(DataCode::not_an_option, file, "format", "\"" + name + "\"",
                  "one of " + boost::join(trajectory_formats(), ", "));
}

const TrajectoryFormat& format_for(std::string_view beginning, const std::string& file) {
  for (const TrajectoryFormat& format : trajectory_readers())
    if (format.matches(beginning)) return format;
  const std::string lacks = what_a_header_lacks(beginning);
  if (!lacks.empty())
    throw DataError(DataCode::format_unknown, file, "",
                    excerpt(beginning.substr(0, beginning.find_first_of("\r\n")), 0, 60), lacks);
  if (beginning.find("\"last_arrival_time\"") != std::string_view::npos)
    throw DataError(DataCode::format_unknown, file, "", "the metrics of a run", "the folder of the run");
  const bool has_robots = beginning.find("\"robots\"") != std::string_view::npos;
  if (has_robots && beginning.find_first_not_of(" \t\r\n") == beginning.find('{'))
    throw DataError(DataCode::format_unknown, file, "", "a scenario, which is no run yet",
                    "a file of trajectories, or the folder of a run, as simulate --out writes it");
  throw DataError(
      DataCode::format_unknown, file, "", excerpt(beginning, 0),
      "a file of trajectories, such as CSV with the columns t,id,x,y; if its format is one of these, name it "
      "with --format: " +
          boost::join(trajectory_formats(), ", "));
}

}  // namespace

const std::vector<TrajectoryFormat>& trajectory_readers() {
  static const std::vector<TrajectoryFormat> kReaders{
      {"crowd-recording", begins_crowd_recording, read_crowd_trajectories},
      {"jupedsim-sqlite", looks_like_sqlite, read_jupedsim_sqlite},
      {"recording", looks_like_recording, read_recorded_trajectories},
      {"trajnet", looks_like_trajnet, read_trajnet},
      {"sumo-fcd", looks_like_sumo_fcd, read_sumo_fcd},
      {"mapf-paths", looks_like_mapf_paths, read_mapf_paths},
      {"mapf-yaml", looks_like_mapf_yaml, read_mapf_yaml},
      {"curves", looks_like_curves, read_curves},
      {"polynomials", looks_like_polynomials, read_polynomials},
      {"jupedsim-txt", looks_like_jupedsim_text, read_jupedsim_text},
      {"csv", looks_like_trajectory_csv, read_trajectory_csv},
      {"obsmat", looks_like_obsmat, read_obsmat},
      {"frame-id-x-y", looks_like_four_columns, read_four_columns},
  };
  return kReaders;
}

std::vector<std::string> trajectory_formats() {
  std::vector<std::string> names;
  for (const TrajectoryFormat& format : trajectory_readers()) names.emplace_back(format.name);
  return names;
}

std::size_t TrajectorySink::agent(std::string_view id) {
  id_.assign(id);
  const auto [at, is_new] = numbers_.try_emplace(id_, numbers_.size());
  if (is_new) {
    file_.agents.push_back(id_);
    last_.push_back({-std::numeric_limits<double>::infinity(), {}, 0, 0.0, {}});
  }
  return at->second;
}

void TrajectorySink::row(std::size_t agent, double time, geometry::Vec2 at, std::uint64_t line, double heading,
                         geometry::Vec2 velocity) {
  EXACTVO_REQUIRE(agent < last_.size(), std::to_string(agent) + " of " + std::to_string(last_.size()));
  const geometry::Vec2 metres = options_.scale * at;
  if (!std::isfinite(time)) refuse(DataCode::not_finite, line, number_text(time), "a finite time");
  if (!is_finite(metres))
    refuse(DataCode::not_finite, line, number_text(at.x) + ", " + number_text(at.y), "a place of finite numbers");
  if (std::fabs(metres.x) > kLargestCoordinate || std::fabs(metres.y) > kLargestCoordinate ||
      std::fabs(time) > kLargestCoordinate)
    refuse(DataCode::out_of_range, line, "a number beyond 2^100", "places in m and times in s up to 2^100");
  const geometry::Vec2 metres_a_second = options_.scale * velocity;  // no numbers: none is known
  if (std::fabs(metres_a_second.x) > kLargestCoordinate || std::fabs(metres_a_second.y) > kLargestCoordinate)
    refuse(DataCode::out_of_range, line, "a velocity beyond 2^100", "velocities in m/s up to 2^100");
  if (std::isinf(heading)) refuse(DataCode::not_finite, line, number_text(heading), "a finite heading, or none");
  Last& last = last_[agent];
  const auto words = [&](double t) { return number_text(t) + " s of agent " + file_.agents[agent]; };
  const auto place_of_last = [&] { return file_.row_word + " " + std::to_string(last.line); };
  if (time < last.time)
    refuse(DataCode::out_of_range, line, words(time),
           "no time before that of " + place_of_last() + ", " + number_text(last.time) + " s");
  if (time == last.time) {
    if (metres != last.at)
      refuse(DataCode::out_of_range, line, "a second place at " + words(time),
             "one place at a time; " + place_of_last() + " has another" +
                 (has_ids_ ? "" : "; the table has no column of ids, such as id, agent or robot"));
    // A row without a heading or a velocity repeats any.
    if (!std::isnan(heading) && heading != last.heading)
      refuse(DataCode::out_of_range, line, "a second heading at " + words(time),
             "one heading at a time; " + place_of_last() + " has another, or none");
    if (options_.one_velocity && is_finite(metres_a_second) && metres_a_second != last.velocity)
      refuse(DataCode::out_of_range, line, "a second velocity at " + words(time),
             "one velocity at a time; " + place_of_last() + " has another, or none");
    ++file_.repeated;
    return;
  }
  constexpr double kLeastTurn = 1e-100;  // s: the arc of a shorter turn leaves the doubles
  if (time - last.time < kLeastTurn && heading != last.heading && !std::isnan(heading) && !std::isnan(last.heading))
    refuse(DataCode::out_of_range, line, "another heading within " + words(time - last.time),
           "at least 1e-100 s for a turn; " + place_of_last() + " has the heading before");
  last = {time, metres, line, heading, metres_a_second};
  if (!std::isnan(heading)) {
    ++headings_;
    large_headings_ += std::fabs(heading) > 2.0 * geometry::kPi ? 1 : 0;
  }
  take_({agent, time, metres, heading, metres_a_second, line});
}

void TrajectorySink::has_no_ids() {
  has_ids_ = false;
  file_.notes.emplace_back("no column of ids: all rows are of one agent");
}

void TrajectorySink::finish() {
  if (std::all_of(last_.begin(), last_.end(), [](const Last& last) { return std::isinf(last.time); }))
    throw DataError(DataCode::format_syntax, file_.file, "", "no row", "at least one row of a trajectory");
  if (2 * large_headings_ > headings_)
    file_.notes.emplace_back("most headings are beyond 2 pi: they are read in radians, not in degrees");
  if (options_.frame_rate > 0.0 && !counts_frames_)
    file_.notes.emplace_back("--frame-rate has no effect: the file has times, and no numbers of frames");
  constexpr double kAfterAllDates = 1e11;  // s: milliseconds since 1970 are more
  double latest = 0.0;
  for (const Last& last : last_) latest = std::max(latest, last.time);
  if (latest > kAfterAllDates)
    file_.notes.push_back("times are read in seconds, and reach " + number_text(latest) +
                          " s: a name such as t_ms, t_us or t_ns says another unit");
}

double TrajectorySink::time_of_frame(double frame, double of_file) {
  counts_frames_ = true;
  if (options_.frame_rate > 0.0) return frame / options_.frame_rate;
  if (of_file > 0.0) return frame / of_file;
  if (!rate_noted_)
    file_.notes.emplace_back("times are frames, since no frame rate is known: one frame counts as 1 s (--frame-rate)");
  rate_noted_ = true;
  return frame;
}

void TrajectorySink::refuse(DataCode code, std::uint64_t line, const std::string& found,
                            const std::string& expected) const {
  throw DataError(code, file_.file, file_.row_word + " " + std::to_string(line), found, expected);
}

double TrajectorySink::number(std::string_view field, const char* what, std::uint64_t line) const {
  double value = 0.0;
  if (!parse_whole(field, value))
    refuse(DataCode::number, line, excerpt(field, 0),
           std::string("a number as ") + what +
               (field.find(',') == std::string_view::npos ? "" : ", with a decimal point"));
  if (!std::isfinite(value))
    refuse(DataCode::not_finite, line, excerpt(field, 0), std::string("a finite number as ") + what);
  return value;
}

// --- The reader ---

namespace {

void require_options(const TrajectoryOptions& options) {
  EXACTVO_REQUIRE(options.scale > 0.0 && std::isfinite(options.scale), number_text(options.scale));
  EXACTVO_REQUIRE(options.frame_rate >= 0.0 && std::isfinite(options.frame_rate), number_text(options.frame_rate));
}

}  // namespace

std::string recognised_trajectory_format(const std::string& file) {
  if (file == "-" || is_pipe(file)) return "";
  const std::string beginning = read_beginning(file, kProbe);
  for (const TrajectoryFormat& format : trajectory_readers())
    if (!beginning.empty() && format.matches(beginning)) return format.name;
  return "";
}

std::vector<std::string> trajectory_files_in(const std::filesystem::path& folder) {
  std::error_code error;
  for (const char* recording : {"recording.jsonl", "recording.evr"})
    if (std::filesystem::is_regular_file(folder / recording, error)) return {(folder / recording).string()};
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.is_regular_file(error) && !recognised_trajectory_format(entry.path().string()).empty())
      files.push_back(entry.path().string());
  if (files.empty())
    throw DataError(DataCode::format_unknown, folder.string(), "", "no file of trajectories",
                    "a folder with files of trajectories, or the folder of a run");
  std::sort(files.begin(), files.end());
  return files;
}

struct TrajectoryReader::State {
  TrajectoryOptions options;
  std::optional<CopyOfInput> spooled;        ///< a long one must not lie in memory
  std::vector<std::filesystem::path> paths;  ///< none: the columns
  TrajectoryColumns columns;
  const TrajectoryFormat* format = nullptr;
  TrajectoryFile file;

  void read_columns(TrajectorySink& sink) const {
    for (const std::string& name : columns.names) sink.agent(name);
    for (std::size_t k = 0; k < columns.time.size(); ++k) {
      TrajectoryRow row;
      if (!columns.heading.empty()) row.heading = columns.heading[k];
      if (!columns.vx.empty()) row.velocity = {columns.vx[k], columns.vy[k]};
      const double time = columns.in_frames ? sink.time_of_frame(columns.time[k], 0.0) : columns.time[k];
      sink.row(columns.agent[k], time, {columns.x[k], columns.y[k]}, k + 1, row.heading, row.velocity);
    }
  }
};

TrajectoryReader::TrajectoryReader(const std::string& file, TrajectoryOptions options)
    : TrajectoryReader(std::vector<std::string>{file}, std::move(options)) {}

TrajectoryReader::TrajectoryReader(const std::vector<std::string>& files, TrajectoryOptions options)
    : state_(std::make_unique<State>()) {
  EXACTVO_REQUIRE(!files.empty(), std::string("no files"));
  require_options(options);
  State& s = *state_;
  s.options = std::move(options);
  for (const std::string& file : files) {
    const std::string name = name_of_input(file);
    const bool is_stream = file == "-" || is_pipe(file);
    if (is_stream && files.size() > 1)
      throw DataError(DataCode::not_an_option, name, "", "a stream among several files", "files, or one stream");
    if (is_stream) s.spooled.emplace(file);
    s.paths.push_back(s.spooled ? s.spooled->path() : std::filesystem::path(file));
    const std::string beginning = read_beginning(s.paths.back(), kProbe);
    if (beginning.empty())
      throw DataError(DataCode::format_unknown, name, "", "an empty file", "a file of trajectories");
    s.format = s.options.format.empty() ? &format_for(beginning, name) : &format_named(s.options.format, name);
    if (files.size() > 1 && s.format->read != &read_polynomials)
      throw DataError(DataCode::not_an_option, name, "", std::string("the format ") + s.format->name,
                      "polynomials, since several files that are read together have one agent each");
  }
  s.file.file = name_of_input(files.front());
  if (files.size() > 1) s.file.file += " and " + std::to_string(files.size() - 1) + " more";
  s.file.format = s.format->name;
}

TrajectoryReader::TrajectoryReader(TrajectoryColumns columns, const std::string& name, TrajectoryOptions options)
    : state_(std::make_unique<State>()) {
  require_options(options);
  const std::size_t rows = columns.time.size();
  const auto fits = [&](const std::vector<double>& array, bool may_lack) {
    return array.size() == rows || (may_lack && array.empty());
  };
  EXACTVO_REQUIRE(columns.agent.size() == rows && fits(columns.x, false) && fits(columns.y, false) &&
                      fits(columns.heading, true) && fits(columns.vx, true) && columns.vx.size() == columns.vy.size(),
                  std::to_string(rows) + " rows");
  state_->options = std::move(options);
  state_->columns = std::move(columns);
  state_->file.file = name;
  state_->file.format = "columns";
}

TrajectoryReader::~TrajectoryReader() = default;

const TrajectoryFile& TrajectoryReader::read(const std::function<void(const TrajectoryRow&)>& take) {
  State& s = *state_;
  TrajectoryFile fresh;
  fresh.file = s.file.file;
  fresh.format = s.file.format;
  s.file = std::move(fresh);
  TrajectorySink sink(s.options, take, s.file);
  if (s.paths.empty()) {
    s.file.row_word = "row";
    s.read_columns(sink);
  }
  for (const std::filesystem::path& path : s.paths) {
    const std::string name = s.paths.size() > 1 ? path.string() : s.file.file;
    try {
      s.format->read(path, sink);
    } catch (const DataError& error) {
      if (error.file() == name) throw;
      throw DataError(error.code(), name, error.place(), error.found(), error.expected());
    }
  }
  sink.finish();
  return s.file;
}

const TrajectoryFile& TrajectoryReader::file() const {
  return state_->file;
}

void TrajectoryReader::refuse(DataCode code, std::uint64_t line, const std::string& found,
                              const std::string& expected) const {
  throw DataError(code, state_->file.file, state_->file.row_word + " " + std::to_string(line), found, expected);
}

}  // namespace exactvo::datasets
