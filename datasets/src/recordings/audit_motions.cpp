// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is plainly apart is told by distances in doubles and the bound of their rounding (geometry/distance.h); all else
// is decided in rationals. Contact is clear.
#include "recordings/audit_points.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/told_apart.h"

namespace exactvo::datasets {

using exact::Chord;
using exact::Point;
using exact::Rational;
using exact::StepMotion;
using exact::Straight;
using exact::Verdict;
using formation::MotionLaw;
using geometry::Box;
using geometry::Segment;
using geometry::Vec2;

Verdict against_point(const Chord& chord, const Point& point, const Rational& reach) {
  const Rational squared = exact::squared_distance(point, chord.way);
  if (chord.stray < reach) {
    const Rational surely = reach - chord.stray;
    if (squared < surely * surely) return Verdict::meets;
  }
  const Rational possibly = reach + chord.stray;
  return squared >= possibly * possibly ? Verdict::clear : Verdict::unknown;
}

Verdict against(const Chord& chord, const RationalObstacle& obstacle, const std::vector<NearEdge>& edges,
                const Rational& reach) {
  if (obstacle.disc) return against_point(chord, obstacle.disc->center, reach + obstacle.disc->radius);
  const auto some_nearer = [&](const Rational& by) {
    return std::any_of(edges.begin(), edges.end(), [&](const NearEdge& near) {
      const Rational r = near.reach + by;
      return sgn(r) > 0 && exact::come_nearer_than(chord.way, obstacle.edges[near.edge], r);
    });
  };
  if (some_nearer(-chord.stray)) return Verdict::meets;
  if (sgn(chord.stray) > 0 && some_nearer(chord.stray)) return Verdict::unknown;
  return exact::is_inside(chord.way.from, *obstacle.obstacle) ? Verdict::meets : Verdict::clear;
}

namespace {

constexpr double kRoundedUp = 1.0 + 0x1p-50;  // of a sum of radii

/// Nearer to contact than this share of the numbers involved, a crowd may take a robot and an obstacle for touching
/// (formation/crowd.h: 40 u in float). Of such an obstacle it promises less: the robot comes no nearer in a step, up to
/// this share again, and is apart from one that moves at the end of it.
constexpr double kTouches = 40.0 * 0x1p-24;

/// A robot that touches may come nearer by rounding: by this share of its radius at most.
constexpr double kMostRounding = 0.01;

double one_norm(Vec2 v) {
  return std::fabs(v.x) + std::fabs(v.y);
}

/// Holds what is nearer to the box than r.
Box round_box(const Box& box, double r) {
  return box.grown(kRoundedUp * r + geometry::rounding_of_distance(box.largest_coordinate() + r));
}

/// `distance`: of things in these boxes, rounded.
bool is_surely_more(double distance, const Box& a, const Box& b, double r) {
  return distance - geometry::rounding_of_distance(a.largest_coordinate() + b.largest_coordinate()) > kRoundedUp * r;
}

class MotionAudit : public RowAudit {
 public:
  explicit MotionAudit(const AuditedRun& run)
      : run_(run),
        is_straight_(run.file.recording.motion == MotionLaw::straight),
        has_places_only_(run.has_places_only) {
    std::vector<Box> boxes;
    for (const RationalObstacle& o : run.obstacles) boxes.push_back(o.box);
    obstacles_by_place_ = geometry::BoxGrid(std::move(boxes));
    for (const formation::MovingObstacle& o : run.scenario.moving_obstacles) moving_.emplace_back(o);
    for (const formation::Robot& robot : run.scenario.robots) largest_ = std::max(largest_, robot.radius);
  }

  void check_row(const RowInRun& at) override {
    if (!run_.scenario.separate) return;
    std::vector<Vec2> places;
    for (const formation::RobotStep& robot : at.row.robots) places.push_back(robot.position);
    part(at.number, at.row.time, places);
  }

