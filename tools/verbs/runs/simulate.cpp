// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo simulate: one scenario, one method, its metrics, recording and figures.
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/datasets/ranks.h"
#include "exactvo/datasets/run_info.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/notices.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/formation/stability.h"
#include "exactvo/geometry/counted.h"
#include "explorer/packed_run.h"
#include "explorer/page.h"
#include "support/escape.h"
#include "support/files.h"
#include "support/rank_watch.h"
#include "support/run.h"
#include "support/simulation_flags.h"
#include "support/stop.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/runs/simulate_crowd.h"

namespace exactvo::tools {

namespace {

/// Its first line says what was run and how it ended. Of many robots those that did not arrive are named first, and
/// few.
std::string run_summary(const datasets::RunInfo& info, const formation::Scenario& scenario,
                        const formation::Metrics& metrics);

/// Lines of a kind; metrics.json has all.
constexpr std::size_t kMostLines = 10;
/// Up to this many robots have a line each.
constexpr std::size_t kMostRobots = 50;

std::string or_dash(const std::optional<double>& value, const char* unit) {
  return value ? fmt::format("{:.4g} {}", *value, unit) : "-";
}

/// A robot of a formation has no goal to arrive at.
std::string robot_line(const formation::RobotMetrics& robot, bool has_goal) {
  std::string arrival = robot.arrived ? "arrived at " + or_dash(robot.arrival_time, "s") + ", " : "did not arrive, ";
  if (!has_goal) arrival.clear();
  const std::string detour = robot.detour ? fmt::format(" ({:.3g} m more than {})", *robot.detour,
                                                        has_goal ? "straight to its goals" : "its slot's")
                                          : "";
  const std::string slot =
      robot.largest_slot_error ? fmt::format(", up to {:.3g} m from its slot", *robot.largest_slot_error) : "";
  return fmt::format("  {:<12} {}path length {:.4g} m{}{}, minimum clearance to obstacles {}{}\n", shown(robot.id),
                     arrival, robot.path_length, detour, slot, or_dash(robot.min_obstacle_clearance, "m"),
                     formation::touched(robot.min_obstacle_clearance) ? ": overlapped an obstacle" : "");
}

/// The first of them; metrics.json has all.
std::string collision_lines(const std::vector<formation::Collision>& all) {
  std::string text;
  for (std::size_t k = 0; k < std::min(all.size(), kMostLines); ++k) {
    const formation::Collision& c = all[k];
    text += fmt::format("  collision    {} with {} '{}' from {:.4g} s to {:.4g} s, {:.3g} m deep at {:.4g} s{}\n",
                        shown(c.robot), name(c.kind), shown(c.with), c.from, c.until, c.depth, c.deepest_at,
                        c.standing ? ", while it stood" : "");
  }
  if (all.size() > kMostLines)
    text += fmt::format("  collision    and {} more: see metrics.json\n", all.size() - kMostLines);
  return text;
}

std::string formation_lines(const formation::Metrics& m) {
  const formation::FormationCourse& course = *m.formation_course;
  const std::string largest = course.largest_error > 0.0
                                  ? fmt::format("largest error {:.3g} m, of {} at {:.4g} s", course.largest_error,
                                                shown(course.largest_error_of), course.largest_error_at)
                                  : std::string("no error at any time");
  return fmt::format(
      "  formation    position error {}, velocity error {} at the end; leader at the end of its path: {}\n"
      "  formation    {}; first formed at {}, holds since {}\n"
      "  formation    formed for {:.3g} % of the time, root mean square of slot errors {:.3g} m\n",
      or_dash(m.formation_position_error, "m"), or_dash(m.formation_velocity_error, "m/s"),
      or_dash(m.leader_arrival_time, "s"), largest, or_dash(course.first_formed, "s"),
      or_dash(course.formed_since, "s"), 100.0 * course.share_formed, course.rms_error);
}

std::string course_words(const formation::LyapunovCourse& c) {
  const std::string rise =
      c.largest_rise > 0.0 ? fmt::format("rises by up to {:.3g} per step", c.largest_rise) : std::string("never rises");
  return fmt::format("{:.4g} -> {:.4g}, minimum {:.4g}, {}", c.first, c.last, c.least, rise);
}

/// Where it was not kept.
std::string margin_line(const formation::Metrics& m) {
  if (!m.robot_margin || m.robot_margin->pair_rows == 0) return "";
  const formation::RobotMarginCourse& margin = *m.robot_margin;
  return fmt::format("  margin       {} of robots nearer to each other than margins.robot, {:.4g} m ({})\n",
                     geometry::counted(margin.pair_rows, "pair-row"), margin.asked,
                     geometry::counted(margin.robots, "robot"));
}

std::string stuck_lines(const std::vector<std::string>& all) {
  std::string text;
  for (std::size_t k = 0; k < std::min(all.size(), kMostLines); ++k)
    text += fmt::format("  stuck        {}\n", shown(all[k]));
  if (all.size() > kMostLines)
    text += fmt::format("  stuck        and {} more: see metrics.json\n", all.size() - kMostLines);
  return text;
}

std::string arrival_line(const formation::Metrics& m) {
  if (m.robots.size() < 2) return "";
  return fmt::format("  arrival      {} of {}, median {}, last {}\n", m.arrived,
                     geometry::counted(m.robots.size(), "robot"), or_dash(m.median_arrival_time, "s"),
                     or_dash(m.last_arrival_time, "s"));
}

/// What was counted of decisions, and what of them is recorded.
std::string decision_lines(const datasets::RunInfo& info, const formation::Metrics& m) {
  const std::size_t count = m.robots.size() * m.steps;
  std::string text = fmt::format("  decisions    {}, {} relaxed", count, m.relaxed_steps);
  if (!m.crowd)
    return text + fmt::format(", {} half-planes not certified; recorded: {}\n", m.uncertified_half_planes,
                              info.decisions == "all" ? "all half-planes" : "half-planes that bind");
  const formation::CrowdMetrics& c = *m.crowd;
  const auto share = [&](std::size_t part) {
    return count > 0 ? static_cast<double>(part) / static_cast<double>(count) : 0.0;
  };
  return text + fmt::format(
                    ", {} cut short before another robot, {} with a reserved place, {} stopped by hard half-planes, "
                    "{} overlapping; none recorded\n"
                    "  half-planes  in a decision {:.3g} against robots, {:.3g} against edges, {:.3g} against bodies "
                    "(discs at rest and moving obstacles)\n",
                    c.cut_short, c.reserved, c.stopped, c.overlapping, share(c.against_robots), share(c.against_edges),
                    share(c.against_bodies));
}

std::string motion_lines(const formation::Metrics& m) {
  double sum = 0.0;
  for (const formation::RobotMetrics& robot : m.robots) sum += robot.path_length;
  std::string text = fmt::format("  path length  {:.4g} m on average\n",
                                 m.robots.empty() ? 0.0 : sum / static_cast<double>(m.robots.size()));
  text += fmt::format("  jitter       {:.4g} m/s^2, {}", m.jitter,
                      geometry::counted(m.heading_reversals, "heading reversal"));
  if (!m.crowd) text += ", " + geometry::counted(m.active_set_switches, "active-set switch", "active-set switches");
  return text + fmt::format("\n  velocity     total variation {:.4g} m/s, peak acceleration {:.4g} m/s^2\n",
                            m.velocity_variation, m.peak_acceleration);
}

std::string run_summary(const datasets::RunInfo& info, const formation::Scenario& scenario,
                        const formation::Metrics& m) {
  std::string text = shown(in_words(info)) + ": " + shown(m.outcome) + "\n" + collision_lines(m.collisions);
  // With many robots only those have lines that stopped elsewhere.
  if (m.robots.size() <= kMostRobots)
    for (const formation::RobotMetrics& robot : m.robots) text += robot_line(robot, !scenario.formation);
  if (scenario.formation) text += formation_lines(m);
  if (m.lyapunov)
    text += fmt::format("  V of (18)    {}\n  valid V      {}\n", course_words(m.lyapunov->paper),
                        course_words(m.lyapunov->sound));
  text += stuck_lines(m.stuck) + arrival_line(m);
  const double robot_steps = static_cast<double>(m.robots.size() * m.steps);
  text += fmt::format("  clearance    to obstacles {}, between robots {}\n{}", or_dash(m.min_obstacle_clearance, "m"),
                      or_dash(m.min_robot_clearance, "m"), margin_line(m));
  text += motion_lines(m) + decision_lines(info, m);
  for (const std::string& words : m.not_measured) text += "  not measured " + words + "\n";
  return text + fmt::format("  steps        {} in {:.3g} s of wall time, {:.3g} robot steps a second\n", m.steps,
                            m.wall_time, m.wall_time > 0.0 ? robot_steps / m.wall_time : 0.0);
}

/// Whether `--record` means stdout: "-", or another name of it. Results go to stderr then.
bool is_stdout(const std::string& path) {
  struct stat there {};
  struct stat standard {};
  if (path == "-") return true;
  return ::stat(path.c_str(), &there) == 0 && ::fstat(STDOUT_FILENO, &standard) == 0 &&
         there.st_dev == standard.st_dev && there.st_ino == standard.st_ino;
}

struct SimulateFlags {
  std::string scenario;
  SimulationFlags simulation;
  DecisionFlags decisions;
  CrowdFlags crowd;
  std::string record;
  std::string out;
  bool json = false;
  bool no_figures = false;
  bool fail_on_collision = false;
  bool fail_unless_arrived = false;
  bool force = false;
};

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) message("warning: " + warning);
}

