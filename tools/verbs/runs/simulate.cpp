// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo simulate: one scenario, one method, its metrics, recording and figures.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

#include "exactvo/datasets/ranks.h"
#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/notices.h"
#include "exactvo/formation/stability.h"
#include "exactvo/geometry/counted.h"
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

struct SimulateFlags {
  std::string scenario;
  SimulationFlags simulation;
  CrowdFlags crowd;
  std::string out;
  bool record_all = false;
  bool json = false;
  bool no_figures = false;
  bool fail_on_collision = false;
  bool fail_unless_arrived = false;
  bool force = false;
};

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
  constexpr std::size_t kMost = 10;
  std::string text;
  for (std::size_t k = 0; k < std::min(all.size(), kMost); ++k) {
    const formation::Collision& c = all[k];
    text += fmt::format("  collision    {} with {} '{}' from {:.4g} s to {:.4g} s, {:.3g} m deep at {:.4g} s\n",
                        shown(c.robot), name(c.kind), shown(c.with), c.from, c.until, c.depth, c.deepest_at);
  }
  if (all.size() > kMost) text += fmt::format("  collision    and {} more: see metrics.json\n", all.size() - kMost);
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

std::string lyapunov_lines(const formation::LyapunovSummary& s) {
  return fmt::format("  V of (18)    {}\n  valid V      {}\n", course_words(s.paper), course_words(s.sound));
}

/// Where it was not kept.
std::string margin_line(const formation::Metrics& m) {
  if (!m.robot_margin || m.robot_margin->pair_rows == 0) return "";
  const formation::RobotMarginCourse& margin = *m.robot_margin;
  return fmt::format("  margin       {} of robots nearer to each other than margins.robot, {:.4g} m ({})\n",
                     geometry::counted(margin.pair_rows, "pair-row"), margin.asked,
                     geometry::counted(margin.robots, "robot"));
}

std::string summary(const FinishedRun& run) {
  const formation::Metrics& m = run.metrics;
  std::string text = fmt::format("{}, method {}", shown(run.file.info.scenario), run.file.info.method);
  if (run.file.info.guidance) text += fmt::format(", guidance {}", *run.file.info.guidance);
  if (run.file.info.liveness) text += fmt::format(", liveness {}", *run.file.info.liveness);
  if (run.file.info.controller) text += fmt::format(", controller {}", *run.file.info.controller);
  text += ": " + shown(m.outcome) + "\n" + collision_lines(m.collisions);
  for (const auto& robot : m.robots) text += robot_line(robot, !run.file.scenario.formation);
  if (run.file.scenario.formation) text += formation_lines(m) + lyapunov_lines(*m.lyapunov);
  for (const std::string& words : m.stuck) text += fmt::format("  stuck        {}\n", shown(words));
  return text + fmt::format(
                    "  clearance    to obstacles {}, between robots {}\n{}"
                    "  jitter       {:.4g} m/s^2, {}, {}\n"
                    "  velocity     total variation {:.4g} m/s, peak acceleration {:.4g} m/s^2\n"
                    "  half-planes  {} not certified, relaxed in {}\n"
                    "  steps        {} in {:.3g} s of wall time\n",
                    or_dash(m.min_obstacle_clearance, "m"), or_dash(m.min_robot_clearance, "m"), margin_line(m),
                    m.jitter, geometry::counted(m.heading_reversals, "heading reversal"),
                    geometry::counted(m.active_set_switches, "active-set switch", "active-set switches"),
                    m.velocity_variation, m.peak_acceleration, m.uncertified_half_planes,
                    geometry::counted(m.relaxed_steps, "decision"), m.steps, m.wall_time);
}

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) message("warning: " + warning);
}

