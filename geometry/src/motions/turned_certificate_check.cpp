// SPDX-License-Identifier: GPL-3.0-or-later
// The check of certificates of turning bodies, in rationals. It shares nothing with what decides motions but the plain
// types.
#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "exactvo/geometry/turning_motions.h"
#include "motions/certificate_pairs.h"

namespace exactvo::geometry {
namespace turn_check {
namespace {

using Number = mpq_class;

/// Angles, rad: the series below need few terms.
constexpr int kMostAngle = 64;
/// Numbers are rounded to multiples of 2^-kGrid, with what that loses added to the enclosure.
constexpr unsigned kGrid = 320;

struct Between {
  Number low, high;
};

Number grid_step() {
  mpz_class two = 1;
  mpz_mul_2exp(two.get_mpz_t(), two.get_mpz_t(), kGrid);
  return {mpz_class(1), two};
}

/// A multiple of 2^-kGrid within one step.
Number on_grid(const Number& x) {
  mpz_class scaled = x.get_num();
  mpz_mul_2exp(scaled.get_mpz_t(), scaled.get_mpz_t(), kGrid);
  mpz_class floor;
  mpz_fdiv_q(floor.get_mpz_t(), scaled.get_mpz_t(), x.get_den().get_mpz_t());
  return floor * grid_step();
}

struct SineAndCosine {
  Between sine, cosine;
};

/// By their series at a point of the grid near the angle. Each term is rounded once; |angle| <= 64, so that terms fall
/// by at least half from the 128th on, and what is left is no more than the last one.
SineAndCosine enclosed(const Number& angle) {
  const Number step = grid_step(), a = on_grid(angle);
  Number sine = 0, cosine = 0, term = 1;
  unsigned long k = 0;
  for (;; ++k) {
    const bool is_even = k % 2 == 0, is_plus = k % 4 < 2;
    (is_even ? cosine : sine) += is_plus ? term : Number(-term);
    term = on_grid(term * a / static_cast<unsigned long>(k + 1));
    if (k > 2 * kMostAngle && abs(term) <= step) break;
  }
  // Of a rounding of a term by one step, the later terms get |a|^j / j! <= e^64 < 2^93 times as much; there are k
  // terms.
  mpz_class growth = k + 4;
  mpz_mul_2exp(growth.get_mpz_t(), growth.get_mpz_t(), 94);
  const Number error = growth * step;
  return {{Number(sine - error), Number(sine + error)}, {Number(cosine - error), Number(cosine + error)}};
}

/// At least the root.
Number root_above(const Number& square) {
  mpz_class scaled = square.get_num();
  mpz_mul_2exp(scaled.get_mpz_t(), scaled.get_mpz_t(), 2 * kGrid);
  mpz_class floor, root;
  mpz_cdiv_q(floor.get_mpz_t(), scaled.get_mpz_t(), square.get_den().get_mpz_t());
  mpz_sqrt(root.get_mpz_t(), floor.get_mpz_t());
  return (root + 1) * grid_step();
}

struct Place {
  Number x, y;
};
Number along(const Place& n, const Number& x, const Number& y) {
  return n.x * x + n.y * y;
}

class TurnCheck {
 public:
  explicit TurnCheck(const TurningMotion& m)
      : m_(m), turn_(m.twist.turn), vx_(m.twist.velocity.x), vy_(m.twist.velocity.y) {}

  bool is_small() const { return abs(turn_) * (Number(m_.end) - Number(m_.start)) <= kMostAngle; }

  bool begins_inside(Vec2 corner, const std::vector<Segment>& edges) const {
    return motion_check::is_inside(Number(m_.at.x) + Number(corner.x), Number(m_.at.y) + Number(corner.y), edges);
  }

  /// For each corner of a part a lower bound of its place along n at a time, and an upper bound of how far it strays
  /// from the chord of its way in `span` s.
  struct Seen {
    Number lowest, stray;
  };
  std::vector<Seen> seen(const Place& n, const RoundedPolygon& part, double time, const Number& span) const {
    const Number at = along(n, Number(m_.at.x), Number(m_.at.y)), passed = Number(time) - Number(m_.start);
    std::optional<SineAndCosine> turned;
    if (sgn(turn_) != 0) turned = enclosed(turn_ * passed);
    std::vector<Seen> all;
    for (const Vec2 c : part.corners) {
      const Number x(c.x), y(c.y), speed_x = vx_ - turn_ * y, speed_y = vy_ + turn_ * x;
      const Number stray = abs(turn_) * root_above(Number(speed_x * speed_x + speed_y * speed_y)) * span * span / 8;
      if (!turned) {
        all.push_back({Number(at + along(n, Number(x + passed * vx_), Number(y + passed * vy_))), stray});
        continue;
      }
      // at + (sin v + (1 - cos) J v) / w + cos q + sin J q, with J (x, y) = (-y, x).
      const Number across = along(n, Number(-vy_), vx_) / turn_;
      const Number of_sine = along(n, vx_, vy_) / turn_ + along(n, Number(-y), x), of_cosine = along(n, x, y) - across;
      all.push_back({Number(at + across + of_sine * (sgn(of_sine) > 0 ? turned->sine.low : turned->sine.high) +
                            of_cosine * (sgn(of_cosine) > 0 ? turned->cosine.low : turned->cosine.high)),
                     stray});
    }
    return all;
  }

