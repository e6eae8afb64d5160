// SPDX-License-Identifier: GPL-3.0-or-later
#include "textbook.h"

#include <cmath>

namespace exactvo::bench {
namespace {

constexpr float kParallel = 1e-5F;

struct Vector {
  float x, y;
};

inline float dot(Vector a, Vector b) {
  return a.x * b.x + a.y * b.y;
}
inline float det(Vector a, Vector b) {
  return a.x * b.y - a.y * b.x;
}
inline Vector point(const TextbookLine& l) {
  return {l.point_x, l.point_y};
}
inline Vector direction(const TextbookLine& l) {
  return {l.direction_x, l.direction_y};
}
inline Vector minus(Vector a, Vector b) {
  return {a.x - b.x, a.y - b.y};
}

/// Positive where v lies right of the line: outside.
inline float outside(const TextbookLine& l, Vector v) {
  return det(direction(l), minus(point(l), v));
}

/// The optimum on line `k` inside lines 0 .. k - 1 and the disc.
inline bool on_line(const TextbookLine* lines, int k, float speed, Vector wish, bool along_wish, Vector& v) {
  const Vector p = point(lines[k]), d = direction(lines[k]);
  const float pd = dot(p, d);
  const float discriminant = pd * pd + speed * speed - dot(p, p);
  if (discriminant < 0.0F) return false;
  const float root = std::sqrt(discriminant);
  float low = -pd - root, high = -pd + root;
  for (int i = 0; i < k; ++i) {
    const float denominator = det(d, direction(lines[i]));
    const float numerator = det(direction(lines[i]), minus(p, point(lines[i])));
    if (std::fabs(denominator) <= kParallel) {
      if (numerator < 0.0F) return false;
      continue;
    }
    const float t = numerator / denominator;
    if (denominator >= 0.0F)
      high = t < high ? t : high;
    else
      low = t > low ? t : low;
    if (low > high) return false;
  }
  float t = 0.0F;
  if (along_wish) {
    t = dot(wish, d) > 0.0F ? high : low;
  } else {
    t = dot(d, minus(wish, p));
    t = t < low ? low : (t > high ? high : t);
  }
  v = {p.x + t * d.x, p.y + t * d.y};
  return true;
}

/// The number of lines kept; less than `count` where the next one contradicts.
inline int incremental(const TextbookLine* lines, int count, float speed, Vector wish, bool along_wish, Vector& v) {
  if (along_wish) {
    v = {wish.x * speed, wish.y * speed};
  } else {
    const float squared = dot(wish, wish);
    const float scale = squared > speed * speed ? speed / std::sqrt(squared) : 1.0F;
    v = {wish.x * scale, wish.y * scale};
  }
  for (int k = 0; k < count; ++k) {
    if (outside(lines[k], v) <= 0.0F) continue;
    const Vector kept = v;
    if (on_line(lines, k, speed, wish, along_wish, v)) continue;
    v = kept;
    return k;
  }
  return count;
}

/// Line `i` as seen on the plane of equal violation with line `k`; false where both are the same.
inline bool equally_violated(const TextbookLine& k, const TextbookLine& i, TextbookLine& out) {
  const float determinant = det(direction(k), direction(i));
  if (std::fabs(determinant) <= kParallel) {
    if (dot(direction(k), direction(i)) > 0.0F) return false;
    out.point_x = 0.5F * (k.point_x + i.point_x);
    out.point_y = 0.5F * (k.point_y + i.point_y);
  } else {
    const float t = det(direction(i), minus(point(k), point(i))) / determinant;
    out.point_x = k.point_x + t * k.direction_x;
    out.point_y = k.point_y + t * k.direction_y;
  }
  const Vector d = minus(direction(i), direction(k));
  const float inverse = 1.0F / std::sqrt(dot(d, d));
  out.direction_x = d.x * inverse;
  out.direction_y = d.y * inverse;
  return true;
}

void relax(const TextbookLine* lines, int count, int hard, int first, float speed, Vector& v) {
  float level = 0.0F;
  TextbookLine projected[kMostTextbookLines];
  for (int k = 0; k < hard; ++k) projected[k] = lines[k];
  for (int k = first; k < count; ++k) {
    if (outside(lines[k], v) <= level) continue;
    int kept = hard;
    for (int i = hard; i < k; ++i) kept += equally_violated(lines[k], lines[i], projected[kept]);
    const Vector up = {-lines[k].direction_y, lines[k].direction_x};
    const Vector before = v;
    if (incremental(projected, kept, speed, up, true, v) < kept) v = before;
    level = outside(lines[k], v);
  }
}

}  // namespace

TextbookVelocity solve_textbook(const TextbookLine* lines, int count, int hard, float speed, float preferred_x,
                                float preferred_y) {
  Vector v{};
  const int kept = incremental(lines, count, speed, {preferred_x, preferred_y}, false, v);
  if (kept < count) relax(lines, count, hard, kept, speed, v);
  return {v.x, v.y, kept == count};
}

}  // namespace exactvo::bench
