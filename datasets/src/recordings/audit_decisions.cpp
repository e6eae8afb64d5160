// SPDX-License-Identifier: GPL-3.0-or-later
//
// That nothing is missing is asked of the scene itself, not of the bodies: for every edge of an obstacle that the
// robot could reach within the step some hard half-plane of its row excludes the edge's velocity obstacle. Of a
// polygon only the edges that face the robot are asked: a disc that goes straight from outside and meets the others
// first does not exist. (At the first contact with a point inside such an edge the disc's centre is on the edge's
// outer side, having come from the inner one; it was nearer to the edge's line just before, so it overlapped already.
// At a vertex between two of them its way leads away from the vertex.)
#include "recordings/audit_points.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "exactvo/formation/stability.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/vo/certificate.h"
#include "exactvo/vo/family.h"
#include "exactvo/vo/lp/certificate.h"
#include "recordings/exact_shapes.h"

namespace exactvo::datasets {
namespace {

using exact::exactly;
using exact::Point;
using exact::Rational;
using exact::Verdict;
using formation::DecisionConstraint;
using formation::GoalBodies;
using formation::OwnConstraint;
using formation::OwnStage;
using formation::RobotStep;
using formation::Step;
using geometry::Vec2;
using vo::BodyKind;

bool is_static(const DecisionConstraint& c) {
  return c.source == BodyKind::enclosure || c.source == BodyKind::obstacle_edge;
}

bool has_numbers(const geometry::HalfPlane& h) {
  return geometry::is_finite(h.normal) && h.normal != Vec2{} && std::isfinite(h.offset);
}

/// The robot's half against the other; nothing where the row has none.
const DecisionConstraint* half_against(const RobotStep& robot, std::size_t other) {
  for (const DecisionConstraint& c : robot.constraints)
    if (c.source == BodyKind::robot && !c.hard && c.index == other && has_numbers(c.half_plane)) return &c;
  return nullptr;
}

Rational violation_at(const geometry::HalfPlane& h, const Point& v) {
  return Rational(h.offset) - exact::dot(exactly(h.normal), v);
}

/// The exact multipliers of the problem, as a claim of the velocity that was chosen. Nothing where they do not prove
/// their own answer tightly, or that one has another status.
std::optional<lp::Certificate> exact_claim_of(const lp::Problem& problem, const lp::Solution& chosen) {
  const lp::Proven exact = lp::solve_exact(problem);
  if (!exact.certificate || exact.solution.status != chosen.status) return std::nullopt;
  if (!lp::is_tight(problem, *exact.certificate)) return std::nullopt;
  lp::Certificate claim = lp::claim_of(problem, chosen);
  claim.bound = exact.certificate->bound;
  claim.contradiction = exact.certificate->contradiction;
  claim.gap = std::max(exact.certificate->gap, lp::claim_of(problem, exact.solution).gap);
  return claim;
}

/// What is wrong with a choice, or cannot be proven; empty where nothing is.
struct Refuted {
  std::string why;
  bool is_open = false;
};

/// Share of the largest speed: what is said to bind does so to within this (lp/certificate.h has the same for gaps).
constexpr double kBindsWithin = lp::kWidestGap;

/// Audits a choice whose status is `no_interior`. The problem is solved again, exactly: no double may be found that
/// satisfies what must hold, and the choice is the best point of what there is, up to rounding.
Refuted without_room(const lp::Problem& problem, const lp::Solution& chosen, double fastest) {
  const lp::Proven exact = lp::solve_exact(problem);
  if (exact.solution.status != lp::Status::no_interior) return {" says that it has no room, but it has some"};
  if (norm(exact.solution.velocity - chosen.velocity) > kBindsWithin * fastest)
    return {" has no room, and is not the best of what there is"};
  if (!exact.certificate) return {" has no room: that it is the best is not proven", true};
  return {};
}

/// Whether a choice is as good as the exact solution, and that has no proof but a wide gap: a region as sharp as a
/// needle, whose tip no double is near to.
bool is_beyond_proof(const lp::Problem& problem, const lp::Solution& chosen) {
  const lp::Proven exact = lp::solve_exact(problem);
  if (exact.solution.status != chosen.status || (exact.certificate && lp::is_tight(problem, *exact.certificate)))
    return false;
  constexpr double kRounding = 1.0 + 0x1p-40;
  return chosen.violation <= kRounding * exact.solution.violation &&
         norm(chosen.velocity - problem.preferred) <= kRounding * norm(exact.solution.velocity - problem.preferred);
}

bool is_hard_in(OwnStage stage, const DecisionConstraint& c) {
  return c.hard || holds_bodies(stage);
}
bool is_hard_in(OwnStage stage, const OwnConstraint& c) {
  return stage == OwnStage::held && c.hard;
}

/// m, and the share of its length: lines between robots that measure each other leave this much room beside the way of
/// braking.
constexpr double kRoomOfLines = 0x1p-43, kRoomOfWays = 0x1p-45;

constexpr const char* kBesideExact = " has multipliers although it says that no double multipliers prove it";

class DecisionAudit : public RowAudit {
 public:
  explicit DecisionAudit(const AuditedRun& run)
      : run_(run),
        literal_horizons_(tracks_choices(run.scenario) && run.file.recording.controller_options &&
                          !run.file.recording.controller_options->horizon_clamp) {
    formation::Method method = formation::Method::ivo;
    if (parse(run.file.info.method, method) && !promises_between_robots(method))
      cone_ = method == formation::Method::rvo ? vo::Variant::rvo : vo::Variant::hrvo;
    if (cone_ && (formation::braking_time_of(run.scenario) > 0.0 || run.scenario.separate || run.scenario.formation)) {
      run.tally.refuted(AuditPoint::scenario, "no run of this scenario has this method");
      cone_.reset();
    }
    run.tally.report.without_pairs = cone_.has_value();
  }

