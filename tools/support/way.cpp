// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/way.h"

#include <fmt/format.h>

#include "exactvo/datasets/data_error.h"
#include "exactvo/formation/crowd_run.h"
#include "support/usage.h"

namespace exactvo::tools {

namespace {

/// What was given of the command line that needs recorded decisions; empty: nothing.
std::string what_needs_decisions(const SimulationFlags& simulation, const std::string& needed) {
  if (!needed.empty()) return needed;
  const bool is_other_method = simulation.method_option->count() > 0 && simulation.method != "orca";
  return is_other_method ? "--method " + simulation.method : std::string();
}

/// Throws where the scenario, or the command line, cannot do without decisions.
void require_crowd(const std::string& file, const formation::Scenario& scenario, const std::string& needed,
                   const std::string& asked_by) {
  if (!needed.empty())
    throw conflict(needed, asked_by, "without recorded decisions the method is orca, and a recording has places alone");
  for (const formation::ScenarioProblem& p : crowd_problems(scenario))
    throw datasets::DataError(datasets::DataCode::scenario, file, p.pointer, p.found,
                              p.expected + ", with " + asked_by);
}

}  // namespace

void declare_decisions(CLI::App& app, DecisionFlags& flags) {
  app.add_option("--decisions", flags.recorded,
                 fmt::format("What is recorded of each decision: binding (the half-planes that bind, and those of what "
                             "could be reached within a time step), all half-planes, or none: places alone, for any "
                             "number of robots with goals, method orca, every motion certified. By default binding, "
                             "and none from {} robots on where nothing needs more",
                             kManyRobots));
  // Its earlier name.
  app.add_flag_callback("--record-all", [&flags] { flags.recorded = "all"; })->group("");
}

Way way_of(const DecisionFlags& flags, const SimulationFlags& simulation, const std::string& file,
           const formation::Scenario& scenario, const std::string& needed, bool has_ranks) {
  if (!flags.recorded.empty()) require_known("--decisions", flags.recorded, {"none", "binding", "all"});
  const std::string need = what_needs_decisions(simulation, needed);
  Way way;
  way.records_all = flags.recorded == "all";
  if (flags.recorded == "none" || has_ranks) {
    if (flags.recorded != "none" && !flags.recorded.empty())
      throw UsageError("--decisions", flags.recorded, "none over ranks of MPI, which keep no decisions");
    require_crowd(file, scenario, need, flags.recorded == "none" ? "--decisions none" : "ranks of MPI");
    way.is_crowd = true;
    return way;
  }
  const std::size_t robots = scenario.robots.size();
  if (!flags.recorded.empty() || robots < kManyRobots) return way;
  const std::vector<formation::ScenarioProblem> problems = crowd_problems(scenario);
  way.is_crowd = need.empty() && problems.empty();
  if (way.is_crowd)
    way.words = fmt::format(
        "{} robots: places are recorded, not decisions, and the method is orca; --decisions "
        "binding records decisions, has the other methods and joint plans, and takes far longer",
        robots);
  else if (need.empty())
    way.words = fmt::format("{} robots, and decisions are recorded, since {} is {}: that may take long", robots,
                            problems.front().pointer, problems.front().found);
  else
    way.words = fmt::format(
        "{} robots, and decisions are recorded, since {} asks for it: that may take long; "
        "--decisions none records places alone",
        robots, need);
  return way;
}

}  // namespace exactvo::tools
