// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes of docs/guide/liveness.md, run by hand: which robots arrive, and how long it takes over the longest straight
// way at full speed. With `audit` the recording is proven in rationals, which takes longer than the run.
//
// No row is kept: memory does not grow with the run. With `audit` the recording goes through a pipe, which stands in
// the present folder meanwhile, and is proven while it is made; else it stays in FILE, and is proven afterwards. The
// seconds are those of the run with its metrics and, if asked for, its recording, or its audit.
//
//   formation_liveness_campaign KIND COUNT [SIZE] [SEED] [off|bias|plan] [audit|FILE]
//   formation_liveness_campaign street 60 4
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/recording_file.h"
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

/// Measures a run as it is made, and writes its recording where it is to be audited: no row is kept.
class MeasuredRun : public RunSink {
 public:
  MeasuredRun(const Scenario& scenario, std::filesystem::path recording) : recording_(std::move(recording)) {
    about_.scenario = scenario;
    if (!scenario.formation) return;
    const SimulationOptions options;
    about_.info.controller = name(options.controller);
    about_.info.integrator = name(options.integrator);
  }

  void begin(const Recording& run) override {
    about_.recording = run;
    if (!recording_.empty()) file_.emplace(recording_, about_);
    evaluator_.emplace(about_.scenario, about_.recording, [this](const Step& row, const LyapunovRow* lyapunov) {
      if (file_) file_->add(row, bodies_, lyapunov);
    });
  }
  void add_body(const vo::Body& body) override { bodies_.push_back(body); }
  // The row before has to stand before these in the file, and it is written when the next one comes.
  void add_goal_bodies(const GoalBodies& of_goal) override { goal_bodies_.push_back(of_goal); }
  void add_plan(const JointPlan& plan) override { plans_.push_back(plan); }
  void add_row(Step row) override {
    if (std::getenv("NOTES")) print_notes(row);
    evaluator_->add(std::make_shared<const Step>(std::move(row)));
    for (const GoalBodies& of_goal : std::exchange(goal_bodies_, {}))
      if (file_) file_->add(of_goal, bodies_);
    for (const JointPlan& plan : std::exchange(plans_, {}))
      if (file_) file_->add(plan);
  }

  Metrics finish(const Recording& run) {
    Evaluation found = evaluator_->finish(run);
    about_.recording = run;
    if (file_) file_->finish(about_);
    return found.metrics;
  }

 private:
  void print_notes(const Step& row) const {
    for (std::size_t i = 0; i < row.robots.size(); ++i)
      if (!row.robots[i].note.empty())
        std::printf("  %.2f %s: %s\n", row.time, about_.scenario.robots[i].id.c_str(), row.robots[i].note.c_str());
  }

  std::filesystem::path recording_;
  datasets::RecordingFile about_;
  std::optional<datasets::RecordingWriter> file_;
  std::optional<Evaluator> evaluator_;
  std::vector<vo::Body> bodies_;
  std::vector<GoalBodies> goal_bodies_;
  std::vector<JointPlan> plans_;
};

bool is_clean(const datasets::AuditReport& report) {
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
  std::filesystem::path recording;
  const bool is_kept = argc > 6 && argv[6] != std::string("audit");
  if (argc > 6) recording = is_kept ? argv[6] : "liveness_campaign." + std::to_string(getpid()) + ".jsonl";
  std::future<datasets::AuditReport> audit;
  if (!recording.empty() && !is_kept) {
    if (::mkfifo(recording.c_str(), 0600) != 0) return 2;
    audit = std::async(std::launch::async, [&] { return datasets::audit_recording(recording); });
  }
  const auto start = std::chrono::steady_clock::now();
  MeasuredRun measured(s, recording);
  const Recording run = simulate(s, options, measured);
  const Metrics m = measured.finish(run);
  if (audit.valid()) audit.wait();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
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
      end.value_or(static_cast<double>(m.steps) * s.time_step) / bound, m.collisions.size(), m.relaxed_steps,
      course.groups, course.largest, course.search_nodes, wall);
  if (!all_arrived) std::printf("  %s\n", m.outcome.c_str());
  bool is_proven = true;
  if (!recording.empty()) is_proven = is_clean(is_kept ? datasets::audit_recording(recording) : audit.get());
  if (!recording.empty() && !is_kept) std::filesystem::remove(recording);
  return all_arrived && is_proven ? 0 : 1;
}
