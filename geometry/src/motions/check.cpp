// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <queue>
#include <tuple>
#include <unordered_map>

#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/motion_check.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/turning_pairs.h"
#include "motions/path.h"
#include "motions/question.h"
#include "motions/straight.h"

namespace exactvo::geometry {
namespace motions {
namespace {

void require_trajectory(const Trajectory& t) {
  EXACTVO_REQUIRE(!t.points.empty(), "no points");
  for (std::size_t i = 0; i < t.points.size(); ++i) {
    const TimedPoint& p = t.points[i];
    EXACTVO_REQUIRE(is_finite(p.at) && std::isfinite(p.time), hex_text(p.time) + " " + excerpt({p.at}));
    EXACTVO_REQUIRE(i == 0 || t.points[i - 1].time <= p.time, hex_text(t.points[i - 1].time) + " " + hex_text(p.time));
  }
  EXACTVO_REQUIRE(t.velocities.empty() || t.velocities.size() == t.points.size(),
                  std::to_string(t.velocities.size()) + " velocities");
  EXACTVO_REQUIRE(std::all_of(t.velocities.begin(), t.velocities.end(), is_finite), excerpt(t.velocities));
}

std::size_t pieces_of(const Trajectory& t, Between between) {
  const bool has_one_a_point = between == Between::hold || between == Between::none;
  return has_one_a_point ? t.points.size() : std::max<std::size_t>(1, t.points.size() - 1);
}

/// At one of its points. REQUIRES: not the only one.
Vec2 velocity_at(const Trajectory& t, std::size_t number) {
  if (!t.velocities.empty()) return t.velocities[number];
  const TimedPoint& before = t.points[number == 0 ? 0 : number - 1];
  const TimedPoint& after = t.points[std::min(number + 1, t.points.size() - 1)];
  return before.time < after.time ? catmull_rom_velocity(before, after) : Vec2{};
}

Motion motion_of(const Trajectory& t, Between between, std::size_t number) {
  const TimedPoint& from = t.points[number];
  const std::size_t next = std::min(number + 1, t.points.size() - 1);
  const TimedPoint& to = t.points[next];
  switch (between) {
    case Between::straight:
      break;
    case Between::hold:
      return held(from, to.time);
    case Between::cubic:
      if (number == next) break;
      return hermite_cubic(from, velocity_at(t, number), to, velocity_at(t, next));
    case Between::none:
      return StraightMotion{from, from};
  }
  return StraightMotion{from, to};
}

/// A body as it is turned during a piece.
struct TurnedBody {
  RigidBody shape;  ///< at the start
  Turned turned;
};

/// A body, and what the sweep wants to know of it.
struct SweptBody {
  RigidBody shape;
  double reach = 0.0;                        ///< m: a disc round the reference point that holds it; rounded up
  bool is_disc = false;                      ///< round the reference point
  bool outside = false;                      ///< of all polygons, at `last`
  TimedPoint last{-kInfinity, {}};           ///< where its last piece ended
  bool ends_exactly = true;                  ///< whether `last` is rounded
  std::uint64_t serial = 0;                  ///< of its last piece
  std::uint64_t continued = 0;               ///< the piece that its last one continues
  std::shared_ptr<const TurnedBody> turned;  ///< during its last piece; null: as it was given
};

SweptBody swept_body(RigidBody shape) {
  SweptBody body;
  body.is_disc = shape.size() == 1 && shape[0].corners.size() == 1 && shape[0].corners[0] == Vec2{};
  for (const RoundedPolygon& part : shape)
    for (const Vec2 c : part.corners) {
      // The norm is right to a few ulps, the sum to one.
      constexpr double kUp = 1.0 + 0x1p-48;
      const double reach = body.is_disc ? part.radius : (norm(c) + part.radius) * kUp;
      body.reach = std::max(body.reach, reach);
    }
  body.shape = std::move(shape);
  return body;
}

/// A motion beside its chord, on which it ends.
struct Chorded {
  StraightMotion chord;                       ///< of a straight motion, itself
  std::shared_ptr<const CurvedMotion> curve;  ///< null: straight
  /// m: at every moment the curve is no farther than this from the uniform motion along the chord.
  double stray = 0.0;
  bool is_exact_at_start = true, is_exact_at_end = true;  ///< whether the curve's ends are the chord's
};

Chorded chorded(const Motion& motion) {
  if (const auto* straight = std::get_if<StraightMotion>(&motion)) return {*straight, nullptr};
  const auto& curve = std::get<CurvedMotion>(motion);
  Chorded m;
  m.curve = std::make_shared<const CurvedMotion>(curve);
  m.is_exact_at_start = curve.basis != CurveBasis::b_spline;
  m.is_exact_at_end = curve.basis == CurveBasis::bezier;
  Path<RunningError> path = path_of<RunningError>(curve, {curve.start, curve.end});
  to_control_points(path);
  // A Bezier curve stays as near to the uniform motion along its chord as its control points to those of the chord.
  // Over its whole time a path's scale is a factorial, which is exact. Places are taken from the origin: what the sum
  // with it rounds is less than 2^-52 of the sizes. 2^-40 stands for all that is rounded besides.
  constexpr double kOutward = 1.0 + 0x1p-40, kOfSizes = 0x1p-50;
  const Vec2 origin = origin_of(motion);
  const double scale = path.scale.value;
  std::vector<Vec2> points;
  double error = 0.0, size = std::max(std::fabs(origin.x), std::fabs(origin.y));
  for (const Vector<RunningError>& p : path.c) {
    points.push_back({p.x.value / scale, p.y.value / scale});
    error = std::max({error, p.x.error / scale, p.y.error / scale});
    size = std::max({size, std::fabs(points.back().x), std::fabs(points.back().y)});
  }
  const auto last = static_cast<double>(points.size() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double share = last > 0.0 ? static_cast<double>(i) / last : 0.0;
    m.stray = std::max(m.stray, norm(points[i] - (points.front() + share * (points.back() - points.front()))));
  }
  m.stray = kOutward * (m.stray + 8.0 * error + kOfSizes * size);
  m.chord = {{curve.start, origin + points.front()}, {curve.end, origin + points.back()}};
  if (m.is_exact_at_start) m.chord.from.at = curve.points.front();
  if (m.is_exact_at_end) m.chord.to.at = curve.points.back();
  return m;
}

Chorded chorded(const StraightMotion& piece, const TurningMotion& arc) {
  Chorded m{piece, nullptr};
  // The arc ends where the chord does up to the rounding of its twist: less than 2^-46 of the way.
  const double rounded = 0x1p-46 * norm(piece.to.at - piece.from.at);
  m.stray = (stray_of(arc.twist, {}, arc.end - arc.start) + rounded) * (1.0 + 0x1p-40);
  m.is_exact_at_start = m.is_exact_at_end = false;
  return m;
}

/// One motion of one body that is under way.
struct Piece {
  Box box;                                    ///< holds the body all the time
  StraightMotion motion;                      ///< the chord of a curve
  std::shared_ptr<const CurvedMotion> curve;  ///< null: straight
  double stray = 0.0;                         ///< m, of the curve from the chord
  std::uint64_t serial = 0;                   ///< from 1, rising as pieces come
  std::uint32_t body = 0;
  std::shared_ptr<const TurnedBody> turned{};  ///< null: the body as it was given
  bool continues = false;                      ///< begins when, where and as turned as the body's piece before it ends
  /// Continues, and lasts: what is met at its first moment is met by the piece before it, too. (A way that is gone in
  /// no time meets others as a whole.)
  bool follows = false;