  void check_step(const RowInRun& at) override {
    if (!(at.row.time >= 0.0 && at.row.time < at.next->time)) return;
    const auto states = [&](const formation::Step& row, std::size_t number) {
      RowStates out{number, row.time, {}, {}, &row};
      for (const formation::RobotStep& robot : row.robots) out.robots.push_back({robot.position, robot.velocity});
      return out;
    };
    check_states(at.number, states(at.row, at.number), states(*at.next, at.number + 1));
  }

  void check_states(std::size_t row, const RowStates& from, const RowStates& to) override {
    from_ = &from;
    to_ = &to;
    lay_out();
    lay_out_moving();
    row_ = row;
    AuditReport& report = run_.tally.report;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      if (!run_.is_asked(row, i)) {
        ++report.left_out;
        continue;
      }
      if (to.step > from.step + 1) ++report.ends_only;
      if (!is_straight_) ++report.curved_steps;
      Answer answer;
      meet_obstacles(i, answer);
      meet_moving(i, answer);
      meet_robots(i, answer);
      const std::string& robot = run_.scenario.robots[i].id;
      if (!answer.met.empty())
        run_.tally.refuted(AuditPoint::motions, at_row(row, robot + " overlaps " + answer.met));
      else if (!answer.open.empty())
        run_.tally.open(AuditPoint::motions,
                        at_row(row, robot + " comes too near to " + answer.open + " to be proven clear of it"));
      else
        run_.tally.proven(AuditPoint::motions);
    }
  }

 private:
  /// What a robot meets in a step, and what it cannot be told apart from; empty where there is nothing.
  struct Answer {
    std::string met, open;
    void take(Verdict verdict, const char* kind, const std::string& id) {
      if (verdict == Verdict::clear) return;
      std::string& where = verdict == Verdict::meets ? met : open;
      if (where.empty()) where = std::string(kind) + " '" + id + "'";
    }
  };
  /// A moving obstacle from one share of the step to another.
  struct Piece {
    Rational start, end;
    Chord chord;
  };

  double radius(std::size_t i) const { return run_.scenario.robots[i].radius; }
  Segment way(std::size_t i) const { return {from_->robots[i].position, to_->robots[i].position}; }

  /// Made when it is asked for: of most robots nothing is near.
  const StepMotion& motion(std::size_t i) {
    std::unique_ptr<StepMotion>& found = motions_[i];
    if (!found)
      found = std::make_unique<StepMotion>(run_.file.recording.motion, run_.law ? &*run_.law : nullptr, run_.duration,
                                           from_->robots[i], to_->robots[i]);
    return *found;
  }

  void lay_out() {
    const std::size_t robots = from_->robots.size();
    motions_.clear();
    motions_.resize(robots);
    boxes_.clear();
    for (std::size_t i = 0; i < robots; ++i) {
      if (is_straight_) {
        boxes_.push_back(box_of(way(i)));
        continue;
      }
      const Chord whole = motion(i).over(Rational(0), Rational(1));
      boxes_.push_back(box_of(whole));
      double& bulge = run_.tally.report.largest_bulge;
      bulge = std::max(bulge, exact::at_least(whole.stray));
    }
    robots_by_place_ = geometry::BoxGrid(boxes_);
  }

  void lay_out_moving() {
    pieces_.assign(moving_.size(), {});
    swept_.assign(moving_.size(), {});
    carried_.clear();
    start_ = Rational(from_->time);
    passed_ = Rational(to_->time) - start_;
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      if (has_places_only_) {
        carried_.emplace_back(MotionLaw::straight, nullptr, run_.duration, exact::State{from_->moved[k], {}},
                              exact::State{to_->moved[k], {}});
        pieces_[k].push_back({Rational(0), Rational(1), carried_[k].over(Rational(0), Rational(1))});
      } else {
        for (const exact::ExactWay::TimedChord& p : run_.ways[k].over(start_, Rational(to_->time)))
          pieces_[k].push_back({(p.start - start_) / passed_, (p.end - start_) / passed_, p.chord});
      }
      for (const Piece& piece : pieces_[k]) {
        const Box by = box_of(piece.chord);
        swept_[k].add(Box{moving_[k].box.low + by.low, moving_[k].box.high + by.high});
      }
      swept_[k] = round_box(swept_[k], 0.0);
    }
  }

