// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo explain: one robot's velocity space at one moment, drawn and in words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_files.h"
#include "exactvo/datasets/provenance.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/datasets/run_info.h"
#include "exactvo/formation/constraint_name.h"
#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/planned_routes.h"
#include "exactvo/formation/stuck.h"
#include "explain/decision.h"
#include "figures/figure.h"
#include "figures/outlines.h"
#include "figures/plane.h"
#include "figures/velocity_space.h"
#include "support/escape.h"
#include "support/json_layout.h"
#include "support/routes_of_run.h"
#include "support/run.h"
#include "support/simulation_flags.h"
#include "support/stop.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"

namespace exactvo::tools {

using formation::ConstraintSource;
using formation::Crowd;
using formation::CrowdExplanation;
using formation::RobotStep;
using formation::Scenario;

namespace {

struct CrowdDecision {
  std::optional<Decision> decision;  ///< none where the run ends before
  double end = 0.0;                  ///< s, of the run, then
  std::vector<std::string> remarks;  ///< what half-planes do not say
};

/// The decision of a robot in the step at `time` (s, >= 0), with all half-planes; of the others it has places and
/// velocities. Multipliers are not known. `method`: how the run is made, in words. `options.progress` is replaced.
/// Throws what run_crowd throws, and Interrupted.
CrowdDecision crowd_decision(const formation::Scenario& scenario, formation::SimulationOptions options,
                             const std::string& method, std::size_t robot, double time);

/// m/s: a velocity of the lattice this near to a line counts as on it.
constexpr double kOnLatticeLine = 1e-4;

/// The obstacle that has these ends among its corners, if one has.
std::vector<std::size_t> obstacle_of(const geometry::Segment& edge, const Scenario& scenario) {
  for (std::size_t o = 0; o < scenario.obstacles.size(); ++o) {
    const std::vector<Vec2> corners = geometry::vertices_of(scenario.obstacles[o].shape);
    const auto has = [&](Vec2 p) { return std::find(corners.begin(), corners.end(), p) != corners.end(); };
    if (has(edge.a) && has(edge.b)) return {o};
  }
  return {};
}

/// Takes one decision, right before it is carried out.
class AtStep : public formation::RunSink {
 public:
  AtStep(const Scenario& scenario, std::string method, std::size_t robot, std::size_t step)
      : scenario_(scenario), method_(std::move(method)), robot_(robot), step_(step) {}

  void before_step(const formation::RunState& now) override {
    if (now.steps == step_) take(now);
  }
  CrowdDecision& taken() { return taken_; }

 private:
  void take(const formation::RunState& now) {
    const Crowd& crowd = *now.crowd;
    const CrowdExplanation e = crowd.explain(static_cast<formation::RobotId>(robot_));
    formation::Step row = places(now);
    RobotStep& step = row.robots[robot_];
    step.preferred = e.preferred;
    step.chosen = e.chosen;
    if (scenario_.robots[robot_].drive) {
      const Vec2 speeds = crowd.wheel_speeds(e.robot);
      step.wheels = formation::OnWheels{crowd.heading(e.robot), {speeds.x, speeds.y}};
    }
    // What does not turn it is not listed: the second level of the step slows it down.
    const std::vector<CrowdExplanation::Neighbour> none;
    if (e.reserved) step.note = "drives straight to a place that it has reserved; half-planes of robots do not turn it";
    Decision& d = taken_.decision.emplace();
    d.scenario = scenario_;
    d.method = method_;
    d.robot = robot_;
    d.time = row.time;
    for (const CrowdExplanation::Neighbour& n : e.reserved ? none : e.neighbours)
      add(d, step, n.half_plane, ConstraintSource::robot, n.robot, geometry::Disc{{}, 0.0}, {n.robot}, n.touching);
    for (const geometry::HalfPlane& own : e.wheels) {
      add(d, step, own, ConstraintSource::robot, robot_, geometry::Disc{{}, 0.0}, {robot_}, false);
      step.constraints.back().hard = true;
    }
    for (const CrowdExplanation::Edge& edge : e.edges)
      add(d, step, edge.half_plane, ConstraintSource::obstacle_edge, step.constraints.size(), edge.edge,
          obstacle_of(edge.edge, scenario_), edge.touching);
    for (const CrowdExplanation::Body& body : e.bodies) {
      const Owner owner = owner_of(crowd, body.body);
      add(d, step, body.half_plane, owner.source, owner.number, owner.shape, {owner.number}, body.touching);
    }
    step.status = e.kept || step.constraints.empty() ? lp::Status::optimal : lp::Status::relaxed;
    for (const formation::DecisionConstraint& c : step.constraints) {
      step.violation = std::max(step.violation, violation_of(c, step.chosen));
      d.seen.push_back(formation::seen_body(scenario_, d.bodies, row, robot_, c));
    }
    d.step = std::move(step);
    add_remarks(e);
  }