/// How fast a formation can form, and where its slots are, said before the run.
void announce(const formation::Scenario& scenario, const formation::SimulationOptions& options) {
  if (!scenario.formation) return;
  if (const std::string moved = formation::recentring_notice(scenario, options); !moved.empty()) message(moved);
  const formation::Stability s = stability_of(*scenario.formation);
  const bool has_limit = options.integrator == formation::Integrator::euler;
  message(fmt::format("formation: eigenvalues of L + B from {:.4g} to {:.4g}; the slowest mode decays at {:.4g} 1/s{}",
                      s.eigenvalues.front(), s.eigenvalues.back(), s.convergence_rate,
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

std::string results(const SimulateFlags& flags, const FinishedRun& finished) {
  return flags.json ? finished.metrics_json() : summary(finished);
}

/// Printed before it is published: where stdout takes no more, nothing is written at all.
FinishedRun run_into_folder(const SimulateFlags& flags, const datasets::LoadedScenario& read,
                            const formation::SimulationOptions& options) {
  const std::optional<datasets::RunInfo> replaced = run_in(flags.out);
  StagedFolder folder(flags.out);
  FinishedRun finished = run_with_progress(flags, read, options, folder.path());
  if (!flags.no_figures) {
    const TerminateOnSignal terminate_on_signal;
    draw_figures_of(finished.file, folder.path() / "figures");
    ProgressLine line(0.0, "");
    line.say("making explorer.html of " + read.scenario.name);
    const std::string title = in_words(datasets::run_info(read.scenario, options, {}));
    write_text(folder.path() / kPageName, explorer_page({{page_key(title), title, "", finished.packed}}));
  }
  if (interrupted()) throw Interrupted();
  print(results(flags, finished));
  if (flags.no_figures) remove_figures(flags.out);
  folder.publish("metrics.json");
  message("wrote " + flags.out + (replaced ? ", in place of an earlier run of " + in_words(*replaced) : ""));
  return finished;
}

FinishedRun run_and_print(const SimulateFlags& flags, const datasets::LoadedScenario& read,
                          const formation::SimulationOptions& options,
                          std::shared_ptr<datasets::AtomicFile> recording) {
  FinishedRun finished = run_with_progress(flags, read, options, {}, std::move(recording));
  is_stdout(flags.crowd.record) ? print_to_stderr(results(flags, finished)) : print(results(flags, finished));
  return finished;
}

/// What `--record` names, before anything can go wrong: who reads it waits for its end, whatever it is.
std::shared_ptr<datasets::AtomicFile> opened_recording(const std::string& path) {
  if (path.empty()) return nullptr;
  const bool has_other_end = is_stdout(path) || path.rfind("/dev/", 0) == 0;  // what a shell has made
  if (!has_other_end) message("begins once " + path + " is read");
  return std::make_shared<datasets::AtomicFile>(is_stdout(path) ? "-" : path, datasets::MissingFolder::is_made,
                                                datasets::Unfinished::goes, datasets::Pipe::is_written);
}

/// From so many robots on, a step of two grids of them that cross takes more than 50 ms of a processor.
constexpr std::size_t kManyRobots = 500;

/// The engine is never chosen for the user, who may not know of the other one.
void note_crowd(const datasets::LoadedScenario& read) {
  const formation::Scenario& scenario = read.scenario;
  const bool wants_plans = read.names_liveness && scenario.liveness != formation::Liveness::off;
  if (scenario.robots.size() < kManyRobots || wants_plans || !crowd_problems(scenario).empty()) return;
  message(
      fmt::format("note: {} robots: --engine crowd can be more than a hundred times as fast, with method orca and "
                  "without joint plans (docs/guide/crowd-recordings.md)",
                  scenario.robots.size()));
}

/// `ranks`: null where this process is alone.
ExitCode simulate(const SimulateFlags& flags, formation::Ranks* ranks) {
  const bool is_crowd = wants_crowd(flags.crowd, flags.simulation, flags.out);
  if (ranks && !is_crowd)
    throw UsageError("--engine", flags.crowd.engine, "crowd, the only engine that runs over ranks of MPI");
  if (ranks && flags.scenario == "-")
    throw UsageError("scenario", "-", "a file: every rank reads it, and only the first has a stdin");
  formation::SimulationOptions options = simulation_options(flags.simulation);
  options.record_all = flags.record_all;
  options.threads = flags.crowd.threads;
  std::shared_ptr<datasets::AtomicFile> recording = is_crowd ? nullptr : opened_recording(flags.crowd.record);
  const datasets::LoadedScenario read = read_scenario(flags.scenario);
  if (is_crowd) return simulate_crowd(flags.crowd, flags.simulation, flags.scenario, read, flags.json, ranks);
  const formation::Scenario& scenario = read.scenario;
  note_unused(flags.simulation, scenario);
  note_liveness(flags.simulation, scenario, options);
  note_crowd(read);
  if (!flags.out.empty()) {
    check_output_folder(flags.out);
    if (!flags.force) check_same_run(flags.out, datasets::run_info(scenario, options, {}));
  }
  announce(scenario, options);
  const FinishedRun finished = flags.out.empty() ? run_and_print(flags, read, options, std::move(recording))
                                                 : run_into_folder(flags, read, options);
  const bool failed = (flags.fail_on_collision && !finished.metrics.collisions.empty()) ||
                      (flags.fail_unless_arrived && !finished.metrics.all_arrived);
  return failed ? ExitCode::negative : ExitCode::success;
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
  const bool may_have_ranks = flags.crowd.engine == "crowd" || datasets::ranks_started() > 1;
  const std::unique_ptr<formation::Ranks> ranks = may_have_ranks ? datasets::join_ranks() : nullptr;
  if (!ranks) return simulate(flags, nullptr);
  return over_ranks(*ranks, [&] { return simulate(flags, ranks.get()); });
}

void declare_simulate(CLI::App& app, SimulateFlags& flags) {
  app.add_option("scenario", flags.scenario, "JSON file, or - for stdin")->required();
  declare_simulation_flags(app, flags.simulation);
  declare_out(app, flags.out,
              "Folder for recording.jsonl, trajectory.csv, metrics.json, lyapunov.csv (formations), figures/ and "
              "explorer.html; "
              "whole or not at all");
  app.add_flag(
      "--record-all", flags.record_all,
      "Record every half-plane, not only the active ones and those of what the robot could reach within a time step");
  app.add_flag("--json", flags.json, "Print the metrics as JSON");
  app.add_flag("--no-figures", flags.no_figures, "Write no figures and no explorer.html");
  app.add_flag("--fail-on-collision", flags.fail_on_collision, "Exit status 1 if a robot overlaps anything");
  app.add_flag("--fail-unless-arrived", flags.fail_unless_arrived,
               "Exit status 1 if a robot did not arrive: at its last goal, or, in a formation, at its slot with the "
               "leader at its end");
  app.add_flag("--force", flags.force,
               "Let --out replace an earlier run of another scenario, method, guidance, liveness or controller");
  declare_crowd_flags(app, flags.crowd);
}

}  // namespace

Verb simulate_verb() {
  return {"simulate", "Run one scenario",
          "  exactvo simulate datasets/data/paper/A2.json --method ivo --out out/A2\n"
          "  exactvo simulate datasets/data/office/office.json --out out/office\n"
          "  exactvo simulate datasets/data/paper/B1.json --controller paper-signs --json\n"
          "  exactvo simulate datasets/data/paper/B3.json --ablation 'no margins' --controller-option smoothing=on\n"
          "  exactvo simulate crowd.json --engine crowd --record out/crowd.evr --every 10\n"
          "  exactvo simulate large.json --record - | exactvo audit -\n"
          "  mpirun -n 4 exactvo simulate crowd.json --engine crowd --record out/crowd.evr\n"
          "  exactvo simulate datasets/data/paper/A7.json --record-all --out out/A7 && exactvo audit out/A7\n",
          with_flags(declare_simulate, simulate_anywhere)};
}

}  // namespace exactvo::tools
