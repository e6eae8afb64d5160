// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmpxx.h>
#include <mpfr.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "exact/exact_vector.h"
#include "exact/stages.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/turning.h"
#include "exactvo/geometry/turning_motions.h"
#include "motions/real_roots.h"
#include "motions/turning_parts.h"

namespace exactvo::geometry {
namespace turned {
namespace {

using Rational = mpq_class;
using Point = detail::Vector<Rational>;
using Polynomial = std::vector<Rational>;
/// All of these polynomials are below zero.
using Condition = std::vector<Polynomial>;

/// The least gap that counts as clear for the filter: any number above 0, for it to keep.
constexpr double kAnyGap = 1e-300;
/// Bits of the enclosure of where the drive ends, first and at most. No root can be there (turning_motions.h), so that
/// the loop ends by itself; the limit is for a defect.
constexpr mpfr_prec_t kFirstBits = 128, kMostBits = 1 << 20;

// --- Where the drive ends, in quarter turns and the tangent of half of what is left ---

struct Span {
  int quarters = 0;            ///< whole ones, at most 4
  Rational low = 0, high = 0;  ///< of tan(rest / 2), in [0, 1]
};

class Float {
 public:
  explicit Float(mpfr_prec_t bits) { mpfr_init2(value_, bits); }
  ~Float() { mpfr_clear(value_); }
  Float(const Float&) = delete;
  Float& operator=(const Float&) = delete;
  mpfr_t& operator*() { return value_; }
  Rational rational() {
    Rational q;
    mpfr_get_q(q.get_mpq_t(), value_);
    return q;
  }

 private:
  mpfr_t value_;
};

/// tan((angle - quarters pi / 2) / 2), rounded down or up.
Rational half_tangent(const Rational& angle, int quarters, mpfr_prec_t bits, bool up) {
  const mpfr_rnd_t outward = up ? MPFR_RNDU : MPFR_RNDD, inward = up ? MPFR_RNDD : MPFR_RNDU;
  Float turned(bits), rest(bits);
  mpfr_const_pi(*turned, inward);
  mpfr_mul_ui(*turned, *turned, static_cast<unsigned long>(quarters), inward);
  mpfr_div_2ui(*turned, *turned, 1, inward);
  mpfr_set_q(*rest, angle.get_mpq_t(), outward);
  mpfr_sub(*rest, *rest, *turned, outward);
  mpfr_div_2ui(*rest, *rest, 1, outward);
  mpfr_tan(*rest, *rest, outward);
  return rest.rational();
}

/// The span of an angle above 0. Nothing where these bits do not decide how many quarters it has.
std::optional<Span> span_of(const Rational& angle, mpfr_prec_t bits) {
  for (int quarters = 0; quarters < 4; ++quarters) {
    // Is it more than another quarter? pi is no rational number.
    Float pi(bits);
    const auto more_than = [&](mpfr_rnd_t towards) {
      mpfr_const_pi(*pi, towards);
      return Rational(2 * angle) > Rational((quarters + 1) * pi.rational());
    };
    const bool surely = more_than(MPFR_RNDU), perhaps = more_than(MPFR_RNDD);
    if (surely != perhaps) return std::nullopt;
    if (surely) continue;
    Span span{quarters, half_tangent(angle, quarters, bits, false), half_tangent(angle, quarters, bits, true)};
    span.low = std::max(span.low, Rational(0));
    span.high = std::min(span.high, Rational(1));
    return span;
  }
  return Span{4, 0, 0};
}

// --- Polynomials in t = tan(half the angle turned since the quarter began), times 1 + t^2 ---

/// constant (1 + t^2) + a (1 - t^2) + b 2 t.
Polynomial course(const Rational& constant, const Rational& a, const Rational& b) {
  return {Rational(constant + a), Rational(2 * b), Rational(constant - a)};
}

Polynomial minus(const Polynomial& p) {
  Polynomial q;
  for (const Rational& c : p) q.push_back(-c);
  return q;
}

/// p^2 - bound (1 + t^2)^2.
Polynomial square_less(const Polynomial& p, const Rational& bound) {
  Polynomial q(5);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) q[i + k] += p[i] * p[k];
  q[0] -= bound;
  q[2] -= 2 * bound;
  q[4] -= bound;
  return q;
}

/// p - bound (1 + t^2).
Polynomial less(Polynomial p, const Rational& bound) {
  p[0] -= bound;
  p[2] -= bound;
  return p;
}

bool holds_at_some_time(const Condition& condition, const Rational& until, motions::Ends ends) {
  using namespace motions;
  TimeSet times = {{Rational(0), Rational(1)}};
  for (Polynomial polynomial : condition) {
    Rational power = 1;
    for (Rational& c : polynomial) {
      c *= power;
      power *= until;
    }
    times = common_times(std::move(times), times_below_zero(primitive(polynomial), ends), ends);
    if (times.empty()) return false;
  }
  return true;
}

/// Two convex parts, the turning one seen from the centre of its turn.
class Pair {
 public:
  /// `turning`: corners from the centre as the quarter begins; `standing` the same; both once round, counter-clockwise.
  Pair(std::vector<Point> turning, std::vector<Point> standing, Rational reach, bool clockwise)
      : turning_(std::move(turning)), standing_(std::move(standing)), reach2_(reach * reach), clockwise_(clockwise) {
    add_near_corners();
    for (std::size_t k = 0; k < edges_of(standing_); ++k) add_near_edge(k, false);
    for (std::size_t k = 0; k < edges_of(turning_); ++k) add_near_edge(k, true);
    if (turning_.size() > 2)
      for (const Point& p : standing_) overlap_.push_back(inside(p, true));
    if (standing_.size() > 2)
      for (const Point& p : turning_) overlap_.push_back(inside(p, false));
    for (std::size_t k = 0; k < edges_of(turning_); ++k)
      for (std::size_t i = 0; i < edges_of(standing_); ++i) add_crossings(k, i);
  }