  static formation::Step places(const formation::RunState& now) {
    formation::Step row;
    row.time = now.time;
    row.robots.resize(now.positions.size());
    for (std::size_t i = 0; i < now.positions.size(); ++i) {
      row.robots[i].position = row.robots[i].anchor = now.positions[i];
      row.robots[i].velocity = row.robots[i].anchor_velocity = now.velocities[i];
    }
    for (const formation::CrowdBodyState& body : now.crowd->bodies())
      if (body.moves) row.moving.push_back({body.displacement, body.velocity});
    return row;
  }

  /// What a body of the crowd is in the scenario.
  struct Owner {
    ConstraintSource source;
    std::size_t number;  ///< of the obstacle, or of the moving obstacle
    geometry::ConvexShape shape;
  };

  /// Bodies that move, and discs at rest, come in the order of the scenario.
  Owner owner_of(const Crowd& crowd, formation::ObstacleId id) const {
    std::size_t moving = 0, obstacle = 0;
    for (const formation::CrowdBodyState& body : crowd.bodies()) {
      while (!body.moves && !scenario_.obstacles.at(obstacle).disc) ++obstacle;  // it has edges instead
      if (body.id == id && body.moves) return {ConstraintSource::moving_obstacle, moving, geometry::Disc{{}, 0.0}};
      if (body.id == id) return {ConstraintSource::enclosure, obstacle, body.shape};
      ++(body.moves ? moving : obstacle);
    }
    throw std::logic_error("a half-plane against no body of the crowd");
  }

  void add(Decision& d, RobotStep& step, const geometry::HalfPlane& half_plane, ConstraintSource source,
           std::size_t index, geometry::ConvexShape shape, std::vector<std::size_t> owners, bool touching) const {
    formation::DecisionConstraint c;
    c.half_plane = half_plane;
    c.source = source;
    c.index = index;
    c.certified = !touching;
    c.hard = source != ConstraintSource::robot;
    c.active = violation_of(c, step.chosen) > -kOnLatticeLine;
    c.time_horizon = scenario_.horizons.orca;
    c.body = d.bodies.size();
    step.constraints.push_back(c);
    d.bodies.push_back({source, std::move(shape), {}, std::move(owners)});
  }

  void add_remarks(const CrowdExplanation& e) {
    if (!(e.wish == e.chosen))
      taken_.remarks.push_back(
          fmt::format("Wished for ({:.3g}, {:.3g}) m/s, and does not get it: another robot would be met within the "
                      "step, which counts more than any half-plane.",
                      e.wish.x, e.wish.y));
    taken_.remarks.push_back(
        "Computed again: decisions of the run are not recorded, and the multipliers of its "
        "half-planes are not known.");
  }

