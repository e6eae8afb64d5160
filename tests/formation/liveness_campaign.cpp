// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes of docs/guide/liveness.md, run by hand: who arrives, and how long it takes over the longest straight way at
// full speed. With `audit` the recording is proven in rationals, which takes longer than the run.
//
//   formation_liveness_campaign KIND COUNT [SIZE] [SEED] [off|bias|plan] [audit]
//   formation_liveness_campaign street 60 4
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "exactvo/datasets/audit.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "liveness_scenes.h"

namespace {

using namespace exactvo;
using namespace exactvo::formation;

Scenario scene(const std::string& kind, int count, double size, std::uint64_t seed) {
  constexpr const char* kSlots = "slots-";
  if (kind.rfind(kSlots, 0) == 0)
    return test_scenes::at_slots(scene(kind.substr(std::string(kSlots).size()), count, size, seed));
  test::SeededRandom random(seed);
  if (kind == "circle") return test_scenes::circle(count, size);
  if (kind == "street") return test_scenes::street(count, size);
  if (kind == "door") return test_scenes::door(count, size, random);
  if (kind == "rooms") return test_scenes::rooms(count, size, random);
  if (kind == "box") return test_scenes::crowded_box(count, size, random);
  if (kind == "siding") return test_scenes::siding();
  if (kind == "cross") return test_scenes::cross(size, random);
  if (kind == "crosses") return test_scenes::cross_with_any_margin(random);
  std::fprintf(stderr,
               "KIND: found '%s', expected circle, street, door, rooms, box, siding, cross or crosses, or one of "
               "them as slots-KIND\n",
               kind.c_str());
  std::exit(2);
}

bool audits_clean(const Scenario& s, const Recording& run) {
  datasets::RecordingFile file;
  file.scenario = s;
  if (s.formation) {
    const SimulationOptions options;
    file.info.controller = name(options.controller);
    file.info.integrator = name(options.integrator);
  }
  file.recording = run;
  const datasets::AuditReport report = datasets::audit(file);
  std::printf("  audit: %zu motions, %zu collisions, %zu unproven, %zu refuted half-planes: %s\n", report.steps,
              report.collisions, report.unproven, report.unsafe, report.clean() ? "clean" : "NOT CLEAN");
  for (const std::string& finding : report.findings) std::printf("    %s\n", finding.c_str());
  return report.clean();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const double size = argc > 3 ? std::atof(argv[3]) : 3.0;
  const auto seed = static_cast<std::uint64_t>(argc > 4 ? std::atoll(argv[4]) : 1);
  Scenario s = scene(argv[1], std::atoi(argv[2]), size, seed);
  SimulationOptions options;
  Liveness liveness = Liveness::plan;
  if (argc > 5 && !parse(argv[5], liveness)) return 2;
  options.liveness = liveness;
  double bound = 0.0;
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    const Robot& r = s.robots[i];
    const geometry::Vec2 goal = s.formation ? s.formation->offsets[i] : r.goals[0];
    bound = std::max(bound, norm(goal - r.position) / r.max_speed);
  }
  if (s.name != "cross") s.time_limit = 15.0 * bound + 200.0;  // there they go to and fro
  const auto start = std::chrono::steady_clock::now();
  const Recording run = simulate(s, options);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Metrics m = measure(s, run);
  std::size_t arrived = 0;
  for (const RobotMetrics& r : m.robots) arrived += r.arrived;
  std::optional<double> end = m.last_arrival_time;
  if (s.formation) {
    end = m.formation_course->formed_since;
    arrived = end ? s.robots.size() : 0;
  }
  const bool all_arrived = arrived == s.robots.size();
  const LivenessCourse course = run.liveness.value_or(LivenessCourse{});
  std::printf(
      "%s %s %g seed %llu: %zu of %zu arrived, %.2f of the bound, %zu collisions, %zu relaxed, %zu plans, largest %zu, "
      "%zu nodes, %.2f s\n",
      argv[1], argv[2], size, static_cast<unsigned long long>(seed), arrived, s.robots.size(),
      end.value_or(run.steps.back().time) / bound, m.collisions.size(), m.relaxed_steps, course.groups, course.largest,
      course.search_nodes, wall);
  if (!all_arrived) std::printf("  %s\n", m.outcome.c_str());
  if (std::getenv("NOTES"))
    for (const Step& row : run.steps)
      for (std::size_t i = 0; i < row.robots.size(); ++i)
        if (!row.robots[i].note.empty())
          std::printf("  %.2f %s: %s\n", row.time, s.robots[i].id.c_str(), row.robots[i].note.c_str());
  const bool is_clean = argc <= 6 || audits_clean(s, run);
  return all_arrived && is_clean ? 0 : 1;
}
