// SPDX-License-Identifier: GPL-3.0-or-later
// Robots on wheels, run by hand (docs/guide/wheels.md).
//
//   formation_wheels_campaign table                 # the numbers of the guide, each run audited
//   formation_wheels_campaign decisions 1000000 1   # in crowded rooms: is any relaxed, does any wheel break a limit?
//   formation_wheels_campaign edits 10000 1         # of headings, wheels, choices and twists: does the audit pass any?
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "exactvo/datasets/audit.h"
#include "options/program_options.h"
#include "wheels_scenes.h"

namespace {

using namespace exactvo;
using namespace exactvo::formation;
using namespace exactvo::formation::test_scenes;

/// Keeps no row.
struct WheelCounts : RunSink {
  explicit WheelCounts(const Scenario& of) : scenario(of) {}

  void add_row(Step row) override {
    for (std::size_t i = 0; i < row.robots.size(); ++i) {
      const RobotStep& r = row.robots[i];
      relaxed += r.status != lp::Status::optimal;
      const WheelSpeeds now = r.wheels->speeds;
      fastest = std::max({fastest, std::fabs(now.left), std::fabs(now.right)});
      if (!before.robots.empty()) {
        const WheelSpeeds was = before.robots[i].wheels->speeds;
        const double change = std::max(std::fabs(now.left - was.left), std::fabs(now.right - was.right));
        hardest = std::max(hardest, change / scenario.time_step);
        ++decisions;
      }
    }
    before = std::move(row);
  }

