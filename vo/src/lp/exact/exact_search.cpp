// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/exact/exact_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lp/exact/exact_abscissa.h"
#include "lp/problem/region.h"

namespace exactvo::lp {
namespace {

/// In the place of a line's position: the disc, and nothing.
constexpr std::size_t kDiscPosition = static_cast<std::size_t>(-1);
constexpr std::size_t kNoPosition = static_cast<std::size_t>(-2);

/// Two conversions of long numbers to double (2 u each: the leading words are truncated), a root, a product, a quotient
/// and a sum: below 16 u of the terms.
constexpr double kConversion = 16.0 * kUnitRoundoff;

/// Two products, a sum and a difference, twice (a soft line against the top one), below 8 u of the terms.
constexpr double kPricing = 8.0 * kUnitRoundoff;

/// What products of doubles may lose below the normal range is far less.
constexpr double kLeast = 0x1p-500;

/// mantissa 2^exponent, the mantissa 0 or from 1/4 to 2 and the exponent even: for numbers beyond the doubles too.
struct WideDouble {
  double mantissa = 0.0;
  int exponent = 0;
};

/// A product of some coordinates of normals and offsets leaves the doubles long before these do.
WideDouble wide(Exact x) {
  if (sign_of(x) == 0) return {};
  constexpr int kStep = 512;
  WideDouble w{x.to_double(), 0};
  const auto scale = [&](double by, int exponent) {
    x = x * Exact(by);
    w = {x.to_double(), w.exponent + exponent};
  };
  while (!(std::abs(w.mantissa) < 1.0 / kLeast)) scale(0x1p-512, kStep);
  while (!(std::abs(w.mantissa) > kLeast)) scale(0x1p512, -kStep);
  int exponent = 0;
  w.mantissa = std::frexp(w.mantissa, &exponent);
  const int odd = exponent % 2;
  return {std::ldexp(w.mantissa, odd), w.exponent + exponent - odd};
}

/// A coordinate (a + b root) / w in double, its error added to `error`.
double rounded_coordinate(const WideDouble& a, const WideDouble& b, const WideDouble& root, const WideDouble& w,
                          double& error) {
  const double x = std::ldexp(a.mantissa / w.mantissa, a.exponent - w.exponent);
  const double y = std::ldexp(b.mantissa * root.mantissa / w.mantissa, b.exponent + root.exponent - w.exponent);
  // Below the normal range a double is off by half the least one, which a long normal makes large.
  error += kConversion * (std::abs(x) + std::abs(y)) + 2.0 * std::numeric_limits<double>::denorm_min();
  return x + y;
}

void round_point(ExactOptimum& o) {
  const WideDouble w = wide(o.point.w), d = wide(o.point.d), root = {std::sqrt(d.mantissa), d.exponent / 2};
  o.error = 0.0;
  o.rounded.x = rounded_coordinate(wide(o.point.x0), wide(o.point.x1), root, w, o.error);
  o.rounded.y = rounded_coordinate(wide(o.point.y0), wide(o.point.y1), root, w, o.error);
}

/// The same direction by a power of two, of a length near 1, so that doubles follow the search: exact, or as it was.
Vec2 scaled_to_unit(Vec2 direction) {
  const int exponent = std::ilogb(std::max(std::abs(direction.x), std::abs(direction.y)));
  const Vec2 near = {std::scalbn(direction.x, -exponent), std::scalbn(direction.y, -exponent)};
  const bool same = std::scalbn(near.x, exponent) == direction.x && std::scalbn(near.y, exponent) == direction.y;
  return same ? near : direction;
}

/// The point of the disc farthest along `direction`.
ExactPoint top_of_disc(const ExactVector& direction, const Exact& radius) {
  const Exact squared = dot(direction, direction);
  return {0, direction.x * radius, 0, direction.y * radius, squared, squared};
}

bool inside_disc(Vec2 v, const ExactRegion& region) {
  const ExactVector e = exact(v);
  return !region.has_disc || sign_of(dot(e, e) - region.disc * region.disc) <= 0;
}

ExactOptimum start_of(const ExactRegion& region, const Aim& aim) {
  ExactOptimum o;
  if (aim.directions.empty() && inside_disc(aim.target, region)) {
    o.point = {Exact(aim.target.x), 0, Exact(aim.target.y), 0, 1, 0};
  } else {
    o.point =
        top_of_disc(exact(scaled_to_unit(aim.directions.empty() ? aim.target : aim.directions.front())), region.disc);
    o.on_disc = true;
  }
  round_point(o);
  return o;
}

// --- What others leave of a line ---

/// A line of the working set, and where it stands in the region.
struct Held {
  ExactLine line;
  std::size_t position;
};

/// The part of a carrier that is left, and which line (its position, kDiscPosition or kNoPosition) cut it off.
struct Interval {
  Abscissa low = end(-1), high = end(1);
  std::size_t low_owner = kNoPosition, high_owner = kNoPosition;
  bool empty = false;  ///< then the owners are what contradicts the carrier
};

Interval inside_disc(const Carrier& carrier) {
  Interval interval;
  if (!carrier.has_disc) return interval;
  interval.low_owner = interval.high_owner = kDiscPosition;
  interval.empty = sign_of(carrier.discriminant) < 0;
  interval.low = disc_end(-1);
  interval.high = disc_end(1);
  return interval;
}

void clip(Interval& interval, const Carrier& carrier, const Held& other) {
  const int side = allowed_side(carrier, other.line);
  if (side == 0) {
    if (sign_of(missing(carrier, other.line)) <= 0) return;
    interval.empty = true;
    interval.low_owner = other.position;
    interval.high_owner = kNoPosition;
    return;
  }
  const Abscissa s = cut(carrier, other.line);
  if (side > 0 && compare(carrier, s, interval.low) > 0) interval.low = s, interval.low_owner = other.position;
  if (side < 0 && compare(carrier, s, interval.high) < 0) interval.high = s, interval.high_owner = other.position;
  interval.empty = compare(carrier, interval.low, interval.high) > 0;
}

/// Where the aim would like to be on the carrier: an end, or a foot.
Abscissa wish(const Carrier& carrier, const Aim& aim) {
  for (const Vec2 direction : aim.directions) {
    const int side = sign_of(dot(exact(direction), carrier.direction));
    if (side != 0) return end(side);
  }
  return foot(carrier, aim.target);
}

Abscissa clamped(const Carrier& carrier, const Interval& interval, const Abscissa& s) {
  if (compare(carrier, s, interval.low) < 0) return interval.low;
  return compare(carrier, s, interval.high) > 0 ? interval.high : s;
}

bool at_disc(const Carrier& carrier, const Abscissa& s) {
  if (!carrier.has_disc) return false;
  return compare(carrier, s, disc_end(-1)) == 0 || compare(carrier, s, disc_end(1)) == 0;
}

/// What binds there is left to the caller.
ExactOptimum optimum_at(const Carrier& carrier, const Abscissa& s) {
  ExactOptimum o;
  o.point = point_at(carrier, s);
  o.on_disc = at_disc(carrier, s);
  round_point(o);
  return o;
}

/// The soft line `other` as a half-plane on the plane of `top`: where other is violated no more than top.
ExactLine below(const ExactLine& top, const ExactLine& other) {
  return {other.normal - top.normal, other.offset - top.offset};
}

/// The optimum on the boundary of `entering` inside the working set and the disc. `tight` is left to the caller
/// where feasible; where not, it names the contradiction.
ExactOptimum best_on_line(const Held& entering, const std::vector<Held>& others, const ExactRegion& region,
                          const Aim& aim) {
  const Carrier carrier = carrier_of(entering.line, region.has_disc, region.disc);
  Interval interval = inside_disc(carrier);
  for (const Held& other : others) {
    if (interval.empty) break;
    clip(interval, carrier, other);
  }
  if (!interval.empty) return optimum_at(carrier, clamped(carrier, interval, wish(carrier, aim)));
  ExactOptimum o;
  o.feasible = false;
  o.tight = {entering.position};
  for (const std::size_t owner : {interval.low_owner, interval.high_owner}) {
    if (owner == kDiscPosition) o.on_disc = true;
    if (owner != kDiscPosition && owner != kNoPosition) o.tight.push_back(owner);
  }
  return o;
}

/// The lowest point of the plane of soft line `top`: a linear program in the plane, the working set line by line.
ExactOptimum lowest_on_plane(const ExactRegion& region, const Aim& aim, const std::vector<std::size_t>& in_hand,
                             std::size_t top) {
  const ExactLine plane = exact(region.lines[top].half_plane);
  Aim down = aim;
  down.directions.insert(down.directions.begin(), region.lines[top].half_plane.normal);
  ExactOptimum o = start_of(region, down);
  std::vector<Held> before;
  for (const std::size_t k : in_hand) {
    Held line{exact(region.lines[k].half_plane), k};
    if (region.lines[k].soft) line.line = below(plane, line.line);
    if (sign_of(line.line.normal.x) == 0 && sign_of(line.line.normal.y) == 0) continue;
    if (sign_of_violation(line.line, o.point) > 0) o = best_on_line(line, before, region, down);
    if (!o.feasible) return o;
    before.push_back(line);
  }
  o.top = top;
  return o;
}

/// The point of the hard line `wall` where the soft lines of the working set are violated least: an end of what the
/// hard ones leave, a crossing of two heights, or where the heights are flat the aim's wish.
class WallSearch {
 public:
  WallSearch(const ExactRegion& region, const Aim& aim, const std::vector<std::size_t>& in_hand, std::size_t wall)
      : carrier_(carrier_of(exact(region.lines[wall].half_plane), region.has_disc, region.disc)),
        wish_(wish(carrier_, aim)),
        left_(inside_disc(carrier_)) {
    for (const std::size_t k : in_hand) {
      const Held line{exact(region.lines[k].half_plane), k};
      if (region.lines[k].soft)
        soft_.push_back(line);
      else if (!left_.empty)
        clip(left_, carrier_, line);
    }
  }