  Chord carried(std::size_t k, const Rational& s, const Rational& e) const {
    return has_places_only_ ? carried_[k].over(s, e) : run_.ways[k].within(start_ + s * passed_, start_ + e * passed_);
  }

  /// Rows that are several steps apart do not say how robots came from one to the next: only their ends are judged.
  template <class Over, class Test>
  Verdict decided(const Over& over, const Test& test, const Rational& start, const Rational& end) const {
    if (to_->step == from_->step + 1) return exact::decide(over, test, start, end);
    const Verdict first = test(over(start, start));
    return first == Verdict::clear ? test(over(end, end)) : first;
  }

  /// m: how near a robot of a crowd may come to what is that far away at the row before, in this box, both as it sees
  /// them. Its radius where it does not touch that there, or overlaps it by more than rounding.
  double allowed(std::size_t i, double distance, const Box& seen) const {
    const double lengths = one_norm(seen.low) + one_norm(seen.high) + radius(i);
    if (std::fabs(distance - radius(i)) > kTouches * lengths) return radius(i);
    const double way = run_.scenario.time_step * run_.scenario.robots[i].max_speed;
    const auto steps = static_cast<double>(std::max<std::size_t>(1, to_->step - from_->step));
    return std::min(distance, radius(i)) - kTouches * steps * (lengths + 4.0 * way);
  }
  /// The same for an obstacle as a whole, seen from `at`.
  double allowed(std::size_t i, const RationalObstacle& o, Vec2 at) const {
    const double distance =
        o.disc ? norm(at - o.disc->disc.center) - o.disc->disc.radius : geometry::signed_distance(*o.obstacle, at);
    return allowed(i, distance, {o.box.low - at, o.box.high - at});
  }

  /// `asked(least)`: the verdict where the robot may come as near as it is allowed to, but no nearer than `least`. What
  /// comes nearer than rounding explains, and no nearer than allowed, is open.
  template <class Asked>
  Verdict allowing(std::size_t i, const Asked& asked) const {
    const Verdict verdict = asked((1.0 - kMostRounding) * radius(i));
    if (verdict == Verdict::clear) return verdict;
    return asked(0.0) == Verdict::meets ? Verdict::meets : Verdict::unknown;
  }

  void meet_obstacles(std::size_t i, Answer& answer) {
    const formation::Robot& robot = run_.scenario.robots[i];
    run_.tally.report.obstacle_questions += run_.obstacles.size();
    obstacles_by_place_.for_each_meeting(round_box(boxes_[i], obstacle_reach_of(robot)), [&](std::size_t k) {
      const std::string& id = run_.scenario.obstacles[k].id;
      answer.take(meet_obstacle(i, run_.obstacles[k]), "obstacle", id);
      if (from_->row)
        answer.take(chain_against(robot, from_->row->robots[i], run_.duration, run_.obstacles[k]), "obstacle", id);
    });
  }

  /// Against what stands.
  double wall_radius(std::size_t i) const { return obstacle_radius(run_.scenario.robots[i]); }

