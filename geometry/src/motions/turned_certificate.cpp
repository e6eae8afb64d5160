// SPDX-License-Identifier: GPL-3.0-or-later
// Makes certificates of turning bodies. Nothing here has to be right: `proves_clear` decides.
#include <algorithm>
#include <cmath>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/turning_motions.h"

namespace exactvo::geometry {
namespace turned {
namespace {

/// How often a piece of time is halved before the proof is given up.
constexpr int kMostHalvingsOfTurn = 40;
/// rad: `proves_clear` takes no more.
constexpr double kMostTurned = 64.0;

Vec2 nearest_on_edge(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 e = b - a;
  const double length2 = squared_norm(e);
  return a + (length2 > 0.0 ? std::clamp(dot(p - a, e) / length2, 0.0, 1.0) : 0.0) * e;
}

/// From the edge to the hull of the corners, between the points of both that are nearest.
Vec2 direction_from(const Segment& edge, const std::vector<Vec2>& corners) {
  Vec2 best;
  double least = kInfinity;
  const auto take = [&](Vec2 between) {
    if (squared_norm(between) > 0.0 && squared_norm(between) < least) {
      least = squared_norm(between);
      best = between;
    }
  };
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
    take(a - nearest_on_edge(a, edge.a, edge.b));
    take(nearest_on_edge(edge.a, a, b) - edge.a);
    take(nearest_on_edge(edge.b, a, b) - edge.b);
  }
  return normalized(best);
}

class TurnProver {
 public:
  TurnProver(const TurningMotion& m, std::vector<Separation>& separations) : m_(m), separations_(separations) {}

  bool prove(std::size_t part, std::size_t other, const RoundedPolygon& body, const Segment& edge, double from,
             double to, int halvings = 0) {
    const double middle = from + 0.5 * (to - from);
    const Segment seen{edge.a - m_.at, edge.b - m_.at};
    const Vec2 n = direction_from(seen, corners_at(body, middle));
    const double margin = n == Vec2{} ? -1.0 : margin_along(n, body, seen, from, to);
    if (margin > 0.0) {
      separations_.push_back({part, other, from, to, n, margin});
      return true;
    }
    if (halvings == kMostHalvingsOfTurn || !(from < middle && middle < to)) return false;
    return prove(part, other, body, edge, from, middle, halvings + 1) &&
           prove(part, other, body, edge, middle, to, halvings + 1);
  }

 private:
  std::vector<Vec2> corners_at(const RoundedPolygon& body, double time) const {
    const Displacement d = displacement_after(m_.twist, time - m_.start);
    std::vector<Vec2> corners;
    for (const Vec2 c : body.corners) corners.push_back(d.moved(c));
    return corners;
  }

  /// A margin that is likely to hold; not above 0 where there is none.
  double margin_along(Vec2 n, const RoundedPolygon& body, const Segment& edge, double from, double to) const {
    double least = kInfinity, size = norm(edge.a) + norm(edge.b);
    for (const double time : {from, to})
      for (const Vec2 c : corners_at(body, time)) {
        least = std::min(least, dot(n, c));
        size = std::max(size, norm(c));
      }
    double stray = 0.0;
    for (const Vec2 c : body.corners) stray = std::max(stray, stray_of(m_.twist, c, to - from));
    const double margin = least - stray - std::max(dot(n, edge.a), dot(n, edge.b)) - body.radius;
    return margin * (1.0 - 0x1p-40) - 0x1p-44 * size;
  }

  const TurningMotion& m_;
  std::vector<Separation>& separations_;
};

}  // namespace
}  // namespace turned

std::optional<MotionCertificate> certify(const TurningMotion& motion, const RigidBody& body, const Obstacle& obstacle) {
  // Just below, since the product is rounded.
  const double angle = std::fabs(motion.twist.turn) * (motion.end - motion.start);
  if (angle > turned::kMostTurned * (1.0 - 0x1p-50)) return std::nullopt;
  if (encounter(motion, body, obstacle) != Encounter::clear) return std::nullopt;
  const std::vector<Segment> edges = edges_of(obstacle);
  MotionCertificate certificate;
  turned::TurnProver prover(motion, certificate.separations);
  for (std::size_t part = 0; part < body.size(); ++part)
    for (std::size_t k = 0; k < edges.size(); ++k)
      if (!prover.prove(part, k, body[part], edges[k], motion.start, motion.end)) return std::nullopt;
  return certificate;
}

}  // namespace exactvo::geometry