  const Scenario& scenario_;
  std::string method_;
  std::size_t robot_, step_;
  CrowdDecision taken_;
};

CrowdDecision crowd_decision(const Scenario& scenario, formation::SimulationOptions options, const std::string& method,
                             std::size_t robot, double time) {
  constexpr double kSameRow = 1e-6;  // of a step
  AtStep at(scenario, method, robot, static_cast<std::size_t>(time / scenario.time_step + kSameRow));
  options.progress = [&](double) { return !interrupted() && !at.taken().decision; };
  const formation::RunReport report = run_crowd(scenario, options, &at);
  if (interrupted()) throw Interrupted();
  at.taken().end = report.time;
  return std::move(at.taken());
}

struct ExplainFlags {
  std::string scenario;
  SimulationFlags simulation;
  DecisionFlags decisions;
  double time = 0.0;
  std::string robot;
  std::string out;
  std::string map;
  bool json = false;
};

/// By id, or by number counted from 0 where no robot has that id.
std::size_t find_robot(const Scenario& scenario, const std::string& text) {
  std::vector<std::string> ids;
  for (const formation::Robot& robot : scenario.robots) ids.push_back(robot.id);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] == text || (std::to_string(i) == text && std::find(ids.begin(), ids.end(), text) == ids.end())) return i;
  }
  throw UsageError("--robot", text,
                   fmt::format("a number from 0 to {} or an id: {}{}", ids.size() - 1, formation::abridged(ids),
                               suggestion(text, ids)));
}

/// Throws UsageError for a time after the end of the run.
void check_time(std::size_t rows, double end, double time_step, double time) {
  if (rows < 2) throw UsageError("--time", fmt::format("{}", time), "a time before the end of the run");
  if (time > end + 0.5 * time_step)
    throw UsageError("--time", fmt::format("{}", time), fmt::format("at most {:.10g} s, when the run ends", end));
}

/// The last row in which a decision was taken: the final row of a recording has none.
const formation::Step& last_decision(const formation::Recording& recording) {
  return recording.steps[recording.steps.size() - 2];
}

struct Explained {
  Decision decision;
  std::vector<std::string> remarks = {};            ///< of the run so far
  std::optional<formation::RouteAhead> ahead = {};  ///< of a robot along a route, or whose goal is out of reach
};

std::optional<formation::RouteAhead> route_ahead_of(const Decision& d, const formation::Recording& recording,
                                                    const std::optional<formation::SimulationOptions>& options) {
  const bool has_route = d.step.mode == formation::Mode::guided || d.step.mode == formation::Mode::staying;
  if (!has_route || !options || d.scenario.formation) return std::nullopt;
  std::size_t goal = 0;
  for (const formation::GoalBodies& of_goal : recording.goal_bodies)
    if (of_goal.robot == d.robot && of_goal.time <= d.time) goal = of_goal.goal;
  return route_ahead(d.scenario, *options, d.robot, goal, d.step.position);
}

/// Warnings of the run, what keeps the robot from turning, and, if it hardly moves, what it rests on. `stuck`: which
/// robots are, at that time.
std::vector<std::string> remarks_on(const Decision& decision, const formation::Recording& recording,
                                    const std::vector<formation::StuckReport>& stuck) {
  constexpr double kAtRest = 0.01;  // of its greatest speed
  std::vector<std::string> remarks;
  for (const std::string& warning : recording.warnings) remarks.push_back("Warning: " + warning + ".");
  for (const formation::StuckReport& report : stuck)
    if (report.robot == decision.robot && report.speed < kAtRest * decision.who().max_speed)
      remarks.push_back("Stuck: " + report.text + ".");
  if (decision.step.lacks_room_to_turn)
    remarks.push_back("Turning: obstacles leave its footprint no room to turn towards where it wants to go.");
  return remarks;
}