  Verdict meet_obstacle(std::size_t i, const RationalObstacle& o) {
    if (are_apart(boxes_[i], o.box, wall_radius(i))) return Verdict::clear;
    const Vec2 at = from_->robots[i].position;
    const bool is_solid = geometry::has_interior(*o.obstacle);
    if (o.disc && is_straight_ &&
        is_surely_more(geometry::distance(way(i), o.disc->disc.center), o.box, boxes_[i],
                       wall_radius(i) + o.disc->disc.radius))
      return Verdict::clear;
    std::vector<NearEdge> edges;
    for (const std::size_t k : o.near(boxes_[i], wall_radius(i))) {
      const Segment& edge = o.segments[k];
      const bool is_apart = is_straight_ && !o.disc &&
                            is_surely_more(geometry::distance(edge, way(i)), o.boxes[k], boxes_[i], wall_radius(i));
      if (!is_apart) edges.push_back({k, Rational(wall_radius(i))});
    }
    if (edges.empty() && !is_solid) return Verdict::clear;
    const auto asked = [&](const Rational& reach) {
      return decided([&](const Rational& s, const Rational& e) { return motion(i).over(s, e); },
                     [&](const Chord& chord) { return against(chord, o, edges, reach); }, Rational(0), Rational(1));
    };
    const Verdict verdict = asked(Rational(wall_radius(i)));
    if (verdict == Verdict::clear || !has_places_only_) return verdict;
    const double of_whole = is_solid ? allowed(i, o, at) : wall_radius(i);
    return allowing(i, [&](double least) {
      for (NearEdge& edge : edges) {
        const Box& box = o.boxes[edge.edge];
        const double near =
            is_solid ? of_whole
                     : allowed(i, geometry::distance(o.segments[edge.edge], at), {box.low - at, box.high - at});
        edge.reach = Rational(std::max(least, near));
      }
      return asked(Rational(std::max(least, of_whole)));
    });
  }

