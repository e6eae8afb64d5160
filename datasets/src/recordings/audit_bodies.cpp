// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/audit_points.h"

#include <algorithm>
#include <string>
#include <variant>

#include "recordings/exact_shapes.h"

namespace exactvo::datasets {
namespace {

using formation::GoalBodies;
using geometry::Vec2;
using vo::Body;
using vo::BodyKind;

bool is_edge_of(const geometry::ConvexShape& shape, const RationalObstacle& obstacle) {
  const auto* s = std::get_if<geometry::Segment>(&shape);
  return s && std::any_of(obstacle.segments.begin(), obstacle.segments.end(), [&](const geometry::Segment& edge) {
           return (edge.a == s->a && edge.b == s->b) || (edge.a == s->b && edge.b == s->a);
         });
}

/// Whether the body is a disc that holds the obstacle's: then it stands for all of it.
bool holds_disc_of(const geometry::ConvexShape& shape, const RationalObstacle& obstacle) {
  const auto* disc = std::get_if<geometry::Disc>(&shape);
  if (!disc || !obstacle.disc) return false;
  const exact::Point apart = exact::exactly(disc->center) - obstacle.disc->center;
  const exact::Rational room = exact::Rational(disc->radius) - obstacle.disc->radius;
  return sgn(room) >= 0 && exact::dot(apart, apart) <= room * room;
}

/// Whether the polygon holds the obstacle's disc: its centre is left of every edge, and no edge is nearer than its
/// radius.
bool holds_its_disc(const RationalObstacle& obstacle) {
  const RationalDisc& disc = *obstacle.disc;
  return std::all_of(obstacle.edges.begin(), obstacle.edges.end(), [&](const exact::Straight& edge) {
    return sgn(exact::cross(edge.to - edge.from, disc.center - edge.from)) > 0 &&
           exact::squared_distance(disc.center, edge) >= disc.radius * disc.radius;
  });
}

class BodyAudit {
 public:
  explicit BodyAudit(const AuditedRun& run) : run_(run), covered_(run.file.recording.bodies.size()) {}

  void check() {
    for (std::size_t k = 0; k < run_.obstacles.size(); ++k)
      if (run_.obstacles[k].disc)
        run_.tally.ask(AuditPoint::bodies, holds_its_disc(run_.obstacles[k]),
                       "the polygon of obstacle '" + run_.scenario.obstacles[k].id + "' does not hold its disc");
    for (std::size_t number = 0; number < run_.file.recording.bodies.size(); ++number) check_body(number);
    check_goal_bodies();
  }

 private:
  void check_body(std::size_t number) {
    const Body& body = run_.file.recording.bodies[number];
    const bool stands_still = body.kind == BodyKind::enclosure || body.kind == BodyKind::obstacle_edge;
    if (!stands_still || body.owners.empty()) return;  // what has no owner may not be named (audit_decisions.cpp)
    const std::string name = "body " + std::to_string(number);
    const std::size_t most = *std::max_element(body.owners.begin(), body.owners.end());
    if (most >= run_.obstacles.size())
      return run_.tally.refuted(AuditPoint::bodies, name + " stands for an obstacle that the scenario does not have");
    if (!geometry::is_valid(body.shape)) return run_.tally.refuted(AuditPoint::bodies, name + " is no valid shape");
    if (body.kind == BodyKind::obstacle_edge) {
      const bool is_edge = body.owners.size() == 1 && is_edge_of(body.shape, run_.obstacles[body.owners.front()]);
      return run_.tally.ask(AuditPoint::bodies, is_edge, name + " is no edge of its obstacle");
    }
    bool stands_for_all = true;
    for (const std::size_t owner : body.owners) {
      Covered& covered = covered_[number].emplace_back(Covered{owner, {}});
      const bool has_disc = holds_disc_of(body.shape, run_.obstacles[owner]);
      for (const exact::Straight& edge : run_.obstacles[owner].edges) {
        covered.edges.push_back(has_disc ||
                                (exact::contains(body.shape, edge.from) && exact::contains(body.shape, edge.to)));
        covered.any = covered.any || covered.edges.back();
      }
      stands_for_all = stands_for_all && covered.any;
    }
    run_.tally.ask(AuditPoint::bodies, stands_for_all || is_made_of_its_owner(body),
                   name + " does not contain an edge of every obstacle that it stands for");
  }

