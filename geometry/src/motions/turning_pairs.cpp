// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/turning_pairs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/turning.h"
#include "motions/turning_parts.h"

namespace exactvo::geometry {
namespace turning_pairs {
namespace {

/// What all roundings of poses come to, as a share of the lengths and with 1 rad for each of the angle: poses are
/// placed at most three times, each by less than 2^-48 (twist_rounding), and a straight motion's velocity is rounded.
constexpr double kPoseRounding = 0x1p-44;
/// A piece of time that is undecided is halved down to this share of the whole, and this many times in all.
constexpr double kFinestShare = 0x1p-30;
constexpr int kMostHalvings = 200;
/// How often a separation is sought on from where the last one ended.
constexpr int kMostStarts = 64;
/// A clearance is enclosed to this share of the lengths first; if that fails, to eight times as much, and so on.
constexpr double kClearanceShare = 0x1p-40;
/// Moments at which the least gap is sought first: at least so many, and so many for each radian turned.
constexpr int kLeastSamples = 12, kMostSamples = 512;
constexpr double kSamplesARadian = 4.0;
constexpr int kGoldenSteps = 55;
/// How often the least gap is sought again, at a moment at which a clearance is not kept; in vain it is no more than a
/// few times.
constexpr int kMostDescents = 64, kDescentsOfOneInVain = 16;
/// A share of the time: so near to the moment of the least gap there is no other one to be sought.
constexpr double kSameDip = 0x1p-10;

/// A body as it stands at a moment, seen from where the first body's motion begins, and how it goes on.
struct Mover {
  Vec2 at;
  Twist twist;
  RigidBody parts;  ///< corners once round, counter-clockwise
};

Mover after(Mover m, double time) {
  const Displacement d = displacement_after(m.twist, time);
  m.at += d.by;
  m.twist.velocity = d.turned(m.twist.velocity);
  for (RoundedPolygon& part : m.parts)
    for (Vec2& corner : part.corners) corner = d.turned(corner);
  return m;
}

Mover back_in_time(Mover m, double time) {
  m = after(std::move(m), time);
  m.twist = {-m.twist.velocity, -m.twist.turn};
  return m;
}

RigidBody parts_of(const RigidBody& body) {
  EXACTVO_REQUIRE(!body.empty(), "no parts");
  return turned::hulls_of(body);
}

/// What a search over a span of time finds of one pair of parts.
struct Found {
  double first = kInfinity;    ///< certainly clear before
  double witness = kInfinity;  ///< certainly an overlap; the first that was found
  bool is_open = false;        ///< there are pieces of time, up to `open_until`, of which nothing is known
  double open_until = 0.0;
  int halvings = 0;
};

/// A part of each body.
struct Pair {
  std::size_t a = 0, b = 0;
  double reach = 0.0;  ///< m, of both
};

/// Two bodies over a span of time, which is counted from 0.
class Span {
 public:
  Span(Mover a, Mover b, double duration) : a_(std::move(a)), b_(std::move(b)), duration_(duration) {
    double extent = 0.0;
    for (const Mover* m : {&a_, &b_})
      for (const RoundedPolygon& part : m->parts)
        for (const Vec2 c : part.corners) extent = std::max(extent, norm(c) + part.radius);
    angle_ = (std::fabs(a_.twist.turn) + std::fabs(b_.twist.turn)) * duration;
    way_ = (norm(a_.twist.velocity) + norm(b_.twist.velocity)) * duration + angle_ * extent;
    size_ = norm(b_.at - a_.at) + way_ + 4.0 * extent;
    slack_ = kPoseRounding * (1.0 + angle_) * size_;
    EXACTVO_REQUIRE(std::isfinite(slack_), hex_text(duration));
  }

  double duration() const { return duration_; }
  double size() const { return size_; }
  double slack() const { return slack_; }
  /// rad: both turn by this much.
  double angle() const { return angle_; }
  /// m: no gap changes by more.
  double way() const { return way_; }

