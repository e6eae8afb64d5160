// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/audit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/vo/certificate.h"
#include "json_text.h"
#include "recordings/exact_motion.h"
#include "sha256.h"
#include "text_file.h"

namespace exactvo::datasets {
namespace {

using exact::Chord;
using exact::exactly;
using exact::ExactWay;
using exact::Point;
using exact::Rational;
using exact::StepMotion;
using exact::Straight;
using exact::Verdict;
using formation::ConstraintSource;
using formation::MotionLaw;
using formation::RecordedConstraint;
using formation::Step;
using geometry::Vec2;

// --- What can be skipped: boxes in doubles, which hold what they stand for ---

struct Box {
  double left, right, bottom, top;
};

Box box_of(const geometry::Segment& s) {
  return {std::min(s.a.x, s.b.x), std::max(s.a.x, s.b.x), std::min(s.a.y, s.b.y), std::max(s.a.y, s.b.y)};
}

Box box_of(const Chord& c) {
  const auto [left, right] = std::minmax(c.way.from.x, c.way.to.x);
  const auto [bottom, top] = std::minmax(c.way.from.y, c.way.to.y);
  return {exact::at_most(left - c.stray), exact::at_least(right + c.stray), exact::at_most(bottom - c.stray),
          exact::at_least(top + c.stray)};
}

/// A difference of doubles that is rounded above r is above r: rounding never changes an order.
bool are_apart(const Box& a, const Box& b, double r) {
  return a.left - b.right > r || b.left - a.right > r || a.bottom - b.top > r || b.bottom - a.top > r;
}

// --- The audit ---

/// An obstacle's edges as rationals, once for all steps.
struct RationalObstacle {
  explicit RationalObstacle(const geometry::Obstacle& shape) : obstacle(&shape) {
    for (const geometry::Segment& edge : edges_of(shape)) {
      edges.push_back({exactly(edge.a), exactly(edge.b)});
      boxes.push_back(box_of(edge));
    }
    box = boxes.front();
    for (const Box& b : boxes) {
      box.left = std::min(box.left, b.left);
      box.right = std::max(box.right, b.right);
      box.bottom = std::min(box.bottom, b.bottom);
      box.top = std::max(box.top, b.top);
    }
  }

  /// Edges that something within the box may come nearer to than r.
  std::vector<const Straight*> near(const Box& within, double r) const {
    std::vector<const Straight*> out;
    for (std::size_t k = 0; k < edges.size(); ++k)
      if (!are_apart(within, boxes[k], r)) out.push_back(&edges[k]);
    return out;
  }

  const geometry::Obstacle* obstacle;
  std::vector<Straight> edges;
  std::vector<Box> boxes;
  Box box;  ///< of the whole, its inside too
};

/// Whether what follows the chord comes nearer than r to an edge or is inside.
Verdict against(const Chord& chord, const RationalObstacle& obstacle, const std::vector<const Straight*>& edges,
                const Rational& r) {
  const auto some_nearer_than = [&](const Rational& reach) {
    return std::any_of(edges.begin(), edges.end(),
                       [&](const Straight* edge) { return exact::come_nearer_than(chord.way, *edge, reach); });
  };
  if (chord.stray < r && some_nearer_than(r - chord.stray)) return Verdict::meets;
  if (sgn(chord.stray) > 0 && some_nearer_than(r + chord.stray)) return Verdict::unknown;
  return exact::is_inside(chord.way.from, *obstacle.obstacle) ? Verdict::meets : Verdict::clear;
}

/// Whether what follows the chord comes nearer than `reach` to the origin.
Verdict against_origin(const Chord& chord, const Rational& reach) {
  const Rational squared = exact::squared_distance({Rational(0), Rational(0)}, chord.way);
  if (chord.stray < reach) {
    const Rational surely = reach - chord.stray;
    if (squared < surely * surely) return Verdict::meets;
  }
  const Rational possibly = reach + chord.stray;
  return squared >= possibly * possibly ? Verdict::clear : Verdict::unknown;
}

/// A row's time step as one robot drives it.
struct Driven {
  StepMotion motion;
  Box box;
};

class Auditor {
 public:
  explicit Auditor(const RecordingFile& file) : file_(file), duration_(file.recording.time_step) {
    Rational end(0);
    for (const Step& step : file.recording.steps) end = std::max(end, Rational(step.time));
    for (const formation::SceneObstacle& o : file.scenario.obstacles) obstacles_.emplace_back(o.shape);
    for (const formation::MovingObstacle& o : file.scenario.moving_obstacles) {
      moving_.emplace_back(o.shape);
      ways_.emplace_back(o.motion, end);
    }
    if (file.recording.motion == MotionLaw::exponential)
      law_.emplace(Rational(file.recording.tracking_gain), duration_);
  }

