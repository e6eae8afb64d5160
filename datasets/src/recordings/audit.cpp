// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/audit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/scenario_file.h"
#include "json/json_text.h"
#include "recordings/audit_bodies.h"
#include "recordings/audit_decisions.h"
#include "recordings/audit_motions.h"
#include "recordings/audit_plans.h"
#include "recordings/audit_rows.h"
#include "recordings/audit_sequence.h"
#include "recordings/recording_lines.h"

namespace exactvo::datasets {
namespace {

using exact::ExactWay;
using exact::Rational;
using formation::MotionLaw;
using formation::Step;
using geometry::Vec2;

/// How robots move between rows: straight without a formation; with one, as its integrator has it.
MotionLaw law_of(const RecordingFile& file) {
  if (!file.scenario.formation) return MotionLaw::straight;
  const std::string integrator = file.info.integrator.value_or("exact");
  if (integrator == "exact") return MotionLaw::exponential;
  return integrator == "euler" ? MotionLaw::straight : MotionLaw::hermite;
}

/// Offsets as the controller uses them: their mean taken off where the scenario asks for it.
bool has_its_offsets(const RecordingFile& file) {
  const formation::FormationSpec& spec = *file.scenario.formation;
  const std::vector<Vec2>& used = file.recording.offsets;
  if (used.size() != spec.offsets.size()) return false;
  const bool recentred = spec.recentre && file.recording.remedies && file.recording.remedies->recentred;
  Vec2 mean{};
  if (recentred) {
    for (const Vec2 d : spec.offsets) mean += d;
    mean = mean / static_cast<double>(used.size());
  }
  return std::equal(used.begin(), used.end(), spec.offsets.begin(),
                    [&](Vec2 a, Vec2 b) { return a == (recentred ? b - mean : b); });
}

/// Point (1), and where the run begins: the header against its own scenario and against the one that was meant.
void check_header(const RecordingFile& file, const RunOutline& outline, const formation::Scenario* meant,
                  AuditTally& tally) {
  const auto require = [&](AuditPoint point, bool ok, const char* what) {
    ok ? tally.proven(point) : tally.refuted(point, what);
  };
  const formation::Recording& recording = file.recording;
  const std::optional<formation::FormationSpec>& formation = file.scenario.formation;
  const AuditPoint scenario = AuditPoint::scenario;
  require(scenario, recording.time_step == file.scenario.time_step, "the header's time step is not the scenario's");
  require(scenario, recording.motion == law_of(file), "the header's motion is not that of its scenario and integrator");
  require(scenario, recording.tracking_gain == (formation ? formation->gains.k3 : 0.0),
          "the header's tracking gain is not the scenario's k3");
  if (formation && recording.remedies) {
    require(scenario, has_its_offsets(file), "the header's offsets are not the scenario's");
    require(scenario, recording.relative_frame == !recording.remedies->absolute_frame,
            "the header's frame is not that of its controller");
  }
  if (!formation)
    require(scenario, !recording.relative_frame && recording.offsets.empty(), "the header is that of a formation");
  if (meant) {
    tally.report.scenario_was_given = true;
    require(scenario, write_scenario(*meant) == write_scenario(file.scenario),
            "the scenario of the recording is not the one given");
  }
  const std::vector<formation::Robot>& robots = file.scenario.robots;
  const std::vector<RunOutline::Places::Robot>& first = outline.first.robots;
  const bool starts = std::equal(robots.begin(), robots.end(), first.begin(), first.end(),
                                 [](const formation::Robot& robot, const RunOutline::Places::Robot& seen) {
                                   return robot.position == seen.position && robot.velocity == seen.velocity;
                                 });
  require(AuditPoint::sequence, outline.first.time == 0.0, "the first row is not at t = 0");
  require(AuditPoint::sequence, starts, "the first row is not the scenario's start");
}

bool has_arrived(const formation::Robot& robot, Vec2 position, double tolerance) {
  const exact::Point d = exact::exactly(position) - exact::exactly(robot.goals.back());
  const Rational reach(tolerance);
  return exact::dot(d, d) <= reach * reach * (1 + Rational(0x1p-48));  // distances in a run are rounded
}

/// In the row before the last, which has no decisions.
bool stayed(const RunOutline& outline, std::size_t robot) {
  return outline.rows > 1 && outline.before_last.robots[robot].mode == formation::Mode::staying;
}

/// Without a formation a run ends before its time limit where all robots have arrived or, as nothing comes to push
/// them, stay because their goals are out of reach.
bool has_ended(const formation::Scenario& s, const RunOutline& outline, bool& somebody_stays) {
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    if (has_arrived(s.robots[i], outline.last.robots[i].position, s.arrival_tolerance)) continue;
    if (!stayed(outline, i) || !s.moving_obstacles.empty()) return false;
    somebody_stays = true;
  }
  return true;
}

/// A run ends at its time limit, when nobody goes on, or when a formation has left every bound.
bool is_whole(const formation::Scenario& s, const RunOutline& outline, bool& somebody_stays) {
  constexpr double kSameRow = 1e-6;     // of a step
  constexpr double kOutOfBounds = 1e6;  // m and m/s
  const double steps = std::ceil(s.time_limit / s.time_step - kSameRow);
  if (static_cast<double>(outline.rows - 1) >= steps) return true;
  const std::vector<RunOutline::Places::Robot>& last = outline.last.robots;
  if (s.formation)
    return std::any_of(last.begin(), last.end(), [](const RunOutline::Places::Robot& r) {
      return !(geometry::norm(r.position) < kOutOfBounds && geometry::norm(r.velocity) < kOutOfBounds);
    });
  return s.robots.size() == last.size() && has_ended(s, outline, somebody_stays);
}

void check_end(const formation::Scenario& scenario, const RunOutline& outline, AuditTally& tally) {
  is_whole(scenario, outline, tally.report.has_staying)
      ? tally.proven(AuditPoint::sequence)
      : tally.refuted(AuditPoint::sequence, "the last row is before the time limit, and not every robot has arrived");
}

/// Point (2), the rows, and point (8), whose findings come in this order though all rows are needed for the first.
void check_rows(const RecordingFile& file, const RunOutline& outline, const EachRow& each, AuditTally& tally) {
  const std::vector<RationalObstacle> obstacles = rational_obstacles(file.scenario);
  std::vector<ExactWay> ways;
  for (const formation::MovingObstacle& o : file.scenario.moving_obstacles)
    ways.emplace_back(o.motion, Rational(outline.latest));
  std::optional<exact::ExponentialLaw> law;
  if (file.recording.motion == MotionLaw::exponential)
    law.emplace(Rational(file.recording.tracking_gain), Rational(file.recording.time_step));
  PlacesInRows places(file, outline);
  DecisionAudit decisions(file, obstacles, tally);
  SequenceAudit sequence(file, ways, law ? &*law : nullptr, outline.last.time, tally);
  MotionAudit motions(file, obstacles, ways, law ? &*law : nullptr, tally);
  const auto of_header = static_cast<std::ptrdiff_t>(tally.report.findings.size());
  walk(each, [&](const RowInRun& at) {
    call_wait_hook();  // a long audit ends where its caller wants to
    places.take(at.number, at.row);
    sequence.check_row(at);
    if (!at.next) return;
    decisions.check(at);
    sequence.check_step(at);
    if (at.row.time >= 0.0 && at.row.time < at.next->time) motions.check(at);
  });
  std::vector<std::string>& findings = tally.report.findings;
  const auto of_rows = static_cast<std::ptrdiff_t>(findings.size());
  BodyAudit(file, obstacles, places, tally).check();
  audit_plans(file, obstacles, places, tally);
  std::rotate(findings.begin() + of_header, findings.begin() + of_rows, findings.end());
}

AuditTally audited(const RecordingFile& run, const RunOutline& outline, const EachRow& each,
                   const formation::Scenario* scenario) {
  AuditTally tally;
  const std::string why = obstruction_of(run, outline);
  if (why.empty()) {
    check_header(run, outline, scenario, tally);
    check_rows(run, outline, each, tally);
    check_end(run.scenario, outline, tally);
  } else {
    tally.refuted(AuditPoint::sequence, why);
  }
  return tally;
}

/// The counts that are sums of others.
AuditReport finished(AuditTally tally) {
  AuditReport& r = tally.report;
  r.unsafe = r[AuditPoint::half_planes].refuted;
  r.steps = r[AuditPoint::motions].asked();
  r.collisions = r[AuditPoint::motions].refuted;
  r.unproven = r[AuditPoint::motions].open;
  r.inconsistencies = r[AuditPoint::scenario].refuted + r[AuditPoint::sequence].refuted;
  return std::move(r);
}

}  // namespace