  void check_step(const RowInRun& at) override {
    moved_.clear();
    for (std::size_t k = 0; k < run_.scenario.moving_obstacles.size() && k < at.row.moving.size(); ++k)
      moved_.push_back(formation::hull_of(run_.scenario.moving_obstacles[k], at.row.moving[k].displacement));
    std::vector<Seen> all;
    for (std::size_t i = 0; i < at.row.robots.size(); ++i) all.push_back(seen(at, i));
    for (const Seen& s : all) {
      nothing_is_missing(s);
      half_planes_hold(s);
      choice_is_best(s);
    }
    if (measures_others(run_.scenario)) return;  // on whose side they are is asked of the choices: audit_braking.cpp
    for (std::size_t i = 0; i < all.size() && !cone_; ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j)
        if (can_meet(all[i], all[j])) answer(against_robot(all[i], all[j]), all[i], "robot '" + id(all[j]) + "'");
  }

 private:
  /// A robot of the row, and how far it can get within the step.
  struct Seen {
    std::size_t row, robot;
    const Step* step;
    const RobotStep* state;
    Point at;
    Rational radius, reach;
    double near;    ///< no less than their sum
    Rational wall;  ///< m: its radius against what stands
  };

  const std::string& id(const Seen& s) const { return run_.scenario.robots[s.robot].id; }

  /// m/s, no less than the length of any velocity within the bound.
  double fastest(std::size_t robot) const {
    constexpr double kDiagonal = 1.4142135623731;  // above sqrt 2 by more than the product's rounding
    const double speed = run_.scenario.robots[robot].max_speed;
    return run_.scenario.speed_bound == formation::SpeedBoundKind::disc ? speed : kDiagonal * speed;
  }

  Seen seen(const RowInRun& at, std::size_t robot) const {
    const RobotStep& state = at.row.robots[robot];
    const Rational radius(run_.scenario.robots[robot].radius), reach = run_.duration * Rational(fastest(robot));
    return {at.number,
            robot,
            &at.row,
            &state,
            exactly(state.anchor),
            radius,
            reach,
            exact::at_least(radius + reach),
            Rational(wall_radius(robot))};
  }

  double wall_radius(std::size_t robot) const { return obstacle_radius(run_.scenario.robots[robot]); }

  // --- (3) Nothing is missing ---

  void answer(Verdict verdict, const Seen& s, const std::string& whom) {
    if (verdict == Verdict::clear) return run_.tally.proven(AuditPoint::completeness);
    if (verdict == Verdict::unknown)
      return run_.tally.open(AuditPoint::completeness, at_row(s.row, id(s) + " overlaps " + whom +
                                                                         ", or decides for less than "
                                                                         "a time step: no half-plane is promised"));
    run_.tally.refuted(AuditPoint::completeness,
                       at_row(s.row, "no half-plane keeps " + id(s) + " from " + whom + " for a time step"));
  }

  void nothing_is_missing(const Seen& s) {
    const geometry::Box here = box_of(s.state->anchor);
    for (std::size_t k = 0; k < run_.obstacles.size(); ++k) {
      if (are_apart(here, run_.obstacles[k].box, s.near)) continue;
      bool in_reach = false;
      const RationalObstacle& obstacle = run_.obstacles[k];
      const Verdict verdict =
          obstacle.disc ? against_disc(s, obstacle, in_reach) : against_edges(s, obstacle, in_reach);
      if (in_reach) answer(verdict, s, "obstacle '" + run_.scenario.obstacles[k].id + "'");
    }
    for (std::size_t k = 0; k < moved_.size(); ++k) {
      bool in_reach = false;
      const Verdict verdict = against_moving(s, k, in_reach);
      if (in_reach) answer(verdict, s, "moving obstacle '" + run_.scenario.moving_obstacles[k].id + "'");
    }
  }