  Motion whole() const { return curve ? Motion(*curve) : Motion(motion); }
  bool turns() const { return turned && turned->turned.by != 0.0; }
  Turned how_turned() const { return turned ? turned->turned : Turned{}; }
};

/// A straight piece as a motion that may turn.
TurningMotion arc_of(const Piece& piece) {
  return turning_motion(piece.motion, piece.how_turned());
}

/// Where a body is at a moment of its piece, and how it is turned.
Pose pose_at(const Piece& piece, double time) {
  const Turned turned = piece.how_turned();
  if (!piece.turns()) return {position_at(piece.whole(), time), turned.from};
  const TurningMotion arc = arc_of(piece);
  const Displacement d = displacement_after(arc.twist, time - arc.start);
  return {arc.at + d.by, turned.from + arc.twist.turn * (time - arc.start)};
}

/// Holds the body and half of what counts as near; rounded outward: three roundings of 2^-53 are less than 2^-50.
Box swept_box(const StraightMotion& m, double body_reach, double near) {
  constexpr double kOutward = 0x1p-50;
  const double reach = body_reach + 0.5 * near;
  Box box;
  box.add(m.from.at);
  box.add(m.to.at);
  const auto down = [&](double x) { return x - reach - kOutward * (std::fabs(x) + reach); };
  const auto up = [&](double x) { return x + reach + kOutward * (std::fabs(x) + reach); };
  return {{down(box.low.x), down(box.low.y)}, {up(box.high.x), up(box.high.y)}};
}

/// The pieces that are under way, by place. Cells are hashed, so that the world has no bounds; their side follows the
/// boxes. Boxes of many cells stand in a list of their own. A piece that follows the one before it takes its place.
class MovingGrid {
 public:
  /// Calls visit(other) once for each piece of another body that is under way as this one begins and whose box meets
  /// this one's, in the order in which they came; then adds it. REQUIRES: no piece before began later.
  template <class Visit>
  void meet_and_add(const Piece& piece, const Visit& visit) {
    now_ = piece.motion.from.time;
    if (++since_swept_ > kept_ + kLeastSwept) forget_ended();
    adapt_side(piece.box);
    const Cells own = cells_of(piece.box);
    find(piece, own);
    if (found_.size() > 1)
      std::sort(found_.begin(), found_.end(),
                [&](std::uint32_t a, std::uint32_t b) { return pool_[a].piece.serial < pool_[b].piece.serial; });
    for (const std::uint32_t k : found_) visit(pool_[k].piece);
    found_.clear();
    add(piece, own);
  }

  std::size_t most_held() const { return pool_.size(); }

 private:
  static constexpr std::int64_t kMostCells = 64;
  static constexpr std::size_t kLeastTable = std::size_t{1} << 12;
  static constexpr std::size_t kLeastSwept = std::size_t{1} << 10;
  static constexpr std::uint32_t kNoPlace = ~std::uint32_t{0};
  struct Cells {
    std::int64_t x0, y0, x1, y1;
    bool is_large() const {
      return x1 - x0 >= kMostCells || y1 - y0 >= kMostCells || (x1 - x0 + 1) * (y1 - y0 + 1) > kMostCells;
    }
    bool operator==(const Cells& c) const { return x0 == c.x0 && y0 == c.y0 && x1 == c.x1 && y1 == c.y1; }
  };
  struct Held {
    Piece piece;
    Cells cells{};
    bool is_free = false;
  };