  AuditReport operator()() {
    const std::vector<Step>& rows = file_.recording.steps;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      call_wait_hook();  // a long audit ends where its caller wants to
      check_half_planes(k);
      if (k + 1 == rows.size()) continue;
      check_sequence(k);
      check_law(k);
      if (rows[k].time >= 0.0 && rows[k].time < rows[k + 1].time) check_motions(k);
    }
    return std::move(report_);
  }

 private:
  void find(std::size_t& counter, std::size_t row, const std::string& what) {
    if (counter++ == 0 || report_.findings.size() < kMostAuditFindings)
      report_.findings.push_back("row " + std::to_string(row) + ": " + what);
  }

  const std::string& robot(std::size_t i) const { return file_.scenario.robots[i].id; }

  void check_half_planes(std::size_t row) {
    const Step& step = file_.recording.steps[row];
    for (std::size_t i = 0; i < step.robots.size(); ++i) {
      for (const RecordedConstraint& c : step.robots[i].constraints) {
        if (!c.certified || c.source == ConstraintSource::robot) continue;
        ++report_.half_planes;
        if (!vo::is_true({c.shape, c.position, c.radius, c.tau, c.shape_velocity, c.half_plane}))
          find(report_.unsafe, row, "a half-plane of " + robot(i) + " is not disjoint from its velocity obstacle");
      }
    }
  }

  /// Rows are a time step apart, up to the rounding of their times.
  void check_sequence(std::size_t row) {
    const std::vector<Step>& rows = file_.recording.steps;
    const double dt = file_.recording.time_step;
    const double passed = rows[row + 1].time - rows[row].time;
    const double rounding = 0x1p-40 * (std::fabs(rows[row + 1].time) + dt);  // sums of up to 2^12 steps err by less
    if (!(std::fabs(passed - dt) <= rounding))
      find(report_.inconsistencies, row, "the next row is not a time step later");
  }

  /// The next row must follow from this one by the law of motion, up to the rounding of doubles; that of the general
  /// integrators has no closed form and is not asked.
  void check_law(std::size_t row) {
    const std::vector<formation::RobotStep>& from = file_.recording.steps[row].robots;
    const std::vector<formation::RobotStep>& to = file_.recording.steps[row + 1].robots;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const bool follows = file_.recording.motion == MotionLaw::hermite ||
                           (law_ ? follows_exponentially(from[i], to[i]) : follows_straight(from[i], to[i]));
      if (!follows) find(report_.inconsistencies, row, robot(i) + " does not get to the next row by its law of motion");
    }
  }

  /// x1 = x0 + T v, v the choice of a kinematic robot, which is its velocity then, or the velocity of explicit Euler:
  /// three roundings.
  bool follows_straight(const formation::RobotStep& from, const formation::RobotStep& to) const {
    const geometry::Vec2 driven = file_.scenario.formation ? from.velocity : from.chosen;
    if (!geometry::is_finite(driven) || (!file_.scenario.formation && to.velocity != from.chosen)) return false;
    const Point x0 = exactly(from.position), x1 = exactly(to.position), way = duration_ * exactly(driven);
    const Rational scale = exact::length_at_most(x0) + exact::length_at_most(way);
    return exact::length_at_most(x1 - x0 - way) <= scale * Rational(0x1p-51);
  }