  Verdict against_edges(const Seen& s, const RationalObstacle& obstacle, bool& in_reach) const {
    const Rational within = (s.wall + s.reach) * (s.wall + s.reach), rim = s.wall * s.wall;
    const bool is_solid = geometry::has_interior(*obstacle.obstacle);
    if (is_solid && exact::is_inside(s.at, *obstacle.obstacle)) {
      in_reach = true;
      return Verdict::unknown;
    }
    bool overlaps = false, missing = false;
    for (const std::size_t e : obstacle.near(box_of(s.state->anchor), s.near)) {
      const exact::Straight& edge = obstacle.edges[e];
      const Rational away = exact::squared_distance(s.at, edge);
      if (away > within) continue;
      in_reach = true;
      overlaps = overlaps || away < rim;
      const bool faces_away = is_solid && sgn(exact::cross(edge.to - edge.from, s.at - edge.from)) > 0;
      missing = missing || (!faces_away && !is_excluded(s, obstacle.segments[e]));
    }
    if (overlaps || (missing && literal_horizons_)) return Verdict::unknown;
    return missing ? Verdict::meets : Verdict::clear;
  }

  /// One half-plane against the disc, or those against the edges of the polygon round it, which holds it.
  Verdict against_disc(const Seen& s, const RationalObstacle& obstacle, bool& in_reach) const {
    const Point apart = s.at - obstacle.disc->center;
    const Rational away = exact::dot(apart, apart), radii = s.wall + obstacle.disc->radius;
    in_reach = away <= (radii + s.reach) * (radii + s.reach);
    if (!in_reach) return Verdict::clear;
    if (away < radii * radii) return Verdict::unknown;
    if (is_excluded(s, obstacle.disc->disc)) return Verdict::clear;
    return against_edges(s, obstacle, in_reach);
  }

  bool is_excluded(const Seen& s, const geometry::ConvexShape& edge) const {
    const double radius = wall_radius(s.robot), step = run_.file.recording.time_step;
    return std::any_of(s.state->constraints.begin(), s.state->constraints.end(), [&](const DecisionConstraint& c) {
      return c.hard && is_static(c) && vo::is_true({edge, s.state->anchor, radius, step, {}, c.half_plane});
    });
  }

  /// At its present velocity; of one of which its greatest speed is known, at any, unless the robot stands.
  Verdict against_moving(const Seen& s, std::size_t k, bool& in_reach) const {
    if (const std::optional<double>& most = run_.scenario.moving_obstacles[k].max_speed) {
      in_reach = !stands(s) && exact::is_within(moved_[k], s.at, s.radius + s.reach + run_.duration * Rational(*most));
      const auto excludes = [&](const DecisionConstraint& c) {
        return c.hard && c.source == BodyKind::moving_obstacle && c.index == k && keeps_from_mover(s, c);
      };
      return std::any_of(s.state->constraints.begin(), s.state->constraints.end(), excludes) ? Verdict::clear
                                                                                             : Verdict::meets;
    }
    const formation::MovedObstacle& moved = s.step->moving[k];
    const Point u = exactly(moved.velocity);
    const Rational reach = s.reach + run_.duration * exact::root(exact::dot(u, u)).high;
    in_reach = exact::is_within(moved_[k], s.at, s.radius + reach);
    if (!in_reach) return Verdict::clear;
    if (!exact::is_clear(moved_[k], s.at, s.radius)) return Verdict::unknown;
    const double radius = run_.scenario.robots[s.robot].radius, step = run_.file.recording.time_step;
    const bool excluded =
        std::any_of(s.state->constraints.begin(), s.state->constraints.end(), [&](const DecisionConstraint& c) {
          return c.source == BodyKind::moving_obstacle && c.index == k &&
                 vo::is_true({moved_[k], s.state->anchor, radius, step, moved.velocity, c.half_plane});
        });
    return excluded ? Verdict::clear : Verdict::meets;
  }

  /// Then nothing is promised to it against what moves in any way.
  static bool stands(const Seen& s) { return s.state->stopping_steps == 0 && s.state->chosen == Vec2{}; }