  /// Piece after piece of the obstacle's way, seen from the obstacle.
  void meet_moving(std::size_t i, Answer& answer) {
    run_.tally.report.moving_questions += moving_.size();
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      if (are_apart(boxes_[i], swept_[k], radius(i))) continue;
      Answer of_this;
      const formation::MovingObstacle& obstacle = run_.scenario.moving_obstacles[k];
      for (const Piece& piece : pieces_[k]) of_this.take(meet_piece(i, k, piece), "moving obstacle", obstacle.id);
      const bool stands = from_->robots[i].position == to_->robots[i].position;
      if (obstacle.max_speed && stands) {  // to which nothing is promised
        run_.tally.report.hits_standing += !of_this.met.empty() || !of_this.open.empty();
        continue;
      }
      if (answer.met.empty()) answer.met = of_this.met;
      if (answer.open.empty()) answer.open = of_this.open;
    }
  }

  Verdict meet_piece(std::size_t i, std::size_t k, const Piece& piece) {
    const RationalObstacle& o = moving_[k];
    const Box seen = box_of(motion(i).over(piece.start, piece.end) - piece.chord);
    if (are_apart(seen, o.box, radius(i))) return Verdict::clear;
    std::vector<NearEdge> edges;
    for (const std::size_t edge : o.near(seen, radius(i))) edges.push_back({edge, Rational(radius(i))});
    const auto over = [&](const Rational& s, const Rational& e) { return motion(i).over(s, e) - carried(k, s, e); };
    const auto asked = [&](const Rational& start, double reach) {
      const Rational r(reach);
      for (NearEdge& edge : edges) edge.reach = r;
      return decided(
          over, [&](const Chord& chord) { return against(chord, o, edges, r); }, start, piece.end);
    };
    const Verdict verdict = asked(piece.start, radius(i));
    if (verdict == Verdict::clear || !has_places_only_) return verdict;
    const double near = allowed(i, o, from_->robots[i].position - from_->moved[k]);
    if (to_ != from_ && asked(piece.end, radius(i)) != Verdict::clear) return Verdict::meets;
    return allowing(i, [&](double least) { return asked(piece.start, std::max(least, near)); });
  }

  void meet_robots(std::size_t i, Answer& answer) {
    run_.tally.report.robot_questions += boxes_.size() - 1;
    robots_by_place_.for_each_meeting(round_box(boxes_[i], radius(i) + largest_), [&](std::size_t j) {
      const double radii = radius(i) + radius(j);
      if (j == i || are_apart(boxes_[i], boxes_[j], kRoundedUp * radii)) return;
      answer.take(meet_robot(i, j, radii), "robot", run_.scenario.robots[j].id);
    });
  }

  Verdict meet_robot(std::size_t i, std::size_t j, double radii) {
    if (const std::pair<std::size_t, std::size_t> pair = std::minmax(i, j); parting_.count(pair) > 0) {
      if (!comes_nearer(i, j)) return Verdict::clear;
      if (nearer_.insert(pair).second) tell(pair, "came nearer after row " + std::to_string(row_));
      return Verdict::meets;
    }
    if (is_straight_ && is_surely_more(geometry::swept_distance(way(i), way(j)), boxes_[i], boxes_[j], radii))
      return Verdict::clear;
    const Rational reach = Rational(radius(i)) + Rational(radius(j));
    const StepMotion seen = motion(i).seen_from(motion(j));
    return decided([&](const Rational& s, const Rational& e) { return seen.over(s, e); },
                   [&](const Chord& chord) {
                     return against_point(chord, {Rational(0), Rational(0)}, reach);
                   },
                   Rational(0), Rational(1));
  }

  // --- Pairs that started in overlap ---

  Straight relative(std::size_t i, std::size_t j) {
    return motion(i).seen_from(motion(j)).over(Rational(0), Rational(1)).way;
  }

  /// Pairs that overlap in the first row, and of these the ones that still do.
  void part(std::size_t row, double time, const std::vector<Vec2>& places) {
    const std::vector<formation::Robot>& robots = run_.scenario.robots;
    const auto overlap = [&](std::size_t i, std::size_t j) {
      const Point d = exact::exactly(places[i]) - exact::exactly(places[j]);
      const Rational reach = Rational(robots[i].radius) + Rational(robots[j].radius);
      return exact::dot(d, d) < reach * reach;
    };
    if (row == 0)
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
      if (nearer_.count(*pair) == 0) tell(*pair, "apart from " + geometry::lossless(time) + " s on");
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
  bool comes_nearer(std::size_t i, std::size_t j) {
    const Straight seen = relative(i, j), of_i = motion(i).over(Rational(0), Rational(1)).way;
    const Point m = seen.to - seen.from;
    const auto size = [](const Point& p) { return Rational(abs(p.x) + abs(p.y)); };
    const Rational rounding = kRoundingOfPlaces * (size(of_i.from) + size(seen.from) + size(m));
    return exact::dot(seen.from, m) < -size(seen.from) * rounding;
  }

  static constexpr double kRoundingOfPlaces = 0x1p-44;  ///< of the coordinates, in a step
  const AuditedRun& run_;
  bool is_straight_, has_places_only_;
  geometry::BoxGrid obstacles_by_place_;
  std::vector<RationalObstacle> moving_;
  double largest_ = 0.0;  ///< m, of the radii
  std::size_t row_ = 0;
  std::set<std::pair<std::size_t, std::size_t>> parting_, nearer_;   ///< nearer_: pairs that came nearer while parting
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> told_;  ///< where in the report each pair stands
  // The step that is judged.
  const RowStates *from_ = nullptr, *to_ = nullptr;
  std::vector<std::unique_ptr<StepMotion>> motions_;
  std::vector<Box> boxes_;  ///< round the robots' ways
  geometry::BoxGrid robots_by_place_;
  Rational start_, passed_;  ///< s
  std::vector<std::vector<Piece>> pieces_;
  std::vector<StepMotion> carried_;  ///< moving obstacles, of places
  std::vector<Box> swept_;           ///< round what each moving obstacle covers
};

}  // namespace

std::unique_ptr<RowAudit> audit_motions(const AuditedRun& run) {
  return std::make_unique<MotionAudit>(run);
}

}  // namespace exactvo::datasets