Explained decide(const ExplainFlags& flags, const Scenario& scenario) {
  formation::SimulationOptions options = simulation_options(flags.simulation);
  options.stop_at = flags.time;
  options.progress = [](double) { return !interrupted(); };
  const std::size_t robot = find_robot(scenario, flags.robot);
  const TerminateOnSignal terminate_on_signal;
  const formation::Recording recording = formation::simulate(scenario, options);
  if (interrupted()) throw Interrupted();
  check_time(recording.steps.size(), recording.steps.empty() ? 0.0 : recording.steps.back().time, recording.time_step,
             flags.time);
  Explained explained{decision_of(scenario, method_words(datasets::run_info(scenario, options, {})), robot,
                                  last_decision(recording), recording.bodies, true)};
  explained.remarks = remarks_on(explained.decision, recording, formation::explain_stuck(scenario, recording));
  explained.ahead = route_ahead_of(explained.decision, recording, options);
  return explained;
}

/// The run as it was at a time, from its rows one after the other: up to the row after the last one at or before it.
class RunUntil {
 public:
  explicit RunUntil(double time) : time_(time) {}

  void add(const datasets::RecordingFile& so_far, formation::Step row) {
    constexpr double kSameRow = 1e-6;  // of a step: 6 * 0.05 is not 0.3 in doubles
    ++rows_;
    end_ = row.time;
    is_cut_ = is_cut_ || (rows_ > 2 && !(last_->time <= time_ + kSameRow * so_far.recording.time_step));
    if (is_cut_) return;
    if (!stuck_) stuck_.emplace(scenario_ = so_far.scenario);
    decided_ = std::move(last_);
    last_ = std::make_shared<const formation::Step>(std::move(row));
    if (rows_ == 1) first_ = last_;
    stuck_->add(last_);
  }

  std::size_t rows() const { return rows_; }
  double end() const { return end_; }
  const formation::Step& decision() const { return *decided_; }
  /// Uses everything of `run` but its rows.
  std::vector<formation::StuckReport> stuck(formation::Recording& run) const {
    run.steps = {*first_, *last_};
    if (is_cut_) run.diverged = formation::has_diverged(run);
    return stuck_->reports(run);
  }

 private:
  double time_;
  std::size_t rows_ = 0;
  double end_ = 0.0;
  bool is_cut_ = false;
  Scenario scenario_;  ///< the watch refers to it
  std::optional<formation::StuckWatch> stuck_;
  std::shared_ptr<const formation::Step> first_, decided_, last_;
};

Explained decision_in(const ExplainFlags& flags, const std::filesystem::path& path) {
  RunUntil until(flags.time);
  datasets::RecordingFile file =
      datasets::read_recording(path, [&](const datasets::RecordingFile& so_far, formation::Step row,
                                         const formation::LyapunovRow*) { until.add(so_far, std::move(row)); });
  const std::size_t robot = find_robot(file.scenario, flags.robot);
  check_time(until.rows(), until.end(), file.recording.time_step, flags.time);
  Explained explained{decision_of(file.scenario, method_words(file.info), robot, until.decision(),
                                  file.recording.bodies, file.recording.all_half_planes)};
  explained.remarks = remarks_on(explained.decision, file.recording, until.stuck(file.recording));
  explained.ahead = route_ahead_of(explained.decision, file.recording, guided_options(file.info));
  if (!file.recording.all_half_planes)
    explained.remarks.push_back(
        "The recording has only the half-planes that bind or are violated and those against what could be met within a "
        "time step: simulate --decisions all keeps the others too, and explain of the scenario computes them.");
  return explained;
}

/// How a run without recorded decisions was made.
struct CrowdMade {
  std::string scenario;  ///< its file
  formation::SimulationOptions options;
};

Explained decided_in_crowd(const ExplainFlags& flags, const CrowdMade& made, const Scenario& scenario) {
  const std::size_t robot = find_robot(scenario, flags.robot);
  const TerminateOnSignal terminate_on_signal;
  const std::string how = method_words(datasets::run_info(scenario, made.options, {}, false));
  CrowdDecision found = crowd_decision(scenario, made.options, how, robot, flags.time);
  if (!found.decision)
    throw UsageError("--time", fmt::format("{}", flags.time),
                     fmt::format("below {:.10g} s, when the run ends", found.end));
  return {std::move(*found.decision), std::move(found.remarks)};
}