/// How fast a formation can form, and where its slots are, said before the run.
void announce(const formation::Scenario& scenario, const formation::SimulationOptions& options) {
  if (!scenario.formation) return;
  if (const std::string moved = formation::recentring_notice(scenario, options); !moved.empty()) message(moved);
  const formation::Stability s = stability_of(*scenario.formation);
  const std::string spectrum = fmt::format("formation: eigenvalues of L + B from {:.4g} to {:.4g}; ",
                                           s.eigenvalues.front(), s.eigenvalues.back());
  if (!tracks_choices(scenario))
    return message(
        fmt::format("{}while no limit of the wheels binds, a step leaves {:.4g} of an error at most, in the long run",
                    spectrum, step_spectral_radius(*scenario.formation, std::nullopt, scenario.time_step)));
  const bool has_limit = options.integrator == formation::Integrator::euler;
  message(fmt::format("{}the slowest mode decays at {:.4g} 1/s{}", spectrum, s.convergence_rate,
                      has_limit ? fmt::format("; explicit Euler's step limit is {:.4g} s, the step {:.4g} s",
                                              s.euler_step_limit, scenario.time_step)
                                : ""));
}

/// Into the folder, which may be none, or as a recording alone.
FinishedRun run_with_progress(const SimulateFlags& flags, const datasets::LoadedScenario& read,
                              const formation::SimulationOptions& options, const std::filesystem::path& folder,
                              std::shared_ptr<datasets::AtomicFile> recording = nullptr) {
  const formation::Scenario& scenario = read.scenario;
  const auto provenance = datasets::make_provenance(command_line(), flags.simulation.seed, read.files);
  ProgressLine line(scenario.time_limit, "s simulated");
  line.show(0.0, scenario.name);  // the shapes of many robots take a while before the first step
  const TerminateOnSignal terminate_on_signal(recording ? "the recording ends early" : "nothing was written");
  const bool figures = !folder.empty() && !flags.no_figures;
  RunOutput output{folder, figures, [&](double time) { line.show(time, scenario.name); }, warn, figures};
  output.recording = std::move(recording);
  return run(scenario, options, provenance, output);
}