  /// Over t from 0 to `until`.
  Encounter within(const Rational& until) const {
    const auto some = [&](const std::vector<Condition>& all, motions::Ends ends) {
      return std::any_of(all.begin(), all.end(),
                         [&](const Condition& c) { return holds_at_some_time(c, until, ends); });
    };
    if (some(overlap_, motions::Ends::open)) return Encounter::overlap;
    if (sgn(reach2_) > 0 && some(near_, motions::Ends::open)) return Encounter::overlap;
    return some(near_, motions::Ends::closed) ? Encounter::contact : Encounter::clear;
  }

 private:
  static std::size_t edges_of(const std::vector<Point>& hull) {
    return hull.size() == 1 ? 0 : hull.size() == 2 ? 1 : hull.size();
  }
  static Point edge_of(const std::vector<Point>& hull, std::size_t k) { return hull[(k + 1) % hull.size()] - hull[k]; }

  /// (R p).n, for p of the turning part.
  Polynomial along(const Point& p, const Point& n, const Rational& constant = 0) const {
    const Rational turned = dot(perp(p), n);
    return course(constant, dot(p, n), clockwise_ ? Rational(-turned) : turned);
  }

  /// Below zero on the left of an edge, by the edge's length: of a standing edge where a turning corner is, or of a
  /// turning edge where a standing corner is.
  Polynomial right_of(std::size_t k, bool of_turning, const Point& corner) const {
    if (!of_turning) {
      const Point e = edge_of(standing_, k), n{e.y, -e.x};
      return along(corner, n, -dot(n, standing_[k]));
    }
    const Point f = edge_of(turning_, k), n{f.y, -f.x};
    return along(n, corner, -dot(n, turning_[k]));
  }
  Polynomial along_edge(std::size_t k, bool of_turning, const Point& corner) const {
    if (!of_turning) {
      const Point e = edge_of(standing_, k);
      return along(corner, e, -dot(e, standing_[k]));
    }
    const Point f = edge_of(turning_, k);
    return along(f, corner, -dot(f, turning_[k]));
  }

