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

#include "crowd/layout.h"
#include "crowd/pair_row.h"
#include "exactvo/formation/crowd.h"

namespace exactvo::formation::crowd {

/// Half-planes of the first level: two from the greatest speed ahead, chords of the disc about 0, the speed back.
inline constexpr std::size_t kChordsOfWheels = 5, kMostWheelRows = kChordsOfWheels + 3;

/// Radians of the heading that may be unknown (2), and the share of limits that is not used, for it and for rounding.
inline constexpr double kMostDoubt = 0x1p-24, kSpare = 1.0 - 0x1p-16;

/// A robot on wheels between two steps.
struct WheelState {
  double a = 1.0, b = 0.0;         ///< half-heading, up to a positive factor
  Vec2 ahead{1.0, 0.0};            ///< the heading, a unit vector, rounded
  double doubt = 0.0;              ///< radians, by how much its heading may differ from the exact one at most
  double left = 0.0, right = 0.0;  ///< ways of the wheels in the last step, lattice steps
};

class Wheels {
 public:
  /// Of all kinds that there are.
  void take_kinds(const std::vector<CrowdKind>& kinds, const CrowdOptions& options);
  /// No kind has wheels.
  bool empty() const { return !has_some_; }
  bool has(std::size_t kind) const { return has_some_ && limits_[kind].ahead > 0.0; }

  /// Whether the robot may drive the motion; true where the kind has no wheels.
  bool allow(std::size_t kind, std::int32_t id, Motion m) const {
    return !has(kind) || m == Motion{} || is_driven(limits_[kind], state(id), m);
  }
  /// Drives it. REQUIRES: it is allowed; no two threads drive one robot.
  void drive(std::size_t kind, std::int32_t id, Motion m);
  /// Half-planes (m/s) of what the robot may wish, at most kMostWheelRows; how many.
  std::size_t rows(std::size_t kind, std::int32_t id, geometry::HalfPlane* out) const;

  /// The edges of the set of velocities (m/s) in the frame of the heading; as `rows` has them.
  const std::vector<geometry::HalfPlane>& polygon(std::size_t kind) const { return limits_[kind].polygon; }
  std::size_t most_rows() const { return most_rows_; }

  const WheelState& state(std::int32_t id) const { return states_[static_cast<std::size_t>(id)]; }
  /// At rest. Makes room for all ids up to this one.
  void put(std::int32_t id, Vec2 half_heading);
  const std::vector<WheelState>& states() const { return states_; }
  /// False, and no change, where one is none that a robot can have.
  bool set_states(std::vector<WheelState> states);
  std::size_t bytes() const { return states_.capacity() * sizeof(WheelState); }

 private:
  /// Lattice steps, those of wheels less what (3) asks for.
  struct Limits {
    double ahead = 0.0;   ///< K, exact; 0: no wheels
    double across = 0.0;  ///< b, exact
    double most = 0.0, change = 0.0, turn = 0.0, back = 0.0, open = 0.0;
    std::vector<geometry::HalfPlane> polygon;  ///< m/s, in the frame of the heading
  };
  struct Twist;

  static Twist twist_of(const Limits& limits, const WheelState& from, Motion m);
  static bool is_driven(const Limits& limits, const WheelState& from, Motion m);

  bool has_some_ = false;
  std::size_t most_rows_ = 0;       ///< of any kind
  std::vector<Limits> limits_;      ///< by kind
  std::vector<WheelState> states_;  ///< by id
};

}  // namespace exactvo::formation::crowd