  const Scenario& scenario;
  Step before;
  std::size_t decisions = 0, relaxed = 0;
  double fastest = 0.0, hardest = 0.0;  ///< m/s, m/s^2
};

int decide(std::uint64_t count, std::uint64_t seed, bool audits) {
  std::size_t decisions = 0, relaxed = 0, worlds = 0, unclean = 0;
  double fastest = 0.0, hardest = 0.0;
  for (; decisions < count; ++worlds) {
    test::SeededRandom random(seed * 1000003 + worlds);
    const Scenario s = crowded_room(random);
    WheelCounts counts(s);
    simulate(s, {}, counts);
    if (counts.relaxed > 0) std::printf("world %zu: %zu decisions relaxed\n", worlds, counts.relaxed);
    decisions += counts.decisions;
    relaxed += counts.relaxed;
    fastest = std::max(fastest, counts.fastest);
    hardest = std::max(hardest, counts.hardest);
    if (audits) {
      const datasets::AuditReport report = datasets::audit(recorded(s));
      if (report.clean()) continue;
      ++unclean;
      std::printf("world %zu: %s\n", worlds, report.findings.empty() ? "open" : report.findings.front().c_str());
    }
  }
  const DifferentialDrive drive = burger();
  const bool keeps = fastest <= drive.max_wheel_speed && hardest <= drive.max_wheel_acceleration * (1.0 + 1e-9);
  std::printf("%zu worlds, %zu decisions, relaxed %zu; fastest wheel %.6f m/s, its speed changed by %.6f m/s^2 at most",
              worlds, decisions, relaxed, fastest, hardest);
  std::printf(audits ? "; audits not clean %zu\n" : "\n", unclean);
  return relaxed == 0 && keeps && unclean == 0 ? 0 : 1;
}

int edit(std::uint64_t count, std::uint64_t seed) {
  Scenario s = burgers_on_circle(2, 1.0, true);
  s.time_limit = 1.0;
  const datasets::RecordingFile file = recorded(s);
  std::size_t passed = datasets::audit(file).clean() ? 0 : 1;
  for (std::uint64_t k = 0; k < count; ++k) {
    test::SeededRandom random(seed * 1000003 + k);
    datasets::RecordingFile forged = file;
    const std::string what = edit_wheels(forged, static_cast<int>(k % kKindsOfEdit), random);
    if (!datasets::audit(forged).clean()) continue;
    ++passed;
    std::printf("edit %llu passed: %s\n", static_cast<unsigned long long>(k), what.c_str());
  }
  std::printf("%llu edits, passed %zu\n", static_cast<unsigned long long>(count), passed);
  return passed == 0 ? 0 : 1;
}

/// 12 that move in any direction at 1.5 m/s across a circle of 8 m. `most`: m/s^2, 0 for velocities that jump.
Scenario points_on_circle(double most, double braking_time) {
  constexpr int kRobots = 12;
  Scenario s;
  s.name = "points";
  s.time_limit = 90.0;
  s.margins.robot = 0.0;
  if (most > 0.0) {
    s.acceleration = Acceleration{most};
    s.braking_time = braking_time;
    s.horizons.robots = s.horizons.orca = std::max(s.horizons.robots, braking_time);
    s.horizons.most = std::max(s.horizons.most, braking_time);
  }
  for (int k = 0; k < kRobots; ++k) {
    const double angle = 2.0 * geometry::kPi * k / kRobots;
    Robot r;
    r.id = "P" + std::to_string(k + 1);
    r.position = polar(8.0, angle);
    r.goals = {polar(-8.0, angle)};
    r.max_speed = 1.5;
    s.robots.push_back(r);
  }
  return s;
}

/// Eight Burgers that measure each other.
Scenario measured_circle(const Measurements& bounds) {
  Scenario s = burgers_on_circle(8, 1.5, false);
  s.acceleration = Acceleration{0.45};
  s.uncertainty = Uncertainty{0.0, bounds};
  return s;
}

int print_table() {
  bool all_hold = true;
  const auto print = [&](const char* what, const Scenario& s, double straight) {
    const datasets::RecordingFile file = recorded(s);
    const datasets::AuditReport report = datasets::audit(file);
    const std::size_t decisions = (file.recording.steps.size() - 1) * s.robots.size();
    std::printf(
        "%s: %s, last %.2f s (straight way %.1f s), relaxed %zu of %zu, %s; could brake: %zu asked, %zu proven\n", what,
        file.recording.outcome.c_str(), last_arrival(file), straight, relaxed_in(file.recording), decisions,
        report.clean() ? "audit clean" : "AUDIT NOT CLEAN", report[datasets::AuditPoint::braking].asked(),
        report[datasets::AuditPoint::braking].proven);
    std::fflush(stdout);
    all_hold = all_hold && report.clean() && relaxed_in(file.recording) == 0;
  };
  print("4 Burgers", burgers_on_circle(4, 1.5, false), 13.6);
  print("12 Burgers", burgers_on_circle(12, 2.2, false), 20.0);
  for (const std::uint64_t seed : {5, 6, 7})
    print("12 Burgers, headings at random", burgers_on_circle(12, 2.2, true, seed), 20.0);
  for (const double tracking : {0.0, 0.01, 0.02, 0.05, 0.1})
    print(("8 Burgers, tracking error " + std::to_string(tracking) + " m").c_str(),
          burgers_on_circle(8, 1.5, false, 5, tracking), 13.6);
  print("8 Burgers that measure each other, exactly", measured_circle({0.0, 0.0, 0.0}), 13.6);
  print("8 Burgers that measure each other, 2 cm, 5 cm/s, 0.1 s", measured_circle({0.02, 0.05, 0.1}), 13.6);
  print("8 Burgers that measure each other, 5 cm, 10 cm/s, 0.1 s", measured_circle({0.05, 0.1, 0.1}), 13.6);
  Scenario s = burgers_on_circle(12, 2.2, false);
  add_pillars(s);
  print("12 Burgers, three pillars", s, 20.0);
  print("12 points without a limit", points_on_circle(0.0, 0.0), 10.7);
  print("12 points, A 3, tau 0.6", points_on_circle(3.0, 0.6), 10.7);
  print("12 points, A 1, tau 1.6", points_on_circle(1.0, 1.6), 10.7);
  print("12 points, A 0.5, tau 3.2", points_on_circle(0.5, 3.2), 10.7);
  test::SeededRandom random(1);
  print("24 Burgers in a crowded room", crowded_room(random), 0.0);
  return all_hold ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return tools::run_program("formation_wheels_campaign", [&] {
    std::string what;
    std::uint64_t count = 1000, seed = 1;
    bool audits = false;
    tools::ProgramOptions options(
        "formation_wheels_campaign",
        "Do robots on wheels keep what the guide promises, and does the audit see it if not?",
        "Exit status 1: a decision was relaxed, a limit broken, an audit not clean, or an edit passed.");
    options.word("WHAT", what, {"table", "decisions", "edits"}, "What to count", true);
    options.whole_number("COUNT", count, 1, "Decisions, or edits, at least");
    options.whole_number("SEED", seed, 0, "Of worlds, or edits");
    options.flag("--audit", audits, "Audit every world of `decisions`");
    if (!options.parse(argc, argv)) return 0;
    return what == "table" ? print_table() : what == "edits" ? edit(count, seed) : decide(count, seed, audits);
  });
}
