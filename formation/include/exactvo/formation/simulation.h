// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Runs a scenario (paper, Sections III-V). Deterministic: the same scenario and options give the same recording, bit
/// for bit, on machines whose C library rounds sin, cos, atan2, exp and hypot alike (the same glibc and CPU features
/// do).

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/controller_options.h"
#include "exactvo/formation/crowd.h"
#include "exactvo/formation/recording.h"
#include "exactvo/formation/run_sink.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/names.h"

namespace exactvo::formation {

/// How robots avoid obstacles.
enum class Method {
  orca,         ///< van den Berg et al. 2011: the baseline
  rvo,          ///< van den Berg, Lin and Manocha 2008, to compare with; promises nothing between robots
  hrvo,         ///< Snape et al. 2011, to compare with; promises nothing between robots
  ivo_edge,     ///< the paper: one ellipse per facade
  ivo_cluster,  ///< enclosures merged where they overlap and fitted trap-free; pure equation (12)
  ivo           ///< ivo_cluster, boost where certified, following after a stall
};

/// How robots of a formation follow their slots.
enum class Controller {
  paper_literal,  ///< equations (14)-(17) as printed
  paper_signs,    ///< the sign errors of (15) and (17) corrected, nothing else
  corrected,      ///< the equations as docs/guide/errata.md corrects them, in the paper's order: filter first
  standard        ///< the default: saturated preference, filter last, brake point, side commitment
};

/// How second-order robots are integrated over a time step.
enum class Integrator {
  exact,  ///< in closed form
  euler,  ///< explicit Euler
  rk4     ///< the classic Runge-Kutta method
};

/// The options that a controller consists of.
ControllerOptions controller_options_of(Controller controller);

///@{
/// The words of the command line for the values of an enumeration, in their order.
constexpr geometry::Names<Method, 6> word_table(Method) {
  return {{{Method::orca, "orca"},
           {Method::rvo, "rvo"},
           {Method::hrvo, "hrvo"},
           {Method::ivo_edge, "ivo-edge"},
           {Method::ivo_cluster, "ivo-cluster"},
           {Method::ivo, "ivo"}}};
}
constexpr geometry::Names<Controller, 4> word_table(Controller) {
  return {{{Controller::paper_literal, "paper-literal"},
           {Controller::paper_signs, "paper-signs"},
           {Controller::corrected, "corrected"},
           {Controller::standard, "default"}}};
}
constexpr geometry::Names<Integrator, 3> word_table(Integrator) {
  return {{{Integrator::exact, "exact"}, {Integrator::euler, "euler"}, {Integrator::rk4, "rk4"}}};
}
constexpr geometry::Names<Guidance, 2> word_table(Guidance) {
  return {{{Guidance::none, "none"}, {Guidance::route, "route"}}};
}
constexpr geometry::Names<Unreachable, 2> word_table(Unreachable) {
  return {{{Unreachable::stay, "stay"}, {Unreachable::nearest, "nearest"}}};
}
constexpr geometry::Names<Liveness, 3> word_table(Liveness) {
  return {{{Liveness::off, "off"}, {Liveness::bias, "bias"}, {Liveness::plan, "plan"}}};
}
constexpr geometry::Names<OwnStage, 4> word_table(OwnStage) {
  return {
      {{OwnStage::none, "none"}, {OwnStage::held, "held"}, {OwnStage::gave, "gave"}, {OwnStage::left_out, "left-out"}}};
}
constexpr geometry::Names<Mode, 10> word_table(Mode) {
  return {{{Mode::direct, "direct"},
           {Mode::guided, "guided"},
           {Mode::by_plan, "by-plan"},
           {Mode::going_back, "going-back"},
           {Mode::staying, "staying"},
           {Mode::boost, "boost"},
           {Mode::following, "following"},
           {Mode::pushing_out, "pushing-out"},
           {Mode::steered, "steered"},
           {Mode::arrived, "arrived"}}};
}
///@}

/// Whether what two robots may do is safe together. With rvo and hrvo each assumes what the other one will do, so that
/// they may choose different sides: they take obstacles as orca does, and nothing is promised between robots.
constexpr bool promises_between_robots(Method method) {
  return method != Method::rvo && method != Method::hrvo;
}
/// Whether obstacles are edges by the baseline's rule, without margins.
constexpr bool takes_edges(Method method) {
  return method == Method::orca || !promises_between_robots(method);
}

/// The word of a value, such as "ivo-edge".
template <class Enum, class = decltype(word_table(Enum{}))>
const char* name(Enum value) {
  return geometry::name_in(word_table(value), value);
}
/// Sets `out` to the value of a word. False for a word that is none; `out` is then unchanged.
template <class Enum, class = decltype(word_table(Enum{}))>
bool parse(const std::string& text, Enum& out) {
  return geometry::parse_in(word_table(out), text, out);
}
/// All words of an enumeration.
template <class Enum>
std::vector<std::string> names_of() {
  return geometry::words_in(word_table(Enum{}));
}
inline constexpr auto& method_names = names_of<Method>;          ///< in the order of Method
inline constexpr auto& controller_names = names_of<Controller>;  ///< in the order of Controller
inline constexpr auto& integrator_names = names_of<Integrator>;  ///< in the order of Integrator
inline constexpr auto& guidance_names = names_of<Guidance>;      ///< in the order of Guidance
inline constexpr auto& liveness_names = names_of<Liveness>;      ///< in the order of Liveness

/// What a run depends on besides its scenario.
struct SimulationOptions {
  Method method = Method::ivo;                          ///< how robots avoid obstacles
  std::optional<Guidance> guidance;                     ///< instead of the scenario's
  std::optional<Liveness> liveness;                     ///< instead of the scenario's
  Controller controller = Controller::standard;         ///< used by formations only
  Integrator integrator = Integrator::exact;            ///< used by formations only
  std::optional<ControllerOptions> controller_options;  ///< formations: these instead of the controller's
  double facade_minor_to_major = 0.5;                   ///< ivo_edge: b = this * a
  double facade_fixed_minor = 0.0;                      ///< m, ivo_edge: > 0 fixes b
  bool record_all = false;                              ///< keep every half-plane, not only the active ones
  int threads = 1;  ///< 1 ... 1024, that decide in a crowd; 0: as many as there are. The run is the same
  /// s, >= 0: stop after the last row at or before this time, keeping every half-plane of its decision.
  std::optional<double> stop_at;
  /// Called with the simulated time, s: about ten times a second of wall time, on a crowd after every step. Returning
  /// false stops the run; in one rank it stops all ranks.
  std::function<bool(double)> progress;

