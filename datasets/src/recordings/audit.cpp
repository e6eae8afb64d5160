// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/audit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/stability.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/require.h"
#include "files/sha256.h"
#include "generators/counter_random.h"
#include "json/json_text.h"
#include "recordings/audit_points.h"
#include "recordings/codec.h"

namespace exactvo::datasets {
namespace {

using exact::Rational;
using formation::MotionLaw;
using formation::RobotStep;
using formation::Step;
using geometry::Vec2;

/// How robots move between rows: straight, unless they track what they choose; then as the integrator has it.
MotionLaw law_of(const RecordingFile& file) {
  if (!tracks_choices(file.scenario)) return MotionLaw::straight;
  const std::string integrator = file.info.integrator.value_or("exact");
  if (integrator == "exact") return MotionLaw::exponential;
  return integrator == "euler" ? MotionLaw::straight : MotionLaw::hermite;
}

/// Offsets as the controller uses them: their mean taken off where the scenario asks for it.
bool has_its_offsets(const RecordingFile& file) {
  const formation::FormationSpec& spec = *file.scenario.formation;
  const std::vector<Vec2>& used = file.recording.offsets;
  if (used.size() != spec.offsets.size()) return false;
  const bool recentred =
      spec.recentre && file.recording.controller_options && file.recording.controller_options->recentred;
  Vec2 mean{};
  if (recentred) {
    for (const Vec2 d : spec.offsets) mean += d;
    mean = mean / static_cast<double>(used.size());
  }
  return std::equal(used.begin(), used.end(), spec.offsets.begin(),
                    [&](Vec2 a, Vec2 b) { return a == (recentred ? b - mean : b); });
}

/// Point (1), and where the run begins: the header against its own scenario and against the one that was meant.
void check_header(const RecordingFile& file, const Step& first, const formation::Scenario* meant, AuditTally& tally) {
  const formation::Recording& recording = file.recording;
  const std::optional<formation::FormationSpec>& formation = file.scenario.formation;
  const AuditPoint scenario = AuditPoint::scenario;
  const bool tracks = tracks_choices(file.scenario);
  tally.ask(scenario, recording.time_step == file.scenario.time_step, "the header's time step is not the scenario's");
  tally.ask(scenario, recording.motion == law_of(file),
            "the header's motion is not that of its scenario and integrator");
  tally.ask(scenario, recording.tracking_gain == (tracks ? formation->gains.k3 : 0.0),
            "the header's tracking gain is not the scenario's k3");
  if (formation && recording.controller_options) {
    tally.ask(scenario, has_its_offsets(file), "the header's offsets are not the scenario's");
    tally.ask(scenario, recording.relative_frame == (tracks && !recording.controller_options->absolute_frame),
              "the header's frame is not that of its controller");
  }
  if (!formation)
    tally.ask(scenario, !recording.relative_frame && recording.offsets.empty(), "the header is that of a formation");
  if (meant) {
    tally.report.scenario_was_given = true;
    tally.ask(scenario, write_scenario(*meant) == write_scenario(file.scenario),
              "the scenario of the recording is not the one given");
  }
  const std::vector<formation::Robot>& robots = file.scenario.robots;
  const Rational tracking(formation::tracking_error_of(file.scenario));
  tally.report.has_tube = sgn(tracking) > 0;
  tally.report.has_measurements = measures_others(file.scenario);
  tally.report.has_movers = meets_movers(file.scenario);
  for (const formation::Robot& robot : robots)  // of those on wheels `audit_kinematics` asks it
    if (tally.report.has_tube && !robot.drive)
      tally.ask(scenario, Rational(robot.radius) >= Rational(robot.body_radius) + tracking,
                "the radius of " + robot.id + " leaves no room for its tracking error");
  const bool starts = std::equal(robots.begin(), robots.end(), first.robots.begin(), first.robots.end(),
                                 [](const formation::Robot& robot, const RobotStep& seen) {
                                   return robot.position == seen.position && robot.velocity == seen.velocity;
                                 });
  tally.ask(AuditPoint::sequence, first.time == 0.0, "the first row is not at t = 0");
  tally.ask(AuditPoint::sequence, starts, "the first row is not the scenario's start");
}

/// The end of a run. Its last row has no decisions, so that modes stand in the one before.
struct End {
  std::size_t rows;
  const Step& last;
  const RowBefore* before_last;