/// What a command line gives as --precision; empty where it does not.
std::string precision_in(const nlohmann::json& command) {
  const std::string option = "--precision";
  std::string precision, before;
  for (const auto& item : command) {
    const std::string word = item.is_string() ? item.get<std::string>() : "";
    if (before == option) precision = word;
    if (word.rfind(option + "=", 0) == 0) precision = word.substr(option.size() + 1);
    before = word;
  }
  return precision;
}

/// Whether every file that a run has read, its scenario and maps for instance, is where it was, with the same bytes.
bool are_unchanged(const nlohmann::json& inputs) {
  return std::all_of(inputs.begin(), inputs.end(), [](const nlohmann::json& input) {
    std::error_code unknown;
    const std::string path = input.value("path", "");
    return std::filesystem::is_regular_file(path, unknown) &&
           datasets::sha256_of_file(path) == input.value("sha256", "");
  });
}

/// What the metrics.json beside a recording without decisions says. Throws DataError (E_FORMAT_UNKNOWN) where there is
/// none, or an input was changed since.
CrowdMade made_as(const std::filesystem::path& recording) {
  using Json = nlohmann::json;
  std::ifstream file(recording.parent_path() / "metrics.json");
  const Json metrics = Json::parse(file, nullptr, false);
  const Json::json_pointer inputs("/provenance/inputs"), first("/provenance/inputs/0");
  const Json::json_pointer command("/provenance/command_line");
  CrowdMade made;
  if (recording.filename() == "recording.evr" && metrics.is_object() && metrics.contains(first))
    made.scenario = metrics[first].value("path", "");
  if (made.scenario.empty() || !are_unchanged(metrics[inputs]))
    throw datasets::DataError(datasets::DataCode::format_unknown, recording.string(), "",
                              "the recording of a crowd (.evr), without decisions, and its scenario or a map is not "
                              "where metrics.json says, or was changed",
                              "explain SCENARIO, which computes the decision again, or a run with --decisions binding; "
                              "audit, convert, draw and view read recordings of crowds");
  made.options.guidance = formation::Guidance::none;
  parse(metrics.value("guidance", "none"), *made.options.guidance);
  made.options.liveness = formation::Liveness::off;
  parse(metrics.value("liveness", "off"), *made.options.liveness);
  parse(precision_in(metrics.value(command, Json())), made.options.precision);
  return made;
}

/// Explains a decision of a recording, or of a scenario that is run until then.
Explained explained_by(const ExplainFlags& flags) {
  if (!(flags.time >= 0.0)) throw UsageError("--time", fmt::format("{}", flags.time), "a time of at least 0 s");
  const auto recording = recording_at(flags.scenario);
  const auto read = recording ? std::vector{*recording} : datasets::files_read_with(flags.scenario, "scenario");
  check_figure_name("--out", flags.out, read);
  check_figure_name("--map", flags.map, read);
  if (recording) note_recorded(flags.simulation);
  if (recording && recording->extension() != ".evr") return decision_in(flags, *recording);
  if (recording) {
    const CrowdMade made = made_as(*recording);
    return decided_in_crowd(flags, made, read_scenario(made.scenario).scenario);
  }
  const Scenario scenario = read_scenario(flags.scenario).scenario;
  const Way way = way_of(flags.decisions, flags.simulation, flags.scenario, scenario, "", false);
  note_unused(flags.simulation, scenario);
  if (!way.is_crowd) return decide(flags, scenario);
  return decided_in_crowd(flags, {flags.scenario, simulation_options(flags.simulation)}, scenario);
}

// --- The route from there ---

constexpr const char* kRobotColour = "#009E73";

