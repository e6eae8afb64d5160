// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/runs/simulate_crowd.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/provenance.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/notices.h"
#include "exactvo/geometry/counted.h"
#include "support/escape.h"
#include "support/rank_watch.h"
#include "support/terminal.h"
#include "support/usage.h"

namespace exactvo::tools {
namespace {

using formation::CrowdRunReport;
using geometry::counted;

std::string or_null(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : "null";
}

std::string or_dash(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g} s", *value) : "-";
}

double share(std::size_t count, const CrowdRunReport& r) {
  const double decisions = static_cast<double>(r.robots) * static_cast<double>(r.steps);
  return decisions > 0.0 ? static_cast<double>(count) / decisions : 0.0;
}

using RobotsNotThere = std::vector<formation::RobotNotThere>;

nlohmann::ordered_json to_json(const RobotsNotThere& robots, const formation::Scenario& scenario) {
  auto list = nlohmann::ordered_json::array();
  for (const formation::RobotNotThere& r : robots)
    list.push_back({{"robot", scenario.robots[r.robot].id}, {"why", r.why}});
  return list;
}

std::string to_json(const CrowdRunReport& r, const formation::Scenario& scenario,
                    const datasets::Provenance& provenance) {
  return fmt::format(
      "{{\"scenario\": {}, \"engine\": \"crowd\", \"method\": \"orca\", \"robots\": {}, \"arrived\": {}, "
      "\"pushed_off\": {}, "
      "\"staying\": {}, \"without_route\": {}, \"goal_taken\": {}, \"stands_still\": {}, "
      "\"steps\": {}, \"time\": {}, \"median_arrival_time\": {}, \"last_arrival_time\": {}, \"path_length\": {}, "
      "\"decisions\": {{\"relaxed\": {}, \"cut_short\": {}, \"reserved\": {}, \"overlapping\": {}, \"touching\": {}, "
      "\"widened\": {}, "
      "\"stopped\": {}}}, "
      "\"half_planes\": {{\"robots\": {}, \"edges\": {}, \"moving\": {}}}, \"digest\": \"{:016x}\", \"wall_time\": {}, "
      "\"provenance\": {}}}\n",
      nlohmann::json(scenario.name).dump(), r.robots, r.arrived, r.pushed_off, r.staying,
      to_json(r.without_route, scenario).dump(), to_json(r.goal_taken, scenario).dump(), r.stands_still, r.steps,
      r.time, or_null(r.median_arrival), or_null(r.last_arrival), r.path_length, r.relaxed, r.cut_short, r.reserved,
      r.overlapping, r.touching, r.widened, r.stopped, r.half_planes, r.edges, r.bodies, r.digest, r.wall_time,
      datasets::to_json(provenance));
}

/// The first of them; --json has all.
std::string lines_of(const char* title, const RobotsNotThere& robots, const formation::Scenario& scenario) {
  constexpr std::size_t kMost = 10;
  std::string text;
  for (std::size_t k = 0; k < std::min(robots.size(), kMost); ++k)
    text += fmt::format("  {:<12} {}: {}\n", title, shown(scenario.robots[robots[k].robot].id), shown(robots[k].why));
  if (robots.size() > kMost)
    text += fmt::format("  {:<12} and {} more: --json has all\n", title, robots.size() - kMost);
  return text;
}

/// Of who neither arrived nor is in a list.
std::string line_of_others(const CrowdRunReport& r) {
  const std::size_t others = r.robots - r.arrived - r.staying - r.goal_taken.size();
  if (others == 0) return "";
  if (r.stands_still)
    return fmt::format(
        "  standstill   {}: nothing moves, and every further step would repeat the last; the standard engine makes "
        "joint plans\n",
        counted(others, "robot"));
  return fmt::format("  on the way   {} when time ran out\n", counted(others, "robot"));
}

std::string summary(const CrowdRunReport& r, const formation::Scenario& scenario) {
  const double decisions = static_cast<double>(r.robots) * static_cast<double>(r.steps);
  return fmt::format(
      "{}, engine crowd, method orca: {} of {} arrived{}, {} without a route{}\n"
      "{}{}{}"
      "  arrival      median {}, last {}\n"
      "  decisions    {:.3g} % relaxed, {:.3g} % cut short before another robot, {:.3g} % with a reserved place, "
      "{:.3g} % stopped before an edge; "
      "{} overlapping\n"
      "  half-planes  {:.3g} against robots, {:.3g} against edges and {:.3g} against moving obstacles in a decision\n"
      "  path length  {:.4g} m on average\n"
      "  steps        {} in {:.3g} s of wall time, {:.3g} robot steps a second\n",
      shown(scenario.name), r.arrived, counted(r.robots, "robot"),
      r.pushed_off > 0 ? fmt::format(" ({} of them pushed off their goals again)", r.pushed_off) : "", r.staying,
      r.goal_taken.empty() ? "" : fmt::format(", {} whose goal is taken", r.goal_taken.size()),
      lines_of("no route", r.without_route, scenario), lines_of("goal taken", r.goal_taken, scenario),
      line_of_others(r), or_dash(r.median_arrival), or_dash(r.last_arrival), 100.0 * share(r.relaxed, r),
      100.0 * share(r.cut_short, r), 100.0 * share(r.reserved, r), 100.0 * share(r.stopped, r), r.overlapping,
      share(r.half_planes, r), share(r.edges, r), share(r.bodies, r), r.path_length / static_cast<double>(r.robots),
      r.steps, r.wall_time, decisions / r.wall_time);
}

/// What a crowd says of a scenario, "robot R: max_speed: found 0, expected ...", in the parts of a DataError.
datasets::DataError refusal(const std::string& file, const formation::CrowdError& e) {
  const std::string words = e.what(), before = ": found ", between = ", expected ";
  const std::size_t found = words.find(before), expected = words.find(between);
  if (found == std::string::npos || expected == std::string::npos)
    return {datasets::DataCode::scenario, file, "", words, "a scenario that a crowd can run"};
  const std::size_t from = found + before.size();
  return {datasets::DataCode::scenario, file, words.substr(0, found), words.substr(from, expected - from),
          words.substr(expected + between.size()) + ", for a crowd"};
}

/// An option that this engine does not have.
UsageError only_with(const std::string& option, bool is_crowd) {
  if (is_crowd) return conflict(option, "--engine crowd", "only the standard engine has that option");
  return lacking(option, "--engine crowd", "only that engine has the option");
}

// --- Snapshots ---

/// Beside the recording: what run it is of, and the snapshot.
class SnapshotFile {
 public:
  /// `identity`: of the inputs and of all options that the result depends on.
  SnapshotFile(const std::string& record, std::string identity)
      : record_(record), path_(record + ".snapshot"), identity_(std::move(identity)) {}