 private:
  const TurningMotion& m_;
  Number turn_, vx_, vy_;
};

/// Whether a direction keeps two parts apart over a piece of time: along it, the way of a corner less that of another
/// is nowhere less than at one of the ends, less what both stray.
bool separates(const Separation& s, const TurnCheck& a, const RoundedPolygon& part, const TurnCheck& b,
               const RoundedPolygon& other) {
  const bool finite = is_finite(s.direction) && std::isfinite(s.margin) && s.margin >= 0.0;
  if (!finite || s.direction == Vec2{}) return false;
  const Place n{Number(s.direction.x), Number(s.direction.y)}, back{Number(-n.x), Number(-n.y)};
  const Number span = Number(s.to) - Number(s.from), length2 = n.x * n.x + n.y * n.y;
  const Number reach = Number(part.radius) + Number(other.radius) + Number(s.margin);
  for (const double time : {s.from, s.to})
    for (const TurnCheck::Seen& p : a.seen(n, part, time, span))
      for (const TurnCheck::Seen& q : b.seen(back, other, time, span)) {
        const Number gap = p.lowest + q.lowest, needed = reach + p.stray + q.stray;
        const Number left = gap * gap, right = needed * needed * length2;
        if (!(sgn(gap) > 0 && (s.margin > 0.0 ? left >= right : left > right))) return false;
      }
  return true;
}

/// Whether the certificate has a direction for each pair of parts and piece of time, and each keeps them apart.
bool covers(const MotionCertificate& certificate, const TurnCheck& a, const RigidBody& body_a, const TurnCheck& b,
            const RigidBody& body_b, double from, double to) {
  return motion_check::all_hold(certificate, body_a.size(), body_b.size(), from, to, [&](const Separation& s) {
    return separates(s, a, body_a[s.part], b, body_b[s.other]);
  });
}

bool is_readable(const TurningMotion& m, const RigidBody& body) {
  return std::isfinite(m.start) && std::isfinite(m.end) && is_finite(m.at) && is_finite(m.twist.velocity) &&
         std::isfinite(m.twist.turn) && std::all_of(body.begin(), body.end(), [](const RoundedPolygon& part) {
           return part.radius >= 0.0 && std::isfinite(part.radius) && !part.corners.empty() &&
                  std::all_of(part.corners.begin(), part.corners.end(), is_finite);
         });
}

}  // namespace
}  // namespace turn_check

bool proves_clear(const MotionCertificate& certificate, const TurningMotion& motion, const RigidBody& body,
                  const Obstacle& obstacle) {
  if (!turn_check::is_readable(motion, body)) return false;
  const turn_check::TurnCheck check(motion);
  if (!(motion.start <= motion.end) || !check.is_small()) return false;
  const std::vector<Segment> edges = edges_of(obstacle);
  RigidBody sides;
  for (const Segment& edge : edges) sides.push_back({{edge.a, edge.b}, 0.0});
  const TurningMotion rest{motion.start, motion.end, {}, {}};
  if (!turn_check::is_readable(rest, sides)) return false;
  if (has_interior(obstacle))
    for (const RoundedPolygon& part : body)
      if (check.begins_inside(part.corners.at(0), edges)) return false;
  return turn_check::covers(certificate, check, body, turn_check::TurnCheck(rest), sides, motion.start, motion.end);
}

bool proves_clear(const MotionCertificate& certificate, const TurningMotion& a, const RigidBody& body_a,
                  const TurningMotion& b, const RigidBody& body_b) {
  if (!turn_check::is_readable(a, body_a) || !turn_check::is_readable(b, body_b)) return false;
  const turn_check::TurnCheck check_a(a), check_b(b);
  if (!(a.start <= a.end && b.start <= b.end) || !check_a.is_small() || !check_b.is_small()) return false;
  return turn_check::covers(certificate, check_a, body_a, check_b, body_b, std::max(a.start, b.start),
                            std::min(a.end, b.end));
}

}  // namespace exactvo::geometry