  /// m: the gap, less the reach, within `slack`. Where two parts overlap, the shortest way out, negative.
  double gap(const Pair& pair, double time) {
    const GapToKeep q = question(pair, time, 0.0, 0.0);
    return keeper_.gap_at(q, 0.0);
  }
  Vec2 nearest_place(const Pair& pair, double time) {
    const GapToKeep q = question(pair, time, 0.0, 0.0);
    return keeper_.lose(q, {false, 0.0}).place;
  }
  /// Until then no gap is less than this one. Certified.
  double keeps_until(const Pair& pair, double gap) { return kept_until(pair, 0.0, duration_, gap); }
  Found search(const Pair& pair) {
    Found found;
    search(pair, 0.0, duration_, found);
    return found;
  }

 private:
  GapToKeep question(const Pair& pair, double time, double duration, double required) {
    const auto place = [&](const Mover& m, const RoundedPolygon& part, std::vector<Vec2>& corners) {
      const Displacement d = displacement_after(m.twist, time);
      corners.clear();
      for (const Vec2 c : part.corners) corners.push_back(d.turned(c));
      return ConvexOnTwist{m.at + d.by, {d.turned(m.twist.velocity), m.twist.turn}, {corners.data(), corners.size()}};
    };
    return {place(a_, a_.parts[pair.a], corners_a_),
            place(b_, b_.parts[pair.b], corners_b_),
            duration,
            pair.reach,
            0.0,
            required};
  }

  double kept_until(const Pair& pair, double from, double to, double required) {
    double now = from;
    for (int k = 0; k < kMostStarts; ++k) {
      const KeptGap kept = keeper_.keep(question(pair, now, to - now, required + slack_));
      if (kept.whole) return to;
      if (kept.kept_until <= kFinestShare * duration_) break;
      now += kept.kept_until;
    }
    return now;
  }

  bool surely_overlaps(const Pair& pair, double time) {
    const GapToKeep q = question(pair, time, 0.0, 0.0);
    return keeper_.gap_at(q, 0.0) + GapKeeper::rounding_of(q) + slack_ < 0.0;
  }

  void search(const Pair& pair, double from, double to, Found& found) {
    if (found.witness < kInfinity) return;
    const double now = kept_until(pair, from, to, 0.0);
    if (now >= to) return;
    found.first = std::min(found.first, now);
    // A duration may be so short that a share of it is 0.
    for (double by = std::max(0x1p-32 * duration_, std::numeric_limits<double>::denorm_min());; by *= 2.0) {
      const double then = std::min(to, now + by);
      if (surely_overlaps(pair, then)) {
        found.witness = then;
        return;
      }
      if (then == to) break;
    }
    if (to - now <= kFinestShare * duration_ || ++found.halvings > kMostHalvings) {
      found.is_open = true;
      found.open_until = to;
      return;
    }
    const double middle = now + 0.5 * (to - now);
    search(pair, now, middle, found);
    search(pair, middle, to, found);
  }

  Mover a_, b_;
  double duration_, angle_ = 0.0, way_ = 0.0, size_ = 0.0, slack_ = 0.0;
  std::vector<Vec2> corners_a_, corners_b_;
  GapKeeper keeper_;
};

struct Window {
  double from, to;
  double at(double time) const { return std::clamp(from + time, from, to); }
  Bounds bounds(double low, double high) const {
    return {at(std::nextafter(from + low, -kInfinity) - from), at(std::nextafter(from + high, kInfinity) - from)};
  }
};

/// The exact verdict on one pair, where there is one.
using Exactly = std::function<std::optional<Encounter>(const Pair&)>;

class Examination {
 public:
  Examination(const Mover& a, const Mover& b, const Window& window, Exactly exactly)
      : window_(window), a_(a), b_(b), span_(a, b, window.to - window.from), exactly_(std::move(exactly)) {
    for (std::size_t i = 0; i < a.parts.size(); ++i)
      for (std::size_t k = 0; k < b.parts.size(); ++k) pairs_.push_back({i, k, a.parts[i].radius + b.parts[k].radius});
    leave_out_the_far();
  }