  void add_near_corners() {
    for (const Point& p : turning_)
      for (const Point& q : standing_) {
        const Point twice{Rational(-2 * q.x), Rational(-2 * q.y)};
        near_.push_back({along(p, twice, dot(p, p) + dot(q, q) - reach2_)});
      }
  }
  void add_near_edge(std::size_t k, bool of_turning) {
    const Point e = edge_of(of_turning ? turning_ : standing_, k);
    const Rational length2 = dot(e, e);
    for (const Point& corner : of_turning ? standing_ : turning_) {
      const Polynomial on = along_edge(k, of_turning, corner);
      near_.push_back({square_less(right_of(k, of_turning, corner), reach2_ * length2), minus(on), less(on, length2)});
    }
  }
  Condition inside(const Point& corner, bool of_turning) const {
    Condition all;
    for (std::size_t k = 0; k < edges_of(of_turning ? turning_ : standing_); ++k)
      all.push_back(right_of(k, of_turning, corner));
    return all;
  }
  /// The open edges cross: each has its ends on two sides of the other.
  void add_crossings(std::size_t k, std::size_t i) {
    const Polynomial a = right_of(k, true, standing_[i]), b = right_of(k, true, standing_[(i + 1) % standing_.size()]);
    const Polynomial c = right_of(i, false, turning_[k]), d = right_of(i, false, turning_[(k + 1) % turning_.size()]);
    for (const bool first : {false, true})
      for (const bool second : {false, true})
        overlap_.push_back({first ? a : minus(a), first ? minus(b) : b, second ? c : minus(c), second ? minus(d) : d});
  }

  std::vector<Point> turning_, standing_;
  Rational reach2_;
  bool clockwise_;
  std::vector<Condition> near_, overlap_;
};

// --- The question ---

class Question {
 public:
  Question(const TurningMotion& motion, const RigidBody& body) : m_(motion) {
    require_drive(m_);
    parts_ = hulls_of(body);
    EXACTVO_REQUIRE(!parts_.empty(), "no parts");
  }

  void add_standing(const RigidBody& body, Vec2 at) {
    EXACTVO_REQUIRE(is_finite(at), excerpt({at}));
    for (RoundedPolygon& part : hulls_of(body)) standing_.push_back({at, std::move(part)});
  }
  void add_edges(const Obstacle& obstacle) {
    for (const Segment& e : geometry::edges_of(obstacle)) {
      EXACTVO_REQUIRE(is_finite(e.a) && is_finite(e.b), excerpt({e.a, e.b}));
      standing_.push_back({{}, {e.a == e.b ? std::vector<Vec2>{e.a} : std::vector<Vec2>{e.a, e.b}, 0.0}});
    }
  }

  /// While it drives; what is so at the start is asked elsewhere.
  Encounter decide() const {
    Encounter worst = Encounter::clear;
    bool by_filter = true;
    for (const RoundedPolygon& part : parts_)
      for (const Standing& other : standing_) {
        if (const std::optional<Encounter> found = filtered(part, other)) {
          worst = std::max(worst, *found);
        } else {
          by_filter = false;
          worst = std::max(worst, exactly(part, other));
        }
        if (worst == Encounter::overlap) break;
      }
    by_filter ? detail::count_filter() : detail::count_exact();
    return worst;
  }

 private:
  struct Standing {
    Vec2 at;
    RoundedPolygon part;
  };

  /// Whether all that is not 0 is so far inside the range of doubles that no product of two leaves it.
  static bool has_plain_sizes(const GapToKeep& q) {
    const auto is_plain = [](double x) { return x == 0.0 || (std::fabs(x) >= 0x1p-400 && std::fabs(x) <= 0x1p400); };
    const auto are_plain = [&](Vec2 v) { return is_plain(v.x) && is_plain(v.y); };
    const auto is_plain_body = [&](const ConvexOnTwist& body) {
      return are_plain(body.at) && are_plain(body.twist.velocity) && is_plain(body.twist.turn) &&
             std::all_of(body.corners.data, body.corners.data + body.corners.size, are_plain);
    };
    return is_plain_body(q.a) && is_plain_body(q.b) && is_plain(q.duration) && is_plain(q.reach);
  }

  std::optional<Encounter> filtered(const RoundedPolygon& part, const Standing& other) const {
    const double duration = m_.end - m_.start;
    const GapToKeep q{{m_.at, m_.twist, {part.corners.data(), part.corners.size()}},
                      {other.at, {}, {other.part.corners.data(), other.part.corners.size()}},
                      duration,
                      part.radius + other.part.radius,
                      0.0,
                      kAnyGap};
    if (!has_plain_sizes(q)) return std::nullopt;
    GapKeeper keeper;
    const KeptGap kept = keeper.keep(q);
    if (kept.whole) return Encounter::clear;
    if (keeper.lose(q, kept).lost_by < kInfinity) return Encounter::overlap;
    return std::nullopt;
  }

