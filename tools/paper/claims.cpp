// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "exactvo/formation/lyapunov.h"
#include "exactvo/formation/metrics.h"
#include "figures/figure.h"

namespace exactvo::tools {

using Json = ReportData::Json;

namespace {

constexpr int kWithObstacles = 15;  // A1-A15
constexpr const char* kScenes[] = {"B0", "B1", "B2", "B3"};
/// J is a hundred times less: what the open problem of the jitter is taken to ask for.
constexpr double kSolved = 100.0;
/// Share of J: obstacles without which this much or more of it is left are not its cause.
constexpr double kNotTheCause = 0.5;

using Runs = std::vector<const Json*>;

Runs avoidance_runs(const ReportData& data, const std::string& method) {
  Runs runs;
  for (int i = 1; i <= kWithObstacles; ++i) runs.push_back(&data.run("A" + std::to_string(i), method));
  return runs;
}

Runs formation_runs(const ReportData& data, const std::string& controller) {
  Runs runs;
  for (const char* scene : kScenes) runs.push_back(&data.run(scene, "ivo", controller));
  return runs;
}

/// A part of the runs says nothing about all of them.
bool complete(const Runs& runs) {
  return std::none_of(runs.begin(), runs.end(), [](const Json* r) { return r->is_null(); });
}

template <typename Holds>
std::size_t count(const Runs& runs, const Holds& holds) {
  return static_cast<std::size_t>(std::count_if(runs.begin(), runs.end(), [&](const Json* r) { return holds(*r); }));
}

/// All of them, none of them, or some.
template <typename Holds>
Verdict verdict_on(const Runs& runs, const Holds& holds) {
  if (!complete(runs)) return Verdict::not_run;
  const std::size_t held = count(runs, holds);
  if (held == runs.size()) return Verdict::holds;
  return held == 0 ? Verdict::fails : Verdict::holds_in_part;
}

/// "13 of 15".
template <typename Holds>
std::string tally(const Runs& runs, const Holds& holds) {
  return complete(runs) ? fmt::format("{} of {}", count(runs, holds), runs.size()) : "-";
}

/// The scenarios of the runs for which it holds: "A6, A10, A13".
template <typename Holds>
std::string names(const Runs& runs, const Holds& holds) {
  if (!complete(runs)) return "-";
  std::string text;
  for (const Json* r : runs)
    if (holds(*r)) text += (text.empty() ? "" : ", ") + (*r)["scenario"].get<std::string>();
  return text.empty() ? "none" : text;
}

bool arrived(const Json& run) {
  return run["all_arrived"].get<bool>();
}
/// A run without any clearance shows nothing of the kind.
bool untouched(const Json& run) {
  const std::optional<double> least = least_clearance(run);
  return least && !formation::touched(least);
}
bool bypassed(const Json& run) {
  return arrived(run) && untouched(run);
}
bool below(const std::optional<double>& error, double bound) {
  return error && *error < bound;
}
bool in_formation(const Json& run) {
  return below(value_of(run, "formation_position_error"), formation::kFormed);
}
template <typename Holds>
auto no(const Holds& holds) {
  return [holds](const Json& run) { return !holds(run); };
}

/// Nothing where a run or its number is missing.
template <typename Measure>
std::optional<double> least(const Runs& runs, const Measure& measure) {
  std::optional<double> least = measure(*runs.front());
  for (const Json* r : runs)
    least = std::min(least, measure(*r));  // an empty optional is less than any number, so it stays
  return least;
}
template <typename Measure>
std::optional<double> most(const Runs& runs, const Measure& measure) {
  std::optional<double> most = measure(*runs.front());
  for (const Json* r : runs) {
    const std::optional<double> x = measure(*r);
    most = most && x ? std::max(most, x) : std::nullopt;
  }
  return most;
}

auto number(const char* key) {
  return [key](const Json& run) { return value_of(run, key); };
}

/// What the runs say of a claim; claims.json has what the paper says, in the order of `claims`.
struct Finding {
  Verdict verdict;
  std::string evidence;
};

Finding orca_stops(const ReportData& data) {
  const Runs runs = avoidance_runs(data, "orca");
  const auto as_claimed = [](const Json& r) { return !arrived(r) && untouched(r); };
  return {verdict_on(runs, as_claimed),
          fmt::format("Stopped without touching anything in {}; got by in {}; touched something in {}.",
                      tally(runs, as_claimed), names(runs, arrived), names(runs, no(untouched)))};
}

Finding ivo_bypasses(const ReportData& data) {
  const Runs paper = avoidance_runs(data, "ivo-edge"), ours = avoidance_runs(data, "ivo");
  const Runs cluster = avoidance_runs(data, "ivo-cluster");
  return {verdict_on(paper, bypassed),
          fmt::format("The paper's ellipse for each facade (ivo-edge, b = a/2): {}, not {}. Enclosures fitted free "
                      "of traps, equation (12) alone (ivo-cluster): {}, not {}. Default (ivo): {}.",
                      tally(paper, bypassed), names(paper, no(bypassed)), tally(cluster, bypassed),
                      names(cluster, no(bypassed)), tally(ours, bypassed))};
}

Finding distances_stay_positive(const ReportData& data) {
  const Runs paper = avoidance_runs(data, "ivo-edge"), ours = avoidance_runs(data, "ivo");
  return {verdict_on(paper, untouched),
          fmt::format("Minimum clearance over A1-A15, swept over the motion: {} m with ivo-edge, {} m with ivo.",
                      shown(least(paper, least_clearance), "{:.4f}"), shown(least(ours, least_clearance), "{:.4f}"))};
}

Finding dynamic_obstacles(const ReportData& data) {
  const Json& paper = data.run("A7", "ivo-edge");
  const Json& ours = data.run("A7", "ivo");
  return {verdict_on({&paper}, bypassed),
          fmt::format("A7, four robots and a wall: minimum distance between robots {} m with ivo-edge, {} m with ivo.",
                      shown(value_of(paper, "min_robot_clearance"), "{:.4f}"),
                      shown(value_of(ours, "min_robot_clearance"), "{:.4f}"))};
}

Finding always_feasible(const ReportData& data) {
  const Runs paper = avoidance_runs(data, "ivo-edge"), ours = avoidance_runs(data, "ivo");
  const auto relaxed = number("decisions/relaxed"), uncertified = number("decisions/uncertified_half_planes");
  return {
      verdict_on(paper, [&](const Json& r) { return below(relaxed(r), 1.0); }),
      fmt::format("A1-A15: at most {} decisions a run in which half-planes contradicted each other with ivo-edge, {} "
                  "with ivo; half-planes not certified {} and {}. It is the closest point of a convex set, not a "
                  "linear program.",
                  shown(most(paper, relaxed), "{:.0f}"), shown(most(ours, relaxed), "{:.0f}"),
                  shown(most(paper, uncertified), "{:.0f}"), shown(most(ours, uncertified), "{:.0f}"))};
}

Finding theorem_one(const ReportData& data) {
  const Runs literal = formation_runs(data, "paper-literal"), signs = formation_runs(data, "paper-signs");
  const Runs ours = formation_runs(data, "default");
  const auto error = number("formation_position_error");
  return {verdict_on(signs, [](const Json& r) { return in_formation(r) && untouched(r); }),
          fmt::format("Position error at the end, B0-B3: as printed {} m at least; signs corrected {} to {} m, "
                      "something touched in {}; default {} m at most, nothing touched in {}.",
                      shown(least(literal, error), "{:.3g}"), shown(least(signs, error), "{:.2g}"),
                      shown(most(signs, error), "{:.2g}"), names(signs, no(untouched)),
                      shown(most(ours, error), "{:.1e}"), tally(ours, untouched))};
}

/// A number of how the paper's function went.
auto of_paper_function(const char* key) {
  return [key](const Json& run) -> std::optional<double> {
    if (run.is_null() || !run.contains("lyapunov") || run["lyapunov"].is_null()) return std::nullopt;
    return value_of(run["lyapunov"]["paper"], key);
  };
}

/// Judged by the counterexample, which is run here.
Finding lyapunov_falls(const ReportData& data) {
  const Runs signs = formation_runs(data, "paper-signs");
  const formation::Counterexample c = formation::theorem_one_counterexample();
  const auto course = summary_of(c.scenario, c.recording).paper;
  const double lost = c.recording.steps.back().robots.front().position.x;
  const bool proves = course.least >= 0.0 || lost < formation::kFormed;  // what a Lyapunov function would show
  const auto error = number("formation_position_error");
  return {proves ? Verdict::holds : Verdict::fails,
          fmt::format("V falls, but not towards the formation. With a constant relative V_IVO = 0.1 m/s on robot 1 it "
                      "falls to {:.3f}, below zero, while robot 1 settles {:.2f} m from its slot. In B0-B3 with the "
                      "signs corrected it falls to {} (greatest rise in a step {}) while the formation ends {} to {} m "
                      "from its slots. A valid Lyapunov function is recorded beside it in every run.",
                      course.least, lost, shown(least(signs, of_paper_function("least")), "{:.0f}"),
                      shown(most(signs, of_paper_function("largest_rise")), "{:.2g}"),
                      shown(least(signs, error), "{:.2g}"), shown(most(signs, error), "{:.2g}"))};
}

Finding velocities_converge(const ReportData& data) {
  const Runs signs = formation_runs(data, "paper-signs"), ours = formation_runs(data, "default");
  const auto error = number("formation_velocity_error");
  return {verdict_on(signs, [&](const Json& r) { return below(error(r), formation::kFormed); }),
          fmt::format("Velocity error at the end: signs corrected {} to {} m/s; default {} m/s at most.",
                      shown(least(signs, error), "{:.2g}"), shown(most(signs, error), "{:.2g}"),
                      shown(most(ours, error), "{:.1e}"))};
}

/// J of a set of controller options in B0, by the ablations.
std::optional<double> ablated_jitter(const ReportData& data, const std::string& variant) {
  if (data.ablations().is_null()) return std::nullopt;
  for (const Json& row : data.ablations()["rows"]) {
    if (row["variant"] != variant) continue;
    for (const Json& run : row["scenes"])
      if (run["scenario"] == "B0") return value_of(run, "jitter");
  }
  return std::nullopt;
}

/// What the ablations, in which the avoidance stays as it is, say of the preference.
std::string preference_words(const ReportData& data) {
  const auto standard = ablated_jitter(data, "default"), constant = ablated_jitter(data, "constant |v_pref|");
  if (!standard || !constant || !(*standard > 0.0))
    return "Robots avoid each other in B0 too; the ablations, which separate the causes, were not run.";
  return fmt::format(
      "Robots avoid each other in B0 too; by the ablations, which leave the avoidance as it is, a preference of "
      "constant size alone makes the default's J in B0 {:.0f} times as much.",
      *constant / *standard);
}

Finding jitter_is_avoidance(const ReportData& data) {
  const auto free = value_of(data.run("B0", "ivo", "paper-signs"), "jitter");
  const auto wall = value_of(data.run("B1", "ivo", "paper-signs"), "jitter");
  const bool ran = free && wall;
  return {!ran ? Verdict::not_run : (*free < kNotTheCause * *wall ? Verdict::holds : Verdict::fails),
          fmt::format("J without any obstacle (B0): {} m/s^2; with a wall (B1): {}. ", shown(free, "{:.0f}"),
                      shown(wall, "{:.0f}")) +
              preference_words(data)};
}

Finding spacing_stays_positive(const ReportData& data) {
  const Runs signs = formation_runs(data, "paper-signs"), ours = formation_runs(data, "default");
  const auto spacing = number("min_robot_clearance");
  const auto apart = [&](const Json& r) { return spacing(r) && !formation::touched(spacing(r)); };
  return {verdict_on(signs, apart),
          fmt::format("Minimum distance between rims, B0-B3: signs corrected {} m, default {} m.",
                      shown(least(signs, spacing), "{:.3f}"), shown(least(ours, spacing), "{:.3f}"))};
}

Finding converges_quickly(const ReportData& data) {
  const Runs signs = formation_runs(data, "paper-signs"), ours = formation_runs(data, "default");
  return {
      verdict_on(signs, bypassed),
      fmt::format(
          "Every robot within the scene's arrival tolerance of its slot once the leader rests, and nothing touched: "
          "signs corrected {}; default {}, the last at {} s, the leader at {} s.",
          tally(signs, bypassed), tally(ours, bypassed), shown(most(ours, number("last_arrival_time")), "{:.2f}"),
          shown(most(ours, number("leader_arrival_time")), "{:.2f}"))};
}

/// How many times more the corrected signs jitter than the default; nothing where either was not run.
std::optional<double> jitter_ratio(const ReportData& data, const char* scene) {
  const auto before = value_of(data.run(scene, "ivo", "paper-signs"), "jitter");
  const auto after = value_of(data.run(scene, "ivo", "default"), "jitter");
  if (!before || !after || !(*after > 0.0)) return std::nullopt;
  return *before / *after;
}

Finding open_problem(const ReportData& data) {
  const auto b1 = jitter_ratio(data, "B1"), b3 = jitter_ratio(data, "B3");
  const Verdict verdict = !b1 || !b3                      ? Verdict::not_run
                          : std::min(*b1, *b3) >= kSolved ? Verdict::solved
                                                          : Verdict::not_solved;
  return {
      verdict,
      fmt::format("J with the signs corrected is {} times the default's in B1, {} times in B3; solved from {:.0f} on.",
                  shown(b1, "{:.0f}"), shown(b3, "{:.0f}"), kSolved)};
}

}  // namespace

const char* name(Verdict verdict) {
  constexpr const char* kNames[] = {"holds", "holds in part", "fails", "not run", "solved", "not solved"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::vector<Claim> claims(const ReportData& data) {
  const std::vector<Finding> findings{orca_stops(data),
                                      ivo_bypasses(data),
                                      distances_stay_positive(data),
                                      dynamic_obstacles(data),
                                      always_feasible(data),
                                      theorem_one(data),
                                      lyapunov_falls(data),
                                      velocities_converge(data),
                                      jitter_is_avoidance(data),
                                      spacing_stays_positive(data),
                                      converges_quickly(data),
                                      open_problem(data)};
  const Json stated = Json::parse(embedded_templates().at("claims"));
  std::vector<Claim> all;
  for (std::size_t k = 0; k < findings.size(); ++k) {
    const auto text = [&](const char* key) { return stated.at(k).at(key).get<std::string>(); };
    all.push_back(
        {text("where"), text("text"), findings[k].verdict, findings[k].evidence, text("figure"), text("subject")});
  }
  return all;
}

}  // namespace exactvo::tools