void add_chain(const std::vector<geometry::ChainPoint>& chain, MapLayers& map) {
  ChainLines lines;
  lines.add(chain);
  map.curves("closed chain", lines.along, line_style(3.0, kSeparatorColour), false);
  map.curves("gap, too narrow", lines.across, line_style(3.0, kSeparatorColour, " dt (4,3)"), false);
  const auto length = [](const Points& gap) { return norm(gap[1] - gap[0]); };
  const auto widest = std::max_element(lines.across.begin(), lines.across.end(),
                                       [&](const Points& a, const Points& b) { return length(a) < length(b); });
  if (widest == lines.across.end()) return;
  map.labels("the widest gap", {{0.5 * ((*widest)[0] + (*widest)[1]), fmt::format("{:.3g} m", length(*widest))}},
             fmt::format("with labels left offset 0.6,0.6 font ',11' tc rgb '{}'", kSeparatorColour));
}

/// In tenths of a millimetre: the rounding error of a 0 is no number to read.
std::string printed(Vec2 v) {
  const auto rounded = [](double x) { return std::nearbyint(1e4 * x) / 1e4 + 0.0; };
  return fmt::format("({}, {})", rounded(v.x), rounded(v.y));
}

/// The footprint at its heading where the robot has one, else its disc.
Points body_outline(const formation::Robot& robot, const RobotStep& now) {
  if (robot.drive && now.wheels && !robot.drive->footprint.empty())
    return footprint_at(*robot.drive, now.position, now.wheels->heading);
  return outline(geometry::Disc{now.position, robot.radius});
}

/// Where a robot is among the obstacles, its route from there and the place that it heads for; of a goal out of reach
/// the closed chain that separates them.
Figure route_map_figure(const Decision& decision, const formation::RouteAhead& ahead) {
  const formation::Robot& robot = decision.who();
  const Vec2 here = decision.step.position;
  MapLayers map;
  map.obstacles(decision.scenario.obstacles);
  add_chain(ahead.route.chain, map);
  if (!ahead.route.points.empty())
    map.curves("route from here", {ahead.route.points}, line_style(2.2, kRouteColour), false);
  map.curves(robot.id, {body_outline(robot, decision.step)}, line_style(2.0, kRobotColour), true);
  if (ahead.heads_for) {
    map.curves("heads for", {{here, *ahead.heads_for}}, line_style(1.2, kRobotColour, " dt (4,3)"), false);
    map.curves("", {{*ahead.heads_for}}, fmt::format("with points pt 6 ps 1.2 lw 2 lc rgb '{}'", kRobotColour), false,
               false);
  }
  map.curves("goal", {{robot.goals[ahead.route.goal]}},
             fmt::format("with points pt 2 ps 1.3 lw 2.5 lc rgb '{}'", kGoalColour), false);
  return map.figure(fmt::format("{} of {} at t = {:.2f} s", robot.id, decision.scenario.name, decision.time));
}

/// One line: "Route: 12.3 m to (8, 3); it heads for (2.1, 0.4), 3.2 m away, the farthest point of it in sight."
std::string route_words(const Decision& decision, const formation::RouteAhead& ahead) {
  if (ahead.route.points.empty()) return "Route: none, out of reach: " + ahead.route.why_not + ".\n";
  std::string text = fmt::format("Route: {:.4g} m to {}", ahead.length, printed(ahead.route.points.back()));
  if (!ahead.route.why_not.empty()) text += ", as near to the goal as it can get";
  if (ahead.heads_for)
    text += fmt::format("; it heads for {}, {:.3g} m away, the farthest point of it in sight",
                        printed(*ahead.heads_for), norm(*ahead.heads_for - decision.step.position));
  return text + " (planned from here; a run keeps the route that it has).\n";
}

// --- The verb ---

std::string words_of(const Explained& explained) {
  std::string text = explanation(explained.decision);
  if (explained.ahead) text += route_words(explained.decision, *explained.ahead);
  text = shown_lines(text);
  for (const std::string& remark : explained.remarks) text += shown(remark) + "\n";
  return text;
}