  Cells cells_of(const Box& box) const {
    const auto cell = [&](double x) {
      constexpr double kMost = 0x1p60;
      const double scaled = std::clamp(x * per_side_, -kMost, kMost);
      const auto whole = static_cast<std::int64_t>(scaled);
      return whole - (static_cast<double>(whole) > scaled ? 1 : 0);
    };
    return {cell(box.low.x), cell(box.low.y), cell(box.high.x), cell(box.high.y)};
  }
  std::vector<std::uint32_t>& list_of(std::int64_t x, std::int64_t y) {
    const auto mixed =
        static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ULL ^ static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FULL;
    return lists_[static_cast<std::size_t>(mixed ^ (mixed >> 29)) & (lists_.size() - 1)];
  }
  template <class Visit>
  static void for_each_cell(const Cells& c, const Visit& visit) {
    for (std::int64_t y = c.y0; y <= c.y1; ++y)
      for (std::int64_t x = c.x0; x <= c.x1; ++x) visit(x, y);
  }

  void find(const Piece& piece, const Cells& own) {
    const auto meets = [&](const Held& held) {
      const Piece& other = held.piece;
      return other.body != piece.body && geometry::meet(other.box, piece.box) && other.motion.to.time >= now_;
    };
    if (own.is_large()) {
      for (std::uint32_t k = 0; k < pool_.size(); ++k)
        if (!pool_[k].is_free && meets(pool_[k])) found_.push_back(k);
      return;
    }
    for (const std::uint32_t k : large_)
      if (meets(pool_[k])) found_.push_back(k);
    for_each_cell(own, [&](std::int64_t x, std::int64_t y) {
      for (const std::uint32_t k : list_of(x, y)) {
        if (!meets(pool_[k])) continue;
        // Reported in the first cell that both have; this also tells cells that share a list apart.
        const Cells& other = pool_[k].cells;
        if (x == std::max(own.x0, other.x0) && y == std::max(own.y0, other.y0)) found_.push_back(k);
      }
    });
  }

  void add(const Piece& piece, const Cells& own) {
    if (piece.body >= place_of_.size()) place_of_.resize(piece.body + 1, kNoPlace);
    std::uint32_t& place = place_of_[piece.body];
    // The next piece has only the end of a way that takes no time.
    if (place != kNoPlace && piece.follows && pool_[place].piece.motion.from.time < now_) {
      Held& held = pool_[place];
      sum_of_widths_ += width_of(piece.box) - width_of(held.piece.box);
      held.piece = piece;
      if (held.cells == own) return;
      unlist(place);
      held.cells = own;
      return list(place);
    }
    if (free_.empty()) {
      free_.push_back(static_cast<std::uint32_t>(pool_.size()));
      pool_.emplace_back();
    }
    place = free_.back();
    free_.pop_back();
    pool_[place] = {piece, own, false};
    sum_of_widths_ += width_of(piece.box);
    list(place);
  }
  void list(std::uint32_t k) {
    const Cells& own = pool_[k].cells;
    if (own.is_large()) return large_.push_back(k);
    for_each_cell(own, [&](std::int64_t x, std::int64_t y) {
      std::vector<std::uint32_t>& cell = list_of(x, y);
      if (cell.empty() || cell.back() != k) cell.push_back(k);
    });
  }
  void unlist(std::uint32_t k) {
    const auto take_from = [&](std::vector<std::uint32_t>& list) {
      const auto at = std::find(list.begin(), list.end(), k);
      if (at == list.end()) return;
      *at = list.back();
      list.pop_back();
    };
    const Cells& own = pool_[k].cells;
    if (own.is_large()) return take_from(large_);
    for_each_cell(own, [&](std::int64_t x, std::int64_t y) { take_from(list_of(x, y)); });
  }

  void forget_ended() {
    since_swept_ = 0;
    for (std::uint32_t k = 0; k < pool_.size(); ++k) {
      Held& held = pool_[k];
      if (held.is_free || held.piece.motion.to.time >= now_) continue;
      unlist(k);
      sum_of_widths_ -= width_of(held.piece.box);
      if (place_of_[held.piece.body] == k) place_of_[held.piece.body] = kNoPlace;
      held.is_free = true;
      free_.push_back(k);
    }
    kept_ = pool_.size() - free_.size();
  }

  static double width_of(const Box& box) { return std::max(box.high.x - box.low.x, box.high.y - box.low.y); }

  /// Lists all anew where cells are far from twice as wide as the mean of the boxes, or lists are fewer than four a
  /// piece.
  void adapt_side(const Box& next) {
    const std::size_t held = pool_.size() - free_.size();
    const double wanted = 2.0 * (sum_of_widths_ + width_of(next)) / static_cast<double>(held + 1);
    const bool is_usable = wanted > 0.0 && std::isfinite(1.0 / wanted);
    const bool fits = !is_usable || (wanted * per_side_ > 0.25 && wanted * per_side_ < 4.0);
    if (fits && 4 * held <= lists_.size()) return;
    if (!fits) per_side_ = 1.0 / wanted;
    std::size_t table = lists_.size();
    while (table < 4 * held) table *= 4;
    lists_.assign(table, {});
    large_.clear();
    sum_of_widths_ = 0.0;
    for (std::uint32_t k = 0; k < pool_.size(); ++k) {
      if (pool_[k].is_free) continue;
      pool_[k].cells = cells_of(pool_[k].piece.box);
      list(k);
      sum_of_widths_ += width_of(pool_[k].piece.box);
    }
  }

