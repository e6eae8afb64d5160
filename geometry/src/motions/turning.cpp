// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/turning.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {
namespace {

/// How many directions are tried one after the other.
constexpr int kMostDirections = 96;
/// The search ends where a direction carries it on by less than this share of the duration.
constexpr double kLeastShare = 0x1p-34;
/// How finely it is found how long a direction holds, as a share of the duration.
constexpr double kFineShare = 0x1p-40;
/// Ways along a direction may turn round within this angle; rad, less than pi.
constexpr double kOneTurningPoint = 3.0;

bool is_at_rest(const Twist& twist) {
  return twist.velocity == Vec2{} && twist.turn == 0.0;
}

double greatest_norm(const CornerView& corners) {
  double most = 0.0;
  for (std::size_t i = 0; i < corners.size; ++i) most = std::max(most, squared_norm(corners.data[i]));
  return std::sqrt(most);
}

/// Points that move together, about a reference point.
struct Points {
  const std::vector<Vec2>& all;
  Vec2 reference;
  Twist twist;
};

double least_along(Vec2 n, const std::vector<Vec2>& points) {
  double least = kInfinity;
  for (const Vec2 p : points) least = std::min(least, dot(n, p));
  return least;
}

/// The gap's course along a direction while time passes from 0 on.
struct Course {
  const Points& a;
  const Points& b;
  Vec2 n;  ///< from b to a
  double reach = 0.0, growth = 0.0, rounding = 0.0;

  /// At least the gap along n, less the reach, at any moment up to `time`.
  double least_within(double time) const {
    const Displacement da = displacement_after(a.twist, time), db = displacement_after(b.twist, time);
    const double b_first = -least_along(-n, b.all);
    double b_last = b_first, b_stray = 0.0;
    const bool b_rests = is_at_rest(b.twist);
    if (!b_rests) {
      b_last = -kInfinity;
      for (const Vec2 p : b.all) {
        b_last = std::max(b_last, dot(n, b.reference + db.moved(p - b.reference)));
        b_stray = std::max(b_stray, stray_of(b.twist, p - b.reference, time));
      }
    }
    const bool turns_once = b_rests && growth == 0.0 && std::fabs(a.twist.turn * time) <= kOneTurningPoint;
    double first = kInfinity, last = kInfinity, dip = 0.0;
    double least = kInfinity;
    for (const Vec2 p : a.all) {
      const Vec2 q = p - a.reference;
      const double at_first = dot(n, p), at_last = dot(n, a.reference + da.moved(q));
      if (turns_once) {
        const Vec2 speed = a.twist.velocity + a.twist.turn * perp(q);
        const double unsure = rounding_of_speed(q);
        const bool dips = dot(n, speed) < unsure && dot(n, da.turned(speed)) > -unsure;
        least = std::min(least, std::min(at_first, at_last) - (dips ? stray_of(a.twist, q, time) : 0.0));
      } else {
        first = std::min(first, at_first);
        last = std::min(last, at_last);
        dip = std::max(dip, stray_of(a.twist, q, time));
      }
    }
    if (turns_once) return least - b_first - reach - rounding;
    return std::min(first - b_first - reach, last - b_last - (reach + growth * time)) - dip - b_stray - rounding;
  }

 private:
  /// m/s: a bound on the rounding of a corner's speed along n, at both ends.
  double rounding_of_speed(Vec2 q) const {
    return 0x1p-46 * (norm(a.twist.velocity) + std::fabs(a.twist.turn) * norm(q));
  }
};

}  // namespace

/// A direction from b to a.
struct GapKeeper::Direction {
  Vec2 n{1.0, 0.0};
  double gap = -kInfinity;
  bool of_a = false;  ///< the normal of an edge of a: it turns with a
};

double GapKeeper::rounding_of(const GapToKeep& q) {
  // With sizes S of all lengths that occur and |w| T <= angle: each position is off by (16 + 2 angle) u S for its
  // twist, twice as it is placed and then moved; differences, scalar products and a normal of length 1 to 4 u add 24 u
  // S.
  constexpr double u = 0x1p-53;
  const double angle = (std::fabs(q.a.twist.turn) + std::fabs(q.b.twist.turn)) * q.duration;
  const double way = (norm(q.a.twist.velocity) + norm(q.b.twist.velocity)) * q.duration;
  const Vec2 apart = q.b.at - q.a.at;
  const double size = norm(apart) + way + greatest_norm(q.a.corners) + greatest_norm(q.b.corners) + q.reach +
                      q.growth * q.duration + std::fabs(q.required);
  return (128.0 + 16.0 * angle) * u * size;
}