  // For robots with goals: what the user adds (own_rules.h). With either there are no joint plans.

  RunSteering steering;       ///< sets the preferred velocities; none: the run does
  RunHalfPlanes half_planes;  ///< adds half-planes of the user; empty: none are added. Not on a crowd

  // Only for runs on a crowd (crowd_run.h).

  CrowdPrecision precision = CrowdPrecision::float_lines;  ///< of half-planes and linear programs
  Ranks* ranks = nullptr;                                  ///< as CrowdOptions::ranks
  std::size_t snapshot_every = 0;  ///< steps, where snapshots are kept; 0: only one, where `progress` stops the run
  /// Takes a snapshot of the whole run, its sink included, in a binary form of this version. Empty: no snapshot is
  /// made. With several ranks either all set it or none; it is called in rank 0. The number of ranks is not in it.
  std::function<void(const std::string&)> keep_snapshot;
  /// A snapshot of a run of the same scenario and options: it goes on from there, with the same bits. Empty: the run
  /// begins at the beginning. The number of threads, and of ranks, may be another. The same in every rank.
  std::string resume_from;
};

/// How robots find their way in a run: none in a formation, whose robots have no goals, and with Method::ivo_edge,
/// whose ellipses would close what a route passes.
Guidance guidance_of(const Scenario& scenario, const SimulationOptions& options);

/// What is done against waiting in a run. Robots with goals have no plans without guidance among obstacles, and none
/// where their acceleration is bounded. Those of a
/// formation have plans or nothing: plans where the controller moves brake points exactly as chosen, the method keeps
/// margins, and there are no moving obstacles.
Liveness liveness_of(const Scenario& scenario, const SimulationOptions& options);

/// Warnings known before a run, a line each: a step beyond the integrator's limit, goals, slots or a leader's end
/// that cannot be reached, or not within the time limit. The run's recording has the same. REQUIRES: a valid scenario.
std::vector<std::string> warnings_before(const Scenario& scenario, const SimulationOptions& options = {});

/// REQUIRES: a valid scenario (`validate`), and options that it can be run with (`option_problems`).
Recording simulate(const Scenario& scenario, const SimulationOptions& options = {});

/// The same run into a sink; the recording that is returned has all but the rows.
Recording simulate(const Scenario& scenario, const SimulationOptions& options, RunSink& sink);

/// What is wrong with a scenario, in words, one a line; empty when it can be run. Each names the JSON pointer of the
/// field.
struct ScenarioProblem {
  std::string pointer;   ///< "/robots/0/radius"
  std::string found;     ///< what stands there
  std::string expected;  ///< what should
};
/// Every problem, in the order of the fields. Empty: `simulate` takes the scenario.
std::vector<ScenarioProblem> validate(const Scenario& scenario);

/// Which options a scenario cannot be run with; `pointer` is the option's name, such as "method". Empty: `simulate`
/// takes both.
std::vector<ScenarioProblem> option_problems(const Scenario& scenario, const SimulationOptions& options);

}  // namespace exactvo::formation
