// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Vectors of the plane over a type of exact numbers. Internal.

namespace exactvo::vo::detail {

template <typename N>
struct VectorOver {
  N x, y;

  friend VectorOver operator+(const VectorOver& a, const VectorOver& b) { return {a.x + b.x, a.y + b.y}; }
  friend VectorOver operator-(const VectorOver& a, const VectorOver& b) { return {a.x - b.x, a.y - b.y}; }
  friend VectorOver operator*(const N& s, const VectorOver& a) { return {s * a.x, s * a.y}; }
  friend N dot(const VectorOver& a, const VectorOver& b) { return a.x * b.x + a.y * b.y; }
  friend N cross(const VectorOver& a, const VectorOver& b) { return a.x * b.y - a.y * b.x; }
  friend VectorOver perp(const VectorOver& a) { return {-a.y, a.x}; }
};

}  // namespace exactvo::vo::detail