std::string results(const SimulateFlags& flags, const FinishedRun& run) {
  return flags.json ? run.metrics_json() : run_summary(run.file.info, run.file.scenario, run.metrics);
}

void write_page(const FinishedRun& run, const std::string& packed, const std::filesystem::path& folder) {
  ProgressLine line(0.0, "");
  line.say("making explorer.html of " + run.file.scenario.name);
  const std::string title = in_words(run.file.info);
  write_text(folder / kPageName, explorer_page({{page_key(title), title, "", packed}}));
}

/// Printed before it is published: where stdout takes no more, nothing is written at all. `beside`: the recording,
/// where it is not in the folder yet.
void publish(const SimulateFlags& flags, const FinishedRun& finished, StagedFolder& folder,
             const std::filesystem::path& beside = {}) {
  if (interrupted()) throw Interrupted();
  print(results(flags, finished));
  if (!beside.empty()) std::filesystem::rename(beside, folder.path() / "recording.evr");
  const std::optional<datasets::RunInfo> replaced = run_in(flags.out);
  if (flags.no_figures) remove_figures(flags.out);
  // Recordings of an earlier run that was made the other way, or whose table was small.
  std::error_code ignored;
  for (const char* name : {"recording.jsonl", "recording.evr", "trajectory.csv", "lyapunov.csv"})
    if (!std::filesystem::exists(folder.path() / name))
      std::filesystem::remove(std::filesystem::path(flags.out) / name, ignored);
  folder.publish("metrics.json");
  message("wrote " + flags.out + (replaced ? ", in place of an earlier run of " + in_words(*replaced) : ""));
}

