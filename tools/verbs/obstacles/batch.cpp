// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo batch: every obstacle of every file decomposed, enclosed and certified.
#include "exactvo/datasets/batch.h"
#include "exactvo/geometry/counted.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <csignal>
#include <iterator>
#include <utility>

#include "exactvo/datasets/input_text.h"
#include "support/escape.h"
#include "support/parse_errors.h"
#include "support/robot_numbers.h"
#include "support/simulation_flags.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/obstacles/obstacle_files.h"

namespace exactvo::tools {

using geometry::counted;

namespace {

using datasets::BatchConfiguration;
using datasets::BatchEnd;
using datasets::BatchProgress;
using datasets::BatchRun;
using datasets::BatchSummary;

struct BatchFlags {
  std::vector<std::string> paths;
  std::string out;
  int workers = 0;
  bool resume = false;
  bool repair = false;
  std::uint64_t limit_memory = 0;
  std::string shard;
  ReadingFlags reading;
  double tolerance = 0.0;
  std::string write = "measurements,pictures";
  bool metres = false;
  std::optional<double> time_horizon;
  double radius = 0.0;
  std::string velocity = "0,0";
  std::vector<std::string> positions;
  std::string goal;
};

void choose_outputs(const std::string& text, BatchConfiguration& configuration) {
  const std::vector<std::string> known{"geopackage", "geojson", "pictures", "measurements"};
  std::vector<std::string> words;
  for (const std::string& word : boost::split(words, text, boost::is_any_of(",")))
    require(std::count(known.begin(), known.end(), word) > 0, "--write", word,
            "geopackage, geojson, pictures, measurements" + suggestion(word, known));
  const auto has = [&](const char* word) { return std::count(words.begin(), words.end(), word) > 0; };
  configuration.geopackage = has("geopackage");
  configuration.geojson = has("geojson");
  configuration.pictures = has("pictures");
}

void check_numbers(const BatchFlags& flags) {
  require_length("--tolerance", flags.tolerance);
  if (!is_radius(flags.radius)) throw UsageError("--radius", fmt::format("{}", flags.radius), kRadii);
  const std::optional<double>& horizon = flags.time_horizon;
  if (horizon && !is_horizon(*horizon))
    throw UsageError("--time-horizon", fmt::format("{}", *horizon), "a time from 2^-100 s to 2^100 s");
}

std::optional<datasets::BatchRobot> robot_of(const BatchFlags& flags) {
  const bool given = flags.time_horizon || flags.radius > 0.0 || !flags.positions.empty() || !flags.goal.empty();
  if (!given) return std::nullopt;
  if (!flags.time_horizon) throw UsageError("--time-horizon", "none", "seconds, more than 0, with a robot");
  if (flags.positions.empty()) throw UsageError("--position", "none", "X,Y, once or more, with a robot");
  datasets::BatchRobot robot;
  robot.radius = flags.radius;
  robot.time_horizon = *flags.time_horizon;
  robot.velocity = parse_point("--velocity", flags.velocity);
  for (const std::string& text : flags.positions) robot.positions.push_back(parse_point("--position", text));
  if (!flags.goal.empty()) robot.goal = parse_point("--goal", flags.goal);
  return robot;
}

BatchConfiguration configuration_of(const BatchFlags& flags) {
  check_numbers(flags);
  BatchConfiguration configuration;
  configuration.reading = reading_options(flags.reading);
  configuration.reading.repair = flags.repair;
  configuration.shapes.facades.tolerance = flags.tolerance;
  configuration.memory_limit = flags.limit_memory;
  configuration.robot = robot_of(flags);
  choose_outputs(flags.write, configuration);
  configuration.geojson_in_metres = flags.metres;
  if (configuration.geopackage && !datasets::built_with_gdal()) {
    message("note: built without GDAL, so no GeoPackage is written");
    configuration.geopackage = false;
  }
  return configuration;
}

/// The command line without what leaves the results as they are, so that a resumed run's provenance is the same: how
/// it is run, and where the results lie.
std::vector<std::string> reproducible_arguments(const std::vector<std::string>& words) {
  const auto takes_value = [](const std::string& w) {
    return w == "-j" || w == "--jobs" || w == "--shard" || w == "--out" || w == "-o";
  };
  const auto stands_alone = [](const std::string& w) {
    const auto begins = [&](const char* start) { return w.rfind(start, 0) == 0; };
    return w == "--resume" || w == "--quiet" || w == "-q" || begins("--jobs=") || begins("--shard=") ||
           begins("--out=") || begins("-j") || begins("-o");
  };
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (takes_value(words[i])) {
      ++i;
    } else if (!stands_alone(words[i])) {
      kept.push_back(i == 0 ? "exactvo" : words[i]);
    }
  }
  return kept;
}

BatchRun run_of(const BatchFlags& flags) {
  BatchRun run;
  run.paths.assign(flags.paths.begin(), flags.paths.end());
  run.out = flags.out;
  run.workers = flags.workers == 0 && datasets::under_mpi() ? 1 : flags.workers;  // ranks share a machine's processors
  run.resume = flags.resume;
  run.command_line = reproducible_arguments(command_line());
  if (flags.shard.empty()) return run;
  char rest = 0;
  const bool two = std::sscanf(flags.shard.c_str(), "%zu/%zu%c", &run.shard, &run.shards, &rest) == 2;
  if (!two || run.shard < 1 || run.shard > run.shards) throw UsageError("--shard", flags.shard, "i/n with 1 <= i <= n");
  return run;
}

/// What is written, times the input: measured on 20,000 polygons of 14 corners as WKT. Grids and compressed files may
/// give much more.
constexpr double kMeasurementsOfInput = 1.3;
constexpr double kGeoPackageOfInput = 31.0;
constexpr double kGeoJsonOfInput = 41.0;

/// Sizes to expect, before the work; twice as much stands on the disk while parts and outputs do.
void say_sizes(const BatchConfiguration& c, const BatchProgress& progress, const std::string& out) {
  const auto input = static_cast<double>(progress.input_bytes);
  const double factor =
      kMeasurementsOfInput + (c.geopackage ? kGeoPackageOfInput : 0.0) + (c.geojson ? kGeoJsonOfInput : 0.0);
  std::string text =
      fmt::format("{}{}, {}: about {} in {}", counted(progress.inputs, "file"),
                  progress.ranks > 1 ? " in each rank" : "", size_text(input), size_text(factor * input), out);
  if (!c.geopackage) text += fmt::format("; --write geopackage adds about {}", size_text(kGeoPackageOfInput * input));
  if (!c.geojson) text += fmt::format("; --write geojson adds about {}", size_text(kGeoJsonOfInput * input));
  message(text);
  std::error_code error;
  const std::filesystem::space_info disk = std::filesystem::space(out, error);
  if (!error && 2.0 * factor * input * progress.ranks > static_cast<double>(disk.available))
    message(fmt::format("warning: {} are free there, and twice the results are needed meanwhile",
                        size_text(static_cast<double>(disk.available))));
}

/// On a terminal's line, or in a message now and then.
void show(const BatchProgress& progress, ProgressLine& line) {
  if (!line.is_due()) return;
  const double left = progress.share_done > 0.0 ? line.elapsed() * (1.0 / progress.share_done - 1.0) : 0.0;
  const std::string text = fmt::format("{} of {}, {:.0f} %, {}, {:.0f}/s, {:.0f} s left: {}", progress.inputs_done,
                                       counted(progress.inputs, "file"), 100.0 * progress.share_done,
                                       counted(progress.obstacles, "obstacle"),
                                       static_cast<double>(progress.obstacles) / line.elapsed(), left, progress.doing);
  line.enabled() ? line.show(progress.share_done, text) : message(text);
}

std::string words_of(const datasets::BatchTally& tally, const char* what) {
  std::string text = fmt::format("{}: {} done, {} repaired, {} rejected", counted(tally.read, what), tally.done,
                                 tally.repaired, tally.rejected_in_all());
  for (const auto& [code, count] : tally.rejected) text += fmt::format(", {} {}", code, count);
  return text;
}

/// For a shard only what the last one did is known, and how long that took: no rate of the whole.
std::string words_of(const BatchSummary& s, const std::string& out, bool with_rates) {
  std::string text = words_of(s.files, "file") + "\n" + words_of(s.obstacles, "obstacle");
  text += fmt::format("\n{} skipped (points, empty geometries)\n", counted(s.passed_over, "input"));
  text += fmt::format("{} in {}: {} certified, {} uncertified, {}\n", counted(s.obstacles_out, "obstacle"), out,
                      s.certified, s.uncertified, counted(s.vertices, "vertex", "vertices"));
  if (with_rates && s.obstacles_now > 0 && s.seconds > 0.0) {
    text +=
        fmt::format("{:.3g} s, {:.0f} obstacles/s, {:.0f} vertices/s\n", s.seconds,
                    static_cast<double>(s.obstacles_now) / s.seconds, static_cast<double>(s.vertices_now) / s.seconds);
  }
  return text;
}

/// On stderr, so that nobody takes a batch of bad files for a good one; all of them are in summary.json.
void name_rejected(const BatchSummary& summary, const std::string& out) {
  constexpr std::size_t kMostNamed = 20;
  const std::vector<datasets::RejectedFile>& all = summary.rejected_files;
  for (std::size_t k = 0; k < std::min(all.size(), kMostNamed); ++k)
    message(fmt::format("rejected: {}: {}", all[k].path, all[k].code));
  if (all.size() > kMostNamed) message(fmt::format("and {} more, see {}/summary.json", all.size() - kMostNamed, out));
}

/// What was assumed of whole files, each text once.
void say_batch_notes(const BatchSummary& summary, const std::string& out) {
  constexpr std::size_t kMostSaid = 20;
  const std::vector<datasets::BatchNote>& notes = summary.notes;
  for (std::size_t k = 0; k < std::min(notes.size(), kMostSaid); ++k) {
    const std::string others =
        notes[k].files > 1 ? fmt::format(" and {}", counted(notes[k].files - 1, "other file")) : "";
    message(shown(fmt::format("{}{}: {}", notes[k].file, others, notes[k].text)));
  }
  if (notes.size() > kMostSaid)
    message(fmt::format("and {} more notes, see {}/summary.json", notes.size() - kMostSaid, out));
}

/// Nothing of them is wrong, and yet whoever takes half-planes from measurements.jsonl must know.
void note_missing_half_planes(const BatchSummary& summary, const std::string& out) {
  if (summary.no_half_plane == 0) return;
  message(fmt::format(
      "note: {} of the half-planes in {}/measurements.jsonl {} null: the robot overlaps the obstacle at that "
      "position, or is too near to prove one",
      summary.no_half_plane, out, summary.no_half_plane == 1 ? "is" : "are"));
}

ExitCode verdict(const BatchSummary& s) {
  if (s.obstacles_out == 0) message("warning: no obstacle came out");
  const bool all_came_out = s.files.rejected.empty() && s.obstacles.rejected.empty() && s.obstacles_out > 0;
  return all_came_out && s.uncertified == 0 ? ExitCode::success : ExitCode::negative;
}

ExitCode batch(const BatchFlags& flags) {
  std::signal(SIGXFSZ, SIG_IGN);     // a file size limit is then an error of the write, and said as one
  datasets::set_wait_hook(nullptr);  // it reads no pipes, and looks for interrupts itself
  const BatchConfiguration configuration = configuration_of(flags);
  const BatchRun run = run_of(flags);
  std::error_code error;
  const bool over_another =
      !flags.resume && !datasets::under_mpi() && std::filesystem::exists(flags.out + "/summary.json", error);
  ProgressLine line(1.0, "of the input");
  bool has_said_sizes = false;
  const auto watch = [&](const BatchProgress& progress) {
    if (progress.rank == 0) {
      if (!std::exchange(has_said_sizes, true)) say_sizes(configuration, progress, flags.out);
      show(progress, line);
    }
    return !interrupted();
  };
  const datasets::BatchResult result = datasets::under_mpi() ? datasets::run_batch_over_ranks(configuration, run, watch)
                                                             : datasets::run_batch(configuration, run, watch);
  line.clear();
  for (const datasets::EarlierBatch& earlier : result.earlier)
    message(fmt::format("note: not read: {} holds an earlier batch ({}); a file that is named is read", earlier.folder,
                        counted(earlier.files, "file")));
  if (result.end == BatchEnd::interrupted) {
    error_message("interrupted; --resume goes on");
    return ExitCode::interrupted;
  }
  if (result.end == BatchEnd::incomplete) {
    if (run.shards > 1)
      message(
          fmt::format("shard {}/{} is complete. The last shard to finish joins the results", run.shard, run.shards));
    else if (!datasets::under_mpi())
      message("another process took the parts of this batch from " + flags.out + " and left no summary");
    return ExitCode::success;
  }
  if (result.was_complete) message("nothing left to do");
  if (over_another && !result.was_complete) message("note: replaced the earlier batch in " + flags.out);
  print(words_of(result.summary, flags.out, run.shards == 1));
  say_batch_notes(result.summary, flags.out);
  name_rejected(result.summary, flags.out);
  note_missing_half_planes(result.summary, flags.out);
  return verdict(result.summary);
}

void declare_batch(CLI::App& app, BatchFlags& flags) {
  app.add_option("paths", flags.paths, "Files and folders; outputs of earlier batches inside the folders are ignored")
      ->required();
  declare_out(app, flags.out, "Folder for the results")->required();
  app.add_option("-j,--jobs", flags.workers,
                 "Worker threads; by default one per processor, or one per rank under mpirun")
      ->check(whole_number(1, 4096));
  app.add_flag("--resume", flags.resume, "Continue an interrupted batch in the folder, or join one that is running");
  app.add_option("--limit-memory", flags.limit_memory, "Memory for obstacles being processed, such as 2GB")
      ->transform(CLI::AsSizeValue(false));
  app.add_option("--shard", flags.shard,
                 "i/n: every n-th file from the i-th on; the last shard to finish merges the results");
  app.add_option(
         "--write", flags.write,
         "Outputs, from measurements (always), pictures, geopackage, geojson; the last two are some 30 and 40 times "
         "the input")
      ->capture_default_str();
  app.add_flag("--metres", flags.metres,
               "GeoJSON in metres, which other programs read as degrees; by default longitude and latitude");
  app.add_flag("--repair", flags.repair, "Repair invalid geometry: self-crossings, overlaps, misplaced holes");
  declare_reading_flags(app, flags.reading);
  app.add_option("--tolerance", flags.tolerance, "Largest distance of a facade from its obstacle, m")
      ->capture_default_str();
  app.add_option("--time-horizon", flags.time_horizon, "Horizon of the velocity obstacles, s");
  app.add_option("--radius", flags.radius, "Radius of the robot, m");
  app.add_option("--position", flags.positions, "X,Y of the robot, m; may be repeated")->allow_extra_args(false);
  app.add_option("--velocity", flags.velocity, "X,Y, m/s; the half-planes are those nearest to this velocity")
      ->capture_default_str();
  app.add_option("--goal", flags.goal,
                 "X,Y, m; trap-free ellipses are fitted for a robot going there from the first position");
}

}  // namespace

Verb batch_verb() {
  return {"batch", "Decompose, enclose and certify every obstacle of every file",
          "  exactvo batch maps --out out/maps -j 4 --repair\n"
          "  exactvo batch maps --out out/maps -j 4 --repair --resume     (after an interruption, or next to a running "
          "batch)\n"
          "    (status 1: a file or an obstacle was rejected, a result is not certified, or no obstacle was produced)\n"
          "  mpirun -n 4 exactvo batch maps --out out/maps -j 1\n"
          "  exactvo batch map.yaml --out out/map --time-horizon 3 --radius 0.3 --position 1,2 --position 4,2\n",
          with_flags(declare_batch, batch)};
}

}  // namespace exactvo::tools
