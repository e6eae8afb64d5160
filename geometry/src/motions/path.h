// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The motion of one body as seen from another, over a window of time, as one polynomial over any ring of numbers.
///
/// Nothing is divided: where a motion has a divisor (its duration, the factorial of a B-spline), the whole path is
/// scaled by it. Paths begin at an origin, a double, which is left out of the polynomial: far from (0, 0) the filter
/// would otherwise lose what the difference of two origins keeps.

#include <vector>

#include "exactvo/geometry/motions.h"
#include "motions/known_sign.h"

namespace exactvo::geometry::motions {

/// A closed span of time, s.
struct Window {
  double from, to;
};

/// The times that both have; from > to where there are none.
Window common_window(const Motion& a, const Motion* b);

/// The point from which a motion is measured.
Vec2 origin_of(const Motion& motion);

/// How often control point j of a uniform B-spline counts in its piece: degree! times the weight, as coefficients of
/// powers of u in [0, 1].
std::vector<std::vector<double>> b_spline_weights(std::size_t degree);

/// scale * (p(s) - origin) = sum of c[k] s^k, with s from 0 to 1 over the window; scale > 0.
template <class T>
struct Path {
  std::vector<Vector<T>> c;
  T scale{1.0};
};

/// c(x + by).
template <class T>
void shift(std::vector<Vector<T>>& c, const T& by) {
  for (std::size_t i = 0; i + 1 < c.size(); ++i)
    for (std::size_t k = c.size() - 1; k-- > i;) c[k] = c[k] + by * c[k + 1];
}

/// c(by * x).
template <class T>
void stretch(std::vector<Vector<T>>& c, const T& by) {
  T factor = by;
  for (std::size_t k = 1; k < c.size(); ++k) {
    c[k] = factor * c[k];
    factor = factor * by;
  }
}

template <class T>
Path<T> path_of(const StraightMotion& m, Window w) {
  const Vector<T> way = detail::difference<T>(m.to.at, m.from.at);
  if (w.from == m.from.time && w.to == m.to.time) return {{Vector<T>{T(0.0), T(0.0)}, way}, T(1.0)};
  const T before = T(w.from) - T(m.from.time), passed = T(w.to) - T(w.from);
  return {{before * way, passed * way}, T(m.to.time) - T(m.from.time)};
}

template <class T>
Path<T> path_of_powers(const CurvedMotion& m, Window w) {
  Path<T> path;
  path.c.push_back({T(0.0), T(0.0)});
  for (std::size_t k = 1; k < m.points.size(); ++k) path.c.push_back(detail::make<T>(m.points[k]));
  if (w.from != m.start) shift(path.c, T(T(w.from) - T(m.start)));
  stretch(path.c, T(T(w.to) - T(w.from)));
  return path;
}

/// The coefficients of powers of u in [0, 1] over the whole motion, less its origin.
template <class T>
Path<T> unit_path(const CurvedMotion& m) {
  Path<T> path;
  const std::size_t degree = m.points.size() - 1;
  std::vector<Vector<T>> from_origin;
  for (const Vec2 p : m.points) from_origin.push_back(detail::difference<T>(p, m.points.front()));
  if (m.basis == CurveBasis::bezier) {
    double choose = 1.0;  // binomial(degree, k)
    for (std::size_t k = 0; k <= degree; ++k) {
      path.c.push_back(T(choose) * from_origin.front());
      for (std::size_t i = 0; i + 1 < from_origin.size(); ++i) from_origin[i] = from_origin[i + 1] - from_origin[i];
      from_origin.pop_back();
      choose = choose * static_cast<double>(degree - k) / static_cast<double>(k + 1);
    }
    return path;
  }
  const std::vector<std::vector<double>> weights = b_spline_weights(degree);
  path.c.assign(degree + 1, {T(0.0), T(0.0)});
  double factorial = 1.0;
  for (std::size_t k = 0; k <= degree; ++k) {
    for (std::size_t j = 1; j <= degree; ++j) path.c[k] = path.c[k] + T(weights[j][k]) * from_origin[j];
    if (k > 1) factorial *= static_cast<double>(k);
  }
  path.scale = T(factorial);
  return path;
}

template <class T>
Path<T> path_of(const CurvedMotion& m, Window w) {
  if (m.basis == CurveBasis::powers) return path_of_powers<T>(m, w);
  Path<T> path = unit_path<T>(m);
  if (w.from == m.start && w.to == m.end) return path;
  // u = (before + s passed) / duration; all is scaled by duration^degree.
  const T duration = T(m.end) - T(m.start);
  T factor(1.0);
  for (std::size_t k = path.c.size(); k-- > 0;) {
    path.c[k] = factor * path.c[k];
    if (k > 0) factor = factor * duration;
  }
  path.scale = path.scale * factor;
  shift(path.c, T(T(w.from) - T(m.start)));
  stretch(path.c, T(T(w.to) - T(w.from)));
  return path;
}

/// REQUIRES: the window lies within the motion.
template <class T>
Path<T> path_of(const Motion& m, Window w) {
  return std::visit([&](const auto& motion) { return path_of<T>(motion, w); }, m);
}

/// a as seen from b: the difference, over both scales. `b` may be none, which is at rest.
template <class T>
Path<T> relative_path(const Motion& a, const Motion* b, Window w) {
  Path<T> path = path_of<T>(a, w);
  if (!b) return path;
  const Path<T> other = path_of<T>(*b, w);
  const bool scaled = sign_of(T(other.scale - T(1.0))) != Known::zero || sign_of(T(path.scale - T(1.0))) != Known::zero;
  path.c.resize(std::max(path.c.size(), other.c.size()), {T(0.0), T(0.0)});
  for (std::size_t k = 0; k < path.c.size(); ++k) {
    if (scaled) path.c[k] = other.scale * path.c[k];
    if (k < other.c.size()) path.c[k] = path.c[k] - (scaled ? path.scale * other.c[k] : other.c[k]);
  }
  if (scaled) path.scale = path.scale * other.scale;
  return path;
}

/// The Bernstein control points of the path, in place: p stays within their hull. Scales the path by what makes all
/// weights whole numbers.
template <class T>
void to_control_points(Path<T>& path) {
  const std::size_t d = path.c.size() - 1;
  if (d == 0) return;
  if (d == 1) {
    path.c[1] = path.c[0] + path.c[1];
    return;
  }
  // b_i = sum over k <= i of binomial(i, k) / binomial(d, k) c_k; the product of the numerators of 1 / binomial(d, k)
  // is d!, as binomial(i, k) / binomial(d, k) = i (i-1) ... (i-k+1) / (d (d-1) ... (d-k+1)).
  double factorial = 1.0;
  for (std::size_t k = 2; k <= d; ++k) factorial *= static_cast<double>(k);
  std::vector<Vector<T>> b(d + 1, {T(0.0), T(0.0)});
  for (std::size_t i = 0; i <= d; ++i) {
    double weight = factorial;  // d! i ... (i-k+1) / (d ... (d-k+1)), a whole number below 2^53 for d <= 10
    for (std::size_t k = 0; k <= i; ++k) {
      b[i] = b[i] + T(weight) * path.c[k];
      if (k < i) weight = weight * static_cast<double>(i - k) / static_cast<double>(d - k);
    }
  }
  path.c = std::move(b);
  path.scale = T(factorial) * path.scale;
}

}  // namespace exactvo::geometry::motions