void GapKeeper::place_at(const GapToKeep& q, double time) {
  const Displacement da = displacement_after(q.a.twist, time), db = displacement_after(q.b.twist, time);
  twist_a_ = {da.turned(q.a.twist.velocity), q.a.twist.turn};
  twist_b_ = {db.turned(q.b.twist.velocity), q.b.twist.turn};
  b_at_ = (q.b.at - q.a.at) + (db.by - da.by);
  a_.clear();
  b_.clear();
  for (std::size_t i = 0; i < q.a.corners.size; ++i) a_.push_back(da.turned(q.a.corners.data[i]));
  for (std::size_t i = 0; i < q.b.corners.size; ++i) b_.push_back(b_at_ + db.turned(q.b.corners.data[i]));
}

GapKeeper::Direction GapKeeper::best_direction() const {
  Direction best;
  const auto take = [&](Vec2 n, bool of_a) {
    const double gap = least_along(n, a_) + least_along(-n, b_);
    if (gap > best.gap) best = {n, gap, of_a};
  };
  const auto take_edges = [&](const std::vector<Vec2>& hull, double sign, bool of_a) {
    for (std::size_t i = 0; hull.size() > 1 && i < hull.size(); ++i) {
      const Vec2 outward = -perp(hull[(i + 1) % hull.size()] - hull[i]);
      const double length = norm(outward);
      if (length > 0.0) take((sign / length) * outward, of_a);
    }
  };
  take_edges(a_, -1.0, true);
  take_edges(b_, 1.0, false);
  // Between the nearest corners: what counts where no edge is nearest.
  Vec2 between;
  double least2 = kInfinity;
  for (const Vec2 p : a_)
    for (const Vec2 r : b_) {
      const double d2 = squared_norm(p - r);
      if (d2 < least2) {
        least2 = d2;
        between = p - r;
      }
    }
  const double length = norm(between);
  if (length > 0.0) take((1.0 / length) * between, false);
  if (best.gap == -kInfinity) take(best.n, false);
  return best;
}

double GapKeeper::gap_at(const GapToKeep& question, double time) {
  place_at(question, time);
  return best_direction().gap - (question.reach + question.growth * time);
}

KeptGap GapKeeper::keep(const GapToKeep& q) {
  EXACTVO_REQUIRE(q.duration >= 0.0 && q.reach >= 0.0 && q.growth >= 0.0 && std::isfinite(rounding_of(q)),
                  hex_text(q.duration) + " " + hex_text(q.reach) + " " + hex_text(q.growth));
  EXACTVO_REQUIRE(q.a.corners.size > 0 && q.b.corners.size > 0, "no corners");
  const double rounding = rounding_of(q);
  KeptGap kept;
  double now = 0.0;
  for (int tried = 0; tried < kMostDirections && !kept.whole; ++tried) {
    place_at(q, now);
    const Direction best = best_direction();
    const double reach = q.reach + q.growth * now;
    if (best.gap - reach - rounding < q.required) break;
    // A direction of a's own is at rest seen from a, where b moves the opposite way, if b is at rest in the world.
    const bool seen_from_a = best.of_a && is_at_rest(q.b.twist);
    const Points a{a_, {}, twist_a_}, b{b_, b_at_, twist_b_};
    const Points b_seen{b_, {}, {-twist_a_.velocity, -twist_a_.turn}}, a_rests{a_, {}, {}};
    const Course course = seen_from_a ? Course{b_seen, a_rests, -best.n, reach, q.growth, rounding}
                                      : Course{a, b, best.n, reach, q.growth, rounding};
    const double left = q.duration - now;
    if (course.least_within(left) >= q.required) {
      kept.whole = true;
      break;
    }
    double low = 0.0, high = left;
    while (high - low > kFineShare * q.duration) {
      const double middle = 0.5 * (low + high);
      if (!(low < middle && middle < high)) break;  // a share of a tiny duration is 0
      (course.least_within(middle) >= q.required ? low : high) = middle;
    }
    if (low <= kLeastShare * q.duration) break;
    now += low;
  }
  kept.kept_until = kept.whole ? q.duration : now;
  return kept;
}

LostGap GapKeeper::lose(const GapToKeep& q, const KeptGap& kept) {
  const double now = kept.kept_until, rounding = rounding_of(q);
  LostGap lost{kInfinity, {}};
  place_at(q, now);
  double least = kInfinity;
  const auto nearest = [&](const std::vector<Vec2>& points, const std::vector<Vec2>& hull) {
    for (const Vec2 p : points)
      for (std::size_t i = 0; i < hull.size(); ++i) {
        const Vec2 on = nearest_on(hull[i], hull[(i + 1) % hull.size()], p);
        if (squared_norm(p - on) < least) {
          least = squared_norm(p - on);
          lost.place = 0.5 * (p + on);
        }
      }
  };
  nearest(a_, b_);
  nearest(b_, a_);
  lost.place += q.a.at + displacement_after(q.a.twist, now).by;
  for (double by = 0x1p-32; by <= 1.0; by *= 2.0) {
    const double then = std::min(q.duration, now + by * q.duration);
    if (gap_at(q, then) + rounding < q.required) {
      lost.lost_by = then;
      break;
    }
  }
  return lost;
}

}  // namespace exactvo::geometry