OrderedJson json_of(const Decision& d, std::size_t half_plane) {
  const formation::DecisionConstraint& c = d.step.constraints[half_plane];
  return {{"number", half_plane + 1},
          {"of", formation::name_of(c, d.scenario, d.bodies)},
          {"effect", name(effect_of(d, c))},
          {"violation", std::max(0.0, violation_of(c, d.step.chosen))},
          {"normal", json_point(c.half_plane.normal)},
          {"offset", c.half_plane.offset},
          {"hard", c.hard},
          {"certified", c.certified},
          {"fell_back", c.fell_back},
          {"time_horizon", c.time_horizon},
          {"clearance", c.clearance},
          {"multiplier", c.multiplier}};
}

OrderedJson json_of(const Explained& explained) {
  const Decision& d = explained.decision;
  OrderedJson waits_for = OrderedJson::array(), half_planes = OrderedJson::array();
  for (const std::size_t i : d.waits_for) waits_for.push_back(d.scenario.robots[i].id);
  for (std::size_t k = 0; k < d.step.constraints.size(); ++k) half_planes.push_back(json_of(d, k));
  return {{"scenario", d.scenario.name},
          {"robot", d.who().id},
          {"time", d.time},
          {"how", d.method},
          {"position", json_point(d.step.position)},
          {"velocity", json_point(d.step.velocity)},
          {"mode", name(d.step.mode)},
          {"waits_for", waits_for},
          {"waiting", d.waiting},
          {"preferred", json_point(d.step.preferred)},
          {"chosen", json_point(d.step.chosen)},
          {"status", lp::name(d.step.status)},
          {"violation", d.step.violation},
          {"all_half_planes", d.has_all_half_planes},
          {"half_planes", half_planes},
          {"remarks", explained.remarks}};
}

ExitCode explain(const ExplainFlags& flags) {
  const Explained explained = explained_by(flags);
  print(flags.json ? laid_out(json_of(explained)) : words_of(explained));
  if (!flags.out.empty()) write_figure(velocity_space_figure(explained.decision), flags.out);
  if (flags.map.empty()) return ExitCode::success;
  if (explained.ahead)
    write_figure(route_map_figure(explained.decision, *explained.ahead), flags.map);
  else
    message("note: --map draws nothing: the robot is not along a route then");
  return ExitCode::success;
}

void declare_explain(CLI::App& app, ExplainFlags& flags) {
  app.add_option("scenario", flags.scenario,
                 "JSON file, or - for stdin; or the recording of a run, or its folder. For a run without recorded "
                 "decisions the decision is computed again")
      ->required();
  app.add_option("--time,-t", flags.time, "Time of the decision, s")->required();
  app.add_option("--robot,-r", flags.robot, "The robot: its id, or its index from 0")->required();
  declare_out(app, flags.out, kFigureFileHelp);
  app.add_option("--map", flags.map,
                 "Figure of the map, FILE as for --out: the robot's route, the point that it heads for, and the chain "
                 "round a goal out of reach");
  app.add_flag("--json", flags.json, "The decision, its half-planes and the remarks as JSON");
  declare_simulation_flags(app, flags.simulation);
  declare_decisions(app, flags.decisions);
}

}  // namespace

Verb explain_verb() {
  return {"explain", "Draw one robot's velocity space at one moment and explain which constraints are binding",
          "  exactvo explain datasets/data/paper/A1.json --method orca --time 10 --robot R1 --out out/stuck.svg\n"
          "  exactvo simulate datasets/data/paper/A7.json --decisions all --out out/A7\n"
          "  exactvo explain out/A7 --time 3 --robot R1\n"
          "  exactvo explain mine.json --time 2 --robot R1 --map out/route.svg\n",
          with_flags(declare_explain, explain)};
}

}  // namespace exactvo::tools
