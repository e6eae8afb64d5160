// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/exact/exact_search.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/infinity.h"
#include "lp/exact/exact_abscissa.h"
#include "lp/exact/exact_wall.h"

namespace exactvo::lp {
namespace {

using geometry::kInfinity;
constexpr double kUnitRoundoff = 0x1p-53;

/// Two conversions of long numbers to double (2 u each: the leading words are truncated), a root, a product, a quotient
/// and a sum: below 16 u of the terms.
constexpr double kConversion = 16.0 * kUnitRoundoff;

/// Two products, a sum and a difference, twice (a soft line against the top one), below 8 u of the terms.
constexpr double kPricing = 8.0 * kUnitRoundoff;

/// Conversions are accurate while no number leaves the normal range, also when two of them are multiplied.
constexpr double kLeast = 0x1p-500;
constexpr double kMost = 0x1p500;

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

bool ordinary(double x) {
  return x == 0.0 || (std::abs(x) > kLeast && std::abs(x) < kMost);
}

/// A coordinate (a + b sqrt(d)) / w in double, its error added to `error`.
double rounded_coordinate(const Exact& a, const Exact& b, double root, double w, double& error) {
  const double first = a.to_double();
  const double second = b.to_double();
  if (!ordinary(first) || !ordinary(second)) error = kInfinity;
  const double x = first / w;
  const double y = second * root / w;
  error += kConversion * (std::abs(x) + std::abs(y));
  return x + y;
}

void round_point(ExactOptimum& o) {
  const double w = o.point.w.to_double();
  const double d = o.point.d.to_double();
  o.error = ordinary(w) && ordinary(d) ? 0.0 : kInfinity;
  const double root = d > 0.0 ? std::sqrt(d) : 0.0;
  o.rounded.x = rounded_coordinate(o.point.x0, o.point.x1, root, w, o.error);
  o.rounded.y = rounded_coordinate(o.point.y0, o.point.y1, root, w, o.error);
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

struct Scan {
  const ExactRegion& region;
  const ExactOptimum& at;
  bool relaxing;  ///< soft lines may be violated as much as line at.top is
};

bool violates(const Scan& scan, std::size_t k) {
  const auto& member = scan.region.lines[k];
  ExactLine line = exact(member.half_plane);
  if (scan.relaxing && member.soft) line = below(exact(scan.region.lines[scan.at.top].half_plane), line);
  return sign_of_violation(line, scan.at.point) > 0;
}

/// A line's violation at the rounded point, and how wrong that can be.
struct Price {
  double violation, error;
};

Price price_of(const HalfPlane& h, Vec2 v, double point_error) {
  const double x = h.normal.x * v.x;
  const double y = h.normal.y * v.y;
  const double terms = std::abs(x) + std::abs(y) + std::abs(h.offset);
  return {h.offset - (x + y), kPricing * terms + (std::abs(h.normal.x) + std::abs(h.normal.y)) * point_error + kLeast};
}

/// The line that enters: the one violated most among those that doubles are sure of, else the first violated exactly.
class Entering {
 public:
  explicit Entering(const Scan& scan) : scan_(scan) {
    if (scan.relaxing) level_ = price_of(scan.region.lines[scan.at.top].half_plane, scan.at.rounded, scan.at.error);
  }

  void look_at(std::size_t k) {
    const auto& member = scan_.region.lines[k];
    Price price = price_of(member.half_plane, scan_.at.rounded, scan_.at.error);
    if (scan_.relaxing && member.soft) {
      price.violation -= level_.violation;
      price.error += level_.error + kPricing * (std::abs(price.violation) + std::abs(level_.violation));
    }
    if (price.violation > price.error) {
      if (price.violation > most_) most_ = price.violation, worst_ = k;
    } else if (!(price.violation < -price.error)) {
      undecided_.push_back(k);
    }
  }

  std::size_t line() const {
    if (worst_ != kNone) return worst_;
    for (const std::size_t k : undecided_)
      if (std::find(scan_.at.tight.begin(), scan_.at.tight.end(), k) == scan_.at.tight.end() && violates(scan_, k))
        return k;
    return kNone;
  }

 private:
  const Scan& scan_;
  Price level_{};
  std::vector<std::size_t> undecided_;
  double most_ = 0.0;
  std::size_t worst_ = kNone;
};

/// The line that enters next.
std::size_t entering(const Scan& scan) {
  Entering search(scan);
  for (std::size_t k = 0; k < scan.region.lines.size(); ++k) search.look_at(k);
  return search.line();
}

/// The optimum on the boundary of `entering` inside the working set and the disc. `tight` is left to the caller
/// where feasible; where not, it names the contradiction.
ExactOptimum best_on_line(const Held& entering, const std::vector<Held>& others, const ExactRegion& region,
                          const Aim& aim) {
  const Carrier carrier = carrier_of(entering.line, region.has_disc, region.disc);
  Stretch stretch = inside_disc(carrier);
  for (const Held& other : others) {
    if (stretch.empty) break;
    clip(stretch, carrier, other.line, other.position);
  }
  ExactOptimum o;
  if (stretch.empty) {
    o.feasible = false;
    o.tight = {entering.position};
    for (const std::size_t owner : {stretch.low_owner, stretch.high_owner}) {
      if (owner == kDiscOwner) o.on_disc = true;
      if (owner != kDiscOwner && owner != kNoOwner) o.tight.push_back(owner);
    }
    return o;
  }
  const Abscissa s = clamped(carrier, stretch, wish(carrier, aim));
  o.point = point_at(carrier, s);
  o.on_disc = at_disc(carrier, s);
  round_point(o);
  return o;
}

std::vector<Held> held(const ExactRegion& region, const std::vector<std::size_t>& positions) {
  std::vector<Held> lines;
  for (const std::size_t k : positions) lines.push_back({exact(region.lines[k].half_plane), k});
  return lines;
}

/// Keeps those of `candidates` that bind at the optimum: every correct basis is among them, ties or not.
void keep_tight(ExactOptimum& o, const ExactRegion& region, const std::vector<std::size_t>& candidates, bool relaxing) {
  for (const std::size_t k : candidates) {
    const auto& member = region.lines[k];
    ExactLine line = exact(member.half_plane);
    if (relaxing && member.soft) line = below(exact(region.lines[o.top].half_plane), line);
    if ((relaxing && k == o.top) || sign_of_violation(line, o.point) == 0) o.tight.push_back(k);
  }
}

ExactOptimum best_step(const ExactRegion& region, const Aim& aim, const ExactOptimum& from, std::size_t enters) {
  const Held line{exact(region.lines[enters].half_plane), enters};
  ExactOptimum next = best_on_line(line, held(region, from.tight), region, aim);
  if (!next.feasible) return next;
  std::vector<std::size_t> candidates = from.tight;
  candidates.push_back(enters);
  keep_tight(next, region, candidates, false);
  return next;
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

/// The point of the hard line `wall` where the soft lines of the working set are violated least.
ExactOptimum lowest_on_wall(const ExactRegion& region, const Aim& aim, const std::vector<std::size_t>& in_hand,
                            std::size_t wall) {
  WallSearch search(carrier_of(exact(region.lines[wall].half_plane), region.has_disc, region.disc), aim);
  for (const std::size_t k : in_hand) {
    const ExactLine line = exact(region.lines[k].half_plane);
    if (region.lines[k].soft)
      search.add_soft(line, k);
    else
      search.add_hard(line, k);
  }
  ExactOptimum o;
  o.feasible = search.run();
  if (!o.feasible) return o;
  o.point = search.point();
  o.top = search.top();
  o.on_disc = search.on_disc();
  round_point(o);
  return o;
}

ExactOptimum relaxing_step(const ExactRegion& region, const Aim& aim, const ExactOptimum& from, std::size_t enters) {
  ExactOptimum next = region.lines[enters].soft ? lowest_on_plane(region, aim, from.tight, enters)
                                                : lowest_on_wall(region, aim, from.tight, enters);
  if (!next.feasible) return next;
  next.tight.clear();
  std::vector<std::size_t> candidates = from.tight;
  candidates.push_back(enters);
  keep_tight(next, region, candidates, true);
  return next;
}

ExactOptimum walk(const ExactRegion& region, const Aim& aim, ExactOptimum o, bool relaxing) {
  while (o.feasible) {
    const std::size_t enters = entering({region, o, relaxing});
    if (enters == kNone) break;
    o = relaxing ? relaxing_step(region, aim, o, enters) : best_step(region, aim, o, enters);
  }
  return o;
}

ExactOptimum least_violation_in_disc(const ExactRegion& region, const Aim& aim) {
  std::size_t top = 0;
  while (!region.lines[top].soft) ++top;
  ExactOptimum o = lowest_on_plane(region, aim, {}, top);
  o.tight = {top};
  return walk(region, aim, std::move(o), true);
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
  if (region.has_disc || aim.directions.empty()) return walk(region, aim, start_of(region, aim), false);
  const ExactRegion bounded = bounded_by(region, around_box(region) + Exact(1));
  return without_disc(walk(bounded, aim, start_of(bounded, aim), false));
}

ExactOptimum exact_least_violation(const ExactRegion& region, const Aim& aim) {
  if (region.has_disc) return least_violation_in_disc(region, aim);
  const ExactOptimum near = least_violation_in_disc(bounded_by(region, far_away(false)), aim);
  if (near.feasible && !near.on_disc) return near;
  return without_disc(least_violation_in_disc(bounded_by(region, far_away(true)), aim));
}

}  // namespace exactvo::lp