  ExactOptimum run() {
    if (!left_.empty) {
      for (const Abscissa& s : {left_.low, left_.high, wish_}) consider(s);
      consider_crossings();
    }
    ExactOptimum o;
    o.feasible = found_;
    if (!found_) return o;
    o = optimum_at(carrier_, best_);
    o.top = soft_[highest_].position;
    return o;
  }

 private:
  Height height_at(std::size_t soft, const Abscissa& s) const { return lp::height_at(carrier_, soft_[soft].line, s); }

  std::size_t highest_at(const Abscissa& s) const {
    std::size_t highest = 0;
    for (std::size_t k = 1; k < soft_.size(); ++k)
      if (compare(carrier_, height_at(k, s), height_at(highest, s)) > 0) highest = k;
    return highest;
  }

  bool nearer_wish(const Abscissa& s) const {
    const int order = compare(carrier_, s, best_);
    if (wish_.infinite != 0) return order * wish_.infinite > 0;
    return order * compare_mean(carrier_, s, best_, wish_) < 0;
  }

  void consider(const Abscissa& s) {
    if (s.infinite != 0 || compare(carrier_, s, left_.low) < 0 || compare(carrier_, s, left_.high) > 0) return;
    const std::size_t highest = highest_at(s);
    const int order = found_ ? compare(carrier_, height_at(highest, s), height_at(highest_, best_)) : -1;
    if (order > 0 || (order == 0 && !nearer_wish(s))) return;
    found_ = true;
    best_ = s;
    highest_ = highest;
  }