  /// A convex piece from the middle of a polygon contains none of its edges.
  bool is_made_of_its_owner(const Body& body) const {
    const auto* polygon = std::get_if<geometry::ConvexPolygon>(&body.shape);
    if (!polygon || body.owners.size() != 1) return false;
    const std::vector<Vec2> all = geometry::vertices_of(*run_.obstacles[body.owners.front()].obstacle);
    return std::all_of(polygon->vertices.begin(), polygon->vertices.end(),
                       [&](Vec2 v) { return std::find(all.begin(), all.end(), v) != all.end(); });
  }

  void check_goal_bodies() {
    const std::vector<GoalBodies>& goal_bodies = run_.file.recording.goal_bodies;
    std::vector<const GoalBodies*> last(run_.scenario.robots.size(), nullptr);
    const bool has_enclosures =
        std::any_of(run_.file.recording.bodies.begin(), run_.file.recording.bodies.end(),
                    [](const Body& body) { return body.kind == BodyKind::enclosure && !body.owners.empty(); });
    const bool has_edges = std::any_of(run_.file.recording.bodies.begin(), run_.file.recording.bodies.end(),
                                       [](const Body& body) { return body.kind == BodyKind::obstacle_edge; });
    // A run among edges names only those that it met, if any: completeness is asked of its rows.
    const bool names_none = !has_enclosures && std::all_of(goal_bodies.begin(), goal_bodies.end(),
                                                           [](const GoalBodies& o) { return o.bodies.empty(); });
    if (has_enclosures && has_edges)
      run_.tally.refuted(AuditPoint::bodies, "the bodies are enclosures and edges: no method has both");
    for (const GoalBodies& of_goal : goal_bodies) {
      const std::string name =
          "the enclosures of " + run_.scenario.robots[of_goal.robot].id + " for goal " + std::to_string(of_goal.goal);
      if (!is_in_order(of_goal, last[of_goal.robot]))
        run_.tally.refuted(AuditPoint::bodies, name + " come out of turn");
      last[of_goal.robot] = &of_goal;
      if (has_edges || names_none) continue;
      const std::vector<bool> covered = covered_by(of_goal);
      for (std::size_t k = 0; k < run_.obstacles.size(); ++k)
        if (covered[k])
          run_.tally.proven(AuditPoint::bodies);
        else
          run_.tally.refuted(AuditPoint::bodies,
                             name + " leave out a part of obstacle '" + run_.scenario.obstacles[k].id + "'");
    }
    for (std::size_t i = 0; i < last.size() && has_enclosures; ++i)
      if (!last[i]) run_.tally.refuted(AuditPoint::bodies, run_.scenario.robots[i].id + " has no enclosures");
  }

  /// The first at t = 0 for the first goal, then goal after goal, each from a row at which the last goal was reached.
  /// Robots of a formation have no goals and see otherwise when they begin and end to go by a plan.
  bool is_in_order(const GoalBodies& of_goal, const GoalBodies* before) const {
    if (!before) return of_goal.time == 0.0 && of_goal.goal == 0;
    if (run_.scenario.formation) {
      return of_goal.goal == 0 && of_goal.time > before->time && run_.places.at_begin(of_goal);
    }
    const formation::Robot& robot = run_.scenario.robots[of_goal.robot];
    if (of_goal.goal != before->goal + 1 || of_goal.goal >= robot.goals.size() || of_goal.time < before->time)
      return false;
    const Vec2* place = run_.places.at_begin(of_goal);
    return place &&
           has_reached(robot.goals[before->goal], *place, std::max(robot.radius, run_.scenario.arrival_tolerance));
  }

  /// For each obstacle, whether each of its edges lies in a body that stands for it on the way to that goal.
  std::vector<bool> covered_by(const GoalBodies& of_goal) const {
    std::vector<std::vector<bool>> edges;
    for (const RationalObstacle& o : run_.obstacles) edges.emplace_back(o.edges.size(), false);
    for (const std::size_t body : of_goal.bodies)
      for (const Covered& covered : covered_[body])
        for (std::size_t e = 0; e < covered.edges.size(); ++e)
          if (covered.edges[e]) edges[covered.owner][e] = true;
    std::vector<bool> all;
    for (const std::vector<bool>& of_obstacle : edges)
      all.push_back(std::all_of(of_obstacle.begin(), of_obstacle.end(), [](bool b) { return b; }));
    return all;
  }

  /// Edges of one owner that lie in the body.
  struct Covered {
    std::size_t owner;
    std::vector<bool> edges;
    bool any = false;
  };

  const AuditedRun& run_;
  std::vector<std::vector<Covered>> covered_;  ///< of each body; of enclosures only
};

}  // namespace

void audit_bodies(const AuditedRun& run) {
  BodyAudit(run).check();
}

}  // namespace exactvo::datasets