/// Before the work, not after.
void check_out(const SimulateFlags& flags, const datasets::RunInfo& info) {
  if (flags.out.empty()) return;
  check_output_folder(flags.out);
  if (!flags.force) check_same_run(flags.out, info);
}

// --- With recorded decisions ---

FinishedRun run_into_folder(const SimulateFlags& flags, const datasets::LoadedScenario& read,
                            const formation::SimulationOptions& options) {
  StagedFolder folder(flags.out);
  FinishedRun finished = run_with_progress(flags, read, options, folder.path());
  if (!flags.no_figures) {
    const TerminateOnSignal terminate_on_signal;
    draw_figures_of(finished.file, folder.path() / "figures");
    write_page(finished, finished.packed, folder.path());
  }
  publish(flags, finished, folder);
  return finished;
}

/// What `--record` names, before anything can go wrong: its reader waits for an end, whatever happens.
std::shared_ptr<datasets::AtomicFile> opened_recording(const std::string& path) {
  const bool has_other_end = is_stdout(path) || path.rfind("/dev/", 0) == 0;  // what a shell has made
  if (!has_other_end) message("begins once " + path + " is read");
  return std::make_shared<datasets::AtomicFile>(is_stdout(path) ? "-" : path, datasets::MissingFolder::is_made,
                                                datasets::Unfinished::goes, datasets::Pipe::is_written);
}

FinishedRun simulate_decisions(const SimulateFlags& flags, const datasets::LoadedScenario& read,
                               const formation::SimulationOptions& options,
                               std::shared_ptr<datasets::AtomicFile> recording) {
  refuse_crowd_flags(flags.crowd);
  if (!flags.record.empty() && !recording)
    throw lacking("--record " + flags.record, "--decisions none",
                  "a recording of decisions goes to - or a pipe, or to disk with --out DIR");
  const formation::Scenario& scenario = read.scenario;
  note_unused(flags.simulation, scenario);
  note_liveness(flags.simulation, scenario, options);
  check_out(flags, datasets::run_info(scenario, options, {}));
  announce(scenario, options);
  if (!flags.out.empty()) return run_into_folder(flags, read, options);
  FinishedRun finished = run_with_progress(flags, read, options, {}, std::move(recording));
  is_stdout(flags.record) ? print_to_stderr(results(flags, finished)) : print(results(flags, finished));
  return finished;
}

// --- Without ---