  /// x1 - x0 = T v0 - lag (v0 - v1): fewer than 32 roundings of the coordinates and of what the velocities, the tracked
  /// one among them, are worth over the step.
  bool follows_exponentially(const formation::RobotStep& from, const formation::RobotStep& to) const {
    const Point v0 = exactly(from.velocity), change = v0 - exactly(to.velocity);
    const Point x0 = exactly(from.position), x1 = exactly(to.position);
    const Point left = x1 - x0 - duration_ * v0 + law_->lag().middle() * change;
    const Rational speeds = exact::length_at_most(v0) + exact::length_at_most(change) / law_->settled().low;
    const Rational scale = exact::length_at_most(x0) + exact::length_at_most(x1) + duration_ * speeds;
    return exact::length_at_most(left) <= scale * Rational(0x1p-48) + law_->lag().half_width() * speeds;
  }

  void check_motions(std::size_t row) {
    const Step& from = file_.recording.steps[row];
    const Step& to = file_.recording.steps[row + 1];
    std::vector<Driven> driven;
    for (std::size_t i = 0; i < file_.scenario.robots.size(); ++i) {
      const StepMotion motion(file_.recording.motion, law_ ? &*law_ : nullptr, duration_, from.robots[i], to.robots[i]);
      const Chord whole = motion.over(Rational(0), Rational(1));
      report_.largest_bulge = std::max(report_.largest_bulge, exact::at_least(whole.stray));
      driven.push_back({motion, box_of(whole)});
    }
    const std::vector<std::vector<ExactWay::TimedChord>> moved = displacements(row);
    for (std::size_t i = 0; i < driven.size(); ++i) {
      ++report_.steps;
      if (file_.recording.motion != MotionLaw::straight) ++report_.curved_steps;
      Answer answer;
      meet_obstacles(driven[i], i, answer);
      meet_moving(driven[i], i, row, moved, answer);
      meet_robots(driven, i, answer);
      if (!answer.met.empty()) find(report_.collisions, row, robot(i) + " overlaps " + answer.met);
      if (answer.met.empty() && !answer.open.empty())
        find(report_.unproven, row, robot(i) + " comes too near to " + answer.open + " to be proven clear of it");
    }
  }

  /// Of one robot and step: whom it meets, and from whom it cannot be told apart; empty where there is nobody.
  struct Answer {
    std::string met, open;
    void take(Verdict verdict, const char* kind, const std::string& id) {
      if (verdict == Verdict::clear) return;
      std::string& where = verdict == Verdict::meets ? met : open;
      if (where.empty()) where = kind + id;
    }
  };

  void meet_obstacles(const Driven& d, std::size_t i, Answer& answer) {
    const double radius = file_.scenario.robots[i].radius;
    const Rational r(radius);
    for (std::size_t k = 0; k < obstacles_.size(); ++k) {
      ++report_.obstacle_questions;
      if (are_apart(d.box, obstacles_[k].box, radius)) continue;
      const std::vector<const Straight*> edges = obstacles_[k].near(d.box, radius);
      const auto over = [&](const Rational& s, const Rational& e) { return d.motion.over(s, e); };
      const auto test = [&](const Chord& chord) { return against(chord, obstacles_[k], edges, r); };
      answer.take(exact::decide(over, test, Rational(0), Rational(1)), "obstacle ", file_.scenario.obstacles[k].id);
    }
  }

  std::vector<std::vector<ExactWay::TimedChord>> displacements(std::size_t row) const {
    const Rational from(file_.recording.steps[row].time), to(file_.recording.steps[row + 1].time);
    std::vector<std::vector<ExactWay::TimedChord>> all;
    for (const ExactWay& way : ways_) all.push_back(way.over(from, to));
    return all;
  }

