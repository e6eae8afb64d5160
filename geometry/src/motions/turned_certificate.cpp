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
/// For each pair of parts. Two that touch have no proof, however long it is.
constexpr std::size_t kMostSeparations = std::size_t{1} << 16;
/// rad: `proves_clear` takes no more.
constexpr double kMostTurned = 64.0;

/// From one hull to the other, between the points of both that are nearest.
Vec2 direction_between(const std::vector<Vec2>& from, const std::vector<Vec2>& to) {
  Vec2 best;
  double least = kInfinity;
  const auto take = [&](Vec2 between) {
    if (squared_norm(between) > 0.0 && squared_norm(between) < least) {
      least = squared_norm(between);
      best = between;
    }
  };
  for (std::size_t i = 0; i < to.size(); ++i)
    for (std::size_t k = 0; k < from.size(); ++k) {
      take(to[i] - nearest_on(from[k], from[(k + 1) % from.size()], to[i]));
      take(nearest_on(to[i], to[(i + 1) % to.size()], from[k]) - from[k]);
    }
  return normalized(best);
}

/// A convex part on its way, seen from where another motion begins.
struct Drive {
  const TurningMotion& motion;
  const RoundedPolygon& part;
  Vec2 at;  ///< of the reference point at the start

  std::vector<Vec2> corners_at(double time) const {
    const Displacement d = displacement_after(motion.twist, time - motion.start);
    std::vector<Vec2> corners;
    for (const Vec2 c : part.corners) corners.push_back(at + d.moved(c));
    return corners;
  }
  double stray(double time) const {
    double most = 0.0;
    for (const Vec2 c : part.corners) most = std::max(most, stray_of(motion.twist, c, time));
    return most;
  }
};

class TurnProver {
 public:
  explicit TurnProver(std::vector<Separation>& separations) : separations_(separations) {}

  bool prove(std::size_t part, std::size_t other, const Drive& a, const Drive& b, double from, double to) {
    most_ = separations_.size() + kMostSeparations;
    return prove(part, other, a, b, from, to, 0);
  }

 private:
  bool prove(std::size_t part, std::size_t other, const Drive& a, const Drive& b, double from, double to,
             int halvings) {
    const double middle = from + 0.5 * (to - from);
    const Vec2 n = direction_between(b.corners_at(middle), a.corners_at(middle));
    const double margin = n == Vec2{} ? -1.0 : margin_along(n, a, b, from, to);
    if (margin > 0.0) {
      separations_.push_back({part, other, from, to, n, margin});
      return true;
    }
    if (halvings == kMostHalvingsOfTurn || separations_.size() > most_ || !(from < middle && middle < to)) return false;
    return prove(part, other, a, b, from, middle, halvings + 1) && prove(part, other, a, b, middle, to, halvings + 1);
  }

 private:
  /// A margin that is likely to hold; not above 0 where there is none.
  static double margin_along(Vec2 n, const Drive& a, const Drive& b, double from, double to) {
    double least = kInfinity, size = 0.0;
    for (const double time : {from, to}) {
      double lowest = kInfinity, highest = -kInfinity;
      for (const Vec2 c : a.corners_at(time)) {
        lowest = std::min(lowest, dot(n, c));
        size = std::max(size, norm(c));
      }
      for (const Vec2 c : b.corners_at(time)) {
        highest = std::max(highest, dot(n, c));
        size = std::max(size, norm(c));
      }
      least = std::min(least, lowest - highest);
    }
    const double margin = least - a.stray(to - from) - b.stray(to - from) - a.part.radius - b.part.radius;
    return margin * (1.0 - 0x1p-40) - 0x1p-44 * size;
  }

  std::vector<Separation>& separations_;
  std::size_t most_ = 0;
};

/// Just below, since the product is rounded.
bool turns_little(const TurningMotion& m) {
  return std::fabs(m.twist.turn) * (m.end - m.start) <= kMostTurned * (1.0 - 0x1p-50);
}

}  // namespace
}  // namespace turned

std::optional<MotionCertificate> certify(const TurningMotion& motion, const RigidBody& body, const Obstacle& obstacle) {
  using turned::Drive;
  if (!turned::turns_little(motion) || encounter(motion, body, obstacle) != Encounter::clear) return std::nullopt;
  const std::vector<Segment> edges = edges_of(obstacle);
  const TurningMotion rest{motion.start, motion.end, {}, {}};
  MotionCertificate certificate;
  turned::TurnProver prover(certificate.separations);
  for (std::size_t part = 0; part < body.size(); ++part)
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const RoundedPolygon edge{{edges[k].a, edges[k].b}, 0.0};
      if (!prover.prove(part, k, {motion, body[part], {}}, {rest, edge, -motion.at}, motion.start, motion.end))
        return std::nullopt;
    }
  return certificate;
}

std::optional<MotionCertificate> certify(const TurningMotion& a, const RigidBody& body_a, const TurningMotion& b,
                                         const RigidBody& body_b) {
  if (!turned::turns_little(a) || !turned::turns_little(b)) return std::nullopt;
  const double from = std::max(a.start, b.start), to = std::min(a.end, b.end);
  MotionCertificate certificate;
  turned::TurnProver prover(certificate.separations);
  for (std::size_t part = 0; part < body_a.size(); ++part)
    for (std::size_t k = 0; k < body_b.size() && from <= to; ++k)
      if (!prover.prove(part, k, {a, body_a[part], {}}, {b, body_b[k], b.at - a.at}, from, to)) return std::nullopt;
  return certificate;
}

}  // namespace exactvo::geometry