  bool stayed(std::size_t robot) const { return before_last && (*before_last)[robot].mode == formation::Mode::staying; }
};

/// Without a formation a run ends before its time limit where all robots have arrived or, as nothing comes to push
/// them, stay because their goals are out of reach or taken.
bool has_ended(const formation::Scenario& s, const End& end, bool& somebody_stays) {
  for (std::size_t i = 0; i < s.robots.size(); ++i) {
    if (has_reached(s.robots[i].goals.back(), end.last.robots[i].position, s.arrival_tolerance)) continue;
    if (!end.stayed(i)) return false;
    somebody_stays = true;
  }
  return !somebody_stays || std::all_of(s.moving_obstacles.begin(), s.moving_obstacles.end(), [&](const auto& o) {
    return exact::ExactWay(o.motion).rests_from(Rational(end.last.time));
  });
}

/// A run ends at its time limit, when no robot goes on, or when a formation has left every bound.
bool is_whole(const formation::Scenario& s, const End& end, bool& somebody_stays) {
  constexpr double kSameRow = 1e-6;     // of a step
  constexpr double kOutOfBounds = 1e6;  // m and m/s
  const double steps = std::ceil(s.time_limit / s.time_step - kSameRow);
  if (static_cast<double>(end.rows - 1) >= steps) return true;
  const std::vector<RobotStep>& last = end.last.robots;
  if (s.formation)
    return std::any_of(last.begin(), last.end(), [](const RobotStep& r) {
      return !(geometry::norm(r.position) < kOutOfBounds && geometry::norm(r.velocity) < kOutOfBounds);
    });
  return s.robots.size() == last.size() && has_ended(s, end, somebody_stays);
}

/// Checks rows as they come, each when the next one is there.
class RunAudit {
 public:
  /// `file` grows while rows are taken; `meant` as in `audit`, may be null. Both must outlive it.
  RunAudit(const RecordingFile& file, const formation::Scenario* meant) : file_(file), meant_(meant) {}

  void take(SharedRow row) {
    if (rows_ == 0) begin(*row);
    if (why_.empty()) why_ = obstruction_in(*row);
    if (run_ && row_) check(row.get());
    if (row_) {
      before_.emplace();
      for (const RobotStep& robot : row_->robots) before_->push_back({robot.chosen, robot.mode});
    }
    row_ = std::move(row);
    ++rows_;
  }

  /// REQUIRES: `file` is whole.
  AuditTally finish() {
    tally_.report.rows = rows_;
    look_at_plans();
    if (rows_ == 0) why_ = "there are no rows";
    if (!why_.empty()) return unauditable();
    check(nullptr);
    check_whole();
    const bool is_whole_run = is_whole(file_.scenario, {rows_, *row_, before()}, tally_.report.has_staying);
    tally_.ask(AuditPoint::sequence, is_whole_run,
               "the last row is before the time limit, and not every robot has arrived");
    return std::move(tally_);
  }

  /// Ends a run that breaks off, whose last row was not known to be the last: what the file says beforehand holds for
  /// the rows that there are. REQUIRES: `file` has no goal's bodies and no plan of a row that did not come.
  AuditTally finish_early() {
    tally_.report.rows = rows_;
    look_at_plans();
    if (!why_.empty()) return unauditable();
    if (!run_) return std::move(tally_);
    run_->places.take(*row_);
    check_whole();
    return std::move(tally_);
  }

  std::size_t rows() const { return rows_; }
  /// Null before the first.
  const Step* last_row() const { return row_.get(); }