  double now_ = -kInfinity;
  double per_side_ = 1.0;  ///< cells a metre
  double sum_of_widths_ = 0.0;
  std::size_t since_swept_ = 0;  ///< pieces that came
  std::size_t kept_ = 0;         ///< pieces, when those that had ended were forgotten
  std::vector<Held> pool_;
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> place_of_;  ///< of each body's last piece in the pool
  std::vector<std::vector<std::uint32_t>> lists_{kLeastTable};
  std::vector<std::uint32_t> large_, found_;
};

/// A quick filter in plain doubles. It proves that n.v > reach |n|, where n is a vector of doubles, so that its own
/// rounding does not matter, and v stands for a difference of two points. With u = 2^-53:
///
///  - x + y differs from n.v by at most 3 u (|x| + |y|): v, the products and the sum are rounded;
///  - `wanted` is wrong by at most 5 u of itself: the length by 2 u, the sum of radii by 2 u, the product; its sum with
///    what follows is rounded once more;
///  - n across an edge is across b - a as it was rounded, so the edge leaves the line across n by up to
///    2 u |n.x n.y| / |n| from a to b, which is much where it is long. Points of it that are farther than `reach` from
///    the disc's centre need no proof. One that is nearer is w = v - d from a, |d| <= reach, and beyond the line by at
///    most n.w <= u (|n.x w.x| + |n.y w.y|) <= u (|x| + |y| + reach |n|), up to u^2. Along an edge n.w has the sign
///    that does no harm.
///
/// All that is less than 4.1 u (|x| + |y|) + 7.1 u wanted; `kQuick` is 16 u. Between two times the bound holds too,
/// since |x| + |y| is convex. A product that underflows is wrong by some 2^-1074, which is nothing beside `kQuick` of
/// kLeastSize; n shorter than kLeastLength have no length, since its square underflows.
constexpr double kQuick = 0x1p-49;
constexpr double kLeastSize = 0x1p-900;
constexpr double kLeastLength = 0x1p-450;

/// Whether n.v > reach |n| for certain. `length`: |n|, rounded.
bool surely_beyond(Vec2 n, double length, Vec2 v, double reach) {
  const double x = n.x * v.x, y = n.y * v.y, wanted = reach * length;
  return length > kLeastLength && wanted > kLeastSize &&
         x + y > wanted + kQuick * (std::fabs(x) + std::fabs(y) + wanted);
}

/// Whether two discs are apart by more than `reach` all the time, between the lines across one of the ends of their
/// difference. False where this is not certain.
bool quickly_apart(const StraightMotion& a, const StraightMotion& b, double reach) {
  const Vec2 from = a.from.at - b.from.at, to = a.to.at - b.to.at;
  const double first = norm(from), last = norm(to);
  return (surely_beyond(from, first, from, reach) && surely_beyond(from, first, to, reach)) ||
         (surely_beyond(to, last, from, reach) && surely_beyond(to, last, to, reach));
}

/// Whether a disc stays beside an edge's line, or before one of its ends. False where this is not certain.
bool quickly_beside(const StraightMotion& m, const Segment& edge, double reach) {
  const Vec2 along = edge.b - edge.a, across{-along.y, along.x};
  const double length = norm(along);
  const auto beyond = [&](Vec2 n, Vec2 origin) {
    return surely_beyond(n, length, m.from.at - origin, reach) && surely_beyond(n, length, m.to.at - origin, reach);
  };
  return beyond(across, edge.a) || beyond(-across, edge.a) || beyond(-along, edge.a) || beyond(along, edge.b);
}

using Filtered = Vector<RunningError>;

/// Whether the filter clears two discs over the same span of time by more than `more`.
bool surely_clear(const StraightMotion& a, double radius_a, const StraightMotion& b, double radius_b, double more) {
  if (a.from.time != b.from.time || a.to.time != b.to.time) return false;
  if (quickly_apart(a, b, radius_a + radius_b + more)) return true;
  const Filtered origin{RunningError(0.0), RunningError(0.0)};
  const Filtered way =
      detail::difference<RunningError>(a.to.at, a.from.at) - detail::difference<RunningError>(b.to.at, b.from.at);
  const RunningError reach = RunningError(radius_a) + RunningError(radius_b) + RunningError(more);
  return beside(detail::difference<RunningError>(b.from.at, a.from.at), origin, way, RunningError(reach * reach)) ==
         Known::positive;
}

bool surely_clear_of(const StraightMotion& a, double radius, const Segment& edge, double more) {
  if (quickly_beside(a, edge, radius + more)) return true;
  const Filtered from{RunningError(0.0), RunningError(0.0)};
  const Filtered to = detail::difference<RunningError>(a.to.at, a.from.at);
  const GrownHull<RunningError> hull{
      {detail::difference<RunningError>(edge.a, a.from.at), detail::difference<RunningError>(edge.b, a.from.at)},
      RunningError(radius) + RunningError(more)};
  return straight_gap(from, to, hull) == Known::positive;
}

/// Joins the pieces' verdicts to events and hands these on as soon as nothing more can be added to them.
class Events {
 public:
  Events(std::function<void(const MotionEvent&)> report, MotionCheck& check)
      : report_(std::move(report)), check_(check) {}

