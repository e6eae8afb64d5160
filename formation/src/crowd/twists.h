// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The twists that motions ask of wheels (wheels.h), a robot a SIMD lane: whether its wheels may drive one, and where
/// it heads then. No call of a library and nothing fused: the same bits on every target, for one robot as for sixteen.

#include "crowd/layout.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::formation::crowd {

/// Radians of the heading that may be unknown (2), and the share of limits that is not used, for it and for rounding.
inline constexpr double kMostDoubt = 0x1p-24, kSpare = 1.0 - 0x1p-16;

/// A robot on wheels between two steps.
struct WheelState {
  double a = 1.0, b = 0.0;         ///< half-heading, up to a positive factor
  geometry::Vec2 ahead{1.0, 0.0};  ///< the heading, a unit vector, rounded
  double doubt = 0.0;              ///< radians, by how much its heading may differ from the exact one at most
  double left = 0.0, right = 0.0;  ///< ways of the wheels in the last step, lattice steps
};

/// Lattice steps, those of wheels less what (3) asks for.
struct WheelLimits {
  double ahead = 0.0;   ///< K, exact; 0: no wheels
  double across = 0.0;  ///< b, exact
  double most = 0.0, change = 0.0, turn = 0.0;
  double back = 0.0;  ///< of both wheels together, no less: negative
};

/// Robots on wheels and motions that they may drive, those of a lane at its place. Lanes without a robot on wheels stay
/// as they are here.
struct TwistLanes {
  alignas(64) double state[7][kPack];   ///< members of WheelState
  alignas(64) double limits[6][kPack];  ///< members of WheelLimits
  alignas(64) double mx[kPack], my[kPack];

  void put(std::size_t lane, const WheelLimits& l, const WheelState& s, double x, double y) {
    const double its[] = {s.a, s.b, s.ahead.x, s.ahead.y, s.doubt, s.left, s.right};
    const double of_kind[] = {l.ahead, l.across, l.most, l.change, l.turn, l.back};
    for (std::size_t k = 0; k < 7; ++k) state[k][lane] = its[k];
    for (std::size_t k = 0; k < 6; ++k) limits[k][lane] = of_kind[k];
    mx[lane] = x;
    my[lane] = y;
  }
  WheelState taken(std::size_t lane) const {
    const auto of = [&](int k) { return state[k][lane]; };
    return {of(0), of(1), {of(2), of(3)}, of(4), of(5), of(6)};
  }
};

/// Bit `lane`, of the first lanes: its wheels may drive the motion, which is not 0.
std::uint32_t drivable(const TwistLanes& lanes, std::size_t count);

/// Drives the motions of the first lanes. REQUIRES: they are drivable.
void drive(TwistLanes& lanes, std::size_t count);

/// The heading of a half-heading, of unit length.
geometry::Vec2 ahead_of(double a, double b);

/// atan(t) / t for t^2 = s <= 1/3, up to 2^-25 of it.
double arc_of(double s);

/// Half-planes of the polygons of wheels, of their kinds, in the frames of their headings.
struct PolygonQuery {
  std::size_t rows = 0, kinds = 0;
  const double *x = nullptr, *y = nullptr, *c = nullptr;  ///< of row k and a kind: at [k * kinds + kind]
  const double *ahead_x = nullptr, *ahead_y = nullptr;    ///< by lane
  const std::int32_t* kind = nullptr;                     ///< by lane; not read where there is one kind
};

/// As rows of kPack robots: turned to their headings.
void put_polygons(const PolygonQuery& query, const LineRows<float>& out);
void put_polygons(const PolygonQuery& query, const LineRows<double>& out);

}  // namespace exactvo::formation::crowd
