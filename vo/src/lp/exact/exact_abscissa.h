// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Positions along a line in exact arithmetic. Point s of the line n.v = c is (c n + s d) / |n|^2 with d = perp(n):
///
///        d ^      s < 0 | s > 0         every cut with another line is rational in s,
///          |   ---------+---------->    the ends at the disc are +-sqrt(radius^2 |n|^2 - c^2)
///

#include "lp/proof/exact_points.h"

namespace exactvo::lp {

/// (rational + root sqrt(D)) / den, den > 0, D that of the carrier; or an end of the line (infinite = -1, +1).
struct Abscissa {
  Exact rational = 0;
  int root = 0;
  Exact den = 1;
  int infinite = 0;
};

/// A line, and what is needed of it time and again.
struct Carrier {
  ExactLine line;
  ExactVector direction;
  Exact squared_length;
  bool has_disc = false;
  Exact discriminant = 0;  ///< D = radius^2 |n|^2 - c^2: negative where the line misses the disc
};

inline Carrier carrier_of(const ExactLine& line, bool has_disc, const Exact& radius) {
  Carrier c{line, perp(line.normal), dot(line.normal, line.normal), has_disc, 0};
  if (has_disc) c.discriminant = radius * radius * c.squared_length - line.offset * line.offset;
  return c;
}

inline int compare(const Carrier& c, const Abscissa& a, const Abscissa& b) {
  if (a.infinite != 0 || b.infinite != 0) return (a.infinite > b.infinite) - (a.infinite < b.infinite);
  const Exact alpha = a.rational * b.den - b.rational * a.den;
  return sign_of_root(alpha, Exact(a.root) * b.den - Exact(b.root) * a.den, c.discriminant);
}

/// The sign of (a + b) / 2 - middle; `middle` rational with denominator 1.
inline int compare_mean(const Carrier& c, const Abscissa& a, const Abscissa& b, const Abscissa& middle) {
  const Exact alpha = a.rational * b.den + b.rational * a.den - Exact(2) * middle.rational * a.den * b.den;
  return sign_of_root(alpha, Exact(a.root) * b.den + Exact(b.root) * a.den, c.discriminant);
}

inline Abscissa foot(const Carrier& c, Vec2 p) {
  Abscissa s;
  s.rational = dot(exact(p), c.direction);
  return s;
}

inline Abscissa disc_end(int side) {
  Abscissa s;
  s.root = side;
  return s;
}

inline Abscissa end(int side) {
  Abscissa s;
  s.infinite = side;
  return s;
}

/// Which way `other` allows from its cut: +1 above, -1 below, 0 for a parallel.
inline int allowed_side(const Carrier& c, const ExactLine& other) {
  return sign_of(dot(other.normal, c.direction));
}

/// By how much the foot of the origin violates `other`, times |n|^2.
inline Exact missing(const Carrier& c, const ExactLine& other) {
  return other.offset * c.squared_length - dot(other.normal, c.line.normal) * c.line.offset;
}

/// Where the boundary of `other` cuts the carrier. REQUIRES: not parallel.
inline Abscissa cut(const Carrier& c, const ExactLine& other) {
  Abscissa s;
  s.rational = missing(c, other);
  s.den = dot(other.normal, c.direction);
  if (sign_of(s.den) < 0) s.rational = -s.rational, s.den = -s.den;
  return s;
}

inline ExactPoint point_at(const Carrier& c, const Abscissa& s) {
  const Exact scaled = c.line.offset * s.den;
  const Exact root(s.root);
  return {c.line.normal.x * scaled + s.rational * c.direction.x,
          root * c.direction.x,
          c.line.normal.y * scaled + s.rational * c.direction.y,
          root * c.direction.y,
          c.squared_length * s.den,
          s.root == 0 ? Exact(0) : c.discriminant};
}

/// The height of a soft line over an abscissa, (rational + root sqrt(D)) / den: its violation there.
struct Height {
  Exact rational, root, den;
};

inline Height height_at(const Carrier& c, const ExactLine& soft, const Abscissa& s) {
  const Exact slope = dot(soft.normal, c.direction);
  return {missing(c, soft) * s.den - s.rational * slope, -(Exact(s.root) * slope), c.squared_length * s.den};
}

inline int compare(const Carrier& c, const Height& a, const Height& b) {
  return sign_of_root(a.rational * b.den - b.rational * a.den, a.root * b.den - b.root * a.den, c.discriminant);
}

}  // namespace exactvo::lp
