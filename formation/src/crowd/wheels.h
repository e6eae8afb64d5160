// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Robots of a crowd that drive on two wheels. The crowd moves reference points, D ahead of axles, by whole lattice
/// steps m; the twist of theorem 2 (motion/differential.h) takes one from p to p + m exactly, on an arc that strays
/// from the chord by less than the room that radii have for it. So whether bodies touch does not depend on headings,
/// and all promises between robots, edges and bodies hold as they stand. What wheels add is which motions there are.
///
/// Let K = 2 D / q, and let w be the half-heading: as complex numbers the heading is w / conj(w). Lemmas (tests quote
/// the numbers):
///  (1) After m the half-heading is K w + m conj(w), up to a positive factor: with w = (a, b) and m = (x, y)
///      ((K + x) a + y b, (K - x) b + y a). Integers and one number K, so where a robot heads follows exactly from
///      where it headed first and from the places of its rows.
///  (2) What is not known of the heading, a small angle, grows in a step by the factor (K^2 - |m|^2) / |K + m
///  conj(e)|^2
///      at most, and what follows of second order: less than 1 where the robot drives ahead. A motion after which more
///      than kMostDoubt were unknown is not driven.
///  (3) With K >= 2 |m|, b <= 16 D and an unknown angle d of the heading, the ways that a twist gives the wheels are
///      off by less than 32 d |m|, and the angle by which it turns by less than 4 d. More than that is left of every
///      limit: a share of it, kSpare, and of turning 4 kMostDoubt as well.
///  (4) Rest is always among the motions: a wheel may stop within a step (A T >= W). All motions that are driven are
///      accepted by `allow`, so the wheels keep their limits whatever the two levels of the step do.
/// The half-planes of the first level are those of theorem 1 about a polygon of few edges; they say what a robot may
/// wish, and nothing rests on them.

#include <cstdint>
#include <vector>

#include "crowd/pair_row.h"
#include "crowd/robots.h"
#include "crowd/twists.h"
#include "exactvo/formation/crowd.h"

namespace exactvo::formation::crowd {

/// Half-planes of the first level: two from the greatest speed ahead, chords of the disc about 0, the speed back.
inline constexpr std::size_t kChordsOfWheels = 5, kMostWheelRows = kChordsOfWheels + 3;

class Wheels {
 public:
  /// Takes all kinds of the crowd.
  void take_kinds(const std::vector<CrowdKind>& kinds, const CrowdOptions& options);
  /// No kind has wheels.
  bool empty() const { return !has_some_; }
  bool has(std::size_t kind) const { return has_some_ && limits_[kind].ahead > 0.0; }

  /// Whether the robot may drive the motion; true where the kind has no wheels.
  bool allow(std::size_t kind, std::int32_t id, Motion m) const {
    return !has(kind) || m == Motion{} || is_driven(limits_[kind], state(id), m);
  }
  /// The same for motions of at most kPack robots from the `first` on: bit `lane`.
  std::uint32_t allow(const Robots& robots, std::size_t first, std::size_t count, const std::int32_t* mx,
                      const std::int32_t* my) const;
  /// Drives the next motions of robots. REQUIRES: they are allowed; no two threads drive one robot.
  void drive(const Robots& robots, std::size_t first, std::size_t last);
  /// Half-planes (m/s) of what the robot may wish, at most kMostWheelRows; how many.
  std::size_t rows(std::size_t kind, std::int32_t id, geometry::HalfPlane* out) const;

  /// The edges of the set of velocities (m/s) in the frame of the heading; as `rows` has them.
  const std::vector<geometry::HalfPlane>& polygon(std::size_t kind) const { return polygons_[kind]; }
  std::size_t most_rows() const { return most_rows_; }

  const WheelState& state(std::int32_t id) const { return states_[static_cast<std::size_t>(id)]; }
  /// Fetches the states of robots, which will be looked at soon: they stand by id, anywhere in memory.
  void fetch(const Robots& robots, std::size_t first, std::size_t last) const {
    for (std::size_t i = first; has_some_ && i < std::min(last, robots.size()); ++i) {
      const auto at = reinterpret_cast<std::uintptr_t>(states_.data()) +
                      static_cast<std::size_t>(robots.id[i]) * sizeof(WheelState);
      __builtin_prefetch(reinterpret_cast<const void*>(at));
      __builtin_prefetch(reinterpret_cast<const void*>(at + sizeof(WheelState) - 1));
    }
  }
  /// At rest. Makes room for all ids up to this one.
  void put(std::int32_t id, Vec2 half_heading);
  const std::vector<WheelState>& states() const { return states_; }
  /// False, and no change, where one is none that a robot can have.
  bool set_states(std::vector<WheelState> states);
  std::size_t bytes() const { return states_.capacity() * sizeof(WheelState); }

 private:
  static bool is_driven(const WheelLimits& limits, const WheelState& from, Motion m);
  void put_lanes(const Robots& robots, std::size_t first, std::size_t count, const std::int32_t* mx,
                 const std::int32_t* my, TwistLanes& lanes) const;

  bool has_some_ = false;
  std::size_t most_rows_ = 0;                               ///< of any kind
  std::vector<WheelLimits> limits_;                         ///< by kind
  std::vector<std::vector<geometry::HalfPlane>> polygons_;  ///< m/s, by kind, in the frame of the heading
  std::vector<WheelState> states_;                          ///< by id
};

}  // namespace exactvo::formation::crowd