  /// Piece after piece of the obstacle's way, seen from the obstacle.
  void meet_moving(const Driven& d, std::size_t i, std::size_t row,
                   const std::vector<std::vector<ExactWay::TimedChord>>& moved, Answer& answer) {
    const double radius = file_.scenario.robots[i].radius;
    const Rational r(radius);
    const Rational from(file_.recording.steps[row].time), passed = Rational(file_.recording.steps[row + 1].time) - from;
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      ++report_.moving_questions;
      for (const ExactWay::TimedChord& piece : moved[k]) {
        const Rational start = (piece.start - from) / passed, end = (piece.end - from) / passed;
        const Box seen = box_of(d.motion.over(start, end) - piece.chord);
        if (are_apart(seen, moving_[k].box, radius)) continue;
        const std::vector<const Straight*> edges = moving_[k].near(seen, radius);
        const auto over = [&](const Rational& s, const Rational& e) {
          return d.motion.over(s, e) - ways_[k].within(from + s * passed, from + e * passed);
        };
        const auto test = [&](const Chord& chord) { return against(chord, moving_[k], edges, r); };
        answer.take(exact::decide(over, test, start, end), "moving obstacle ", file_.scenario.moving_obstacles[k].id);
      }
    }
  }

  void meet_robots(const std::vector<Driven>& driven, std::size_t i, Answer& answer) {
    for (std::size_t j = 0; j < driven.size(); ++j) {
      if (j == i) continue;
      ++report_.robot_questions;
      const Rational reach = Rational(file_.scenario.robots[i].radius) + Rational(file_.scenario.robots[j].radius);
      if (are_apart(driven[i].box, driven[j].box, exact::at_least(reach))) continue;
      const StepMotion seen = driven[i].motion.seen_from(driven[j].motion);
      const auto over = [&](const Rational& s, const Rational& e) { return seen.over(s, e); };
      const auto test = [&](const Chord& chord) { return against_origin(chord, reach); };
      answer.take(exact::decide(over, test, Rational(0), Rational(1)), "robot ", robot(j));
    }
  }

  const RecordingFile& file_;
  Rational duration_;
  std::vector<RationalObstacle> obstacles_, moving_;
  std::vector<ExactWay> ways_;
  std::optional<exact::ExponentialLaw> law_;
  AuditReport report_;
};

/// What keeps a recording from being audited at all; empty where nothing does.
std::string obstruction(const RecordingFile& file) {
  const formation::Recording& recording = file.recording;
  const bool is_exponential = recording.motion == MotionLaw::exponential;
  if (!(recording.time_step > 0.0) || !std::isfinite(recording.time_step)) return "the time step is not above 0";
  if (is_exponential && (!(recording.tracking_gain > 0.0) || !std::isfinite(recording.tracking_gain)))
    return "the tracking gain is not above 0";
  if (recording.time_step > kLargestCoordinate) return "the time step is out of range";
  const auto in_range = [](Vec2 v) {
    return std::fabs(v.x) <= kLargestCoordinate && std::fabs(v.y) <= kLargestCoordinate;
  };
  for (const Step& step : recording.steps) {
    if (!(std::fabs(step.time) <= kLargestCoordinate)) return "a row's time is not finite, or out of range";
    for (const formation::RobotStep& robot : step.robots) {
      if (!in_range(robot.position)) return "a robot's position is not finite, or out of range";
      if (!in_range(robot.velocity)) return "a robot's velocity is not finite, or out of range";
    }
  }
  return recording.steps.empty() ? "there are no rows" : "";
}

/// How robots move between rows: straight without a formation; with one, as its integrator has it.
MotionLaw law_of(const RecordingFile& file) {
  if (!file.scenario.formation) return MotionLaw::straight;
  const std::string integrator = file.info.integrator.value_or("exact");
  if (integrator == "exact") return MotionLaw::exponential;
  return integrator == "euler" ? MotionLaw::straight : MotionLaw::hermite;
}

/// The header against its own scenario.
void check_header(const RecordingFile& file, AuditReport& report) {
  const auto require = [&](bool ok, const char* what) {
    if (ok) return;
    ++report.inconsistencies;
    report.findings.emplace_back(what);
  };
  require(file.recording.time_step == file.scenario.time_step, "the header's time step is not the scenario's");
  require(file.recording.motion == law_of(file), "the header's motion is not that of its scenario and integrator");
  require(file.recording.steps.front().time == 0.0, "the first row is not at t = 0");
  const std::vector<formation::Robot>& robots = file.scenario.robots;
  const std::vector<formation::RobotStep>& first = file.recording.steps.front().robots;
  const bool starts = std::equal(robots.begin(), robots.end(), first.begin(), first.end(),
                                 [](const formation::Robot& robot, const formation::RobotStep& step) {
                                   return robot.position == step.position && robot.velocity == step.velocity;
                                 });
  require(starts, "the first row is not the scenario's start");
  if (file.recording.motion == MotionLaw::exponential)
    require(file.scenario.formation && file.recording.tracking_gain == file.scenario.formation->gains.k3,
            "the header's tracking gain is not the scenario's k3");
}