 private:
  void look_at_plans() {
    for (const formation::JointPlan& plan : file_.recording.plans)
      if (why_.empty()) why_ = obstruction_in(plan, rows_);
  }

  AuditTally unauditable() {
    tally_ = {};
    tally_.report.rows = rows_;
    tally_.refuted(AuditPoint::sequence, why_);
    return std::move(tally_);
  }

  void begin(const Step& first) {
    why_ = obstruction_in(file_);
    if (why_.empty()) why_ = obstruction_in(first);
    if (!why_.empty()) return;
    check_header(file_, first, meant_, tally_);
    of_header_ = tally_.report.findings.size();
    run_.emplace(file_, tally_);
    for (const auto& audit_point : {audit_decisions, audit_sequence, audit_motions, audit_braking, audit_kinematics})
      points_.push_back(audit_point(*run_));
  }

  /// The row that was taken last. `next`: null after the last.
  void check(const Step* next) {
    if (!why_.empty()) return;
    call_wait_hook();  // a long audit ends where its caller wants to
    const RowInRun at{rows_ - 1, *row_, before(), next};
    run_->places.take(at.row);
    for (const auto& point : points_) point->check_row(at);
    if (!next) return;
    for (const auto& point : points_) point->check_step(at);
  }

  /// Points (2) and (8), whose findings come before those of rows.
  void check_whole() {
    std::vector<std::string>& findings = tally_.report.findings;
    const auto of_rows = static_cast<std::ptrdiff_t>(findings.size());
    audit_bodies(*run_);
    audit_plans(*run_);
    std::rotate(findings.begin() + static_cast<std::ptrdiff_t>(of_header_), findings.begin() + of_rows, findings.end());
  }

  const RowBefore* before() const { return before_ ? &*before_ : nullptr; }

  const RecordingFile& file_;
  const formation::Scenario* meant_;
  AuditTally tally_;
  std::optional<AuditedRun> run_;  ///< nothing before the first row, and where there is a `why_`
  std::vector<std::unique_ptr<RowAudit>> points_;
  std::string why_;  ///< why the run can't be audited; else empty
  std::optional<RowBefore> before_;
  SharedRow row_;
  std::size_t rows_ = 0;
  std::size_t of_header_ = 0;  ///< findings
};

/// Lines of a file or a pipe with their digest, which is made while they are read; "-" is standard input.
class SealedLines {
 public:
  explicit SealedLines(const std::filesystem::path& path) : lines_(path.string(), kLargestWholeFile) {}

  bool next(std::string_view& line) {
    if (!lines_.next(line)) return false;
    if (lines_.number() > 1) hash_.add(last_ += '\n');
    last_ = line;
    return true;
  }
  const std::string& file() const { return lines_.file(); }
  /// Whether the last line has the digest of all lines above it. REQUIRES: a recording was read to its end.
  bool are_sealed() {
    const Json last = Json::parse(last_);
    return last.contains("end") && last["end"].value("sha256", "") == hash_.digest();
  }

