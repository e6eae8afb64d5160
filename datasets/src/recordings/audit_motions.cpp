// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/audit_points.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "exactvo/geometry/told_apart.h"

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
using formation::MotionLaw;

/// Whether what follows the chord comes nearer than `reach` to the point.
Verdict against_point(const Chord& chord, const exact::Point& point, const Rational& reach) {
  const Rational squared = exact::squared_distance(point, chord.way);
  if (chord.stray < reach) {
    const Rational surely = reach - chord.stray;
    if (squared < surely * surely) return Verdict::meets;
  }
  const Rational possibly = reach + chord.stray;
  return squared >= possibly * possibly ? Verdict::clear : Verdict::unknown;
}

/// Whether what follows the chord comes nearer than r to an edge or is inside, or comes nearer than r to the disc.
Verdict against(const Chord& chord, const RationalObstacle& obstacle, const std::vector<std::size_t>& edges,
                const Rational& r) {
  if (obstacle.disc) return against_point(chord, obstacle.disc->center, r + obstacle.disc->radius);
  const auto some_nearer_than = [&](const Rational& reach) {
    return std::any_of(edges.begin(), edges.end(), [&](std::size_t edge) {
      return exact::come_nearer_than(chord.way, obstacle.edges[edge], reach);
    });
  };
  if (chord.stray < r && some_nearer_than(r - chord.stray)) return Verdict::meets;
  if (sgn(chord.stray) > 0 && some_nearer_than(r + chord.stray)) return Verdict::unknown;
  return exact::is_inside(chord.way.from, *obstacle.obstacle) ? Verdict::meets : Verdict::clear;
}

class MotionAudit : public RowAudit {
 public:
  explicit MotionAudit(const AuditedRun& run) : run_(run) {
    for (const formation::MovingObstacle& o : run.scenario.moving_obstacles) moving_.emplace_back(o);
  }

  void check_row(const RowInRun& at) override {
    row_ = at.number;
    if (run_.scenario.separate) part(at);
  }

  void check_step(const RowInRun& at) override {
    const formation::Step &from = at.row, &to = *at.next;
    if (!(from.time >= 0.0 && from.time < to.time)) return;
    const exact::ExponentialLaw* law = run_.law ? &*run_.law : nullptr;
    AuditReport& report = run_.tally.report;
    std::vector<Driven> driven;
    for (std::size_t i = 0; i < run_.scenario.robots.size(); ++i) {
      const StepMotion motion(run_.file.recording.motion, law, run_.duration, from.robots[i], to.robots[i]);
      const Chord whole = motion.over(Rational(0), Rational(1));
      report.largest_bulge = std::max(report.largest_bulge, exact::at_least(whole.stray));
      driven.push_back({motion, box_of(whole)});
    }
    const Moved moved = displacements(from, to);
    for (std::size_t i = 0; i < driven.size(); ++i) {
      if (run_.file.recording.motion != MotionLaw::straight) ++report.curved_steps;
      Answer answer;
      meet_obstacles(driven[i], i, answer);
      meet_moving(driven[i], i, moved, answer);
      meet_robots(driven, i, answer);
      const std::string& robot = run_.scenario.robots[i].id;
      if (!answer.met.empty())
        run_.tally.refuted(AuditPoint::motions, at_row(at.number, robot + " overlaps " + answer.met));
      else if (!answer.open.empty())
        run_.tally.open(AuditPoint::motions,
                        at_row(at.number, robot + " comes too near to " + answer.open + " to be proven clear of it"));
      else
        run_.tally.proven(AuditPoint::motions);
    }
  }

 private:
  /// A row's time step as one robot drives it.
  struct Driven {
    StepMotion motion;
    geometry::Box box;
  };
  /// Of one robot and step: whom it meets, and from whom it cannot be told apart; empty where there is nobody.
  struct Answer {
    std::string met, open;
    void take(Verdict verdict, const char* kind, const std::string& id) {
      if (verdict == Verdict::clear) return;
      std::string& where = verdict == Verdict::meets ? met : open;
      if (where.empty()) where = std::string(kind) + " '" + id + "'";
    }
  };
  /// What moving obstacles do between two rows.
  struct Moved {
    Rational start, passed;  ///< s
    std::vector<std::vector<ExactWay::TimedChord>> ways;
  };

  Moved displacements(const formation::Step& from, const formation::Step& to) const {
    const Rational start(from.time), end(to.time);
    Moved moved{start, end - start, {}};
    for (const ExactWay& way : run_.ways) moved.ways.push_back(way.over(start, end));
    return moved;
  }

  void meet_obstacles(const Driven& d, std::size_t i, Answer& answer) {
    const double radius = run_.scenario.robots[i].radius;
    const Rational r(radius);
    for (std::size_t k = 0; k < run_.obstacles.size(); ++k) {
      ++run_.tally.report.obstacle_questions;
      if (are_apart(d.box, run_.obstacles[k].box, radius)) continue;
      const std::vector<std::size_t> edges = run_.obstacles[k].near(d.box, radius);
      const auto over = [&](const Rational& s, const Rational& e) { return d.motion.over(s, e); };
      const auto test = [&](const Chord& chord) { return against(chord, run_.obstacles[k], edges, r); };
      answer.take(exact::decide(over, test, Rational(0), Rational(1)), "obstacle", run_.scenario.obstacles[k].id);
    }
  }

