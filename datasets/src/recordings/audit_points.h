// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The points of an audit, a file each (audit_POINT.cpp), and what they share: the scene in rationals, with boxes in
/// doubles that tell what can be skipped, and the counts of what was found.

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/crowd_recording.h"
#include "exactvo/geometry/box.h"
#include "recordings/audit_rows.h"
#include "recordings/exact_motion.h"
#include "recordings/exact_plane.h"

namespace exactvo::datasets {

/// Counts by point, with the first findings of each in words.
class AuditTally {
 public:
  void proven(AuditPoint point) { ++report[point].proven; }
  void refuted(AuditPoint point, const std::string& what) { find(report[point], report[point].refuted, what); }
  void open(AuditPoint point, const std::string& what) { find(report[point], report[point].open, what); }
  /// Proven where it holds, else refuted.
  void ask(AuditPoint point, bool holds, const std::string& what) { holds ? proven(point) : refuted(point, what); }

  AuditReport report;

 private:
  /// Each kind has its own bound, so that none is crowded out by another.
  void find(PointCount& point, std::size_t& counter, const std::string& what) {
    if (counter++ < kMostAuditFindings) {
      report.findings.push_back(what);
    } else {
      ++point.unlisted;
    }
  }
};

inline std::string at_row(std::size_t row, const std::string& what) {
  return "row " + std::to_string(row) + ": " + what;
}

/// Whether a robot there has reached its goal. Distances in a run are rounded.
inline bool has_reached(geometry::Vec2 goal, geometry::Vec2 place, double within) {
  const exact::Point d = exact::exactly(place) - exact::exactly(goal);
  const exact::Rational reach(within);
  return exact::dot(d, d) <= reach * reach * (1 + exact::Rational(0x1p-48));
}

inline geometry::Box box_of(const geometry::Segment& s) {
  geometry::Box box{s.a, s.a};
  box.add(s.b);
  return box;
}

inline geometry::Box box_of(geometry::Vec2 p) {
  return {p, p};
}

inline geometry::Box box_of(const exact::Chord& c) {
  const auto [left, right] = std::minmax(c.way.from.x, c.way.to.x);
  const auto [bottom, top] = std::minmax(c.way.from.y, c.way.to.y);
  return {{exact::at_most(left - c.stray), exact::at_most(bottom - c.stray)},
          {exact::at_least(right + c.stray), exact::at_least(top + c.stray)}};
}

/// A difference of doubles that is rounded above r is above r: rounding never changes an order.
inline bool are_apart(const geometry::Box& a, const geometry::Box& b, double r) {
  return a.low.x - b.high.x > r || b.low.x - a.high.x > r || a.low.y - b.high.y > r || b.low.y - a.high.y > r;
}

struct RationalDisc {
  explicit RationalDisc(const geometry::Disc& d) : disc(d), center(exact::exactly(d.center)), radius(d.radius) {}
  geometry::Disc disc;
  exact::Point center;
  exact::Rational radius;
};

/// An obstacle's edges as rationals, once for all steps. Of a disc they are those of the polygon round it.
struct RationalObstacle {
  template <class Obstacle>
  explicit RationalObstacle(const Obstacle& o) : obstacle(&o.shape), segments(edges_of(o.shape)) {
    if (o.disc) disc.emplace(*o.disc);
    for (const geometry::Segment& edge : segments) {
      edges.push_back(exact::exactly(edge));
      boxes.push_back(box_of(edge));
    }
    for (const geometry::Box& b : boxes) box.add(b);
  }

  /// Numbers of the edges that something within the box may come nearer to than r.
  std::vector<std::size_t> near(const geometry::Box& within, double r) const {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < edges.size(); ++k)
      if (!are_apart(within, boxes[k], r)) out.push_back(k);
    return out;
  }

  const geometry::Obstacle* obstacle;
  std::optional<RationalDisc> disc;  ///< what robots must keep clear of, where set
  std::vector<geometry::Segment> segments;
  std::vector<exact::Straight> edges;
  std::vector<geometry::Box> boxes;
  geometry::Box box;  ///< of the whole, its inside too
};

