// SPDX-License-Identifier: GPL-3.0-or-later
// Makes certificates. Nothing here has to be right: motion_certificate.h's `proves_clear` decides.
#include <algorithm>
#include <cmath>

#include "exactvo/geometry/motion_certificate.h"
#include "motions/question.h"

namespace exactvo::geometry {
namespace motions {
namespace {

/// How often a piece of time is halved before the proof is given up.
constexpr int kMostHalvingsOfProof = 40;

/// A direction in which a way is likely to be apart from a hull: between the points of both that are nearest.
struct Directed {
  Vec2 direction;
  double distance2 = -1.0;
  void take(Vec2 between) {
    const double d2 = squared_norm(between);
    if (d2 > 0.0 && (distance2 < 0.0 || d2 < distance2)) *this = {between, d2};
  }
};

Vec2 direction_between(const std::vector<Vec2>& way, const std::vector<Vec2>& hull) {
  Directed best;
  const Vec2 from = way.front(), to = way.back();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 a = hull[i], b = hull[(i + 1) % hull.size()];
    best.take(nearest_on(from, to, a) - a);
    best.take(from - nearest_on(a, b, from));
    best.take(to - nearest_on(a, b, to));
  }
  return normalized(best.direction);
}

Vec2 rounded(const Vector<RunningError>& v, double scale) {
  return {v.x.value / scale, v.y.value / scale};
}

class Prover {
 public:
  explicit Prover(const Question& q) : q_(q) {}

  /// Separations of one target over a window; false where one piece cannot be proven.
  bool prove(std::size_t part, std::size_t other, const Target& target, Window w, int halvings = 0) {
    Path<RunningError> path = relative_path<RunningError>(q_.motion(), q_.other(), w);
    to_control_points(path);
    const auto hull = hull_over<RunningError>(target, origin_of(q_.motion()), q_.other_origin(), path.scale, 0.0);
    std::vector<Vec2> way, corners;
    for (const auto& p : path.c) way.push_back(rounded(p, path.scale.value));
    for (const auto& v : hull.vertices) corners.push_back(rounded(v, path.scale.value));
    const Vec2 n = direction_between(way, corners);
    const double margin = margin_along(n, path, hull);
    if (margin >= 0.0) {
      separations_.push_back({part, other, w.from, w.to, n, margin});
      return true;
    }
    const double middle = w.from + 0.5 * (w.to - w.from);
    if (halvings == kMostHalvingsOfProof || !(w.from < middle && middle < w.to)) return false;
    return prove(part, other, target, {w.from, middle}, halvings + 1) &&
           prove(part, other, target, {middle, w.to}, halvings + 1);
  }

  std::vector<Separation> taken() { return std::move(separations_); }

 private:
  /// A margin that is certainly kept; negative where there is none.
  static double margin_along(Vec2 n, const Path<RunningError>& path, const GrownHull<RunningError>& hull) {
    const Vector<RunningError> direction = detail::make<RunningError>(n);
    double least = INFINITY;
    for (const auto& p : path.c)
      for (const auto& v : hull.vertices) {
        const RunningError gap = dot(direction, p - v);
        least = std::min(least, gap.value - 2.0 * gap.error);
      }
    constexpr double kRounding = 1.0 + 0x1p-40;  // of the length of n, which is 1 up to rounding, and of what follows
    const double scale = path.scale.value;
    const double margin = (least - (hull.reach.value + 2.0 * hull.reach.error) * kRounding) / scale;
    return margin > 0.0 && std::isfinite(margin) ? margin * (1.0 - 0x1p-40) : -1.0;
  }

  const Question& q_;
  std::vector<Separation> separations_;
};

std::optional<MotionCertificate> certified(const Question& q, std::size_t others) {
  const Window w = q.window();
  if (w.from > w.to) return MotionCertificate{};
  if (q.decide(w) != Encounter::clear) return std::nullopt;
  Prover prover(q);
  for (std::size_t i = 0; i < q.targets().size(); ++i)
    if (!prover.prove(i / others, i % others, q.targets()[i], w)) return std::nullopt;
  return MotionCertificate{prover.taken()};
}

}  // namespace
}  // namespace motions

std::optional<MotionCertificate> certify(const Motion& a, const RigidBody& body_a, const Motion& b,
                                         const RigidBody& body_b) {
  return motions::certified(motions::Question(a, body_a, b, body_b), body_b.size());
}

std::optional<MotionCertificate> certify(const Motion& a, const RigidBody& body_a, const Obstacle& obstacle) {
  return motions::certified(motions::Question(a, body_a, obstacle), edges_of(obstacle).size());
}

}  // namespace exactvo::geometry