  /// `within_at_start`, `within_at_end`: the body is inside an obstacle, whose distance counts as 0.
  TurningVerdict verdict(bool within_at_start, bool within_at_end) {
    search();
    if (within_at_start || within_at_end) worst_ = Encounter::overlap;
    TurningVerdict answer;
    answer.is_open = is_open_ && worst_ != Encounter::overlap;
    MotionVerdict& v = answer.verdict;
    v.encounter = answer.is_open ? Encounter::contact : worst_;
    find_nearest();
    v.clearance = clearance(v.encounter, answer.is_open, within_at_start || within_at_end);
    v.nearest_time = window_.at(nearest_time_);
    if (!pairs_.empty()) v.place = span_.nearest_place(nearest_, nearest_time_);
    if (v.encounter == Encounter::clear) return answer;
    v.first = within_at_start ? Bounds{window_.from, window_.from} : first_;
    v.last = within_at_end ? Bounds{window_.to, window_.to} : last_moment();
    return answer;
  }

 private:
  /// Pairs that never can be the nearest, nor touch.
  void leave_out_the_far() {
    std::vector<double> gaps;
    double nearest = kInfinity;
    for (const Pair& pair : pairs_) {
      gaps.push_back(span_.gap(pair, 0.0));
      nearest = std::min(nearest, gaps.back());
    }
    std::vector<Pair> near;
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      if (gaps[k] - span_.way() - 4.0 * span_.slack() <= std::max(nearest, 0.0)) near.push_back(pairs_[k]);
    pairs_ = std::move(near);
  }

  void search() {
    double first = kInfinity, witness = kInfinity, open_until = 0.0;
    for (const Pair& pair : pairs_) {
      Found found = span_.search(pair);
      if (found.first == kInfinity) continue;
      bool is_open = found.witness == kInfinity && found.is_open;
      Encounter e = found.witness < kInfinity ? Encounter::overlap : Encounter::clear;
      if (is_open)
        if (const std::optional<Encounter> exact = exactly_(pair)) {
          e = *exact;
          is_open = false;
          if (e != Encounter::clear) open_until = std::max(open_until, found.open_until);
        }
      if (e == Encounter::clear && !is_open) continue;
      if (is_open) open_until = std::max(open_until, found.open_until);
      unclear_.push_back(pair);
      is_open_ |= is_open;
      worst_ = std::max(worst_, e);
      first = std::min(first, found.first);
      witness = std::min(witness, found.witness);
    }
    if (unclear_.empty()) return;
    witness_ = witness;
    open_until_ = open_until;
    first_ = window_.bounds(first, witness < kInfinity ? witness : open_until);
  }

  /// Seen backwards.
  Bounds last_moment() {
    const double duration = span_.duration();
    Span back(back_in_time(a_, duration), back_in_time(b_, duration), duration);
    double first = kInfinity, witness = kInfinity;
    for (const Pair& pair : unclear_) {
      const Found found = back.search(pair);
      first = std::min(first, found.first);
      witness = std::min(witness, found.witness);
    }
    // What was seen from the start need not be seen from the end, where the two graze.
    const double latest = first < kInfinity ? duration - first : duration;
    const double earliest = witness < kInfinity ? duration - witness : std::min(first_.low - window_.from, latest);
    Bounds last = window_.bounds(std::min(earliest, latest), latest);
    last.high = std::max(last.high, first_.low);
    return last;
  }

  void try_moment(double time) {
    for (const Pair& pair : pairs_) {
      const double way_out = span_.gap(pair, time), gap = std::max(way_out, -pair.reach);
      // Where sets without a radius overlap, the longest way out is shown.
      if (gap < least_ || (gap == least_ && way_out < least_way_out_)) {
        least_ = gap;
        least_way_out_ = way_out;
        nearest_time_ = time;
        nearest_ = pair;
      }
    }
  }