  /// Lemma 8 (accelerations): n.x >= c, and n.(x + (k + 1) / 2 T u) >= c + U k T for all u of the half-plane. Its
  /// horizon is (k + 1) / 2 T, rounded once.
  bool keeps_from_mover(const Seen& s, const DecisionConstraint& c) const {
    if (!has_numbers(c.half_plane) || s.state->stopping_steps == 0) return false;
    const auto half_steps = static_cast<double>(s.state->stopping_steps + 1);
    if (c.time_horizon != 0.5 * half_steps * run_.file.recording.time_step) return false;
    const auto& disc = std::get<geometry::Disc>(moved_[c.index]);
    const Rational steps(s.state->stopping_steps), away = s.radius + Rational(disc.radius);
    const Rational by_then =
        away + Rational(*run_.scenario.moving_obstacles[c.index].max_speed) * steps * run_.duration;
    const Point n = exactly(c.half_plane.normal);
    const Rational from = exact::dot(n, s.at - exactly(disc.center)), square = exact::dot(n, n);
    const Rational end = from + (steps + 1) / 2 * run_.duration * Rational(c.half_plane.offset);
    return is_no_less(from, away, square) && is_no_less(end, by_then, square);
  }

  /// x >= r sqrt(square), r >= 0.
  static bool is_no_less(const Rational& x, const Rational& r, const Rational& square) {
    return sgn(x) >= 0 && x * x >= r * r * square;
  }

  /// Within the step, and one of them does something about it.
  bool can_meet(const Seen& a, const Seen& b) const {
    constexpr double kRounding = 1.0 + 0x1p-50;
    if (are_apart(box_of(a.state->anchor), box_of(b.state->anchor), kRounding * (a.near + b.near))) return false;
    const std::vector<formation::Robot>& robots = run_.scenario.robots;
    if (!robots[a.robot].cooperates && !robots[b.robot].cooperates) return false;
    const Rational near = a.radius + b.radius + a.reach + b.reach;
    const Point apart = b.at - a.at;
    return exact::dot(apart, apart) <= near * near;
  }

  /// Two that cooperate: opposite normals, bit for bit, and the sum of the offsets for the relative velocity. One that
  /// does not keeps its present velocity.
  Verdict against_robot(const Seen& a, const Seen& b) const {
    const Rational reach = a.radius + b.radius;
    const Point apart = b.at - a.at;
    if (exact::dot(apart, apart) < reach * reach) return Verdict::unknown;
    const bool a_yields = run_.scenario.robots[a.robot].cooperates;
    const bool b_yields = run_.scenario.robots[b.robot].cooperates;
    const DecisionConstraint* of_a = a_yields ? half_against(*a.state, b.robot) : nullptr;
    const DecisionConstraint* of_b = b_yields ? half_against(*b.state, a.robot) : nullptr;
    if ((a_yields && !of_a) || (b_yields && !of_b)) return Verdict::meets;
    if (of_a && of_b && of_a->half_plane.normal != -of_b->half_plane.normal) return Verdict::meets;
    const Point n = of_a ? exactly(of_a->half_plane.normal) : exactly(-of_b->half_plane.normal);
    const auto at_least = [](const DecisionConstraint* half, const Point& normal, const RobotStep& robot) {
      return half ? Rational(half->half_plane.offset) : Rational(exact::dot(normal, exactly(robot.anchor_velocity)));
    };
    const Point m{Rational(-n.x), Rational(-n.y)};
    const Rational offset = at_least(of_a, n, *a.state) + at_least(of_b, m, *b.state);
    return exact::excludes_disc(apart, reach, n, offset, run_.duration) ? Verdict::clear : Verdict::meets;
  }

  // --- (4) Half-planes ---

  void half_planes_hold(const Seen& s) {
    std::size_t uncertified = 0;
    for (const DecisionConstraint& c : s.state->constraints) {
      const std::string wrong = misnamed(s, c);
      if (!wrong.empty()) {
        run_.tally.refuted(AuditPoint::half_planes, at_row(s.row, "a half-plane of " + id(s) + wrong));
        continue;
      }
      const bool is_true = holds(s, c);
      if (!c.certified) ++uncertified;
      run_.tally.report.half_planes += (c.certified || is_true) && c.source != BodyKind::robot;
      if (is_true) {
        run_.tally.proven(AuditPoint::half_planes);
      } else if (c.certified || is_clear_of(s, c)) {
        const bool is_line = measures_others(run_.scenario) && c.source == BodyKind::robot;
        run_.tally.refuted(AuditPoint::half_planes,
                           at_row(s.row, "a half-plane of " + id(s) +
                                             (is_line ? " gives it more than its measurement proves to be its own"
                                                      : " is not disjoint from its velocity obstacle")));
      } else {
        run_.tally.open(AuditPoint::half_planes,
                        at_row(s.row, "a half-plane of " + id(s) + " is not certified: it overlaps the body"));
      }
    }
    const bool counts =
        run_.file.recording.all_half_planes ? uncertified == s.state->uncertified : uncertified <= s.state->uncertified;
    if (!counts)
      run_.tally.refuted(AuditPoint::half_planes, at_row(s.row, "half-planes of " + id(s) +
                                                                    " that are not certified are not "
                                                                    "as many as it says"));
  }

