// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A crowd behind its interface: robots by id, what callers may get wrong, when to sort.

#include <iosfwd>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "crowd/engine.h"

namespace exactvo::formation::crowd {

inline constexpr std::uint32_t kMostRobots = 1U << 30U;
inline constexpr std::size_t kMostKinds = Robots::kKind + std::size_t{1};
inline constexpr std::uint32_t kNowhere = 0xFFFFFFFFU;
/// m/s; squares of speeds stay ordinary floats.
inline constexpr double kFastest = 0x1p15;
/// m; of edges.
inline constexpr double kFarthestEdge = 0x1p40;
/// Bound on the displacement of a body, in lattice steps: differences to places of robots are exact doubles.
inline constexpr std::int64_t kFarthestBody = std::int64_t{1} << 50;
inline constexpr std::size_t kMostEdgesOfAll = std::size_t{1} << 24U;
/// m
inline constexpr double kLeastStrip = 0x1p-6;

void require_valid(const CrowdOptions& options);
void require_valid(const CrowdKind& kind, const CrowdOptions& options);
void require_valid(const geometry::ConvexShape& shape);

class CrowdBody {
 public:
  explicit CrowdBody(const CrowdOptions& options);

  KindId add_kind(const CrowdKind& kind);
  RobotId add_robot(Vec2 position, KindId kind, Vec2 velocity = {});
  void remove_robot(RobotId robot);
  void set_heading(RobotId robot, double degrees);
  /// Throws where it has none.
  const WheelState& wheels_of(RobotId robot);
  ObstacleId add_obstacle(const geometry::Obstacle& obstacle);
  ObstacleId add_body(const geometry::ConvexShape& shape, bool moves, Vec2 velocity);
  void set_body_velocity(ObstacleId body, Vec2 velocity);
  /// Throws where there is none of this id.
  const Body& body(ObstacleId id) const;
  void remove_obstacle(ObstacleId obstacle);
  StepReport step();
  /// Sorts and lays out where something has changed. Calling it more often changes nothing.
  void make_ready();
  /// Throws where there is none of this id.
  std::size_t place_of(RobotId robot);
  std::uint64_t digest() const;

  /// Robots by their place in the order:
  Vec2 position(std::size_t at) const { return core->position_of(at); }
  Vec2 velocity(std::size_t at) const { return core->velocity_of(core->robots.mx[at], core->robots.my[at]); }
  /// Puts what `value_of` says of each place where its robot's id is; grows the array to `id_end`.
  template <class Value, class ValueOf>
  void fill(std::vector<Value>& by_id, const ValueOf& value_of) const {
    if (by_id.size() < id_end) by_id.resize(id_end);
    const Robots& r = core->robots;
    for (std::size_t i = 0; i < r.size(); ++i) by_id[static_cast<std::size_t>(r.id[i])] = value_of(i);
  }
  std::size_t bytes() const {
    return core->bytes() + core->edges.bytes() + core->bodies.bytes() + 4 * (places.capacity() + free_ids.capacity());
  }

  std::unique_ptr<CrowdCore> core;
  std::uint64_t steps = 0;
  RobotId id_end = 0;
  std::vector<RobotId> free_ids;      ///< the last one is given first
  std::vector<std::uint32_t> places;  ///< by id, or empty
  std::map<ObstacleId, std::vector<geometry::Segment>> obstacles;
  ObstacleId next_obstacle = 0;
  bool kinds_changed = false;
  bool edges_changed = false;  ///< or the kinds, which say how far robots look
  bool unsorted = true;
  bool unchecked = true;  ///< robots are new

 private:
  Motion motion_of(Vec2 velocity, const CrowdKind& kind) const;
  std::size_t obstacle_size() const;
  std::pair<std::int32_t, std::int32_t> body_motion(Vec2 velocity) const;
  void lay_out_edges();
  void drive_wheels();
  void guess_hints();
  void follow_density();
  void require_apart() const;
  void require_on_lattice() const;
  bool is_new(std::size_t at) const { return (core->robots.tag[at] & Robots::kSettled) == 0; }
};

/// snapshot.cpp. The crowd is ready.
void write_snapshot(const CrowdBody& body, std::ostream& to);
CrowdOptions read_options(std::istream& from);
void read_snapshot(CrowdBody& body, std::istream& from);

}  // namespace exactvo::formation::crowd
