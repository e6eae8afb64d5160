// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/runs/simulate_crowd.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/provenance.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/notices.h"
#include "figures/crowd_figures.h"
#include "support/rank_watch.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"

namespace exactvo::tools {
namespace {

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

// --- Snapshots ---

std::string snapshot_name(const std::string& record) {
  return record + ".snapshot";
}

/// Beside the recording: what run it is of, and the snapshot.
class SnapshotFile {
 public:
  /// `identity`: of the inputs and of all options that the result depends on.
  SnapshotFile(const std::string& record, std::string identity)
      : record_(record), path_(snapshot_name(record)), identity_(std::move(identity)) {}

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

formation::SimulationOptions options_of(const CrowdTask& task) {
  formation::SimulationOptions options = simulation_options(task.simulation);
  if (!parse(task.flags.precision, options.precision))
    throw UsageError("--precision", task.flags.precision, "float or double");
  options.threads = task.flags.threads;
  options.ranks = task.ranks;
  return options;
}

/// What is known before the run, where it is found quickly.
std::vector<std::string> warnings_of(const formation::Scenario& scenario, const formation::SimulationOptions& options) {
  if (scenario.robots.size() > formation::kMostClearances) {
    const std::string arrived = formation::arrived_at_start(scenario);
    return arrived.empty() ? std::vector<std::string>{} : std::vector{arrived};
  }
  formation::SimulationOptions standard;
  standard.method = formation::Method::orca;
  standard.guidance = options.guidance;
  return formation::warnings_before(scenario, standard);
}

}  // namespace

void declare_crowd_flags(CLI::App& app, CrowdFlags& flags) {
  const auto without = [&](CLI::Option* option) {
    flags.without_decisions.push_back(option);
    return option;
  };
  without(app.add_option("--every", flags.every, "Record the places at every Nth step; with --decisions none"))
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  without(app.add_option("--snapshot-every", flags.snapshot_every,
                         "Keep a snapshot every N steps, beside the recording, for --resume; with --decisions none"))
      ->check(CLI::Range(1, 1000000000));
  without(app.add_flag(
      "--resume", flags.resume,
      "With --snapshot-every: go on with an interrupted run from its last snapshot. The result is the same"));
  app.add_option(
         "--threads", flags.threads,
         "Number of threads that decide in runs without recorded decisions; 0 for one per processor. The result is "
         "the same")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  without(app.add_option("--precision", flags.precision, "float or double, both certified; with --decisions none"))
      ->capture_default_str();
}

void refuse_crowd_flags(const CrowdFlags& flags) {
  const auto reason = [](const std::string& option) {
    if (option == "--every") return "audit proves of recorded decisions that each row follows from the one before";
    if (option == "--precision") return "recorded decisions are made in doubles";
    return "snapshots are of runs whose decisions are not recorded";
  };
  for (const CLI::Option* option : flags.without_decisions)
    if (option->count() > 0) throw lacking(option->get_name(), "--decisions none", reason(option->get_name()));
}

void take_up(const std::filesystem::path& record) {
  if (!std::filesystem::exists(record)) return;
  const std::filesystem::path unfinished = datasets::unfinished_name(record);
  if (!std::filesystem::exists(snapshot_name(record.string())) || std::filesystem::exists(unfinished))
    throw datasets::DataError(datasets::DataCode::file_unwritable, record.string(), "", "a file",
                              "none, since the recording stands there until the folder is whole: move it, or give "
                              "--out another name");
  std::filesystem::rename(record, unfinished);
}

void remove_snapshot(const std::filesystem::path& record) {
  std::error_code ignored;
  std::filesystem::remove(snapshot_name(record.string()), ignored);
}

datasets::RunInfo crowd_info(const CrowdTask& task) {
  return datasets::run_info(task.read.scenario, options_of(task),
                            datasets::make_provenance(command_line(), task.simulation.seed, task.read.files), false);
}

std::optional<FinishedRun> run_on_crowd(const CrowdTask& task) {
  const CrowdFlags& flags = task.flags;
  const bool is_first = !task.ranks || task.ranks->rank() == 0;
  const formation::Scenario& scenario = task.read.scenario;
  formation::SimulationOptions options = options_of(task);
  FinishedRun finished;
  finished.file.info = crowd_info(task);
  finished.file.scenario = scenario;
  ProgressLine line(scenario.time_limit, "s simulated");
  line.show(0.0, scenario.name);
  options.progress = [&](double time) {
    line.show(time, scenario.name);
    return !interrupted();
  };
  const bool has_snapshots = flags.snapshot_every > 0;
  const std::string identity = has_snapshots || task.ranks
                                   ? identity_of(flags, task.simulation, scenario, finished.file.info.provenance)
                                   : std::string();
  if (task.ranks) require_same(fmt::format("{} snapshots={}", identity, flags.snapshot_every), task.file, *task.ranks);
  const SnapshotFile snapshot(task.record.string(), identity);
  if (has_snapshots) {
    options.snapshot_every = flags.snapshot_every;
    options.keep_snapshot = [&](const std::string& bytes) { snapshot.keep(bytes); };
    if (task.ranks) RankWatch::keeps_snapshots();
    if (flags.resume) options.resume_from = read_in_all(snapshot, task.ranks);
    if (flags.resume)
      message(options.resume_from.empty() ? "no snapshot of " + task.record.string() + ": begins at the beginning"
                                          : "goes on from " + snapshot.path());
  }
  std::vector<std::string> warnings = is_first ? warnings_of(scenario, options) : std::vector<std::string>();
  for (const std::string& warning : warnings) message("warning: " + warning);
  std::optional<datasets::CrowdRecorder> recorder;
  if (!task.record.empty() && is_first)
    recorder.emplace(task.record, scenario, flags.every,
                     has_snapshots ? datasets::Unfinished::stays : datasets::Unfinished::goes);
  if (has_snapshots && is_first && options.resume_from.empty()) remove_snapshot(task.record);
  formation::Evaluator evaluator(scenario, recorder ? &*recorder : nullptr);
  formation::RunReport report;
  try {
    report = run_crowd(scenario, options, &evaluator);
  } catch (const formation::RanksDiffer& e) {
    throw datasets::DataError(datasets::DataCode::ranks_differ, task.file, "", e.what(),
                              "machines that compute the same bits");
  } catch (const formation::CrowdError& e) {
    if (e.problem() != formation::CrowdProblem::bad_snapshot) throw refusal(task.file, e);
    throw datasets::DataError(datasets::DataCode::format_syntax, snapshot.path(), "", "a snapshot that was changed",
                              "what simulate has written; without --resume the run begins anew");
  }
  line.clear();
  const bool is_interrupted = report.interrupted || interrupted();
  if (is_interrupted && has_snapshots) message("interrupted; --resume goes on");
  if (is_interrupted) throw Interrupted();
  if (!is_first) return std::nullopt;
  if (recorder) recorder->finish();
  if (has_snapshots && !task.keeps_snapshot) remove_snapshot(task.record);
  finished.metrics = evaluator.finish(report, std::move(warnings));
  return finished;
}

bool draw_crowd_figures(const std::filesystem::path& recording, const std::filesystem::path& folder) {
  ProgressLine line(0.0, "");
  line.say("reading " + recording.string());
  const CrowdCourse course = course_of(recording);
  line.clear();
  draw(write_figures(crowd_figures(course), folder), course.name);
  return course.cut_off;
}

void write_crowd_table(const FinishedRun& run, const std::filesystem::path& recording,
                       const std::filesystem::path& folder) {
  const std::size_t lines = run.metrics.robots.size() * (run.metrics.steps + 1);
  if (lines > kMostTableLines) {
    message(fmt::format("no trajectory.csv, which would have {} lines: convert makes a table of the recording", lines));
    return;
  }
  datasets::AtomicFile table(folder / "trajectory.csv");
  datasets::write_crowd_csv(recording, table);
  table.commit(datasets::Durability::content);
}

}  // namespace exactvo::tools