  /// What is wrong with the names of a half-plane; empty where nothing is.
  std::string misnamed(const Seen& s, const DecisionConstraint& c) const {
    const std::vector<vo::Body>& bodies = run_.file.recording.bodies;
    if (c.body >= bodies.size() || bodies[c.body].owners.empty() || bodies[c.body].kind != c.source)
      return " names no body that stands for something";
    if (formation::is_own_limit(c)) {
      const bool is_its_own = (run_.scenario.acceleration || run_.scenario.robots[s.robot].drive) &&
                              c.index == s.robot && bodies[c.body].owners.front() == s.robot;
      return is_its_own && c.piece == 0 ? "" : " has the priority of another kind";
    }
    const bool is_mover = c.source == BodyKind::moving_obstacle && meets_movers(run_.scenario);
    if (c.hard != (is_static(c) || is_mover)) return " has the priority of another kind";
    const vo::Body& body = bodies[c.body];
    if (c.source == BodyKind::robot || c.source == BodyKind::moving_obstacle) {
      if (c.piece != 0 || c.index != body.owners.front()) return " has another index than its body";
      if (c.source == BodyKind::robot && c.index >= run_.scenario.robots.size()) return " is against no robot";
      if (c.source == BodyKind::robot && (c.index == s.robot || !run_.scenario.robots[s.robot].cooperates))
        return " is against itself, or of a robot that ignores others";
      return c.source == BodyKind::moving_obstacle && c.index >= moved_.size() ? " is against what has no place" : "";
    }
    if (!(c.time_horizon >= run_.file.recording.time_step) && !literal_horizons_)
      return " looks less than a time step ahead";
    if (c.source == BodyKind::obstacle_edge) return "";
    const GoalBodies* of_goal = nullptr;
    for (const GoalBodies& o : run_.file.recording.goal_bodies)
      if (o.robot == s.robot && o.time <= s.step->time) of_goal = &o;
    if (!of_goal) return run_.file.recording.goal_bodies.empty() ? "" : " is none of its enclosures";
    if (c.index >= of_goal->bodies.size()) return " is none of its enclosures";
    const std::size_t enclosure = of_goal->bodies[c.index];
    if (c.piece == 0) return enclosure == c.body ? "" : " is none of its enclosures";
    const std::vector<std::size_t>& owners = bodies[enclosure].owners;
    const bool is_piece = std::all_of(body.owners.begin(), body.owners.end(), [&](std::size_t owner) {
      return std::find(owners.begin(), owners.end(), owner) != owners.end();
    });
    return is_piece ? "" : " is no piece of its enclosure";
  }

  /// By more than rounding: then a half-plane can be certified, and one that is said to be uncertified was forged.
  bool is_clear_of(const Seen& s, const DecisionConstraint& c) const {
    constexpr double kRounding = 0x1p-40;  // of the coordinates
    const Vec2 at = s.state->anchor;
    double radius = is_static(c) ? wall_radius(s.robot) : run_.scenario.robots[s.robot].radius;
    radius += kRounding * (std::fabs(at.x) + std::fabs(at.y) + radius);
    const auto is_outside = [&](const geometry::ConvexShape& shape) {
      return !geometry::is_valid(shape) || geometry::locate({shape, at, radius}, Vec2{}) == geometry::Place::outside;
    };
    if (c.source == BodyKind::moving_obstacle) return is_outside(moved_[c.index]);
    if (formation::is_own_limit(c)) return true;
    if (c.source != BodyKind::robot) return is_outside(run_.file.recording.bodies[c.body].shape);
    return is_outside(geometry::Disc{s.step->robots[c.index].anchor, run_.scenario.robots[c.index].radius});
  }

  /// It leaves the velocity its change in every direction, but for what the sides of a polygon of 24 sides cut off:
  /// else a choice could be made the best by a limit. (Whether the change is kept is asked of the choice.)
  bool leaves_its_change(const Seen& s, const DecisionConstraint& c) const {
    constexpr double kInside = 0.99144;  // less than cos(pi / 24)
    if (!has_numbers(c.half_plane) || c.time_horizon != run_.file.recording.time_step) return false;
    if (run_.scenario.robots[s.robot].drive) return true;  // what wheels allow is asked of the choice alone
    const Point n = exactly(c.half_plane.normal);
    const Rational left = exact::dot(n, exactly(s.state->velocity)) - Rational(c.half_plane.offset);
    const Rational change = Rational(kInside) * Rational(run_.scenario.acceleration->max) * run_.duration;
    return left > 0 && left * left >= change * change * exact::dot(n, n);
  }