  Encounter exactly(const RoundedPolygon& part, const Standing& other) const {
    const Rational turn(m_.twist.turn), duration = Rational(m_.end) - Rational(m_.start);
    const Rational reach = Rational(part.radius) + Rational(other.part.radius);
    if (sgn(turn) == 0 || sgn(duration) == 0) return straight(part, other);
    // The centre of the turn, from the reference point's first place: J v / w.
    const Point centre{Rational(-Rational(m_.twist.velocity.y) / turn), Rational(Rational(m_.twist.velocity.x) / turn)};
    std::vector<Point> turning, standing;
    for (const Vec2 c : part.corners) turning.push_back(detail::make<Rational>(c) - centre);
    for (const Vec2 c : other.part.corners)
      standing.push_back(detail::make<Rational>(c) + detail::difference<Rational>(other.at, m_.at) - centre);
    const bool clockwise = sgn(turn) < 0;
    const Rational angle = abs(turn) * duration;
    mpfr_prec_t bits = kFirstBits;
    std::optional<Span> span;
    while (!(span = span_of(angle, bits))) bits *= 2;
    Encounter worst = Encounter::clear;
    for (int k = 0; k < span->quarters && worst != Encounter::overlap; ++k) {
      worst = std::max(worst, Pair(turning, standing, reach, clockwise).within(Rational(1)));
      for (Point& p : turning) p = clockwise ? Point{p.y, Rational(-p.x)} : perp(p);
    }
    if (span->quarters == 4 || worst == Encounter::overlap) return worst;
    const Pair last(turning, standing, reach, clockwise);
    for (;; bits *= 2) {
      EXACTVO_REQUIRE(bits <= kMostBits, std::to_string(bits) + " bits");
      span = span_of(angle, bits);
      const Encounter by_then = last.within(span->low), at_most = last.within(span->high);
      if (by_then == at_most || by_then == Encounter::overlap) return std::max(worst, by_then);
    }
  }

  /// A polynomial of degree 1: exactly at + velocity (time - start).
  Encounter straight(const RoundedPolygon& part, const Standing& other) const {
    const Motion way = CurvedMotion{CurveBasis::powers, m_.start, m_.end, {m_.at, m_.twist.velocity}};
    const RigidBody body{part};
    if (other.part.radius == 0.0 && other.part.corners.size() == 2)
      return encounter(way, body, Obstacle(Polyline{other.part.corners}));
    const Motion stays = StraightMotion{{m_.start, other.at}, {m_.end, other.at}};
    return encounter(way, body, stays, RigidBody{other.part});
  }

  const TurningMotion& m_;
  RigidBody parts_;
  std::vector<Standing> standing_;
};

}  // namespace

void require_drive(const TurningMotion& m) {
  EXACTVO_REQUIRE(std::isfinite(m.start) && std::isfinite(m.end) && m.start <= m.end,
                  hex_text(m.start) + " " + hex_text(m.end));
  EXACTVO_REQUIRE(is_finite(m.at) && is_finite(m.twist.velocity) && std::isfinite(m.twist.turn),
                  excerpt({m.at, m.twist.velocity}));
}

RigidBody hulls_of(const RigidBody& body) {
  RigidBody hulls;
  for (const RoundedPolygon& part : body) {
    EXACTVO_REQUIRE(part.radius >= 0.0 && std::isfinite(part.radius), hex_text(part.radius));
    EXACTVO_REQUIRE(!part.corners.empty() && std::all_of(part.corners.begin(), part.corners.end(), is_finite),
                    excerpt(part.corners));
    hulls.push_back({convex_hull(part.corners).vertices, part.radius});
    EXACTVO_REQUIRE(part.radius > 0.0 || hulls.back().corners.size() > 2, excerpt(part.corners));
  }
  return hulls;
}

}  // namespace turned

Encounter encounter(const TurningMotion& motion, const RigidBody& body, const Obstacle& obstacle) {
  turned::Question q(motion, body);
  q.add_edges(obstacle);
  // Only what begins inside a polygon is there without having met its edges.
  const TimedPoint start{motion.start, motion.at};
  if (has_interior(obstacle) && encounter(StraightMotion{start, start}, body, obstacle) == Encounter::overlap)
    return Encounter::overlap;
  return q.decide();
}

Encounter encounter(const TurningMotion& motion, const RigidBody& body, const RigidBody& other, Vec2 other_at) {
  turned::Question q(motion, body);
  q.add_standing(other, other_at);
  return q.decide();
}

}  // namespace exactvo::geometry