  void add(const TurningVerdict& verdict, std::size_t body, bool with_obstacle, std::size_t other, const Pose& pose,
           const Pose& other_pose) {
    const Key key{body, with_obstacle, other};
    const MotionVerdict& v = verdict.verdict;
    const MotionEvent event{v.encounter,   body,         with_obstacle,      other,          v.first,
                            v.last,        v.clearance,  v.nearest_time,     v.place,        pose.at,
                            other_pose.at, pose.heading, other_pose.heading, verdict.is_open};
    const auto [last, is_new] = last_of_pair_.try_emplace(key, next_number_);
    if (!is_new && event.first.low <= open_.at(last->second).last.high) {
      join(open_.at(last->second), event);
    } else {
      last->second = next_number_;
      open_.emplace(next_number_++, event);
    }
    ends_.push({open_.at(last->second).last.high, key, last->second});
  }

  /// All that is added from now on begins at `now` or later.
  void advance(double now) {
    while (!ends_.empty() && std::get<0>(ends_.top()) < now) {
      const auto [end, key, number] = ends_.top();
      ends_.pop();
      const auto open = open_.find(number);
      if (open == open_.end() || open->second.last.high != end) continue;  // it has gone on, or is reported already
      ++(open->second.is_open                           ? check_.open
         : open->second.encounter == Encounter::overlap ? check_.overlaps
                                                        : check_.contacts);
      report_(open->second);
      open_.erase(open);
      const auto last = last_of_pair_.find(key);
      if (last != last_of_pair_.end() && last->second == number) last_of_pair_.erase(last);
    }
  }
  void finish() { advance(kInfinity); }

 private:
  using Key = std::tuple<std::size_t, bool, std::size_t>;
  using End = std::tuple<double, Key, std::uint64_t>;

  static void join(MotionEvent& open, const MotionEvent& next) {
    if (next.last.high > open.last.high) open.last = next.last;
    if (next.first.low < open.first.low) open.first = next.first;
    // Polygons that only touch are as near as those that overlap, but are no example of an overlap.
    if (next.encounter > open.encounter ||
        (next.encounter == open.encounter && next.clearance.low < open.clearance.low)) {
      open.nearest_time = next.nearest_time;
      open.place = next.place;
      open.at = next.at;
      open.other_at = next.other_at;
      open.turned = next.turned;
      open.other_turned = next.other_turned;
    }
    open.clearance = {std::min(open.clearance.low, next.clearance.low),
                      std::min(open.clearance.high, next.clearance.high)};
    open.encounter = std::max(open.encounter, next.encounter);
    // An overlap is one whatever else is open. A contact may be one where another piece is open.
    open.is_open = open.encounter != Encounter::overlap && (open.is_open || next.is_open);
  }
  std::function<void(const MotionEvent&)> report_;
  MotionCheck& check_;
  std::map<Key, std::uint64_t> last_of_pair_;
  std::unordered_map<std::uint64_t, MotionEvent> open_;  ///< by number, rising as they begin
  std::uint64_t next_number_ = 0;
  std::priority_queue<End, std::vector<End>, std::greater<>> ends_;
};

/// The map's edges by place, and which obstacle each belongs to.
class Map {
 public:
  Map(const std::vector<Obstacle>& obstacles, const std::vector<std::optional<Disc>>& discs) : obstacles_(obstacles) {
    EXACTVO_REQUIRE(discs.empty() || discs.size() == obstacles.size(), std::to_string(discs.size()));
    std::vector<Box> boxes, boxes_of_discs;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
      if (!discs.empty() && discs[k]) {
        const auto& [center, radius] = *discs[k];
        EXACTVO_REQUIRE(is_finite(center) && std::isfinite(radius) && radius >= 0.0, hex_text(radius));
        discs_.push_back({k, *discs[k]});
        boxes_of_discs.push_back(swept_box({{0.0, center}, {0.0, center}}, radius, 0.0));
        continue;
      }
      Box whole;
      for (const Segment& edge : edges_of(obstacles[k])) {
        EXACTVO_REQUIRE(is_finite(edge.a) && is_finite(edge.b), excerpt({edge.a, edge.b}));
        edges_.push_back(edge);
        owner_.push_back(k);
        Box box;
        box.add(edge.a);
        box.add(edge.b);
        boxes.push_back(box);
        whole.add(box);
      }
      if (has_interior(obstacles[k])) {
        solid_.push_back(k);
        extents_.push_back(whole);
      }
    }
    if (!boxes.empty()) grid_ = BoxGrid(std::move(boxes));
    if (!extents_.empty()) solids_ = BoxGrid(extents_);
    if (!boxes_of_discs.empty()) by_disc_ = BoxGrid(std::move(boxes_of_discs));
  }

  /// Calls visit(edge, obstacle) for each edge whose box meets this one.
  template <class Visit>
  void for_each_edge(const Box& box, const Visit& visit) const {
    if (!edges_.empty()) grid_.for_each_meeting(box, [&](std::size_t i) { visit(edges_[i], owner_[i]); });
  }
  /// Calls visit(obstacle) for each polygon whose extent meets this box.
  template <class Visit>
  void for_each_polygon(const Box& box, const Visit& visit) const {
    if (!solid_.empty()) solids_.for_each_meeting(box, [&](std::size_t i) { visit(solid_[i]); });
  }

  /// Calls visit(disc, obstacle) for each obstacle that is a disc and whose box meets this one.
  template <class Visit>
  void for_each_disc(const Box& box, const Visit& visit) const {
    if (!discs_.empty())
      by_disc_.for_each_meeting(box, [&](std::size_t i) { visit(discs_[i].second, discs_[i].first); });
  }

  const Obstacle& operator[](std::size_t k) const { return obstacles_[k]; }