  bool holds(const Seen& s, const DecisionConstraint& c) const {
    if (formation::is_own_limit(c)) return leaves_its_change(s, c);
    const double radius = run_.scenario.robots[s.robot].radius;
    const Vec2 at = s.state->anchor;
    if (c.source == BodyKind::moving_obstacle && meets_movers(run_.scenario)) return keeps_from_mover(s, c);
    if (c.source == BodyKind::moving_obstacle)
      return vo::is_true({moved_[c.index], at, radius, c.time_horizon, s.step->moving[c.index].velocity, c.half_plane});
    if (c.source != BodyKind::robot)
      return vo::is_true(
          {run_.file.recording.bodies[c.body].shape, at, wall_radius(s.robot), c.time_horizon, {}, c.half_plane});
    const formation::Robot& other = run_.scenario.robots[c.index];
    const RobotStep& them = s.step->robots[c.index];
    const geometry::Disc disc{them.anchor, other.radius};
    if (other.cooperates && cone_) return leaves_cone(s, c, disc) || keeps_pair_apart(s, c);
    if (measures_others(run_.scenario)) return is_own_side(s, c);
    if (other.cooperates) return keeps_pair_apart(s, c);
    return vo::is_true({disc, at, radius, c.time_horizon, them.anchor_velocity, c.half_plane});
  }

  /// A line that leaves the robot no more than what was measured of the other proves to be its own: with E for how far
  /// the other's way of braking may be from the foreseen one and l for the distance of that, the way of the choice goes
  /// no more than (l - E - R) / 2, or 0, beyond the robot's own way of braking.
  bool is_own_side(const Seen& s, const DecisionConstraint& c) const {
    if (!has_numbers(c.half_plane) || c.time_horizon != braking_time_of(run_.scenario)) return false;
    const auto same = std::find_if(s.state->measured.begin(), s.state->measured.end(),
                                   [&](const formation::MeasuredRobot& m) { return m.robot == c.index; });
    if (same == s.state->measured.end() || !geometry::is_finite(same->position) ||
        !geometry::is_finite(same->velocity) || !(same->age >= 0.0) || !std::isfinite(same->age))
      return false;
    const formation::Measurements& bounds = *run_.scenario.uncertainty->measurements;
    const Rational tau(formation::braking_time_of(run_.scenario)), age(same->age), left = tau - run_.duration;
    const Rational off_speed = Rational(bounds.velocity) + age * Rational(run_.scenario.acceleration->max);
    const Rational off = Rational(bounds.position) + (age + tau) * off_speed;
    const Point v = exactly(same->velocity), now = exactly(same->position) + age * v;
    const exact::Straight theirs{now, now + left * v};
    const exact::Straight mine{s.at, s.at + left * exactly(s.state->velocity)};
    Rational square = std::min({exact::squared_distance(mine.from, theirs), exact::squared_distance(mine.to, theirs),
                                exact::squared_distance(theirs.from, mine), exact::squared_distance(theirs.to, mine)});
    const Rational radii = s.radius + Rational(run_.scenario.robots[c.index].radius);
    const Rational usable = std::max(Rational(0), Rational((exact::root(square).high - off - radii) / 2));
    const Point n = exactly(c.half_plane.normal);
    const Point way = mine.to - mine.from;
    const Rational room = usable + Rational(kRoomOfLines) + Rational(kRoomOfWays) * exact::length_at_most(way);
    return tau * Rational(c.half_plane.offset) >=
           std::min(Rational(0), exact::dot(n, way)) - room * exact::root(exact::dot(n, n)).high;
  }

  /// The half-plane excludes the inside of the cone of a method that promises nothing between robots; the recording has
  /// twice the time horizon, as the cone is cut off there.
  bool leaves_cone(const Seen& s, const DecisionConstraint& c, const geometry::Disc& disc) const {
    if (!has_numbers(c.half_plane) || !(c.time_horizon > 0.0) || !std::isfinite(c.time_horizon)) return false;
    vo::Encounter pair;
    pair.obstacle = disc;
    pair.obstacle_velocity = s.step->robots[c.index].anchor_velocity;
    pair.position = s.state->anchor;
    pair.velocity = s.state->anchor_velocity;
    pair.radius = run_.scenario.robots[s.robot].radius;
    pair.time_horizon = 0.5 * c.time_horizon;
    const vo::Member member = vo::family_member(*cone_, pair);
    return member.cone &&
           vo::is_true({disc, pair.position, pair.radius, c.time_horizon, member.cone->apex, c.half_plane});
  }