  void consider_crossings() {
    for (std::size_t j = 0; j < soft_.size(); ++j) {
      for (std::size_t k = j + 1; k < soft_.size(); ++k) {
        const ExactLine crossing = below(soft_[j].line, soft_[k].line);
        if (allowed_side(carrier_, crossing) != 0) consider(cut(carrier_, crossing));
      }
    }
  }

  Carrier carrier_;
  Abscissa wish_;
  Interval left_;
  std::vector<Held> soft_;
  Abscissa best_;
  bool found_ = false;
  std::size_t highest_ = 0;
};

// --- The search ---

struct Scan {
  const ExactRegion& region;
  const ExactOptimum& at;
  bool relaxing;  ///< soft lines may be violated as much as line at.top is
};

/// The sign of the violation of line k beyond what it may be violated by.
int sign_of_violation(const Scan& scan, std::size_t k) {
  const auto& member = scan.region.lines[k];
  ExactLine line = exact(member.half_plane);
  if (scan.relaxing && member.soft) line = below(exact(scan.region.lines[scan.at.top].half_plane), line);
  return sign_of_violation(line, scan.at.point);
}

/// A line's violation at the rounded point, and how wrong that can be.
struct Price {
  double violation = 0.0, error = 0.0;
};

Price price_of(const HalfPlane& h, Vec2 v, double point_error) {
  const double x = h.normal.x * v.x;
  const double y = h.normal.y * v.y;
  const double terms = std::abs(x) + std::abs(y) + std::abs(h.offset);
  return {h.offset - (x + y), kPricing * terms + (std::abs(h.normal.x) + std::abs(h.normal.y)) * point_error + kLeast};
}

/// The line that enters: the one violated most among those that doubles are sure of, else the first violated exactly.
std::size_t entering(const Scan& scan) {
  const auto& [region, at, relaxing] = scan;
  Price level;
  if (relaxing) level = price_of(region.lines[at.top].half_plane, at.rounded, at.error);
  std::vector<std::size_t> undecided;
  double most = 0.0;
  std::size_t worst = kNoPosition;
  for (std::size_t k = 0; k < region.lines.size(); ++k) {
    Price price = price_of(region.lines[k].half_plane, at.rounded, at.error);
    if (relaxing && region.lines[k].soft) {
      price.violation -= level.violation;
      price.error += level.error + kPricing * (std::abs(price.violation) + std::abs(level.violation));
    }
    if (price.violation > price.error) {
      if (price.violation > most) most = price.violation, worst = k;
    } else if (!(price.violation < -price.error)) {
      undecided.push_back(k);
    }
  }
  if (worst != kNoPosition) return worst;
  for (const std::size_t k : undecided)
    if (std::find(at.tight.begin(), at.tight.end(), k) == at.tight.end() && sign_of_violation(scan, k) > 0) return k;
  return kNoPosition;
}

/// The optimum of the working set with the line that enters. Of those lines it keeps as the next working set what binds
/// there: every correct basis is among them, ties or not.
ExactOptimum step(const Scan& from, const Aim& aim, std::size_t enters) {
  const ExactRegion& region = from.region;
  std::vector<std::size_t> working = from.at.tight;
  ExactOptimum next;
  if (!from.relaxing) {
    std::vector<Held> others;
    for (const std::size_t k : working) others.push_back({exact(region.lines[k].half_plane), k});
    next = best_on_line({exact(region.lines[enters].half_plane), enters}, others, region, aim);
  } else if (region.lines[enters].soft) {
    next = lowest_on_plane(region, aim, working, enters);
  } else {
    next = WallSearch(region, aim, working, enters).run();
  }
  if (!next.feasible) return next;
  next.tight.clear();
  working.push_back(enters);
  for (const std::size_t k : working)
    if ((from.relaxing && k == next.top) || sign_of_violation({region, next, from.relaxing}, k) == 0)
      next.tight.push_back(k);
  return next;
}

ExactOptimum search(const ExactRegion& region, const Aim& aim, ExactOptimum o, bool relaxing) {
  while (o.feasible) {
    const Scan scan{region, o, relaxing};
    const std::size_t enters = entering(scan);
    if (enters == kNoPosition) break;
    o = step(scan, aim, enters);
  }
  return o;
}

ExactOptimum least_violation_in_disc(const ExactRegion& region, const Aim& aim) {
  std::size_t top = 0;
  while (!region.lines[top].soft) ++top;
  ExactOptimum o = lowest_on_plane(region, aim, {}, top);
  o.tight = {top};
  return search(region, aim, std::move(o), true);
}

/// Radii of discs that stand for no bound at all. Vertices of lines of doubles lie within 2^4300 (quotients of sums of
/// products of three); the first radius suffices for all but needles and keeps the doubles' filter working.
Exact far_away(bool beyond_everything) {
  Exact radius(0x1p60);
  for (int k = 0; beyond_everything && k < 9; ++k) radius = radius * Exact(0x1p500);
  return radius;
}

ExactRegion bounded_by(ExactRegion region, const Exact& radius) {
  region.has_disc = true;
  region.disc = radius;
  return region;
}

/// A radius that contains the box. REQUIRES: all four sides among the lines.
Exact around_box(const ExactRegion& region) {
  Exact radius = 0;
  for (const auto& member : region.lines)
    if (is_speed_bound(member.binding)) radius = radius - Exact(member.half_plane.offset);
  return radius;
}

/// The disc that was put there for want of a bound must not be what stops the search.
ExactOptimum without_disc(ExactOptimum o) {
  o.on_disc = false;
  return o;
}

}  // namespace

ExactOptimum exact_best(const ExactRegion& region, const Aim& aim) {
  if (region.has_disc || aim.directions.empty()) return search(region, aim, start_of(region, aim), false);
  const ExactRegion bounded = bounded_by(region, around_box(region) + Exact(1));
  return without_disc(search(bounded, aim, start_of(bounded, aim), false));
}

ExactOptimum exact_least_violation(const ExactRegion& region, const Aim& aim) {
  if (region.has_disc) return least_violation_in_disc(region, aim);
  const ExactOptimum near = least_violation_in_disc(bounded_by(region, far_away(false)), aim);
  if (near.feasible && !near.on_disc) return near;
  return without_disc(least_violation_in_disc(bounded_by(region, far_away(true)), aim));
}

}  // namespace exactvo::lp
