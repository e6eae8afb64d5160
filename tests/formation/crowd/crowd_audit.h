// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a crowd promises, checked in rationals by code that shares nothing with it.

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "exactvo/formation/crowd.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/vo/certificate.h"

namespace exactvo::formation {

/// The numbers of the properties are those of crowd.h.
struct CrowdAudit {
  std::size_t pairs = 0;            ///< looked at
  std::size_t touching = 0;         ///< of them
  std::size_t one_sided = 0;        ///< only one of the two has the other among its neighbours
  std::size_t near = 0;             ///< pairs that could meet within the step, neighbours or not
  std::size_t overlapping = 0;      ///< of them, at the beginning of the step
  std::size_t unsafe = 0;           ///< (2): the halves leave a velocity that collides within the horizon
  std::size_t unequal = 0;          ///< (2): normals are not the negatives of each other
  std::size_t broken = 0;           ///< a kept robot violates a half-plane
  std::size_t met = 0;              ///< (1): two robots that were apart overlap within the step
  std::size_t fast = 0;             ///< (3)
  std::size_t edges = 0;            ///< edges near robots that were looked at
  std::size_t edges_touching = 0;   ///< of them: nothing is promised
  std::size_t edges_open = 0;       ///< no half-plane of the robot excludes what meets the edge
  std::size_t edges_met = 0;        ///< (7)
  std::size_t bodies = 0;           ///< bodies near robots that were looked at
  std::size_t bodies_touching = 0;  ///< of them
  std::size_t bodies_open = 0;      ///< the robot's half-plane does not exclude what meets the body, or it has none
  std::size_t bodies_met = 0;       ///< (7), (9)
  std::size_t differing = 0;        ///< `explain` said another velocity than `step` chose
  std::string first;                ///< the first that failed, in hexadecimal floats

  std::size_t failures() const {
    return unsafe + unequal + broken + met + fast + edges_open + edges_met + bodies_open + bodies_met + differing;
  }
};

struct AuditedBody {
  ObstacleId id = 0;
  geometry::ConvexShape shape;
  bool moves = false;
};

class CrowdAuditor {
 public:
  /// With the obstacles of the crowd.
  explicit CrowdAuditor(Crowd& crowd, const std::vector<geometry::Obstacle>& obstacles = {}) : crowd_(crowd) {
    for (const auto& obstacle : obstacles)
      for (const geometry::Segment& e : geometry::edges_of(obstacle)) edges_.push_back(e);
  }
  /// Those that the crowd has.
  void set_bodies(std::vector<AuditedBody> bodies) { bodies_ = std::move(bodies); }

  /// Audits one step of the crowd, every pair of neighbours of it.
  void step(CrowdAudit& audit) {
    before_.clear();
    std::vector<Vec2> velocities, positions;
    crowd_.positions(positions);
    for (RobotId id = 0; id < crowd_.id_end(); ++id) before_.push_back(crowd_.explain(id));
    body_from_.clear();
    body_to_.clear();
    for (const AuditedBody& b : bodies_) body_from_.push_back(crowd_.body_displacement(b.id));
    crowd_.step();
    for (const AuditedBody& b : bodies_) body_to_.push_back(crowd_.body_displacement(b.id));
    crowd_.velocities(velocities);
    crowd_.kept(kept_);
    moved_.clear();
    crowd_.positions(moved_);
    for (RobotId id = 0; id < crowd_.id_end(); ++id) {
      const CrowdExplanation& e = before_[id];
      if (!(velocities[id] == e.chosen) || (kept_[id] != 0) != e.kept) fail(audit, audit.differing, e, nullptr);
      check_robot(audit, e);
      for (const geometry::Segment& edge : edges_) check_edge(audit, e, edge);
      for (std::size_t k = 0; k < bodies_.size(); ++k) check_body(audit, e, k);
      for (const auto& n : e.neighbours) check_pair(audit, e, n);
    }
    for (RobotId a = 0; a < crowd_.id_end(); ++a)
      for (RobotId b = a + 1; b < crowd_.id_end(); ++b) check_motions(audit, before_[a], before_[b]);
  }