 private:
  TextLines lines_;
  Sha256 hash_;
  std::string last_;  ///< not in the hash yet
};

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

void add(PointCount& sum, const PointCount& other) {
  sum.proven += other.proven;
  sum.refuted += other.refuted;
  sum.open += other.open;
  sum.unlisted += other.unlisted;
}

/// What is said of rows that did not come goes.
void drop_what_follows(std::size_t rows, const Step* last, formation::Recording& run) {
  const auto follows = [&](const formation::GoalBodies& o) { return !last || o.time > last->time; };
  run.goal_bodies.erase(std::remove_if(run.goal_bodies.begin(), run.goal_bodies.end(), follows), run.goal_bodies.end());
  while (!run.plans.empty() && run.plans.back().row >= rows) run.plans.pop_back();
}

/// Says of a recording that it ends early, as `why` has it.
AuditReport audited_so_far(AuditReport report, const DataError& why) {
  PointCount all;
  for (const PointCount& point : report.points) add(all, point);
  const std::string found = "; audited so far: " + geometry::counted(report.rows, "row") + ", " +
                            geometry::counted(all.asked(), "question") + ", " + std::to_string(all.refuted) +
                            " refuted, " + std::to_string(all.open) + " left open";
  report.cut_off.emplace_back(
      DataError(why.code(), why.file(), why.place(), why.found(), why.expected() + found).what());
  return report;
}

/// Robots and moving obstacles of a row of a crowd.
RowStates states_of(const CrowdRecordingHead& head, const CrowdRow& row) {
  RowStates states{row.step, row.step * head.time_step, {}, {}};
  states.robots.reserve(row.x.size());
  for (std::size_t i = 0; i < row.x.size(); ++i) states.robots.push_back({head.place(row, i), {}});
  for (std::size_t k = 0; k < head.bodies.size(); ++k)
    if (head.bodies[k].moves) states.moved.push_back(head.displacement(row, k));
  return states;
}

std::size_t motions_in(const std::filesystem::path& path) {
  CrowdRecordingReader reader(path);
  std::size_t rows = 0;
  for (CrowdRow row; reader.next(row);) ++rows;
  return rows * reader.head().kind_of.size();
}

/// A recording of places: how robots move, by the points that need no decisions.
AuditReport audit_places(const std::filesystem::path& path, std::size_t sample) {
  const std::size_t one_of = sample == 0 ? 1 : std::max<std::size_t>(1, motions_in(path) / sample);
  CrowdRecordingReader reader(path);
  const RecordingFile file = scene_of(reader.head());
  AuditTally tally;
  AuditedRun run(file, tally);
  run.has_places_only = true;
  run.one_of = one_of;
  const std::unique_ptr<RowAudit> sequence = audit_sequence(run), motions = audit_motions(run),
                                  wheels = audit_wheels(run, reader.head());
  RowStates before;
  for (CrowdRow row; reader.next(row); ++tally.report.rows) {
    call_wait_hook();
    RowStates now = states_of(reader.head(), row);
    const std::size_t number = tally.report.rows;
    if (number == 0 ? now.step != 0 : now.step <= before.step)
      throw DataError(
          DataCode::format_syntax, path.string(), "row " + std::to_string(number), "step " + std::to_string(now.step),
          number == 0 ? "the start of the run, step 0" : "a row after that of step " + std::to_string(before.step));
    for (std::size_t k = 0; k < reader.head().bodies.size(); ++k)
      if (!reader.head().bodies[k].moves && reader.head().displacement(row, k) != geometry::Vec2{})
        tally.refuted(AuditPoint::sequence,
                      at_row(tally.report.rows, reader.head().body_name(k) + " has moved, and stands still"));
    if (tally.report.rows == 0) {
      motions->check_states(0, now, now);
    } else {
      sequence->check_states(tally.report.rows - 1, before, now);
      motions->check_states(tally.report.rows - 1, before, now);
      wheels->check_states(tally.report.rows - 1, before, now);
    }
    before = std::move(now);
  }
  if (tally.report.rows == 0 && !reader.is_cut_off())
    throw DataError(DataCode::format_syntax, path.string(), "", "no row", "the start of the run at least");
  AuditReport report = finished(std::move(tally));
  report.has_places = true;
  if (!reader.is_cut_off()) return report;
  const std::string found = "the end of the file after " + geometry::counted(report.rows, "row");
  return audited_so_far(std::move(report),
                        {DataCode::cut_off, path.string(), "", found, "an end of the recording: it was cut off"});
}

}  // namespace

bool AuditedRun::is_asked(std::size_t row, std::size_t robot) const {
  return one_of == 1 || mixed(row * kRandomStride + robot) % one_of == 0;
}

AuditedRun::AuditedRun(const RecordingFile& recorded, AuditTally& counts)
    : file(recorded), scenario(file.scenario), duration(file.recording.time_step), places(file), tally(counts) {
  for (const formation::SceneObstacle& o : scenario.obstacles) obstacles.emplace_back(o);
  for (const formation::MovingObstacle& o : scenario.moving_obstacles) ways.emplace_back(o.motion);
  if (file.recording.motion == MotionLaw::exponential) law.emplace(Rational(file.recording.tracking_gain), duration);
}

const char* name(AuditPoint point) {
  constexpr const char* kNames[] = {"scenario", "bodies",  "completeness", "half_planes", "choices",
                                    "sequence", "motions", "plans",        "braking",     "kinematics"};
  return kNames[static_cast<std::size_t>(point)];
}

bool AuditReport::fails() const {
  return (*this)[AuditPoint::motions].open > 0 ||
         std::any_of(points.begin(), points.end(), [](const PointCount& p) { return p.refuted > 0; });
}

bool AuditReport::clean() const {
  return !fails() && cut_off.empty();
}

AuditReport audit(const RecordingFile& file, const formation::Scenario* scenario) {
  RunAudit audit(file, scenario);
  for (const Step& row : file.recording.steps) audit.take(SharedRow(SharedRow(), &row));
  return finished(audit.finish());
}

AuditReport audit_recording(const std::filesystem::path& path, const formation::Scenario* scenario,
                            std::size_t sample) {
  if (is_crowd_recording(path)) {
    EXACTVO_REQUIRE(!scenario, "a scenario to compare with " + path.string() + ", which contains none");
    return audit_places(path, sample);
  }
  SealedLines lines(path);
  RecordingFile run;
  RunAudit audit(run, scenario);
  try {
    read_recording_lines([&](std::string_view& line) { return lines.next(line); }, lines.file(),
                         [&](const RecordingFile&, Step row, const formation::LyapunovRow*) {
                           audit.take(std::make_shared<const Step>(std::move(row)));
                         },
                         run);
  } catch (const DataError& error) {
    if (error.code() != DataCode::cut_off || audit.rows() == 0) throw;
    drop_what_follows(audit.rows(), audit.last_row(), run.recording);
    return audited_so_far(finished(audit.finish_early()), error);
  }
  AuditTally tally = audit.finish();
  tally.ask(AuditPoint::scenario, lines.are_sealed(),
            "the lines are not those that the sha256 of the last one was made of");
  return finished(std::move(tally));
}

void add(AuditReport& sum, const AuditReport& other) {
  for (std::size_t p = 0; p < kAuditPoints; ++p) add(sum.points[p], other.points[p]);
  for (std::size_t AuditReport::*count :
       {&AuditReport::rows, &AuditReport::half_planes, &AuditReport::unsafe, &AuditReport::steps,
        &AuditReport::collisions, &AuditReport::hits_standing, &AuditReport::unproven, &AuditReport::inconsistencies,
        &AuditReport::curved_steps, &AuditReport::ends_only, &AuditReport::left_out, &AuditReport::obstacle_questions,
        &AuditReport::moving_questions, &AuditReport::robot_questions})
    sum.*count += other.*count;
  for (bool AuditReport::*some : {&AuditReport::scenario_was_given, &AuditReport::has_staying, &AuditReport::has_sums,
                                  &AuditReport::has_tube, &AuditReport::has_measurements, &AuditReport::has_movers,
                                  &AuditReport::without_pairs, &AuditReport::has_places})
    sum.*some = sum.*some || other.*some;
  sum.largest_bulge = std::max(sum.largest_bulge, other.largest_bulge);
  sum.largest_violation = std::max(sum.largest_violation, other.largest_violation);
  sum.started_overlapping.insert(sum.started_overlapping.end(), other.started_overlapping.begin(),
                                 other.started_overlapping.end());
  sum.cut_off.insert(sum.cut_off.end(), other.cut_off.begin(), other.cut_off.end());
  sum.findings.insert(sum.findings.end(), other.findings.begin(), other.findings.end());
}

std::vector<std::string> not_audited(const AuditReport& report) {
  std::vector<std::string> words;
  if (report.has_places) {
    words.emplace_back("decisions and goals of recordings without them, and whether their runs are whole");
    words.emplace_back(
        "that radii, speed limits, wheels, the tracking error, edges and bodies in a recording of a crowd are those of "
        "its scenario, and its marks of half-planes that were kept");
  }
  if (report.ends_only > 0)
    words.emplace_back("how robots came from one row to the next where these are several steps apart: of " +
                       geometry::counted(report.ends_only, "motion") + " only the ends are judged");
  if (report.left_out > 0) words.push_back(geometry::counted(report.left_out, "motion") + " that --sample left out");
  if (report.has_tube)
    words.emplace_back(
        "that bodies are where rows have them, up to the tracking error of the scenario, which is assumed: what is "
        "proven holds in every world in which they are");
  if (report.has_places && report[AuditPoint::scenario].asked() == 0) return words;
  if (!report.scenario_was_given)
    words.emplace_back("that the scenario in the recording is the intended one (--scenario FILE compares them)");
  words.emplace_back(
      "why a velocity was preferred, and entries that explain it: mode, side, note, lacks_room_to_turn, "
      "clearance, fell_back, method, controller, outcome, warnings, stuck, collisions, lyapunov, provenance, wall "
      "time");
  words.emplace_back(
      "whether the rows have the half-planes against what is out of reach of a time step, also where "
      "all_half_planes says so");
  words.emplace_back(
      "that recorded half-planes forbid no more than they must, and that those marked as a user's are: a choice is the "
      "best, and its stage the first, for the half-planes in its row");
  if (report.without_pairs)
    words.emplace_back(
        "half-planes of pairs of robots: the method promises nothing between robots, and their motions tell");
  if (report[AuditPoint::kinematics].asked() > 0)
    words.emplace_back(
        "that robots on wheels could not have chosen better velocities than their recorded limits allow, and that "
        "their wheels did as recorded");
  if (report.has_measurements)
    words.emplace_back(
        "that robots of the world measure within the bounds of the scenario, as those of the rows do, which is "
        "assumed");
  if (report.has_movers)
    words.emplace_back(
        "that moving obstacles of the world are no faster than their max_speed, as those of the rows are, which is "
        "assumed; and robots that stand, which they may hit: " +
        geometry::counted(report.hits_standing, "step") + " in which that is so");
  if (report.has_staying)
    words.emplace_back(
        "that the goals of robots that stay are out of reach (`route` proves it, and `audit --certificate` its "
        "answer) or taken by others");
  if (report.has_sums)
    words.emplace_back(
        "what robots track whose controller adds to the choice, or bounds its change: that they track "
        "one velocity over the step is asked, not which");
  return words;
}

std::string to_json(const AuditReport& report) {
  JsonWriter json(JsonWriter::Layout::indented);
  json.begin_object();
  json.member("rows", report.rows);
  json.member("cut_off", !report.cut_off.empty());
  json.member("half_planes", report.half_planes);
  json.member("unsafe", report.unsafe);
  json.member("steps", report.steps);
  json.member("collisions", report.collisions);
  json.member_if(report.has_movers, "hits_standing", report.hits_standing);
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
  json.member_if(report.has_places, "ends_only", report.ends_only);
  json.member_if(report.has_places, "left_out", report.left_out);
  json.member("against_obstacles", report.obstacle_questions);
  json.member("against_moving_obstacles", report.moving_questions);
  json.member("against_robots", report.robot_questions);
  json.member("largest_bulge", report.largest_bulge).end_object();
  json.member_if(!report.started_overlapping.empty(), "started_overlapping", report.started_overlapping);
  json.member("not_audited", not_audited(report)).member("findings", report.findings);
  return json.end_object().take();
}

}  // namespace exactvo::datasets