/// An edge of an obstacle, and how near something may come to it, m.
struct NearEdge {
  std::size_t edge;
  exact::Rational reach;
};

/// Whether what follows the chord comes nearer than `reach` to the point.
exact::Verdict against_point(const exact::Chord& chord, const exact::Point& point, const exact::Rational& reach);
/// Whether it comes too near to one of these edges or is inside, or comes nearer than `reach` to the disc.
exact::Verdict against(const exact::Chord& chord, const RationalObstacle& obstacle, const std::vector<NearEdge>& edges,
                       const exact::Rational& reach);

/// m: no disc of a robot that keeps clear of obstacles reaches farther from its place, rounded up.
double obstacle_reach_of(const formation::Robot& robot);
/// Whether all discs of a footprint's chain but the first keep clear of the obstacle wherever a robot may come that
/// drives at its choice for `time`, while its heading turns from where it is towards the choice.
exact::Verdict chain_against(const formation::Robot& robot, const formation::RobotStep& state,
                             const exact::Rational& time, const RationalObstacle& obstacle);

/// What is audited. Points refer to it.
struct AuditedRun {
  /// Once the header is known: `recorded` grows while rows are taken.
  AuditedRun(const RecordingFile& recorded, AuditTally& counts);

  /// Whether a robot's motion is looked at.
  bool is_asked(std::size_t row, std::size_t robot) const;

  const RecordingFile& file;
  const formation::Scenario& scenario;
  exact::Rational duration;  ///< s, of a step
  std::vector<RationalObstacle> obstacles;
  std::vector<exact::ExactWay> ways;         ///< of the moving obstacles
  std::optional<exact::ExponentialLaw> law;  ///< where the motion is exponential
  PlacesInRows places;
  AuditTally& tally;
  bool has_places_only = false;  ///< its rows are places of a crowd, on a lattice, without decisions
  std::size_t one_of = 1;        ///< about one motion in this many is judged
};

/// Where robots are in a row, and how they move.
struct RowStates {
  std::size_t step = 0;                  ///< time steps from the start
  double time = 0.0;                     ///< s
  std::vector<exact::State> robots;      ///< of places without velocities
  std::vector<geometry::Vec2> moved;     ///< m, of places: how far each moving obstacle has come
  const formation::Step* row = nullptr;  ///< of a recording with decisions
};

/// Points that are asked of each row as it comes.
class RowAudit {
 public:
  virtual ~RowAudit() = default;
  /// The row by itself.
  virtual void check_row(const RowInRun&) {}
  /// What is decided in it, and how it leads to the next. REQUIRES: there is one.
  virtual void check_step(const RowInRun& at) = 0;
  /// How a row leads to the next, of a recording of places.
  virtual void check_states(std::size_t /*row*/, const RowStates& /*from*/, const RowStates& /*to*/) {}
};

/// (3), (4) and (5): nothing is missing in a row, its half-planes are true, its choices satisfy them and are optimal.
std::unique_ptr<RowAudit> audit_decisions(const AuditedRun& run);
/// (6): rows follow from one another.
std::unique_ptr<RowAudit> audit_sequence(const AuditedRun& run);
/// (7): no two swept motions meet.
std::unique_ptr<RowAudit> audit_motions(const AuditedRun& run);
/// (10): robots on wheels drive what they chose.
std::unique_ptr<RowAudit> audit_kinematics(const AuditedRun& run);
/// (10), of a recording of places: where every step is a row, robots on wheels drive arcs from place to place within
/// the limits of their wheels; else that is left open. `head` outlives it.
std::unique_ptr<RowAudit> audit_wheels(const AuditedRun& run, const CrowdRecordingHead& head);
/// (9): robots with an acceleration could have braked in every row.
std::unique_ptr<RowAudit> audit_braking(const AuditedRun& run);

// What is said beforehand. REQUIRES: `run.places` of all rows.

/// (2): bodies contain what they stand for, and every robot has some for every obstacle.
void audit_bodies(const AuditedRun& run);
/// (8): joint plans begin where their robots were, and no move of one runs into an obstacle or into another robot of
/// the plan. REQUIRES: plans as read_recording gives them.
void audit_plans(const AuditedRun& run);

}  // namespace exactvo::datasets