const char* name(AuditPoint point) {
  constexpr const char* kNames[] = {"scenario", "bodies",   "completeness", "half_planes",
                                    "choices",  "sequence", "motions",      "plans"};
  return kNames[static_cast<std::size_t>(point)];
}

bool AuditReport::clean() const {
  const bool refuted = std::any_of(points.begin(), points.end(), [](const PointCount& p) { return p.refuted > 0; });
  return !refuted && (*this)[AuditPoint::motions].open == 0;
}

AuditReport audit(const RecordingFile& file, const formation::Scenario* scenario) {
  const EachRow each = [&](const auto& take) {
    for (const Step& row : file.recording.steps) take(SharedRow(SharedRow(), &row));
  };
  RunOutline outline;
  for (const Step& row : file.recording.steps) outline.add(row);
  return finished(audited(file, outline, each, scenario));
}

AuditReport audit_recording(const std::filesystem::path& path, const formation::Scenario* scenario) {
  SealedRecording recording(path);
  RunOutline outline;
  const RecordingFile run =
      recording.read([&](const RecordingFile&, const Step& row, const formation::LyapunovRow*) { outline.add(row); });
  const EachRow each = [&](const auto& take) {
    recording.read([&](const RecordingFile&, Step row, const formation::LyapunovRow*) {
      take(std::make_shared<const Step>(std::move(row)));
    });
  };
  AuditTally tally = audited(run, outline, each, scenario);
  const AuditPoint point = AuditPoint::scenario;
  recording.is_sealed() ? tally.proven(point)
                        : tally.refuted(point, "the lines are not those that the sha256 of the last one was made of");
  return finished(std::move(tally));
}