  /// A guess; `clearance` goes on from it.
  void find_nearest() {
    const double duration = span_.duration();
    const int samples = static_cast<int>(
        std::clamp(std::ceil(kSamplesARadian * span_.angle()), double{kLeastSamples}, double{kMostSamples}));
    for (int k = 0; k <= samples; ++k) try_moment(duration * k / samples);
    for (const double time : {witness_, first_.low - window_.from})
      if (time >= 0.0 && time <= duration) try_moment(time);
    descend(nearest_time_ - duration / samples, nearest_time_ + duration / samples);
  }
  /// To a least gap between two moments, by golden sections.
  void descend(double low, double high) {
    constexpr double kGolden = 0.6180339887498949;
    low = std::max(0.0, low);
    high = std::min(span_.duration(), high);
    double x = high - kGolden * (high - low), y = low + kGolden * (high - low);
    double at_x = least_gap(x), at_y = least_gap(y);
    for (int k = 0; k < kGoldenSteps; ++k) {
      if (at_x <= at_y) {
        high = y;
        y = x;
        at_y = at_x;
        x = high - kGolden * (high - low);
        at_x = least_gap(x);
      } else {
        low = x;
        x = y;
        at_x = at_y;
        y = low + kGolden * (high - low);
        at_y = least_gap(y);
      }
    }
    try_moment(0.5 * (low + high));
  }
  /// From a moment at which a gap below the least one may begin.
  void descend_from(double time) {
    for (double share = 0x1p-3; share > 0x1p-16; share *= 0x1p-4) descend(time, time + share * span_.duration());
  }
  /// The first moment at which a gap may be less than `low`; infinite: none is. Certified.
  double first_below(double low) {
    double first = kInfinity;
    for (const Pair& pair : pairs_) {
      const double kept = span_.keeps_until(pair, low);
      if (kept < span_.duration()) first = std::min(first, kept);
    }
    return first;
  }
  double least_gap(double time) {
    double least = kInfinity;
    for (const Pair& pair : pairs_) least = std::min(least, distance_of(pair, time));
    return least;
  }
  /// The distance of the rims. That of sets that overlap counts as 0, however deep they do.
  double distance_of(const Pair& pair, double time) { return std::max(span_.gap(pair, time), -pair.reach); }

  /// The distance of parts that overlap counts as 0. Where a gap below the least known one cannot be ruled out, the
  /// search goes on there, so that the moment of the least one is as good as the bounds.
  Bounds clearance(Encounter encounter, bool is_open, bool is_within) {
    if (encounter == Encounter::contact && !is_open) return {0.0, 0.0};
    double deepest = 0.0, shallow = kInfinity;
    for (const Pair& pair : pairs_) deepest = std::max(deepest, pair.reach);
    for (const RoundedPolygon& part : a_.parts) shallow = std::min(shallow, part.radius);
    if (is_within)
      for (const RoundedPolygon& part : a_.parts) deepest = std::max(deepest, part.radius);
    const double lowest = encounter == Encounter::clear ? 0.0 : -deepest;
    double certain = lowest;
    int descents = 0;
    for (double by = kClearanceShare * span_.size(); !is_within && std::isfinite(by);) {
      const double low = (is_open ? 0.0 : least_) - by;
      if (low <= lowest) break;
      const double lost = first_below(low);
      if (lost == kInfinity) {
        certain = low;
        break;
      }
      const double before = least_;
      const bool is_elsewhere = std::fabs(lost - nearest_time_) > kSameDip * span_.duration();
      if (!is_open && is_elsewhere && ++descents <= kMostDescents) descend_from(lost);
      if (least_ < before) continue;
      descents += kDescentsOfOneInVain;
      by *= 8.0;
    }
    Bounds bounds{-deepest, kInfinity};
    if (!pairs_.empty()) bounds.high = std::max(least_, -nearest_.reach) + 4.0 * span_.slack();
    if (is_within) bounds.high = std::min(bounds.high, -shallow);
    if (encounter == Encounter::overlap) bounds.high = std::min(bounds.high, 0.0);
    bounds.low = is_within ? std::min(lowest, bounds.high) : std::min(certain, bounds.high);
    return bounds;
  }