 private:
  const std::vector<Obstacle>& obstacles_;
  std::vector<std::pair<std::size_t, Disc>> discs_;  ///< and which obstacle each is
  std::vector<Segment> edges_;
  std::vector<std::size_t> owner_, solid_;
  std::vector<Box> extents_;
  BoxGrid grid_, solids_, by_disc_;
};

/// The least approach of each pair so far.
class Approaches {
 public:
  explicit Approaches(double near) : near_(near) {}

  /// m: what comes no nearer than that says nothing new.
  double limit(std::size_t body, bool with_obstacle, std::size_t other) const {
    if (near_ == 0.0) return 0.0;
    const auto found = all_.find(Key{body, with_obstacle, other});
    return found == all_.end() ? near_ : std::max(0.0, found->second.clearance.high);
  }
  void add(const MotionVerdict& v, std::size_t body, bool with_obstacle, std::size_t other) {
    if (near_ == 0.0 || !(v.clearance.low < near_)) return;
    const auto [place, is_new] = all_.try_emplace(
        Key{body, with_obstacle, other}, Approach{body, with_obstacle, other, v.clearance, v.nearest_time, v.place});
    if (is_new) return;
    Approach& least = place->second;
    if (v.clearance.low < least.clearance.low) {
      least.nearest_time = v.nearest_time;
      least.place = v.place;
    }
    least.clearance = {std::min(least.clearance.low, v.clearance.low),
                       std::min(least.clearance.high, v.clearance.high)};
  }
  std::vector<Approach> sorted() const {
    std::vector<Approach> list;
    list.reserve(all_.size());
    for (const auto& [pair, approach] : all_) list.push_back(approach);
    std::sort(list.begin(), list.end(), [](const Approach& a, const Approach& b) {
      return std::tie(a.body, a.with_obstacle, a.other) < std::tie(b.body, b.with_obstacle, b.other);
    });
    return list;
  }

 private:
  struct Key {
    std::size_t body;
    bool with_obstacle;
    std::size_t other;
    bool operator==(const Key& k) const {
      return body == k.body && with_obstacle == k.with_obstacle && other == k.other;
    }
  };
  struct Hash {
    std::size_t operator()(const Key& k) const {
      return (k.body * 0x9E3779B97F4A7C15ULL) ^ (2 * k.other + (k.with_obstacle ? 1 : 0)) * 0xC2B2AE3D27D4EB4FULL;
    }
  };
  double near_;
  std::unordered_map<Key, Approach, Hash> all_;
};

class Sweep {
 public:
  Sweep(const std::vector<Obstacle>& obstacles, MotionCheckOptions options,
        std::function<void(const MotionEvent&)> report)
      : options_(std::move(options)),
        near_(options_.near),
        map_(obstacles, options_.discs),
        events_(std::move(report), check_),
        approaches_(near_) {
    EXACTVO_REQUIRE(near_ >= 0.0 && std::isfinite(near_), hex_text(near_));
  }

  std::size_t add_body(RigidBody shape) {
    encounter(StraightMotion{}, shape, StraightMotion{}, disc_body(0.0));  // requires a valid body
    bodies_.push_back(swept_body(std::move(shape)));
    return bodies_.size() - 1;
  }

  void add(std::size_t number, const Motion& given, Turned turned) {
    EXACTVO_REQUIRE(number < bodies_.size(), std::to_string(number));
    SweptBody& body = bodies_[number];
    require_motion(given);
    if (body.is_disc) turned = {};
    const auto* straight = std::get_if<StraightMotion>(&given);
    require_turned(straight, turned);
    Chorded chord = turned.by == 0.0 ? chorded(given) : chorded(*straight, turning_motion(*straight, turned));
    const StraightMotion& motion = chord.chord;
    EXACTVO_REQUIRE(now_ <= motion.from.time && body.last.time <= motion.from.time,
                    hex_text(motion.from.time) + " after " + hex_text(std::max(now_, body.last.time)));
    EXACTVO_REQUIRE(std::isfinite(chord.stray), excerpt({motion.from.at, motion.to.at}));
    if (now_ < motion.from.time) {
      meet_at_ends();
      now_ = motion.from.time;
      events_.advance(now_);
    }
    const bool is_turned_alike = turn(body, turned);
    const bool continues = is_turned_alike && chord.is_exact_at_start && body.ends_exactly &&
                           body.last.time == motion.from.time && body.last.at == motion.from.at;
    const Piece piece{swept_box(motion, body.reach + chord.stray, near_),
                      motion,
                      std::move(chord.curve),
                      chord.stray,
                      ++check_.pieces,
                      static_cast<std::uint32_t>(number),
                      body.turned,
                      continues,
                      continues && motion.from.time < motion.to.time};
    if (piece.follows) {
      body.continued = body.serial;
    } else {
      meet_at_ends(number);
    }
    meet_map(piece, body);
    meet_discs(piece, body);
    body.last = motion.to;
    body.ends_exactly = chord.is_exact_at_end;
    body.serial = piece.serial;
    grid_.meet_and_add(piece, [&](const Piece& other) {
      const bool has_ended = other.motion.to.time == now_ && other.motion.from.time < now_;
      if (has_ended && options_.between == Between::hold) return;
      // Where the other goes on, its next piece is met at this moment too.
      if (has_ended && bodies_[other.body].serial == other.serial) {
        at_ends_.push_back({piece, other});
      } else {
        meet_body(piece, other);
      }
    });
  }

  MotionCheck finish() {
    meet_at_ends();
    events_.finish();
    check_.most_held = grid_.most_held();
    check_.approaches = approaches_.sorted();
    return std::move(check_);
  }

 private:
  /// A piece, and one of another body that ends as it begins.
  struct AtEnd {
    Piece piece, ended;
  };