void add(AuditReport& sum, const AuditReport& other) {
  for (std::size_t p = 0; p < kAuditPoints; ++p) {
    sum.points[p].proven += other.points[p].proven;
    sum.points[p].refuted += other.points[p].refuted;
    sum.points[p].open += other.points[p].open;
    sum.points[p].unlisted += other.points[p].unlisted;
  }
  for (std::size_t AuditReport::*count :
       {&AuditReport::half_planes, &AuditReport::unsafe, &AuditReport::steps, &AuditReport::collisions,
        &AuditReport::unproven, &AuditReport::inconsistencies, &AuditReport::curved_steps,
        &AuditReport::obstacle_questions, &AuditReport::moving_questions, &AuditReport::robot_questions})
    sum.*count += other.*count;
  for (bool AuditReport::*some : {&AuditReport::scenario_was_given, &AuditReport::has_staying, &AuditReport::has_sums,
                                  &AuditReport::has_integrated})
    sum.*some = sum.*some || other.*some;
  sum.largest_bulge = std::max(sum.largest_bulge, other.largest_bulge);
  sum.largest_violation = std::max(sum.largest_violation, other.largest_violation);
  sum.findings.insert(sum.findings.end(), other.findings.begin(), other.findings.end());
}

std::vector<std::string> not_audited(const AuditReport& report) {
  std::vector<std::string> words;
  if (!report.scenario_was_given)
    words.emplace_back("that the scenario in the recording is the one that was meant (--scenario FILE compares them)");
  words.emplace_back(
      "why a velocity was preferred, and what is said beside the numbers: mode, side, note, clearance, "
      "method, controller, outcome, warnings, stuck, collisions, lyapunov, provenance, wall time");
  words.emplace_back("whether the rows have the half-planes against what is out of reach of a time step");
  if (report.has_staying)
    words.emplace_back(
        "that the goals of robots that stay are out of reach (`route` proves it, and `audit --certificate` its "
        "answer)");
  if (report.has_sums)
    words.emplace_back(
        "what robots track whose controller adds to the choice, or bounds its change: that they track "
        "one velocity over the step is asked, not which");
  if (report.has_integrated)
    words.emplace_back(
        "that rows of dopri5 and rosenbrock4 solve the law of motion better than to a millionth (what is "
        "proven clear is the cubic through them)");
  return words;
}

std::string to_json(const AuditReport& report) {
  JsonWriter json(JsonWriter::Layout::indented);
  json.begin_object();
  json.member("half_planes", report.half_planes);
  json.member("unsafe", report.unsafe);
  json.member("steps", report.steps);
  json.member("collisions", report.collisions);
  json.member("unproven", report.unproven);
  json.member("inconsistencies", report.inconsistencies);
  json.key("points").begin_object();
  for (std::size_t p = 0; p < kAuditPoints; ++p) {
    const PointCount& point = report.points[p];
    json.key(name(static_cast<AuditPoint>(p))).begin_object();
    json.member("asked", point.asked());
    json.member("proven", point.proven);
    json.member("refuted", point.refuted);
    json.member("open", point.open);
    json.member("unlisted", point.unlisted);
    json.end_object();
  }
  json.end_object().member("largest_violation", report.largest_violation);
  json.key("proved").begin_object();
  json.member("half_planes", report.half_planes - std::min(report.half_planes, report.unsafe));
  json.member("clear_steps", report.steps - report.collisions - report.unproven);
  json.member("curved_steps", report.curved_steps);
  json.member("against_obstacles", report.obstacle_questions);
  json.member("against_moving_obstacles", report.moving_questions);
  json.member("against_robots", report.robot_questions);
  json.member("largest_bulge", report.largest_bulge).end_object();
  json.list("not_audited", not_audited(report)).list("findings", report.findings);
  return json.end_object().take();
}

}  // namespace exactvo::datasets