  /// Two discs that move straight by whole steps of the lattice: do they overlap at a moment between, exactly?
  static bool overlap(Vec2 a, Vec2 a_to, Vec2 b, Vec2 b_to, const mpq_class& squared_radius) {
    const mpq_class px = mpq_class(b.x) - mpq_class(a.x), py = mpq_class(b.y) - mpq_class(a.y);
    const mpq_class mx = mpq_class(a_to.x) - mpq_class(a.x) - mpq_class(b_to.x) + mpq_class(b.x);
    const mpq_class my = mpq_class(a_to.y) - mpq_class(a.y) - mpq_class(b_to.y) + mpq_class(b.y);
    const mpq_class along = px * mx + py * my, squared = mx * mx + my * my;
    const mpq_class ex = px - mx, ey = py - my;
    if (along <= 0) return px * px + py * py < squared_radius;
    if (along >= squared) return ex * ex + ey * ey < squared_radius;
    const mpq_class across = px * my - py * mx;
    return across * across < squared_radius * squared;
  }

 private:
  void check_robot(CrowdAudit& audit, const CrowdExplanation& e) {
    const mpq_class dt(crowd_.options().time_step), x = (mpq_class(moved_[e.robot].x) - mpq_class(e.position.x)) / dt,
                                                    y = (mpq_class(moved_[e.robot].y) - mpq_class(e.position.y)) / dt;
    const mpq_class limit(crowd_.kind(crowd_.kind_of(e.robot)).max_speed);
    if (x * x + y * y > limit * limit) fail(audit, audit.fast, e, nullptr);
    if (!e.kept) return;
    for (const auto& n : e.edges) {
      const geometry::HalfPlane& h = n.half_plane;
      if (mpq_class(h.normal.x) * x + mpq_class(h.normal.y) * y < mpq_class(h.offset))
        fail(audit, audit.broken, e, nullptr);
    }
    for (const auto& n : e.neighbours) {
      const geometry::HalfPlane& h = n.half_plane;
      if (mpq_class(h.normal.x) * x + mpq_class(h.normal.y) * y < mpq_class(h.offset)) fail(audit, audit.broken, e, &n);
    }
  }

  /// Squared distance of a point from a segment, exactly.
  static mpq_class squared_distance(Vec2 p, const geometry::Segment& s) {
    const mpq_class ax = mpq_class(p.x) - mpq_class(s.a.x), ay = mpq_class(p.y) - mpq_class(s.a.y);
    const mpq_class dx = mpq_class(s.b.x) - mpq_class(s.a.x), dy = mpq_class(s.b.y) - mpq_class(s.a.y);
    const mpq_class along = ax * dx + ay * dy, length = dx * dx + dy * dy;
    if (along <= 0) return ax * ax + ay * ay;
    if (along >= length) {
      const mpq_class bx = mpq_class(p.x) - mpq_class(s.b.x), by = mpq_class(p.y) - mpq_class(s.b.y);
      return bx * bx + by * by;
    }
    const mpq_class across = ax * dy - ay * dx;
    return across * across / length;
  }

  static bool is_far(Vec2 p, const geometry::Segment& s, double range) {
    const Vec2 along = s.b - s.a, from = p - s.a;
    const double length = geometry::squared_norm(along);
    const double t = length > 0.0 ? std::min(1.0, std::max(0.0, geometry::dot(from, along) / length)) : 0.0;
    return geometry::norm(from - t * along) > range;
  }

  static int side(const geometry::Segment& s, Vec2 p) {
    const mpq_class dx = mpq_class(s.b.x) - mpq_class(s.a.x), dy = mpq_class(s.b.y) - mpq_class(s.a.y);
    return sgn(mpq_class(dx * (mpq_class(p.y) - mpq_class(s.a.y)) - dy * (mpq_class(p.x) - mpq_class(s.a.x))));
  }

  static bool farther_apart(const geometry::Segment& s, const geometry::Segment& t, double radius) {
    const mpq_class limit = mpq_class(radius) * mpq_class(radius);
    if (side(s, t.a) * side(s, t.b) < 0 && side(t, s.a) * side(t, s.b) < 0) return false;
    return squared_distance(s.a, t) > limit && squared_distance(s.b, t) > limit && squared_distance(t.a, s) > limit &&
           squared_distance(t.b, s) > limit;
  }

