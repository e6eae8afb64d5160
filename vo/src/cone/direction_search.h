// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The local minima over |n| = 1 of f(n) = h_S(n) - n.y: the outward normals of S at the points nearest to y. Rounded.

#include <array>
#include <cmath>
#include <cstddef>

#include "exactvo/geometry/support.h"

namespace exactvo::vo::detail {

using geometry::GrownShape;
using geometry::Vec2;

/// The candidates that can be the best under h_S(n) <= 0: a disc has one, an ellipse at most two, a segment its
/// nearest and both sides, a polygon its nearest and the shallowest edge that faces the robot.
struct Normals {
  std::array<Vec2, 3> n{};
  std::size_t count = 0;
  void add(Vec2 normal) { n[count++] = normal; }
};

inline constexpr Vec2 kAnyDirection{1.0, 0.0};  // where every direction is as good: the same on every machine

/// `geometry::normalized` in the same bits: along an axis the length is exact.
inline Vec2 unit(Vec2 v) {
  const double length = v.x == 0.0 || v.y == 0.0 ? std::fabs(v.x) + std::fabs(v.y) : std::hypot(v.x, v.y);
  return length > 0.0 ? v / length : Vec2{};
}

/// The unit normal on the left of a segment.
inline Vec2 side_of(Vec2 a, Vec2 b) {
  return a == b ? kAnyDirection : unit(geometry::perp(b - a));
}

/// The axis-aligned frame of an ellipse: L = R diag(a, b) V, columns of R the axes.
struct EllipseFrame {
  double a, b;  ///< m, the half-axes
  Vec2 major, minor;
};

/// Those of an ellipse, the second looked for when it is asked for: with y outside, it is seldom needed.
///
/// In the ellipse's frame with y = (qx, qy), both >= 0, the first normal is that of the least f, and the second one
/// (nx, -ny), nx and ny >= 0 however it was rounded. By symmetry f(nx, -ny) = f(nx, ny) + 2 ny qy >= f(first) + 2 ny
/// qy.
class EllipseNormals {
 public:
  EllipseNormals(const geometry::Ellipse& e, Vec2 centre, Vec2 y);

  const Normals& first() const { return first_; }
  /// `first` with the second where there is one.
  Normals all() const;

 private:
  /// From the folded frame.
  Vec2 unfolded(Vec2 n, double sign_y) const { return (n.x * sign_x_) * frame_.major + (n.y * sign_y) * frame_.minor; }
  /// The normal, of length 1, at the foot of parameter s.
  Vec2 normal_at(double s) const;

  EllipseFrame frame_;
  double sign_x_ = 1.0, sign_y_ = 1.0;
  double r0_ = 0.0, z1_ = 0.0, n0_ = 0.0;
  Normals first_;
  bool may_have_second_ = false;
};

/// REQUIRES: nothing; degenerate positions (a centre, a vertex) give some unit normal, the same one on every machine.
Normals nearest_normals(const GrownShape& s, Vec2 y);

}  // namespace exactvo::vo::detail