  /// Those whose other body has not gone on; of one body only where it is given, and then no more.
  void meet_at_ends(std::optional<std::size_t> body = {}) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < at_ends_.size(); ++k) {
      const AtEnd& pair = at_ends_[k];
      if (body && pair.ended.body != *body) {
        at_ends_[kept++] = pair;
      } else if (bodies_[pair.ended.body].continued != pair.ended.serial) {
        meet_body(pair.piece, pair.ended);
      }
    }
    at_ends_.resize(kept);
  }

  void require_turned(const StraightMotion* straight, const Turned& turned) {
    EXACTVO_REQUIRE(std::isfinite(turned.from) && std::fabs(turned.by) <= kPi,
                    hex_text(turned.from) + " " + hex_text(turned.by));
    EXACTVO_REQUIRE(turned.by == 0.0 || (straight && straight->from.time < straight->to.time), "no straight piece");
    has_turns_ |= turned.by != 0.0;
    has_others_ |= !straight || (straight->from.time == straight->to.time && straight->from.at != straight->to.at);
    EXACTVO_REQUIRE(!has_turns_ || !has_others_, "bodies that turn, and curves or ways that are gone in no time");
  }

  /// Whether the body is turned as it was at the end of its last piece.
  static bool turn(SweptBody& body, const Turned& turned) {
    const Turned last = body.turned ? body.turned->turned : Turned{};
    if (turned.from == last.from && turned.by == 0.0 && last.by == 0.0) return true;
    body.turned = turned.from == 0.0 && turned.by == 0.0
                      ? nullptr
                      : std::make_shared<const TurnedBody>(TurnedBody{turned_body(body.shape, turned.from), turned});
    return false;
  }

  const RigidBody& shape_of(const Piece& piece) const {
    return piece.turned ? piece.turned->shape : bodies_[piece.body].shape;
  }

  /// Nothing where they are clear and no clearance is asked for.
  std::optional<TurningVerdict> judged(const Piece& piece, const std::vector<Segment>& edges,
                                       const Obstacle& obstacle) const {
    const RigidBody& shape = shape_of(piece);
    if (piece.turns()) return geometry::examine(arc_of(piece), shape, obstacle, edges);
    const Motion whole = piece.whole();
    if (near_ == 0.0 && encounter(whole, shape, obstacle) == Encounter::clear) return std::nullopt;
    return TurningVerdict{examine(whole, shape, obstacle), false};
  }
  std::optional<TurningVerdict> judged(const Piece& a, const Piece& b) const {
    return judged(a, b.whole(), shape_of(b), b.turns() ? std::optional(arc_of(b)) : std::nullopt);
  }
  /// `arc`: of the other, if it turns.
  std::optional<TurningVerdict> judged(const Piece& a, const Motion& other, const RigidBody& other_shape,
                                       const std::optional<TurningMotion>& arc) const {
    const RigidBody& shape = shape_of(a);
    if (a.turns() || arc) {
      const auto as_turning = [](const StraightMotion& m) { return turning_motion(m, {}); };
      return geometry::examine(arc_of(a), shape, arc ? *arc : as_turning(std::get<StraightMotion>(other)), other_shape);
    }
    const Motion motion = a.whole();
    if (near_ == 0.0 && encounter(motion, shape, other, other_shape) == Encounter::clear) return std::nullopt;
    return TurningVerdict{examine(motion, shape, other, other_shape), false};
  }

  void meet_map(const Piece& piece, SweptBody& body) {
    const StraightMotion& m = piece.motion;
    const bool stays_outside = body.outside && piece.continues;
    suspects_.clear();
    met_.clear();
    edges_.clear();
    map_.for_each_edge(swept_box(m, body.reach + piece.stray, 2.0 * near_), [&](const Segment& edge, std::size_t k) {
      ++check_.edge_pairs;
      if (options_.met) met_.push_back(k);
      if (surely_clear_of(m, body.reach, edge, piece.stray)) {
        if (near_ > 0.0) approach_edge(piece, body, edge, k);
      } else {
        suspects_.push_back(k);
        if (piece.turns()) edges_.emplace_back(k, edge);
      }
    });
    if (!stays_outside)
      map_.for_each_polygon(piece.box, [&](std::size_t k) {
        suspects_.push_back(k);
        met_.push_back(k);
      });
    keep_each_once(suspects_);
    if (options_.met) {
      keep_each_once(met_);
      for (const std::size_t k : met_) options_.met({piece.body, piece.whole(), true, k, {}, piece.how_turned(), {}});
    }
    body.outside = true;
    if (suspects_.empty()) return;
    for (const std::size_t k : suspects_) {
      ++check_.examined;
      std::vector<Segment> near;
      for (const auto& [owner, edge] : edges_)
        if (owner == k) near.push_back(edge);
      const std::optional<TurningVerdict> verdict = judged(piece, near, map_[k]);
      if (!verdict) continue;
      approaches_.add(verdict->verdict, piece.body, true, k);
      if (verdict->verdict.encounter == Encounter::clear) continue;
      body.outside = false;
      events_.add(*verdict, piece.body, true, k, pose_at(piece, verdict->verdict.nearest_time), {});
    }
  }