  void check_edge(CrowdAudit& audit, const CrowdExplanation& e, const geometry::Segment& edge) {
    const CrowdKind& kind = crowd_.kind(crowd_.kind_of(e.robot));
    const double range = kind.radius + kind.max_speed * kind.time_horizon;
    if (is_far(e.position, edge, 1.001 * range)) return;  // by far: that needs no rationals
    if (squared_distance(e.position, edge) > range * range) return;
    ++audit.edges;
    bool excluded = false;
    for (const auto& n : e.edges) {
      const bool same = n.edge.a == edge.a && n.edge.b == edge.b;
      if (same && n.touching) {
        ++audit.edges_touching;
        return;
      }
      excluded = excluded || excludes(e, kind, range, n.half_plane, edge);
    }
    if (!excluded) fail(audit, audit.edges_open, e, nullptr);
    if (!farther_apart({e.position, moved_[e.robot]}, edge, kind.radius)) fail(audit, audit.edges_met, e, nullptr);
  }

  /// Places on the lattice: differences are exact.
  void check_body(CrowdAudit& audit, const CrowdExplanation& e, std::size_t k) {
    const AuditedBody& body = bodies_[k];
    const CrowdKind& kind = crowd_.kind(crowd_.kind_of(e.robot));
    const Vec2 velocity = crowd_.body_velocity(body.id), from = e.position - body_from_[k];
    const double range = kind.radius + kind.time_horizon * (kind.max_speed + geometry::norm(velocity));
    if (geometry::distance_below(geometry::box_of(body.shape), from) > 1.001 * range) return;
    const CrowdExplanation::Body* line = nullptr;
    for (const auto& b : e.bodies)
      if (b.body == body.id) line = &b;
    const Vec2 motion = moved_[e.robot] - body_to_[k] - from;
    const geometry::GrownShape grown{body.shape, from, kind.radius};
    if (!line) {
      if (geometry::locate({body.shape, from, range}, Vec2{}) == geometry::Place::inside)
        fail(audit, audit.bodies_open, e, nullptr);
      if (geometry::segment_meets(grown, motion, 1.0)) fail(audit, audit.bodies_met, e, nullptr);
      return;
    }
    ++audit.bodies;
    if (line->touching) {
      ++audit.bodies_touching;
      const geometry::GrownShape after{body.shape, from + motion, kind.radius};
      if (body.moves && e.kept && geometry::locate(after, Vec2{}) == geometry::Place::inside)
        fail(audit, audit.bodies_met, e, nullptr);
      return;
    }
    if (!vo::is_true({body.shape, from, kind.radius, kind.time_horizon, velocity, line->half_plane}))
      fail(audit, audit.bodies_open, e, nullptr);
    if ((e.kept || !body.moves) && geometry::segment_meets(grown, motion, 1.0))
      fail(audit, audit.bodies_met, e, nullptr);
  }

  /// What can be met within the horizon is nearer than the range: the rest of a long edge does not count.
  static bool excludes(const CrowdExplanation& e, const CrowdKind& kind, double range, const geometry::HalfPlane& h,
                       const geometry::Segment& edge) {
    const vo::HalfPlaneClaim claim{edge, e.position, kind.radius, kind.time_horizon, {}, h};
    if (vo::is_true(claim)) return true;
    const Vec2 along = edge.b - edge.a;
    const double length = geometry::norm(along), foot = geometry::dot(e.position - edge.a, along) / length;
    const double from = std::max(0.0, foot - 1.4 * range) / length, to = std::min(length, foot + 1.4 * range) / length;
    const geometry::Segment near{edge.a + from * along, edge.a + to * along};
    return vo::is_true({near, e.position, kind.radius, kind.time_horizon, {}, {h.normal, h.offset + 1e-9}});
  }

