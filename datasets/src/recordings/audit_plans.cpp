// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/audit_points.h"

#include <algorithm>
#include <string>

namespace exactvo::datasets {
namespace {

using exact::Point;
using exact::Rational;
using exact::Straight;
using formation::JointPlan;

/// A move may come nearer than radii allow by this share of them, since plans are rounded: squared distances are
/// compared to within a share of 1e-9, and a place within 1e-9 diameters of a known one counts as that one.
constexpr double kPlanRounding = 1e-8;

/// A plan on its way: where each robot stands.
class PlanAudit {
 public:
  PlanAudit(const AuditedRun& run, const JointPlan& plan) : run_(run), plan_(plan), at_(plan.starts) {}

  void check() {
    for (std::size_t k = 0; k < plan_.robots.size(); ++k) begins(k);
    for (std::size_t m = 0; m < plan_.moves.size(); ++m) move(m);
  }

 private:
  const std::string& id(std::size_t robot) const { return run_.scenario.robots[robot].id; }
  Rational radius(std::size_t robot) const { return Rational(run_.scenario.robots[robot].radius); }

  void begins(std::size_t k) {
    const std::size_t robot = plan_.robots[k];
    const geometry::Vec2* place = run_.places.at_begin(plan_, robot);
    const std::string where = "where " + id(robot) + " was in row " + std::to_string(plan_.from_row);
    if (place && *place == plan_.starts[k])
      run_.tally.proven(AuditPoint::plans);
    else if (run_.places.is_forgotten(plan_, robot))
      run_.tally.open(AuditPoint::plans, at_row(plan_.row, "the plan begins too long ago to know " + where));
    else
      run_.tally.refuted(AuditPoint::plans, at_row(plan_.row, "the plan does not begin " + where));
  }

  void move(std::size_t m) {
    const std::size_t robot = plan_.moves[m].robot;
    const auto found = std::lower_bound(plan_.robots.begin(), plan_.robots.end(), robot);
    const auto mover = static_cast<std::size_t>(found - plan_.robots.begin());
    std::string met, open;
    meet_obstacles(mover, plan_.moves[m].to, met, open);
    meet_robots(mover, plan_.moves[m].to, met, open);
    at_[mover] = plan_.moves[m].to;
    const std::string what = "move " + std::to_string(m) + " of the plan takes " + id(robot) + " too near to ";
    if (!met.empty())
      run_.tally.refuted(AuditPoint::plans, at_row(plan_.row, what + met));
    else if (!open.empty())
      run_.tally.open(AuditPoint::plans, at_row(plan_.row, what + open + ", where it is too near before"));
    else
      run_.tally.proven(AuditPoint::plans);
  }

  /// A pair that is too near at the beginning is left open: plans are made from where robots stand.
  void meet_obstacles(std::size_t mover, geometry::Vec2 to, std::string& met, std::string& open) const {
    const std::size_t robot = plan_.robots[mover];
    const Rational reach = radius(robot) * (1 - Rational(kPlanRounding));
    const geometry::Box swept = box_of(geometry::Segment{at_[mover], to});
    const Straight way{exact::exactly(at_[mover]), exact::exactly(to)};
    const Straight start{way.from, way.from};
    for (std::size_t o = 0; o < run_.obstacles.size(); ++o) {
      if (are_apart(swept, run_.obstacles[o].box, run_.scenario.robots[robot].radius)) continue;
      bool meets = exact::is_inside(way.from, *run_.obstacles[o].obstacle), stood = meets;
      for (const std::size_t edge : run_.obstacles[o].near(swept, run_.scenario.robots[robot].radius)) {
        if (!exact::come_nearer_than(way, run_.obstacles[o].edges[edge], reach)) continue;
        meets = true;
        stood = stood || exact::come_nearer_than(start, run_.obstacles[o].edges[edge], reach);
      }
      std::string& where = stood ? open : met;
      if (meets && where.empty()) where = "obstacle '" + run_.scenario.obstacles[o].id + "'";
    }
  }

  void meet_robots(std::size_t mover, geometry::Vec2 to, std::string& met, std::string& open) const {
    const Straight way{exact::exactly(at_[mover]), exact::exactly(to)};
    for (std::size_t k = 0; k < at_.size(); ++k) {
      if (k == mover) continue;
      const Rational reach = (radius(plan_.robots[mover]) + radius(plan_.robots[k])) * (1 - Rational(kPlanRounding));
      const Point other = exact::exactly(at_[k]);
      if (exact::squared_distance(other, way) >= reach * reach) continue;
      const Point before = other - way.from;
      std::string& where = exact::dot(before, before) < reach * reach ? open : met;
      if (where.empty()) where = "robot '" + id(plan_.robots[k]) + "'";
    }
  }

  const AuditedRun& run_;
  const JointPlan& plan_;
  std::vector<geometry::Vec2> at_;  ///< m
};

}  // namespace

void audit_plans(const AuditedRun& run) {
  for (const JointPlan& plan : run.file.recording.plans) PlanAudit(run, plan).check();
}

}  // namespace exactvo::datasets