/// Into the folder. Where a run must be able to go on, its recording and its snapshot stand beside the folder until all
/// else is made.
std::optional<FinishedRun> crowd_into_folder(const SimulateFlags& flags, CrowdTask task) {
  const bool is_first = !task.ranks || task.ranks->rank() == 0, has_snapshots = flags.crowd.snapshot_every > 0;
  std::optional<StagedFolder> folder;
  if (is_first) folder.emplace(flags.out);
  std::filesystem::path beside(flags.out);
  if (!beside.has_filename()) beside = beside.parent_path();
  beside += ".evr";
  task.record = has_snapshots || !is_first ? beside : folder->path() / "recording.evr";
  task.keeps_snapshot = has_snapshots;
  if (has_snapshots && is_first) take_up(beside);
  std::optional<FinishedRun> finished = run_on_crowd(task);
  if (!finished) return std::nullopt;
  const std::filesystem::path& recording = task.record;
  const std::string metrics = finished->metrics_json();
  write_text(folder->path() / "metrics.json", metrics);
  write_crowd_table(*finished, recording, folder->path());
  if (!flags.no_figures) {
    const TerminateOnSignal terminate_on_signal;
    draw_crowd_figures(recording, folder->path() / "figures");
    write_page(*finished, packed_crowd(recording, {}, metrics).packed, folder->path());
  }
  publish(flags, *finished, *folder, has_snapshots ? recording : std::filesystem::path());
  if (has_snapshots) remove_snapshot(recording);
  return finished;
}

/// Nothing in ranks other than the first.
std::optional<FinishedRun> simulate_crowd(const SimulateFlags& flags, const datasets::LoadedScenario& read,
                                          formation::Ranks* ranks) {
  if (flags.crowd.snapshot_every > 0 && flags.record.empty() && flags.out.empty())
    throw lacking("--snapshot-every", "--out DIR or --record FILE.evr", "a snapshot is of the run that is recorded");
  if (flags.crowd.resume && flags.crowd.snapshot_every == 0)
    throw lacking("--resume", "--snapshot-every N", "give the options of the run that was interrupted");
  if (!flags.record.empty() && std::filesystem::path(flags.record).extension() != ".evr")
    throw UsageError("--record", flags.record, "a name that ends in .evr, of a recording without decisions");
  if (flags.fail_on_collision && read.scenario.robots.size() > formation::kMostClearances)
    throw conflict("--fail-on-collision", fmt::format("a run of more than {} robots", formation::kMostClearances),
                   "their clearances are not measured; audit judges every motion of the recording, with its status");
  note_unused(flags.simulation, read.scenario);
  const CrowdTask task{flags.crowd, flags.simulation, flags.scenario, read, flags.record, ranks};
  check_out(flags, crowd_info(task));
  if (!flags.out.empty()) return crowd_into_folder(flags, task);
  std::optional<FinishedRun> finished = run_on_crowd(task);
  if (!finished) return std::nullopt;
  if (!flags.record.empty()) message("wrote " + flags.record);
  print(results(flags, *finished));
  return finished;
}

// --- Both ---

ExitCode status_of(const SimulateFlags& flags, const formation::Metrics& m) {
  const bool overlapped = !m.collisions.empty() || (m.crowd && m.crowd->overlapping > 0);
  const bool failed = (flags.fail_on_collision && overlapped) || (flags.fail_unless_arrived && !m.all_arrived);
  return failed ? ExitCode::negative : ExitCode::success;
}

/// `ranks`: null where this process is alone.
ExitCode simulate(const SimulateFlags& flags, formation::Ranks* ranks) {
  refuse_both(!flags.record.empty() && !flags.out.empty(), "--record", "--out",
              "--out DIR already writes the recording into the folder");
  if (!flags.record.empty() && is_stdout(flags.record) && ::isatty(STDOUT_FILENO) == 1)
    throw UsageError("--record", flags.record, "a reader of stdout, which is a terminal: --record - | exactvo audit -");
  if (ranks && flags.scenario == "-")
    throw UsageError("scenario", "-", "a file: every rank reads it, and only the first has a stdin");
  formation::SimulationOptions options = simulation_options(flags.simulation);
  std::error_code unknown;
  const bool is_streamed =
      !flags.record.empty() && (is_stdout(flags.record) || std::filesystem::is_fifo(flags.record, unknown));
  const std::string needed = is_streamed ? "--record " + flags.record : std::string();
  std::shared_ptr<datasets::AtomicFile> recording;
  if (!needed.empty() && flags.decisions.recorded != "none" && !ranks) recording = opened_recording(flags.record);
  datasets::LoadedScenario read = read_scenario(flags.scenario);
  const Way way = way_of(flags.decisions, flags.simulation, flags.scenario, read.scenario, needed, ranks != nullptr);
  if (!way.words.empty()) message(way.words);
  options.record_all = way.records_all;
  options.threads = flags.crowd.threads;
  if (!way.is_crowd) return status_of(flags, simulate_decisions(flags, read, options, recording).metrics);
  read.scenario.liveness = options.liveness.value_or(read.scenario.liveness);
  const std::optional<FinishedRun> finished = simulate_crowd(flags, read, ranks);
  return finished ? status_of(flags, finished->metrics) : ExitCode::success;
}