  /// Against a robot that cooperates. Either this half-plane takes half of what the pair's relative velocity must
  /// change, which is 2 offset - n.(v_a + v_b): where both take as much, they do not collide within tau. Or it adds up
  /// with the half-plane that the other robot has against this one, of the opposite normal: any two velocities that
  /// keep both do not collide within tau. So do pairs that fell back (liveness).
  bool keeps_pair_apart(const Seen& s, const DecisionConstraint& c) const {
    if (!has_numbers(c.half_plane) || !(c.time_horizon > 0.0) || !std::isfinite(c.time_horizon)) return false;
    const RobotStep& them = s.step->robots[c.index];
    const Point n = exactly(c.half_plane.normal), apart = exactly(them.anchor) - s.at;
    const Rational offset(c.half_plane.offset), reach = s.radius + Rational(run_.scenario.robots[c.index].radius);
    const auto excludes = [&](const Rational& relative) {
      return exact::excludes_disc(apart, reach, n, relative, Rational(c.time_horizon));
    };
    if (excludes(2 * offset - exact::dot(n, exactly(s.state->anchor_velocity) + exactly(them.anchor_velocity))))
      return true;
    return std::any_of(them.constraints.begin(), them.constraints.end(), [&](const DecisionConstraint& theirs) {
      return theirs.source == BodyKind::robot && theirs.index == s.robot && has_numbers(theirs.half_plane) &&
             theirs.half_plane.normal == -c.half_plane.normal && excludes(offset + Rational(theirs.half_plane.offset));
    });
  }

  // --- (5) Choices ---

  void choice_is_best(const Seen& s) {
    const RobotStep& r = *s.state;
    const auto answer = [&](const std::string& why, bool is_open) {
      if (why.empty()) return run_.tally.proven(AuditPoint::choices);
      const std::string text = at_row(s.row, "the choice of " + id(s) + why);
      is_open ? run_.tally.open(AuditPoint::choices, text) : run_.tally.refuted(AuditPoint::choices, text);
    };
    const auto all_have_numbers = [](const auto& some) {
      return std::all_of(some.begin(), some.end(), [](const auto& c) { return has_numbers(c.half_plane); });
    };
    if (!geometry::is_finite(r.preferred) || !geometry::is_finite(r.chosen) || !std::isfinite(r.violation) ||
        !all_have_numbers(r.constraints) || !all_have_numbers(r.own))
      return answer(" is without numbers", false);
    if (const std::string early = earlier_stage(s); !early.empty()) return answer(early, false);
    const Violations most = violations(s);
    run_.tally.report.largest_violation =
        std::max(run_.tally.report.largest_violation, exact::at_least(most.forbidden));
    lp::Problem problem;
    lp::Solution solution;
    std::string why = misstated(s, most);
    if (why.empty()) why = stated(s, problem, solution);
    if (!why.empty()) return answer(why, false);
    if (r.status == lp::Status::no_interior) {
      const Refuted no_room = without_room(problem, solution, fastest(s.robot));
      return answer(no_room.why, no_room.is_open);
    }
    const std::optional<lp::Certificate> claim =
        r.exact_multipliers ? exact_claim_of(problem, solution) : lp::claim_of(problem, solution);
    const lp::CertificateError flaw = claim ? lp::check(problem, *claim) : lp::CertificateError::bound;
    if (flaw == lp::CertificateError::none) return answer("", false);
    if (flaw == lp::CertificateError::bound && is_beyond_proof(problem, solution))
      return answer(" is that of the exact solution, which no doubles prove to be the best", true);
    answer(flaw == lp::CertificateError::velocity ? " breaks a half-plane or the speed bound"
                                                  : " is not proven the best by its multipliers",
           false);
  }

  /// A decision with half-planes of a user counts in the first stage that has an answer. Where they gave, they cannot
  /// be held; where they are left out, those against bodies alone leave no room.
  std::string earlier_stage(const Seen& s) const {
    const RobotStep& r = *s.state;
    if (r.own.empty() != (r.own_stage == OwnStage::none))
      return " states a stage without half-planes of a user, or has such half-planes without a stage";
    const bool has_answer = r.status == lp::Status::optimal || r.status == lp::Status::relaxed;
    if (holds_bodies(r.own_stage) && !has_answer) return " is made in a stage that has no answer";
    if (r.own_stage == OwnStage::none || r.own_stage == OwnStage::held) return "";
    lp::Problem before;
    state(s, OwnStage::held, r.own_stage == OwnStage::gave ? r.own : std::vector<OwnConstraint>(), before);
    const lp::Status status = lp::solve_exact(before).solution.status;
    if (status == lp::Status::infeasible || status == lp::Status::no_interior) return "";
    return " gives up half-planes of a user that can be held";
  }

  /// The linear program of a stage.
  void state(const Seen& s, OwnStage stage, const std::vector<OwnConstraint>& own, lp::Problem& problem) const {
    const auto take = [&](const auto& some) {
      for (const auto& c : some)
        problem.constraints.push_back({c.half_plane, is_hard_in(stage, c) ? lp::Priority::hard : lp::Priority::soft});
    };
    const double speed = run_.scenario.robots[s.robot].max_speed;
    if (run_.scenario.speed_bound == formation::SpeedBoundKind::disc)
      problem.bound.disc = speed;
    else
      problem.bound.box_x = problem.bound.box_y = speed;
    if (s.state->stopping_steps > 0 && meets_movers(run_.scenario))
      problem.bound.disc = std::min(
          problem.bound.disc,
          formation::stopping_speed(run_.scenario.acceleration->max, run_.scenario.time_step, s.state->stopping_steps));
    problem.preferred = s.state->preferred;
    take(s.state->constraints);
    if (holds_bodies(stage)) take(own);
  }

