// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Places that robots of a crowd have reserved and drive straight to (liveness/reservations.h decides which). Such a
/// robot is slowed down but never turned; the others keep out of its capsule, the discs between where it is and its
/// place. A matter of manners: that no two robots overlap does not rest on it. Heuristic.

#include <cstdint>
#include <vector>

#include "crowd/bodies.h"
#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::formation::crowd {

class ReservedWays {
 public:
  /// `obstacle` of a line that is against a capsule.
  static constexpr std::uint32_t kCapsule = 0xFFFFFFFFU;

  bool empty() const { return holders_ == 0; }
  bool holds(std::int32_t id) const {
    return holders_ != 0 && static_cast<std::size_t>(id) < reserved_.size() &&
           reserved_[static_cast<std::size_t>(id)] != 0;
  }
  Vec2 place(std::int32_t id) const { return place_[static_cast<std::size_t>(id)]; }
  const std::vector<Vec2>& places() const { return place_; }
  const std::vector<std::uint8_t>& reserved() const { return reserved_; }
  void set(const std::vector<Vec2>& place, const std::vector<std::uint8_t>& reserved);
  void forget(std::int32_t id);

  struct Capsule {
    geometry::Segment way;  ///< m
    double radius = 0.0;    ///< m, of its robot
  };
  /// Before robots ask.
  void lay_out(std::vector<Capsule> capsules);
  /// Adds to `out` a half-plane against every capsule that the disc can enter within the step, for motions of
  /// `horizon` (s). None against one in which the disc already is.
  void add_lines(Vec2 at, double radius, double max_speed, double horizon, std::vector<BodyLine>& out) const;

 private:
  std::vector<Vec2> place_;             ///< m, by id
  std::vector<std::uint8_t> reserved_;  ///< by id
  std::size_t holders_ = 0;
  std::vector<Capsule> capsules_;
  geometry::BoxGrid grid_;
  double widest_ = 0.0;  ///< m, radius
};

}  // namespace exactvo::formation::crowd