  const Window window_;
  const Mover &a_, &b_;
  Span span_;
  const Exactly exactly_;
  std::vector<Pair> pairs_, unclear_;
  Encounter worst_ = Encounter::clear;
  bool is_open_ = false;
  double witness_ = kInfinity, open_until_ = 0.0;
  Bounds first_;
  double least_ = kInfinity, least_way_out_ = kInfinity, nearest_time_ = 0.0;
  Pair nearest_;
};

bool is_at_rest(const TurningMotion& m) {
  return m.twist.velocity == Vec2{} && m.twist.turn == 0.0;
}

/// Where a motion is at a moment, as a motion of no duration, and the body as it is turned there.
struct Standing {
  StraightMotion motion;
  RigidBody body;
};

Standing standing_at(const TurningMotion& m, const RigidBody& body, double time) {
  const Displacement d = displacement_after(m.twist, time - m.start);
  Standing s{{{time, m.at + d.by}, {time, m.at + d.by}}, body};
  if (d.sine == 0.0 && d.cosine == 1.0) return s;
  for (RoundedPolygon& part : s.body)
    for (Vec2& corner : part.corners) corner = d.turned(corner);
  return s;
}

}  // namespace
}  // namespace turning_pairs

TurningVerdict examine(const TurningMotion& a, const RigidBody& body_a, const TurningMotion& b,
                       const RigidBody& body_b) {
  using namespace turning_pairs;
  turned::require_drive(a);
  turned::require_drive(b);
  const Window window{std::max(a.start, b.start), std::min(a.end, b.end)};
  if (window.from > window.to) return {{Encounter::clear, {kInfinity, kInfinity}, {}, {}, 0.0, {}}, false};
  if (window.from == window.to) {
    const Standing s = standing_at(a, body_a, window.from), t = standing_at(b, body_b, window.from);
    return {examine(s.motion, s.body, t.motion, t.body), false};
  }
  const Mover first = after({{}, a.twist, parts_of(body_a)}, window.from - a.start);
  const Mover second = after({b.at - a.at, b.twist, parts_of(body_b)}, window.from - b.start);
  const auto exactly = [&](const Pair& pair) -> std::optional<Encounter> {
    const auto against = [&](const TurningMotion& m, const RigidBody& body, std::size_t part,
                             const TurningMotion& other, const RigidBody& other_body,
                             std::size_t other_part) -> std::optional<Encounter> {
      if (!is_at_rest(other)) return std::nullopt;
      const Encounter found = encounter(TurningMotion{m.start, window.to, m.at, m.twist}, RigidBody{body[part]},
                                        RigidBody{other_body[other_part]}, other.at);
      // The question was about more time than both have: `clear` holds for less time too, other answers need not.
      if (m.start != window.from && found != Encounter::clear) return std::nullopt;
      return found;
    };
    const auto found = against(a, body_a, pair.a, b, body_b, pair.b);
    return found ? found : against(b, body_b, pair.b, a, body_a, pair.a);
  };
  TurningVerdict answer = Examination(first, second, window, exactly).verdict(false, false);
  answer.verdict.place += a.at;
  return answer;
}

TurningVerdict examine(const TurningMotion& a, const RigidBody& body_a, const Obstacle& obstacle) {
  return examine(a, body_a, obstacle, edges_of(obstacle));
}

TurningVerdict examine(const TurningMotion& a, const RigidBody& body_a, const Obstacle& obstacle,
                       const std::vector<Segment>& edges) {
  using namespace turning_pairs;
  turned::require_drive(a);
  if (a.start == a.end) {
    const Standing s = standing_at(a, body_a, a.start);
    return {examine(s.motion, s.body, obstacle), false};
  }
  const Mover first{{}, a.twist, parts_of(body_a)};
  Mover second;
  for (const Segment& e : edges) {
    EXACTVO_REQUIRE(is_finite(e.a) && is_finite(e.b), excerpt({e.a, e.b}));
    second.parts.push_back({{e.a - a.at}, 0.0});
    if (e.a != e.b) second.parts.back().corners.push_back(e.b - a.at);
  }
  const auto exactly = [&](const Pair& pair) -> std::optional<Encounter> {
    return encounter(a, RigidBody{body_a[pair.a]}, Polyline{{edges[pair.b].a, edges[pair.b].b}});
  };
  const auto is_within = [&](double time) {
    if (!has_interior(obstacle)) return false;
    const Standing s = standing_at(a, body_a, time);
    return encounter(s.motion, s.body, obstacle) == Encounter::overlap;
  };
  const bool at_start = is_within(a.start), at_end = is_within(a.end);
  TurningVerdict answer = Examination(first, second, {a.start, a.end}, exactly).verdict(at_start, at_end);
  answer.verdict.place += a.at;
  return answer;
}

}  // namespace exactvo::geometry
