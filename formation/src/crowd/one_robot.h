// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One robot decided alone, with any number of neighbours, to the bits that a pack gives it; and what a pack leaves to
/// be done robot by robot.

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "crowd/edge_pack.h"
#include "crowd/engine.h"

namespace exactvo::formation {

struct CrowdMotion {
  std::int32_t mx, my;  ///< lattice steps
  bool kept;            ///< all half-planes
  bool nudged = false, stopped = false;
  bool reserved = false;  ///< drives straight to its reserved place
};

struct CrowdDecision {
  CrowdMotion motion;
  std::int32_t hint;  ///< lattice steps, for the next search
  StepReport counts;  ///< half-planes, touching, widened
};

/// A robot near another, by cut squared distance (lattice steps) and place in the sorted order.
using Near = std::pair<float, std::int32_t>;

/// One per thread.
template <class T>
struct OneRobotBuffers {
  std::vector<Near> near;
  crowd::EdgePackQuery<T> edge_query;
  crowd::EdgePackTable edge_table;
  crowd::Array<T> edge_x, edge_y, edge_c;  ///< half-planes of edges, lane 0 of a row each
  std::vector<std::uint32_t> edge;         ///< their numbers
  std::vector<std::uint8_t> edge_touching;
  std::vector<std::uint32_t> near_bodies;
  std::vector<crowd::BodyLine> body_lines, capsule_lines;
  std::size_t still = 0;                ///< of body_lines, the first: against bodies at rest
  crowd::Array<T> row_x, row_y, row_c;  ///< half-planes of edges and bodies at rest, of robots, of bodies that move
};

template <class T>
class OneRobot {
 public:
  using Buffers = OneRobotBuffers<T>;

  /// Both are looked at when a robot is decided.
  OneRobot(const CrowdCore& crowd, const crowd::KindTable<T>& table) : crowd_(crowd), table_(table) {}

  /// `words`: gets the half-planes, unless null.
  CrowdDecision decide(std::size_t robot, Vec2 preferred, Buffers& b, CrowdExplanation* words) const;

  /// A lane of the query for the robot: most have no edges nearby, and ask for nothing else then.
  void ask_edges(std::size_t robot, std::size_t lane, crowd::EdgePackQuery<T>& query) const {
    const Vec2 at = crowd_.position_of(robot);
    const crowd::EdgeGrid::Range near = crowd_.edges.near(at);
    query.first[lane] = static_cast<std::int32_t>(near.first);
    query.count[lane] = static_cast<std::int32_t>(near.last - near.first);
    if (query.count[lane] == 0) return;
    const Vec2 velocity = crowd_.velocity_of(crowd_.robots.mx[robot], crowd_.robots.my[robot]);
    const CrowdKind& kind = kind_of(robot);
    query.edges = crowd_.edges.edges().data();
    query.items = crowd_.edges.items().data();
    query.slack = table_.lattice_slack;
    query.x[lane] = at.x;
    query.y[lane] = at.y;
    query.vx[lane] = velocity.x;
    query.vy[lane] = velocity.y;
    query.radius[lane] = kind.radius;
    query.horizon[lane] = obstacle_horizon(robot);
    query.max_speed[lane] = kind.max_speed;
    query.least[lane] = table_.least_offset[crowd_.robots.kind(robot)];
  }

  /// Into b.body_lines and b.still, those against capsules of reserved ways among them.
  void lines_of_bodies(std::size_t robot, Buffers& b) const;
  /// On wheels: whether it may drive a motion.
  bool can_drive(std::size_t robot, crowd::Motion m) const {
    return crowd_.wheels.allow(crowd_.robots.kind(robot), crowd_.robots.id[robot], m);
  }
  bool has_bodies() const { return !crowd_.bodies.empty() || !crowd_.reserved_ways.empty(); }

  /// The half-planes against edges and bodies at rest, in the first rows of lane 0; how many.
  std::size_t put_obstacles(std::size_t robot, Buffers& b) const;
  /// Whether a motion of (mx, my) lattice steps keeps the first `lines` rows of `put_obstacles`.
  bool keeps_obstacles(std::size_t robot, std::size_t lines, const Buffers& b, double mx, double my) const;
  /// The longest part of a robot's preferred motion that keeps the first `hard` lines and that its wheels allow: for
  /// one that is never turned.
  CrowdMotion straight(std::size_t robot, Vec2 preferred, crowd::Answers<T> in, std::size_t hard) const;

  /// Where a motion does not satisfy all half-planes, or wheels do not allow it: another one nearby, or none. `hard`:
  /// the number of first lines that are of edges, bodies at rest and wheels.
  CrowdMotion settled(std::size_t robot, const crowd::Answers<T>& in, std::uint8_t status, std::int32_t hard,
                      CrowdMotion m) const;

  /// As a row: a half-plane, `normal` and `offset`.
  template <class Line>
  void put(const Line& line, std::size_t robot, T& x, T& y, T& c) const {
    x = static_cast<T>(line.normal.x);
    y = static_cast<T>(line.normal.y);
    c = row_offset(line.offset, crowd_.robots.kind(robot));
  }
  /// m/s, of a half-plane of a robot of this kind, with what covers the rounding to the lattice.
  T row_offset(double offset, std::size_t kind) const {
    return std::max(table_.least_offset[kind],
                    crowd::rounded_up<T>(offset + static_cast<double>(table_.lattice_slack)));
  }

 private:
  const CrowdKind& kind_of(std::size_t robot) const { return crowd_.kinds[crowd_.robots.kind(robot)]; }
  bool is_reserved(std::size_t robot) const { return crowd_.reserved_ways.holds(crowd_.robots.id[robot]); }
  /// s: a robot that drives to a reserved place stops there, and looks no farther than the step.
  double obstacle_horizon(std::size_t robot) const {
    return is_reserved(robot) ? crowd_.options.time_step : edge_horizon(kind_of(robot));
  }
  crowd::BodyQuery query_of(std::size_t robot) const;
  std::size_t lines_of_edges(std::size_t robot, Buffers& b) const;
  void lay_out_rows(std::size_t rows, Buffers& b) const;
  void put_obstacles(std::size_t robot, std::size_t edges, std::size_t between, Buffers& b,
                     CrowdExplanation* words) const;
  geometry::HalfPlane half_plane(std::size_t row, const Buffers& b) const;
  bool put_neighbours(std::size_t robot, std::size_t first, std::size_t row, Buffers& b, CrowdExplanation* words) const;
  void part(std::size_t robot, std::size_t other, T& x, T& y, T& c) const;
  CrowdMotion solve(std::size_t robot, Vec2 preferred, std::size_t lines, std::int32_t hard, const Buffers& b) const;
  CrowdMotion kept_off_edges(std::size_t robot, crowd::Answers<T> in, std::size_t hard, CrowdMotion m) const;
  CrowdMotion driven(std::size_t robot, crowd::Answers<T> in, std::size_t hard, CrowdMotion m) const;
  std::size_t put_wheels(std::size_t robot, std::size_t row, Buffers& b, CrowdExplanation* words) const;

  const CrowdCore& crowd_;
  const crowd::KindTable<T>& table_;
};

}  // namespace exactvo::formation