  void check_pair(CrowdAudit& audit, const CrowdExplanation& a, const CrowdExplanation::Neighbour& n) {
    const CrowdExplanation& b = before_[n.robot];
    const CrowdExplanation::Neighbour* back = nullptr;
    for (const auto& m : b.neighbours)
      if (m.robot == a.robot) back = &m;
    if (back && n.robot < a.robot) return;  // already looked at
    ++audit.pairs;
    audit.one_sided += back == nullptr;
    audit.touching += n.touching;
    if (n.touching) return;
    const CrowdKind& kind_a = crowd_.kind(crowd_.kind_of(a.robot));
    const CrowdKind& kind_b = crowd_.kind(crowd_.kind_of(b.robot));
    if (back) check_halves(audit, a, n, *back, kind_a, kind_b);
  }

  void check_motions(CrowdAudit& audit, const CrowdExplanation& a, const CrowdExplanation& b) {
    const CrowdKind& kind_a = crowd_.kind(crowd_.kind_of(a.robot));
    const CrowdKind& kind_b = crowd_.kind(crowd_.kind_of(b.robot));
    const double reach =
        kind_a.radius + kind_b.radius + (kind_a.max_speed + kind_b.max_speed) * crowd_.options().time_step;
    if (geometry::norm(a.position - b.position) > 1.001 * reach) return;
    ++audit.near;
    const mpq_class radius = mpq_class(kind_a.radius) + mpq_class(kind_b.radius);
    const mpq_class dx = mpq_class(a.position.x) - mpq_class(b.position.x),
                    dy = mpq_class(a.position.y) - mpq_class(b.position.y);
    const bool overlaps = dx * dx + dy * dy < radius * radius;
    audit.overlapping += overlaps;
    if (!overlaps && overlap(a.position, moved_[a.robot], b.position, moved_[b.robot], radius * radius))
      fail(audit, audit.met, a, nullptr);
  }

  void check_halves(CrowdAudit& audit, const CrowdExplanation& a, const CrowdExplanation::Neighbour& n,
                    const CrowdExplanation::Neighbour& back, const CrowdKind& kind_a, const CrowdKind& kind_b) {
    if (!(back.half_plane.normal == -n.half_plane.normal)) fail(audit, audit.unequal, a, &n);
    // The sum, rounded down.
    const double sum = std::nextafter(n.half_plane.offset + back.half_plane.offset, -1e300);
    const double horizon = std::min(kind_a.time_horizon, kind_b.time_horizon);
    const geometry::Disc other{before_[n.robot].position, kind_b.radius};
    if (!vo::is_true({other, a.position, kind_a.radius, horizon, {}, {n.half_plane.normal, sum}}))
      fail(audit, audit.unsafe, a, &n);
  }

  void fail(CrowdAudit& audit, std::size_t& count, const CrowdExplanation& e, const CrowdExplanation::Neighbour* n) {
    ++count;
    if (!audit.first.empty()) return;
    char text[512];
    std::snprintf(text, sizeof text,
                  "robot %u at (%a, %a), velocity (%a, %a), preferred (%a, %a), chosen (%a, %a), kept %d", e.robot,
                  e.position.x, e.position.y, e.velocity.x, e.velocity.y, e.preferred.x, e.preferred.y, e.chosen.x,
                  e.chosen.y, e.kept);
    audit.first = text;
    if (!n) return;
    const CrowdExplanation& o = before_[n->robot];
    std::snprintf(text, sizeof text,
                  "; against %u at (%a, %a), velocity (%a, %a): normal (%a, %a), offset %a, touching %d", n->robot,
                  o.position.x, o.position.y, o.velocity.x, o.velocity.y, n->half_plane.normal.x,
                  n->half_plane.normal.y, n->half_plane.offset, n->touching);
    audit.first += text;
  }

  Crowd& crowd_;
  std::vector<geometry::Segment> edges_;
  std::vector<AuditedBody> bodies_;
  std::vector<Vec2> body_from_, body_to_;
  std::vector<CrowdExplanation> before_;
  std::vector<Vec2> moved_;
  std::vector<std::uint8_t> kept_;
};

/// Audits a crowd of `crowd_of(scene)`.
template <class Scene>
std::vector<AuditedBody> bodies_of(const Scene& scene) {
  std::vector<AuditedBody> bodies;
  for (const auto& body : scene.bodies)
    bodies.push_back({static_cast<ObstacleId>(scene.obstacles.size() + bodies.size()), body.shape, body.moves});
  return bodies;
}

}  // namespace exactvo::formation