/// Runs `work` in every rank. What the first that fails throws is thrown there; the others end quietly, with success:
/// mpirun answers with the status of the one that failed. All but the first rank are quiet.
ExitCode over_ranks(formation::Ranks& ranks, const std::function<ExitCode()>& work) {
  if (ranks.rank() > 0) set_quiet(true);
  try {
    const RankWatch watch(ranks);
    const ExitCode code = work();
    ranks.least(0);  // the others stay until the first has written everything
    return code;
  } catch (const formation::AnotherRankFailed&) {
    return ExitCode::success;
  } catch (...) {
    if (!ranks.fail()) return ExitCode::success;
    throw;
  }
}

/// In this process, or over the ranks that mpirun has started.
ExitCode simulate_anywhere(const SimulateFlags& flags) {
  const bool may_have_ranks = flags.decisions.recorded == "none" || datasets::ranks_started() > 1;
  const std::unique_ptr<formation::Ranks> ranks = may_have_ranks ? datasets::join_ranks() : nullptr;
  if (!ranks) return simulate(flags, nullptr);
  return over_ranks(*ranks, [&] { return simulate(flags, ranks.get()); });
}

void declare_simulate(CLI::App& app, SimulateFlags& flags) {
  app.add_option("scenario", flags.scenario, "JSON file, or - for stdin")->required();
  declare_simulation_flags(app, flags.simulation);
  declare_decisions(app, flags.decisions);
  declare_out(app, flags.out,
              "Folder for the recording (recording.jsonl, without decisions recording.evr), metrics.json, "
              "trajectory.csv, lyapunov.csv (formations), figures/ and explorer.html; whole or not at all");
  app.add_option("--record", flags.record,
                 "The recording alone, without --out: with --decisions none FILE.evr; else a pipe that takes it as the "
                 "run is made, or - for stdout (results go to stderr then)");
  app.add_flag("--json", flags.json, "Print the metrics as JSON");
  app.add_flag("--no-figures", flags.no_figures, "Write no figures and no explorer.html");
  app.add_flag("--fail-on-collision", flags.fail_on_collision,
               "Exit status 1 if a robot overlaps anything; with --decisions none for at most 2000 robots");
  app.add_flag("--fail-unless-arrived", flags.fail_unless_arrived,
               "Exit status 1 if a robot did not arrive: at its last goal, or, in a formation, at its slot with the "
               "leader at its end");
  app.add_flag("--force", flags.force,
               "Let --out replace an earlier run of another scenario, method, guidance, liveness or controller, or one "
               "with recorded decisions a run without");
  declare_crowd_flags(app, flags.crowd);
}

}  // namespace

Verb simulate_verb() {
  return {"simulate", "Run one scenario",
          "  exactvo simulate datasets/data/paper/A2.json --method ivo --out out/A2\n"
          "  exactvo simulate datasets/data/office/office.json --out out/office\n"
          "  exactvo simulate datasets/data/paper/B1.json --controller paper-signs --json\n"
          "  exactvo simulate datasets/data/paper/B3.json --ablation 'no margins' --controller-option smoothing=on\n"
          "  exactvo simulate crowd.json --decisions none --every 10 --out out/crowd\n"
          "  exactvo simulate large.json --record - | exactvo audit -\n"
          "  mpirun -n 4 exactvo simulate crowd.json --out out/crowd\n"
          "  exactvo simulate datasets/data/paper/A7.json --decisions all --out out/A7 && exactvo audit out/A7\n",
          with_flags(declare_simulate, simulate_anywhere)};
}

}  // namespace exactvo::tools
