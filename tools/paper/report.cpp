// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/stability.h"
#include "explorer/page.h"
#include "figures/figure.h"
#include "paper/expected.h"

namespace exactvo::tools {

namespace fs = std::filesystem;
using Json = ReportData::Json;
using Rows = std::vector<std::vector<std::string>>;

namespace {

std::string point_words(geometry::Vec2 v) {
  return fmt::format("({:g}, {:g})", v.x, v.y);
}

std::string places_of(const Equation& e) {
  std::string text;
  for (const EquationPlace& p : e.places) text += (text.empty() ? "`" : ", `") + p.file + "` (`" + p.symbol + "`)";
  return text;
}

/// The sum of a count over all runs; nothing where a run does not have it, or there are none.
std::optional<double> total_of(const ReportData& data, const char* key) {
  double total = 0.0;
  for (const Json& run : data.runs()) {
    const std::optional<double> x = value_of(run, key);
    if (!x) return std::nullopt;
    total += *x;
  }
  return data.has_runs() ? std::optional<double>(total) : std::nullopt;
}

/// What the runs have to add to what is implemented.
std::string recorded_words(const ReportData& data, const std::string& equation) {
  const auto count = [&](const char* key, const char* words) {
    const auto total = total_of(data, key);
    return total ? fmt::format("; in these runs {:.0f} {}", *total, words) : std::string();
  };
  if (equation == "(10)") return count("decisions/uncertified_half_planes", "half-planes are not certified");
  if (equation == "(12)") return "; no certificate of optimality is recorded";
  if (equation == "(13)") return count("decisions/relaxed", "decisions gave way");
  return "";
}

void add_equations(const ReportData& data, Document& d) {
  d.heading(2, "Equations");
  d.paragraph(
      "What is printed, what is wrong with it, and what runs. Controller `paper-literal` runs the formation "
      "equations as printed, `paper-signs` with the signs of (15) and (17) corrected, `corrected` all of the "
      "fourth column in the paper's order, `default` what makes the promises hold.");
  Rows rows;
  for (const Equation& e : equations())
    rows.push_back({e.number, e.printed, e.trouble.empty() ? "-" : e.trouble,
                    e.implemented + recorded_words(data, e.number), places_of(e)});
  d.table({"eq.", "printed", "what is wrong", "implemented", "where"}, rows);
}

void add_claims(const ReportData& data, Document& d) {
  d.heading(2, "Claims");
  d.paragraph(
      "Verdicts judge the paper's own method, and the default where the paper leaves something open. They are computed "
      "from the "
      "runs below: a claim about many runs holds in part where it holds for some of them, and has no verdict "
      "where one is missing.");
  Rows rows;
  for (const Claim& c : claims(data))
    rows.push_back({c.where, c.text, name(c.verdict), "`" + c.subject + "`", c.evidence, "`" + c.figure + "`"});
  d.table({"where", "the paper says", "verdict", "on", "seen", "figure"}, rows);
}

// --- Tables I and II, and the parameters ---

struct PaperRobot {
  const char* name;
  geometry::Vec2 start, target;
};
constexpr double kPaperRadius = 0.5;  // m, both tables

/// A word beside what was seen where it is not what was expected.
std::string unless(bool as_expected) {
  return as_expected ? "" : " DIFFERS";
}

std::string compared(geometry::Vec2 seen, geometry::Vec2 paper) {
  return point_words(seen) + unless(seen == paper);
}
std::string compared(double seen, double paper) {
  return fmt::format("{:g}", seen) + unless(seen == paper);
}

/// The initial states of a table: the paper's, and those as run. `target` names what `target_of` a robot's number
/// gives.
template <class Target>
void add_robots(const std::vector<PaperRobot>& paper, const formation::Scenario& s, const char* target,
                const Target& target_of, Document& d) {
  Rows rows;
  for (std::size_t i = 0; i < paper.size(); ++i) {
    const formation::Robot& r = s.robots.at(i);
    rows.push_back({paper[i].name, point_words(paper[i].start), compared(r.position, paper[i].start),
                    point_words(paper[i].target), compared(target_of(i), paper[i].target), "(0, 0)",
                    compared(r.velocity, {}), fmt::format("{:g}", kPaperRadius), compared(r.radius, kPaperRadius)});
  }
  d.table(
      {"robot", "initial position", "as run", target, "as run", "initial velocity", "as run", "radius [m]", "as run"},
      rows);
}

void add_table_one(const ReportData& data, Document& d) {
  const formation::Scenario s = datasets::load_scenario(data.scenarios() / "A1.json");
  d.heading(3, "Table I: the two robots of Section V.A (paper, and as run in A1)");
  add_robots(
      {{"robot1", {0, 0}, {25, 13}}, {"robot2", {24, 14}, {10, 0}}}, s, "target position",
      [&](std::size_t i) { return s.robots.at(i).goals.back(); }, d);
}

bool is_near(double seen, double expected) {
  constexpr double kRounded = 1e-9;  // of the paper's numbers, which are short
  return std::fabs(seen - expected) <= kRounded;
}

bool are_near(const std::vector<double>& seen, const std::vector<double>& expected) {
  return std::equal(seen.begin(), seen.end(), expected.begin(), expected.end(), is_near);
}

/// Section V.B's parameters, the paper's and those of the run.
void add_parameters(const formation::FormationSpec& spec, Document& d) {
  const formation::Gains& g = spec.gains;
  const formation::Leader& leader = spec.leader;
  const formation::Stability stability = stability_of(spec);
  const double paper_speed = std::hypot(3.0, 3.0);  // m/s
  const bool same_path = leader.path.size() == 2 && leader.path.front() == geometry::Vec2{0, 0} &&
                         leader.path.back() == geometry::Vec2{25, 25};
  d.table(
      {"parameter", "paper", "as run"},
      {{"k1, k2, k3", "0.25, 0.45, 37.5",
        fmt::format("{:g}, {:g}, {:g}", g.k1, g.k2, g.k3) + unless(are_near({g.k1, g.k2, g.k3}, {0.25, 0.45, 37.5}))},
       {"leader", "(0, 0) to (25, 25) at (3, 3) m/s",
        fmt::format("{} to {} at {:.4f} m/s = |(3, 3)|", point_words(leader.path.front()),
                    point_words(leader.path.back()), leader.speed) +
            unless(same_path && is_near(leader.speed, paper_speed))},
       {"eigenvalues of L + B", "(1, 4, 4 follow from (21))",
        fmt::format("{:.6g}", fmt::join(stability.eigenvalues, ", ")) +
            unless(are_near({stability.eigenvalues.begin(), stability.eigenvalues.end()}, {1.0, 4.0, 4.0}))},
       {"explicit Euler's step limit", "-", fmt::format("{:.4f} s", stability.euler_step_limit)}});
}

void add_table_two(const ReportData& data, Document& d) {
  const formation::Scenario s = datasets::load_scenario(data.scenarios() / "B1.json");
  d.heading(3, "Table II: the three robots of Section V.B (paper, and as run in B1)");
  add_robots(
      {{"robot1", {3, 0}, {1, 1}}, {"robot2", {0, 3}, {-1, 1}}, {"robot3", {-3, 0}, {1, -1}}}, s, "Delta_i",
      [&](std::size_t i) { return s.formation->offsets.at(i); }, d);
  add_parameters(*s.formation, d);
}

// --- Section V.A ---

std::optional<double> arrival_of(const Json& run) {
  return run["all_arrived"].get<bool>() ? value_of(run, "last_arrival_time") : std::nullopt;
}

/// What was seen, what is expected of it, and a word where they differ. That nothing is touched is expected of every
/// method but `orca`.
template <class Kept>
std::string avoidance_cell(const Json& run, const std::string& expected, const Kept& kept, bool may_touch = false) {
  if (run.is_null()) return "not run";
  const std::optional<double> seen = arrival_of(run);
  const bool touched = formation::touched(least_clearance(run));
  return fmt::format("{}{} / {}{}", seen ? fmt::format("{:.1f}", *seen) : "X", touched ? "!" : "", expected,
                     unless(kept(seen.value_or(kStuck)) && (may_touch || !touched)));
}

std::string orca_cell(const Json& run, const Expected& e) {
  const bool stuck = e.orca == kStuck;
  const auto kept = [&](double seen) { return std::fabs(seen - e.orca) <= kOrcaTolerance; };
  return avoidance_cell(run, stuck ? "X" : fmt::format("{:.1f} +- {:g}", e.orca, kOrcaTolerance), kept, true);
}

std::string arrives_cell(const Json& run, bool arrives) {
  return avoidance_cell(run, arrives ? "arrives" : "X", [&](double seen) { return (seen != kStuck) == arrives; });
}

std::string default_cell(const Json& run) {
  const auto kept = [](double seen) { return seen != kStuck && seen < kLatest; };
  return avoidance_cell(run, fmt::format("below {:g}", kLatest), kept);
}

void add_section_a(const ReportData& data, Document& d) {
  d.heading(2, "Section V.A: robots among polyhedral obstacles");
  d.paragraph(
      "Last arrival in seconds, seen / expected; X: stuck; !: touched something; DIFFERS: not as expected, or "
      "something touched by another method than orca. Of ivo-edge and ivo-cluster no times are expected. The "
      "paper's figures do not give their obstacles: A0-A15 stand in for them.");
  Rows rows;
  for (const Expected& e : kExpected) {
    const Json& ours = data.run(e.scenario, "ivo");
    rows.push_back({e.scenario, orca_cell(data.run(e.scenario, "orca"), e),
                    arrives_cell(data.run(e.scenario, "ivo-edge"), e.edge_half),
                    arrives_cell(data.run(e.scenario, "ivo-cluster"), e.cluster), default_cell(ours),
                    shown(value_of(ours, "min_obstacle_clearance"), "{:.3f}"),
                    shown(value_of(ours, "min_robot_clearance"), "{:.3f}")});
  }
  d.table({"scenario", "orca", "ivo-edge, b = a/2", "ivo-cluster", "ivo", "ivo: minimum clearance to obstacles [m]",
           "between robots [m]"},
          rows);
  d.picture("figures/fig5-orca/A2/paths.png",
            "Scenario A2 with ORCA: both robots stop at the obstacles (Fig. 5(a) of the paper).");
  d.picture("figures/fig5-orca/A2/obstacle_distance.png",
            "The same run: distance of each robot from the nearest obstacle over time (Fig. 5(b)).");
  d.picture("figures/fig6-ivo-edge/A2/paths.png",
            "Scenario A2 with the paper's ellipses, method ivo-edge (Fig. 6(a)).");
  d.picture("figures/fig6-ivo-edge/A2/obstacle_distance.png",
            "The same run: distance of each robot from the nearest obstacle over time (Fig. 6(b)).");
  d.picture("figures/fig6-ivo-edge/A2/robot_distance.png",
            "The same run: distance between the robots over time (Fig. 6(c)).");
  d.picture("figures/fig6-ivo/A2/paths.png", "Scenario A2 with the default method, ivo.");
  for (const char* method : {"orca", "ivo-edge", "ivo-cluster", "ivo"})
    d.picture(std::string("figures/all-") + method + ".png",
              std::string("Paths in scenarios A0 to A15, method ") + method + ", all at one scale.");
}

// --- Section V.B ---

/// What is expected of a number, and a word where what was seen is not within the limits; `seen` is none of a number
/// that is not finite.
std::string expected_cell(const Json& run, const std::optional<double>& seen, double least, double most,
                          const std::string& words) {
  if (run.is_null()) return "not run";
  if (least == 0.0 && most == kAnything) return "-";
  return words + unless(seen ? *seen >= least && *seen <= most : most == kAnything);
}

/// A clearance, and a word where something was touched that was not to be.
std::string clearance_cell(const Json& run, const char* key, const ExpectedFormation& e) {
  const auto seen = value_of(run, key);
  return shown(seen, "{:.3f}") + unless(!(e.untouched && formation::touched(seen)));
}

std::vector<std::string> formation_row(const Json& run, const char* scene, const ExpectedFormation& e) {
  const auto whole = [&](const char* key) { return shown(value_of(run, key), "{:.0f}"); };
  const auto position = value_of(run, "formation_position_error"), velocity = value_of(run, "formation_velocity_error");
  return {scene,
          e.controller,
          shown(position, "{:.2g}"),
          expected_cell(run, position, e.least, e.most, e.words),
          shown(velocity, "{:.2g}"),
          expected_cell(run, velocity, 0.0, e.most_velocity_error, fmt::format("below {:g}", e.most_velocity_error)),
          clearance_cell(run, "min_obstacle_clearance", e),
          clearance_cell(run, "min_robot_clearance", e),
          whole("jitter"),
          whole("peak_acceleration"),
          whole("heading_reversals"),
          whole("decisions/active_set_switches")};
}

void add_section_b(const ReportData& data, Document& d) {
  d.heading(2, "Section V.B: three robots and a virtual leader");
  d.paragraph("DIFFERS: not as expected. Of the default it is also expected that nothing is touched.");
  Rows rows;
  for (const char* scene : {"B0", "B1", "B2", "B3"})
    for (const ExpectedFormation& e : kExpectedFormations)
      rows.push_back(formation_row(data.run(scene, "ivo", e.controller), scene, e));
  d.table({"scenario", "controller", "position error [m]", "expected", "velocity error [m/s]", "expected",
           "to obstacles [m]", "between robots [m]", "jitter J [m/s²]", "peak acceleration [m/s²]", "heading reversals",
           "active-set switches"},
          rows);
  const std::pair<const char*, const char*> pictures[] = {
      {"paths", "Paths of the three robots in scenario B3 (Fig. 8(a), (b), (e))"},
      {"velocity", "Velocity of each robot in B3, along x and y (Fig. 8(c))"},
      {"robot_distance", "Distance between the robots in B3 (Fig. 8(d))"},
      {"formation_error", "Distance of each robot in B3 from its place in the formation"},
      {"lyapunov", "The Lyapunov function of the paper and a valid one along B3, term by term"}};
  for (const auto& [folder, controller] : {std::pair{"fig8-paper-signs", "controller paper-signs (signs corrected)"},
                                           std::pair{"fig8-formation", "default controller"}})
    for (const auto& [stem, caption] : pictures)
      d.picture(fmt::format("figures/{}/B3/{}.png", folder, stem), fmt::format("{}, {}.", caption, controller));
  d.picture("figures/jitter.png",
            "Jitter (sum of the changes of acceleration) with controller paper-signs and with the default.");
  d.picture(
      "figures/all-formation.png",
      "Paths in scenarios B0 to B3 with the controller as printed, with its signs corrected, and with the default.");
}

// --- The campaigns ---

/// Whether every field was reached safely.
bool all_reached(const Json& row) {
  return row.is_null() || row["reached_and_safe"] == row["fields"];
}

std::string share(const Json& row) {
  if (row.is_null()) return "-";
  return fmt::format("{} of {}", row["reached_and_safe"].get<std::uint64_t>(), row["fields"].get<std::uint64_t>());
}

void add_random(const ReportData& data, Document& d) {
  d.heading(2, "Random fields");
  if (data.random().is_null()) {
    d.paragraph("Not run: `exactvo paper --out DIR --random 1000` adds them.");
    return;
  }
  d.paragraph(fmt::format("Reached and safe; seed {}, fields 0 to {}. Expected of ivo: all; DIFFERS where not.",
                          data.random()["seed"].get<std::uint64_t>(),
                          data.random()["fields"].get<std::uint64_t>() - 1));
  Rows rows;
  for (const char* kind : {"convex", "open", "formation"})
    rows.push_back({kind, share(data.random(kind, "orca")), share(data.random(kind, "ivo-edge")),
                    share(data.random(kind, "ivo-cluster")),
                    share(data.random(kind, "ivo")) + unless(all_reached(data.random(kind, "ivo")))});
  d.table({"fields", "orca", "ivo-edge, b = a/2", "ivo-cluster", "ivo"}, rows);
}

void add_ablations(const ReportData& data, Document& d) {
  d.heading(2, "Ablations: the controller options added one by one, and the default less one at a time");
  if (data.ablations().is_null()) {
    d.paragraph("Not run: `exactvo paper --out DIR --ablations` adds them.");
    return;
  }
  Rows rows;
  for (const Json& row : data.ablations()["rows"]) {
    std::vector<std::string> cells{row["variant"].get<std::string>(), share(row),
                                   std::to_string(row["reached"].get<std::uint64_t>())};
    for (const Json& run : row["scenes"]) cells.push_back(shown(value_of(run, "jitter"), "{:.0f}"));
    cells.push_back(shown(value_of(row, "median_jitter"), "{:.0f}"));
    rows.push_back(cells);
  }
  d.table({"controller options", "reached and safe", "reached", "jitter J in B0 [m/s²]", "B1", "B2", "B3", "median J"},
          rows);
  d.picture("ablations/options.png",
            "How many random formations reach their goal without a collision, for each set of controller options.");
  d.picture("ablations/options_jitter.png", "Jitter in B0 to B3 for each set of controller options.");
}

/// Which program made each file that this is made of, whoever puts the report together.
void add_sources(const ReportData& data, Document& d) {
  Rows rows;
  std::set<std::string> programs;
  for (const SourceFile& s : data.sources()) {
    rows.push_back({"`" + s.name + "`", fmt::format("{}", fmt::join(s.programs, "; ")),
                    s.inputs.empty() ? "-" : fmt::format("{}", fmt::join(s.inputs, ", "))});
    programs.insert(s.programs.begin(), s.programs.end());
  }
  d.table({"made of", "by ExactVO", "of (SHA-256 begins)"}, rows);
  if (programs.size() > 1)
    d.paragraph(
        "These files were not all written by one program: repeat the older runs to compare like with "
        "like.");
}

}  // namespace

const std::vector<Equation>& equations() {
  static const std::vector<Equation> all = [] {
    std::vector<Equation> equations;
    for (const Json& e : Json::parse(embedded_templates().at("equations"))) {
      const auto text = [](const Json& of, const char* key) { return of.at(key).get<std::string>(); };
      equations.push_back({text(e, "number"), text(e, "printed"), text(e, "trouble"), text(e, "implemented"), {}});
      for (const Json& p : e.at("places")) equations.back().places.push_back({text(p, "file"), text(p, "symbol")});
    }
    return equations;
  }();
  return all;
}

Document reproduction_report(const ReportData& data, const fs::path& folder) {
  Document d("Multi-Robot Formation with Obstacle Avoidance: a reproduction", folder);
  d.paragraph(
      "Of \"Multi-Robot Formation with Obstacle Avoidance: An Improved Velocity Obstacle-Based Approach\", by "
      "ExactVO. SI units.");
  if (fs::exists(folder / kPageName))
    d.link(kPageName, "Every run of Section V, to play and to look into, in a browser");
  add_sources(data, d);
  add_claims(data, d);
  add_equations(data, d);
  d.heading(2, "Initial states and parameters");
  add_table_one(data, d);
  add_table_two(data, d);
  add_section_a(data, d);
  add_section_b(data, d);
  add_random(data, d);
  add_ablations(data, d);
  return d;
}

void write_report(const ReportData& data, const fs::path& folder) {
  const Document document = reproduction_report(data, folder);
  datasets::write_file_atomically(folder / "report.md", document.markdown());
  datasets::write_file_atomically(folder / "report.html", document.html());
}

}  // namespace exactvo::tools