  /// Piece after piece of the obstacle's way, seen from the obstacle.
  void meet_moving(const Driven& d, std::size_t i, const Moved& moved, Answer& answer) {
    const double radius = run_.scenario.robots[i].radius;
    const Rational r(radius);
    const Rational &from = moved.start, &passed = moved.passed;
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      ++run_.tally.report.moving_questions;
      for (const ExactWay::TimedChord& piece : moved.ways[k]) {
        const Rational start = (piece.start - from) / passed, end = (piece.end - from) / passed;
        const geometry::Box seen = box_of(d.motion.over(start, end) - piece.chord);
        if (are_apart(seen, moving_[k].box, radius)) continue;
        const std::vector<std::size_t> edges = moving_[k].near(seen, radius);
        const auto over = [&](const Rational& s, const Rational& e) {
          return d.motion.over(s, e) - run_.ways[k].within(from + s * passed, from + e * passed);
        };
        const auto test = [&](const Chord& chord) { return against(chord, moving_[k], edges, r); };
        answer.take(exact::decide(over, test, start, end), "moving obstacle", run_.scenario.moving_obstacles[k].id);
      }
    }
  }

  void meet_robots(const std::vector<Driven>& driven, std::size_t i, Answer& answer) {
    constexpr double kRounding = 1.0 + 0x1p-50;
    for (std::size_t j = 0; j < driven.size(); ++j) {
      if (j == i) continue;
      ++run_.tally.report.robot_questions;
      const double radius = run_.scenario.robots[i].radius, other = run_.scenario.robots[j].radius;
      if (are_apart(driven[i].box, driven[j].box, kRounding * (radius + other))) continue;
      if (parting_.count(std::minmax(i, j)) > 0) {
        if (!comes_nearer(driven[i], driven[j])) continue;
        answer.take(Verdict::meets, "robot", run_.scenario.robots[j].id);
        if (nearer_.emplace(std::minmax(i, j)).second)
          tell(std::minmax(i, j), "came nearer after row " + std::to_string(row_));
        continue;
      }
      const Rational reach = Rational(radius) + Rational(other);
      const StepMotion seen = driven[i].motion.seen_from(driven[j].motion);
      const auto over = [&](const Rational& s, const Rational& e) { return seen.over(s, e); };
      const auto test = [&](const Chord& chord) { return against_point(chord, {Rational(0), Rational(0)}, reach); };
      answer.take(exact::decide(over, test, Rational(0), Rational(1)), "robot", run_.scenario.robots[j].id);
    }
  }

  // --- Pairs that started in overlap ---

  static Straight relative(const Driven& a, const Driven& b) {
    return a.motion.seen_from(b.motion).over(Rational(0), Rational(1)).way;
  }

  /// Pairs that overlap in the first row, and of these the ones that still do.
  void part(const RowInRun& at) {
    const std::vector<formation::Robot>& robots = run_.scenario.robots;
    const auto overlap = [&](std::size_t i, std::size_t j) {
      const Point d = exactly(at.row.robots[i].position) - exactly(at.row.robots[j].position);
      const Rational reach = Rational(robots[i].radius) + Rational(robots[j].radius);
      return exact::dot(d, d) < reach * reach;
    };
    if (at.number == 0)
      for (std::size_t i = 0; i < robots.size(); ++i)
        for (std::size_t j = i + 1; j < robots.size(); ++j)
          if (overlap(i, j)) {
            parting_.emplace(i, j);
            told_[{i, j}] = run_.tally.report.started_overlapping.size();
            run_.tally.report.started_overlapping.push_back(robots[i].id + " and " + robots[j].id +
                                                            ", still in overlap at the end");
          }
    for (auto pair = parting_.begin(); pair != parting_.end();) {
      const auto [i, j] = *pair;
      if (overlap(i, j)) {
        ++pair;
        continue;
      }
      if (nearer_.count(*pair) == 0) tell(*pair, "apart from " + geometry::lossless(at.row.time) + " s on");
      pair = parting_.erase(pair);
    }
  }

  /// What became of a pair.
  void tell(const std::pair<std::size_t, std::size_t>& pair, const std::string& words) {
    const std::vector<formation::Robot>& robots = run_.scenario.robots;
    run_.tally.report.started_overlapping[told_.at(pair)] =
        robots[pair.first].id + " and " + robots[pair.second].id + ", " + words;
  }

  /// By more than the rounding of places and motions. Straight motions: the distance is convex, so that it grows all
  /// the way if it does at the start.
  bool comes_nearer(const Driven& a, const Driven& b) const {
    const Straight seen = relative(a, b), of_a = a.motion.over(Rational(0), Rational(1)).way;
    const Point m = seen.to - seen.from;
    const auto size = [](const Point& p) { return Rational(abs(p.x) + abs(p.y)); };
    const Rational rounding = kRoundingOfPlaces * (size(of_a.from) + size(seen.from) + size(m));
    return exact::dot(seen.from, m) < -size(seen.from) * rounding;
  }

  static constexpr double kRoundingOfPlaces = 0x1p-44;  ///< of the coordinates, in a step
  const AuditedRun& run_;
  std::vector<RationalObstacle> moving_;
  std::size_t row_ = 0;
  std::set<std::pair<std::size_t, std::size_t>> parting_, nearer_;   ///< nearer_: pairs that came nearer while parting
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> told_;  ///< where in the report each pair stands
};

}  // namespace

std::unique_ptr<RowAudit> audit_motions(const AuditedRun& run) {
  return std::make_unique<MotionAudit>(run);
}

}  // namespace exactvo::datasets