  /// A disc of the map is a body at rest: radii are added as exactly as those of two bodies.
  void meet_discs(const Piece& piece, const SweptBody& body) {
    const StraightMotion& m = piece.motion;
    map_.for_each_disc(swept_box(m, body.reach + piece.stray, 2.0 * near_), [&](const Disc& disc, std::size_t k) {
      ++check_.edge_pairs;
      const StraightMotion rest = held({m.from.time, disc.center}, m.to.time);
      if (options_.met) options_.met({piece.body, piece.whole(), true, k, rest, piece.how_turned(), {}});
      const double more = strayed(approaches_.limit(piece.body, true, k), piece.stray);
      if (surely_clear(m, body.reach, rest, disc.radius, more)) return;
      ++check_.examined;
      const std::optional<TurningVerdict> verdict = judged(piece, rest, disc_body(disc.radius), {});
      if (!verdict) return;
      approaches_.add(verdict->verdict, piece.body, true, k);
      if (verdict->verdict.encounter == Encounter::clear) return;
      events_.add(*verdict, piece.body, true, k, pose_at(piece, verdict->verdict.nearest_time), {});
    });
  }

  /// An edge that is not touched, but may be near.
  void approach_edge(const Piece& piece, const SweptBody& body, const Segment& edge, std::size_t k) {
    const double more = strayed(approaches_.limit(piece.body, true, k), piece.stray);
    if (surely_clear_of(piece.motion, body.reach, edge, more)) return;
    ++check_.examined;
    const Polyline wall{{edge.a, edge.b}};
    if (const auto verdict = judged(piece, {edge}, wall)) approaches_.add(verdict->verdict, piece.body, true, k);
  }

  void meet_body(const Piece& one, const Piece& another) {
    ++check_.pairs;
    const bool in_order = one.body < another.body;
    const Piece &a = in_order ? one : another, &b = in_order ? another : one;
    const SweptBody &body = bodies_[a.body], &other = bodies_[b.body];
    if (options_.met) options_.met({a.body, a.whole(), false, b.body, b.whole(), a.how_turned(), b.how_turned()});
    const double more = strayed(approaches_.limit(a.body, false, b.body), a.stray + b.stray);
    if (surely_clear(a.motion, body.reach, b.motion, other.reach, more)) return;
    ++check_.examined;
    const std::optional<TurningVerdict> verdict = judged(a, b);
    if (!verdict) return;
    approaches_.add(verdict->verdict, a.body, false, b.body);
    if (verdict->verdict.encounter == Encounter::clear) return;
    const double t = verdict->verdict.nearest_time;
    events_.add(*verdict, a.body, false, b.body, pose_at(a, t), pose_at(b, t));
  }

  /// m: how far apart chords must be for curves to be apart by `more`; rounded up.
  static double strayed(double more, double stray) { return stray == 0.0 ? more : (1.0 + 0x1p-50) * (more + stray); }

  static void keep_each_once(std::vector<std::size_t>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }

  const MotionCheckOptions options_;
  const double near_;
  MotionCheck check_;
  Map map_;
  Events events_;
  Approaches approaches_;
  MovingGrid grid_;
  std::vector<SweptBody> bodies_;
  std::vector<std::size_t> suspects_, met_;
  std::vector<std::pair<std::size_t, Segment>> edges_;  ///< of suspects, for a body that turns
  std::vector<AtEnd> at_ends_;
  double now_ = -kInfinity;
  bool has_turns_ = false, has_others_ = false;
};

}  // namespace
}  // namespace motions

TurningMotion turning_motion(const StraightMotion& piece, const Turned& turned) {
  const auto& [from, to] = piece;
  const double duration = to.time - from.time;
  EXACTVO_REQUIRE(duration > 0.0 || from.at == to.at, hex_text(from.time) + " " + hex_text(to.time));
  if (!(duration > 0.0)) return {from.time, to.time, from.at, {}};
  const Vec2 way = to.at - from.at;
  if (turned.by == 0.0) return {from.time, to.time, from.at, {way / duration, 0.0}};
  return {from.time, to.time, from.at, twist_between({{}, 0.0}, {way, turned.by}, duration)};
}

struct MotionStream::State {
  motions::Sweep sweep;
};

MotionStream::MotionStream(const std::vector<Obstacle>& map, MotionCheckOptions options,
                           std::function<void(const MotionEvent&)> report)
    : state_(new State{{map, std::move(options), std::move(report)}}) {}

MotionStream::~MotionStream() = default;

std::size_t MotionStream::add_body(RigidBody body) {
  return state_->sweep.add_body(std::move(body));
}

void MotionStream::add(std::size_t body, const Motion& piece, const Turned& turned) {
  state_->sweep.add(body, piece, turned);
}

MotionCheck MotionStream::finish() {
  return state_->sweep.finish();
}

MotionCheck check_motions(const std::vector<Trajectory>& trajectories, const std::vector<Obstacle>& map,
                          const MotionCheckOptions& options, const std::function<void(const MotionEvent&)>& report) {
  struct Begin {
    double time;
    std::uint32_t body, number;
  };
  motions::Sweep sweep(map, options, report);
  std::vector<Begin> begins;
  for (std::size_t b = 0; b < trajectories.size(); ++b) {
    motions::require_trajectory(trajectories[b]);
    sweep.add_body(trajectories[b].body);
    for (std::size_t k = 0; k < motions::pieces_of(trajectories[b], options.between); ++k)
      begins.push_back({trajectories[b].points[k].time, static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(k)});
  }
  std::sort(begins.begin(), begins.end(), [](const Begin& x, const Begin& y) {
    return std::tie(x.time, x.body, x.number) < std::tie(y.time, y.body, y.number);
  });
  for (const Begin& begin : begins)
    sweep.add(begin.body, motions::motion_of(trajectories[begin.body], options.between, begin.number), {});
  return sweep.finish();
}

}  // namespace exactvo::geometry