  void keep(const std::string& snapshot) const { datasets::write_file_atomically(path_, identity_ + "\n" + snapshot); }

  /// Empty where there is none. Throws DataError (E_OTHER_RUN) where it is of another run.
  std::string read() const {
    if (!std::filesystem::exists(path_) || !std::filesystem::exists(datasets::unfinished_name(record_))) return "";
    std::ifstream in(path_, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const std::size_t end = text.find('\n');
    if (end == std::string::npos || text.substr(0, end) != identity_)
      throw datasets::DataError(datasets::DataCode::other_run, path_, "", "the snapshot of another run",
                                "one of this scenario, these options and this version; without --resume the run "
                                "begins anew");
    return text.substr(end + 1);
  }

  void remove() const {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }

  const std::string& path() const { return path_; }

 private:
  std::string record_, path_, identity_;
};

/// What the first rank has to go on from, in all of them; empty where there is nothing.
std::string read_in_all(const SnapshotFile& file, formation::Ranks* ranks) {
  if (!ranks) return file.read();
  return ranks->broadcast(ranks->rank() == 0 ? file.read() : std::string());
}

/// Throws DataError (E_OTHER_RUN) where this rank's run is another than the first one's.
void require_same(const std::string& identity, const std::string& file, formation::Ranks& ranks) {
  if (ranks.broadcast(identity) == identity) return;
  throw datasets::DataError(datasets::DataCode::other_run, file, "rank " + std::to_string(ranks.rank()),
                            "another scenario, other options or another version than the first rank's",
                            "the same in every rank");
}

/// On one line.
std::string identity_of(const CrowdFlags& flags, const SimulationFlags& simulation, const formation::Scenario& scenario,
                        const datasets::Provenance& provenance) {
  std::string text = fmt::format("exactvo {} {} every={} precision={} guidance={} scenario={}", provenance.version,
                                 provenance.commit, flags.every, flags.precision, simulation.guidance,
                                 datasets::sha256_of(datasets::write_scenario(scenario)));
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Of the standard engine.
void check_record(const std::string& record, const std::string& out) {
  std::error_code unknown;
  refuse_both(!out.empty(), "--record", "--out", "--out DIR already writes the recording, DIR/recording.jsonl");
  if (is_stdout(record)) {
    if (::isatty(STDOUT_FILENO) == 1)
      throw UsageError("--record", record, "a reader of stdout, which is a terminal: --record - | exactvo audit -");
    return;
  }
  if (!std::filesystem::is_fifo(record, unknown))
    throw UsageError(
        "--record", record,
        "- for stdout, or a pipe; --out DIR writes a recording to disk, and --engine crowd takes FILE.evr");
}

}  // namespace

bool is_stdout(const std::string& path) {
  struct stat there {};
  struct stat standard {};
  if (path == "-") return true;
  return ::stat(path.c_str(), &there) == 0 && ::fstat(STDOUT_FILENO, &standard) == 0 &&
         there.st_dev == standard.st_dev && there.st_ino == standard.st_ino;
}

void declare_crowd_flags(CLI::App& app, CrowdFlags& flags) {
  app.add_option("--engine", flags.engine,
                 "standard: everything; crowd: many robots with goals among obstacles, method orca, every step "
                 "certified. From 500 robots on a note says where crowd would be faster")
      ->capture_default_str();
  app.add_option("--record", flags.record,
                 "With --engine crowd: FILE.evr for positions, whole or not at all. Else, without --out: a pipe that "
                 "takes the recording as the run is made, or - for stdout (results go to stderr then)");
  app.add_option("--every", flags.every, "With --record: a row every N steps")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  app.add_option("--snapshot-every", flags.snapshot_every,
                 "With --record: keep a snapshot every N steps, beside FILE, for --resume")
      ->check(CLI::Range(1, 1000000000));
  app.add_flag("--resume", flags.resume,
               "With --snapshot-every: go on with an interrupted run from its last snapshot. The result is the same");
  app.add_option("--threads", flags.threads,
                 "Number of threads of the crowd, or of the search for joint plans; 0 for one per processor. The "
                 "result is the same")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  app.add_option("--precision", flags.precision, "With --engine crowd: float or double, both certified")
      ->capture_default_str();
  flags.method = app.get_option("--method");
  for (const char* option : {"--every", "--snapshot-every", "--resume", "--precision"})
    flags.of_crowd.push_back(app.get_option(option));
  for (const char* option : {"--liveness", "--record-all", "--fail-on-collision", "--fail-unless-arrived", "--force"})
    flags.of_standard.push_back(app.get_option(option));
}

bool wants_crowd(const CrowdFlags& flags, const SimulationFlags& simulation, const std::string& out) {
  require_known("--engine", flags.engine, {"standard", "crowd"});
  const bool is_crowd = flags.engine == "crowd";
  if (!is_crowd && !flags.record.empty()) check_record(flags.record, out);
  for (const CLI::Option* option : is_crowd ? flags.of_standard : flags.of_crowd)
    if (option->count() > 0) throw only_with(option->get_name(), is_crowd);
  if (is_crowd && flags.method->count() > 0 && simulation.method != "orca")
    throw UsageError("--method", simulation.method, "orca, the only method of --engine crowd");
  if (is_crowd && !flags.record.empty() && std::filesystem::path(flags.record).extension() != ".evr")
    throw UsageError("--record", flags.record, "a name that ends in .evr");
  if (flags.snapshot_every > 0 && flags.record.empty())
    throw lacking("--snapshot-every", "--record FILE.evr", "a snapshot is of the run that is recorded");
  if (flags.resume && flags.snapshot_every == 0)
    throw lacking("--resume", "--snapshot-every N", "give the options of the run that was interrupted");
  refuse_both(is_crowd && !out.empty(), "--out", "--engine crowd",
              "a crowd is recorded in one file, --record FILE.evr, and --json prints its metrics");
  return is_crowd;
}

ExitCode simulate_crowd(const CrowdFlags& flags, const SimulationFlags& simulation, const std::string& file,
                        const datasets::LoadedScenario& read, bool json, formation::Ranks* ranks) {
  const bool is_first = !ranks || ranks->rank() == 0;
  const formation::Scenario& scenario = read.scenario;
  for (const formation::ScenarioProblem& p : crowd_problems(scenario))
    throw datasets::DataError(datasets::DataCode::scenario, file, p.pointer, p.found, p.expected);
  if (const std::string arrived = formation::arrived_at_start(scenario); is_first && !arrived.empty())
    message("warning: " + arrived);
  formation::CrowdRunOptions options;
  if (!simulation.guidance.empty())
    options.guidance =
        parse_choice<formation::Guidance>("--guidance", simulation.guidance, formation::guidance_names());
  if (!parse(flags.precision, options.precision)) throw UsageError("--precision", flags.precision, "float or double");
  options.threads = flags.threads;
  options.ranks = ranks;
  const datasets::Provenance provenance = datasets::make_provenance(command_line(), simulation.seed, read.files);
  ProgressLine line(scenario.time_limit, "s simulated");
  line.show(0.0, scenario.name);
  options.progress = [&](double time) {
    line.show(time, scenario.name);
    return !interrupted();
  };
  const bool has_snapshots = flags.snapshot_every > 0;
  const std::string identity =
      has_snapshots || ranks ? identity_of(flags, simulation, scenario, provenance) : std::string();
  if (ranks) require_same(fmt::format("{} snapshots={}", identity, flags.snapshot_every), file, *ranks);
  const SnapshotFile snapshot(flags.record, identity);
  if (has_snapshots) {
    options.snapshot_every = flags.snapshot_every;
    options.keep_snapshot = [&](const std::string& bytes) { snapshot.keep(bytes); };
    if (ranks) RankWatch::keeps_snapshots();
    if (flags.resume) options.resume_from = read_in_all(snapshot, ranks);
    if (flags.resume)
      message(options.resume_from.empty() ? "no snapshot of " + flags.record + ": begins at the beginning"
                                          : "goes on from " + snapshot.path());
  }
  std::optional<datasets::CrowdRecorder> recorder;
  if (!flags.record.empty() && is_first)
    recorder.emplace(flags.record, scenario, flags.every,
                     has_snapshots ? datasets::Unfinished::stays : datasets::Unfinished::goes);
  if (has_snapshots && is_first && options.resume_from.empty()) snapshot.remove();
  CrowdRunReport report;
  try {
    report = run_crowd(scenario, options, recorder ? &*recorder : nullptr);
  } catch (const formation::RanksDiffer& e) {
    throw datasets::DataError(datasets::DataCode::ranks_differ, file, "", e.what(),
                              "machines that compute the same bits");
  } catch (const formation::CrowdError& e) {
    if (e.problem() != formation::CrowdProblem::bad_snapshot) throw refusal(file, e);
    throw datasets::DataError(datasets::DataCode::format_syntax, snapshot.path(), "", "a snapshot that was changed",
                              "what simulate has written; without --resume the run begins anew");
  }
  line.clear();
  const bool is_interrupted = report.interrupted || interrupted();
  if (is_interrupted && has_snapshots) message("interrupted; --resume goes on");
  if (is_interrupted) throw Interrupted();
  if (!is_first) return ExitCode::success;
  if (recorder) {
    recorder->finish();
    if (has_snapshots) snapshot.remove();
    message(fmt::format("wrote {}: {} bytes", flags.record, recorder->bytes()));
  }
  print(json ? to_json(report, scenario, provenance) : summary(report, scenario));
  return ExitCode::success;
}

}  // namespace exactvo::tools