/// The seal in the last line against all above it.
void check_seal(const std::string& text, AuditReport& report) {
  const std::size_t end = text.find_last_not_of('\n');
  const std::size_t before = text.rfind('\n', end);
  const std::size_t last_line = before == std::string::npos ? 0 : before + 1;
  Sha256 hash;
  hash.add(std::string_view(text).substr(0, last_line));
  const Json last = Json::parse(text.begin() + static_cast<std::ptrdiff_t>(last_line), text.end());
  if (last.contains("end") && last["end"].value("sha256", "") == hash.digest()) return;
  ++report.inconsistencies;
  report.findings.push_back("the lines are not those that the sha256 of the last one was made of");
}

}  // namespace

AuditReport audit(const RecordingFile& file) {
  const std::string why = obstruction(file);
  if (why.empty()) {
    AuditReport report = Auditor(file)();
    check_header(file, report);
    return report;
  }
  AuditReport report;
  report.inconsistencies = 1;
  report.findings.push_back(why);
  return report;
}

AuditReport audit_recording(const std::filesystem::path& path) {
  AuditReport report = audit(read_recording(path));
  check_seal(read_text_file(path), report);
  return report;
}

void add(AuditReport& sum, const AuditReport& other) {
  for (std::size_t AuditReport::*count :
       {&AuditReport::half_planes, &AuditReport::unsafe, &AuditReport::steps, &AuditReport::collisions,
        &AuditReport::unproven, &AuditReport::inconsistencies, &AuditReport::curved_steps,
        &AuditReport::obstacle_questions, &AuditReport::moving_questions, &AuditReport::robot_questions})
    sum.*count += other.*count;
  sum.largest_bulge = std::max(sum.largest_bulge, other.largest_bulge);
  sum.findings.insert(sum.findings.end(), other.findings.begin(), other.findings.end());
}

const std::vector<std::string>& not_audited() {
  static const std::vector<std::string> words{
      "that every obstacle and robot within reach has a half-plane",
      "that the shapes, radii and horizons beside the half-planes are the scenario's",
      "that the half-planes between robots leave no collision",
      "that the chosen velocities satisfy the half-planes and the speed limit",
      "that rows of the integrators rk4, dopri5 and rosenbrock4 solve the law of motion (what is proven clear is the "
      "cubic through them)"};
  return words;
}

std::string to_json(const AuditReport& report) {
  JsonWriter json(JsonWriter::Layout::indented);
  const auto count = [&json](const char* key, std::size_t n) { json.member(key, static_cast<std::uint64_t>(n)); };
  json.begin_object();
  count("half_planes", report.half_planes);
  count("unsafe", report.unsafe);
  count("steps", report.steps);
  count("collisions", report.collisions);
  count("unproven", report.unproven);
  count("inconsistencies", report.inconsistencies);
  json.key("proved").begin_object();
  count("half_planes", report.half_planes - report.unsafe);
  count("clear_steps", report.steps - report.collisions - report.unproven);
  count("curved_steps", report.curved_steps);
  count("against_obstacles", report.obstacle_questions);
  count("against_moving_obstacles", report.moving_questions);
  count("against_robots", report.robot_questions);
  json.member("largest_bulge", report.largest_bulge).end_object();
  const auto texts = [&json](const char* key, const std::vector<std::string>& all) {
    json.key(key).begin_array();
    for (const std::string& text : all) json.value(text);
    json.end_array();
  };
  texts("not_audited", not_audited());
  texts("findings", report.findings);
  json.end_object();
  return json.take();
}

}  // namespace exactvo::datasets