  /// m/s
  struct Violations {
    Rational forbidden, given;
  };

  /// By how much the choice breaks what must hold, and what may give.
  Violations violations(const Seen& s) const {
    const RobotStep& r = *s.state;
    const bool no_room = r.status == lp::Status::no_interior, infeasible = r.status == lp::Status::infeasible;
    const Point chosen = exactly(r.chosen);
    Violations most{Rational(0), Rational(0)};
    const auto take = [&](const auto& c) {
      const Rational violation = violation_at(c.half_plane, chosen);
      const bool is_hard = is_hard_in(r.own_stage, c);
      const bool may_give = infeasible || (!is_hard && (no_room || r.status == lp::Status::relaxed));
      if (!may_give) most.forbidden = std::max(most.forbidden, violation);
      if (may_give && is_hard == infeasible) most.given = std::max(most.given, violation);
    };
    for (const DecisionConstraint& c : r.constraints) take(c);
    if (holds_bodies(r.own_stage))
      for (const OwnConstraint& c : r.own) take(c);
    return most;
  }

  /// What is wrong with what a row says of its choice beside the multipliers; empty where nothing is.
  std::string misstated(const Seen& s, const Violations& most) const {
    const RobotStep& r = *s.state;
    const Point chosen = exactly(r.chosen);
    const Rational speed(fastest(s.robot)), near = Rational(kBindsWithin) * speed;
    if (r.status == lp::Status::no_interior) {
      if (most.forbidden > near || exact::dot(chosen, chosen) > (speed + near) * (speed + near))
        return " breaks a half-plane or the speed bound";
      return "";
    }
    if (abs(Rational(r.violation) - most.given) > near) return " states another violation than it has";
    for (const lp::ActiveConstraint& part : r.bound)
      if (r.exact_multipliers && part.multiplier != 0.0) return kBesideExact;
    const auto wrong_with = [&](const auto& c) {
      if (r.exact_multipliers && c.multiplier != 0.0) return kBesideExact;
      if (!c.active && c.multiplier != 0.0) return " has a multiplier for an inactive half-plane";
      if (c.active && r.status == lp::Status::optimal && violation_at(c.half_plane, chosen) < -near)
        return " lists a half-plane as active whose boundary it is not on";
      return "";
    };
    std::string wrong;
    for (const DecisionConstraint& c : r.constraints)
      if (wrong.empty()) wrong = wrong_with(c);
    for (const OwnConstraint& c : r.own) {
      if (wrong.empty()) wrong = wrong_with(c);
      if (wrong.empty() && c.active && !holds_bodies(r.own_stage)) wrong = " lists as active what it leaves out";
    }
    return wrong;
  }

  /// The decision as a problem of the recorded half-planes, and its answer. Says what is wrong with its terms.
  std::string stated(const Seen& s, lp::Problem& problem, lp::Solution& solution) const {
    const RobotStep& r = *s.state;
    state(s, r.own_stage, r.own, problem);
    solution.velocity = r.chosen;
    solution.status = r.status;
    solution.violation = r.violation;
    bool fits = true;
    const auto take = [&](const lp::Binding& binding, double multiplier) {
      fits = fits && solution.active_count < solution.active.size() && multiplier >= 0.0 && std::isfinite(multiplier);
      if (fits) solution.active[solution.active_count++] = {binding, multiplier};
    };
    std::size_t number = 0;
    for (const DecisionConstraint& c : r.constraints) {
      if (c.active) take(lp::constraint_at(number), c.multiplier);
      ++number;
    }
    for (const OwnConstraint& c : r.own) {
      if (c.active) take(lp::constraint_at(number), c.multiplier);
      ++number;
    }
    for (const lp::ActiveConstraint& part : r.bound) take(part.binding, part.multiplier);
    return fits ? "" : " has too many or invalid multipliers";
  }

  const AuditedRun& run_;
  std::optional<vo::Variant> cone_;           ///< of a method that promises nothing between robots
  bool literal_horizons_;                     ///< the controller's horizons may be shorter than a step
  std::vector<geometry::ConvexShape> moved_;  ///< moving obstacles in the present row
};

}  // namespace

std::unique_ptr<RowAudit> audit_decisions(const AuditedRun& run) {
  return std::make_unique<DecisionAudit>(run);
}

}  // namespace exactvo::datasets
