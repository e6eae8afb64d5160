// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/motions.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/pieces.h"
#include "exactvo/geometry/require.h"
#include "motions/question.h"

namespace exactvo::geometry::motions {
namespace {

// The least clearance of a question in plain doubles: a guess, which exact questions then confirm.

struct Nearest {
  double clearance = 0.0;  ///< m, rounded; no less than -reach
  double time = 0.0;       ///< s
  Vec2 place;              ///< m
  double size = 0.0;       ///< m, of the lengths whose rounding counts
  double reach = 0.0;      ///< m, the largest reach, rounded up: no clearance is below its negative
};

/// The search ends when its bounds are this share of the lengths apart, or after this many pieces.
constexpr double kSearchShare = 0x1p-42;
constexpr int kMostSearchPieces = 2000;

struct Hull {
  std::vector<Vec2> vertices;
  double reach = 0.0;
  const Target* target = nullptr;
};

/// The point of a hull that is nearest to a point, which lies between two corners.
struct Foot {
  double distance = kInfinity;  ///< 0 inside
  std::size_t corner = 0;
  double share = 0.0;  ///< of the way to the next corner
};

Foot foot_of(const Hull& hull, Vec2 p) {
  Foot foot;
  const std::size_t n = hull.vertices.size();
  bool inside = n > 2;
  for (std::size_t i = 0; i < (n == 2 ? 1 : n); ++i) {
    const Vec2 a = hull.vertices[i], b = hull.vertices[(i + 1) % n];
    if (cross(b - a, p - a) < 0.0) inside = false;
    const double share = nearest_share(a, b, p);
    const double distance = norm(p - (a + share * (b - a)));
    if (distance < foot.distance) foot = {distance, i, share};
  }
  if (inside) foot.distance = 0.0;
  return foot;
}

bool cross_properly(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  return cross(b - a, c - a) * cross(b - a, d - a) < 0.0 && cross(d - c, a - c) * cross(d - c, b - c) < 0.0;
}

/// Where on the way from a to b the hull is nearest, as a share of it.
struct OnWay {
  double distance = kInfinity;
  double share = 0.0;
};

OnWay nearest_on_way(const Hull& hull, Vec2 a, Vec2 b) {
  OnWay best;
  const auto take = [&](double distance, double share) {
    if (distance < best.distance) best = {distance, share};
  };
  take(foot_of(hull, a).distance, 0.0);
  take(foot_of(hull, b).distance, 1.0);
  const std::size_t n = hull.vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 v = hull.vertices[i], w = hull.vertices[(i + 1) % n];
    const double share = nearest_share(a, b, v);
    take(norm(v - (a + share * (b - a))), share);
    if (n > 1 && cross_properly(a, b, v, w)) take(0.0, cross(w - v, v - a) / cross(w - v, b - a));
  }
  return best;
}

/// The way over a part of the window, as control points, and bounds of its clearance.
struct WayPiece {
  std::vector<Vec2> points;
  double from = 0.0, to = 1.0;  ///< shares of the window
  double at_least = 0.0;
  friend bool operator<(const WayPiece& a, const WayPiece& b) { return a.at_least > b.at_least; }
};

class Search {
 public:
  Search(const Question& q, Window over) : q_(q), over_(over) {
    Path<RunningError> path = relative_path<RunningError>(q.motion(), q.other(), over);
    if (path.c.size() == 1) path.c.push_back({RunningError(0.0), RunningError(0.0)});
    to_control_points(path);
    const double scale = path.scale.value;
    for (const Vector<RunningError>& p : path.c) whole_.points.push_back({p.x.value / scale, p.y.value / scale});
    const Vec2 origin = origin_of(q.motion());
    for (const Target& t : q.targets()) {
      Hull hull{{}, t.reach + t.other_reach, &t};
      for (const Corner& c : t.corners) hull.vertices.push_back((q.other_origin() - origin) + (c.plus - c.minus));
      for (const Vec2 v : hull.vertices) size_ = std::max({size_, std::fabs(v.x), std::fabs(v.y)});
      reach_ = std::max(reach_, hull.reach * (1.0 + 0x1p-50));
      hulls_.push_back(std::move(hull));
    }
    for (const Vec2 p : whole_.points) size_ = std::max({size_, std::fabs(p.x), std::fabs(p.y)});
    size_ = std::max(size_, reach_);
  }

  Nearest operator()() {
    best_.clearance = kInfinity;
    if (starts_inside()) {
      best_.clearance = -reach_;
      best_share_ = 0.0;
    } else {
      search();
    }
    return described();
  }

 private:
  /// Looks along the chord: an actual clearance from above, and a bound from below by how far the curve strays.
  void look_at(WayPiece& piece) {
    const std::vector<Vec2>& p = piece.points;
    const std::size_t d = p.size() - 1;
    double stray = 0.0;
    for (std::size_t i = 1; i < d; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(d);
      stray = std::max(stray, norm(p[i] - (p[0] + share * (p[d] - p[0]))));
    }
    piece.at_least = kInfinity;
    for (const Hull& hull : hulls_) {
      const OnWay on_way = nearest_on_way(hull, p.front(), p.back());
      piece.at_least = std::min(piece.at_least, std::max(on_way.distance - stray, 0.0) - hull.reach);
      const double share = d < 2 ? on_way.share : std::round(on_way.share);
      const double distance = d < 2 ? on_way.distance : foot_of(hull, share > 0.0 ? p.back() : p.front()).distance;
      if (distance - hull.reach < best_.clearance) {
        best_.clearance = distance - hull.reach;
        best_share_ = piece.from + share * (piece.to - piece.from);
        best_hull_ = &hull;
      }
    }
  }

  void search() {
    std::priority_queue<WayPiece> open;
    look_at(whole_);
    open.push(whole_);
    for (int looked_at = 0; looked_at < kMostSearchPieces && !open.empty(); ++looked_at) {
      const WayPiece piece = open.top();
      open.pop();
      if (piece.at_least >= best_.clearance - kSearchShare * size_ || piece.points.size() <= 2) break;
      WayPiece first{{}, piece.from, 0.5 * (piece.from + piece.to)}, second{piece.points, first.to, piece.to};
      for (std::size_t k = 0; k < piece.points.size(); ++k) {
        first.points.push_back(second.points[0]);
        for (std::size_t i = 0; i + 1 < piece.points.size() - k; ++i)
          second.points[i] = 0.5 * (second.points[i] + second.points[i + 1]);
      }
      for (WayPiece* half : {&first, &second}) {
        look_at(*half);
        open.push(*half);
      }
    }
  }

  bool starts_inside() const {
    const Vec2 origin = origin_of(q_.motion());
    for (const Anchor& anchor : q_.anchors()) {
      Vec2 at = origin + whole_.points.front();
      for (const Vec2 c : anchor.corners) at += c / static_cast<double>(anchor.corners.size());
      bool inside = false;
      for (const Segment& e : q_.edges()) {
        if ((e.a.y > at.y) == (e.b.y > at.y)) continue;
        if ((cross(e.b - e.a, at - e.a) > 0.0) == (e.b.y > e.a.y)) inside = !inside;
      }
      if (inside) return true;
    }
    return false;
  }

  /// The way's point at a share of the window.
  Vec2 at(double share) const {
    std::vector<Vec2> p = whole_.points;
    for (std::size_t n = p.size(); n > 1; --n)
      for (std::size_t i = 0; i + 1 < n; ++i) p[i] = (1.0 - share) * p[i] + share * p[i + 1];
    return p[0];
  }

  Nearest described() const {
    Nearest nearest = best_;
    nearest.size = size_;
    nearest.reach = reach_;
    const double time = over_.from + best_share_ * (over_.to - over_.from);
    nearest.time = std::isfinite(time) ? std::clamp(time, over_.from, over_.to) : over_.from;
    nearest.place = position_at(q_.motion(), nearest.time);
    if (!best_hull_) return nearest;
    // From the body's own nearest corner on, halfway into the gap or the overlap.
    const Vec2 p = at(best_share_);
    const Foot foot = foot_of(*best_hull_, p);
    const std::vector<Corner>& corners = best_hull_->target->corners;
    const Vec2 here = corners[foot.corner].minus, next = corners[(foot.corner + 1) % corners.size()].minus;
    const Vec2 from = best_hull_->vertices[foot.corner];
    const Vec2 to = best_hull_->vertices[(foot.corner + 1) % corners.size()];
    const Vec2 way = from + foot.share * (to - from) - p;
    nearest.place += here + foot.share * (next - here);
    nearest.place += (best_hull_->target->reach + 0.5 * nearest.clearance) * normalized(way);
    return nearest;
  }

  const Question& q_;
  const Window over_;
  std::vector<Hull> hulls_;
  WayPiece whole_;
  Nearest best_;
  double best_share_ = 0.0;
  const Hull* best_hull_ = nullptr;
  double size_ = 0.0, reach_ = 0.0;
};

/// REQUIRES: `over` is a part of the question's window.
Nearest nearest_of(const Question& q, Window over) {
  return Search(q, over)();
}

}  // namespace
}  // namespace exactvo::geometry::motions

namespace exactvo::geometry {
namespace {

using motions::Question;
using motions::Window;

/// A moment is enclosed to this share of the window, or by two neighbouring doubles.
constexpr double kMomentShare = 0x1p-36;
/// The first try encloses a clearance to this share of the lengths involved; if it fails, eight times as much, and so
/// on.
constexpr double kClearanceShare = 0x1p-44;

/// Whether a part of the window has the whole's verdict.
struct Meets {
  const Question& question;
  Encounter encounter;
  bool operator()(Window w) const { return question.decide(w) >= encounter; }
};

/// A double strictly between two, or one of them where there is none.
double middle_of(double low, double high) {
  return low + 0.5 * (high - low);
}

/// The first moment that meets, or the last one. `met` is a moment by which there has been one, or from which on.
Bounds outermost_moment(const Meets& meets, double met, bool first) {
  const Window whole = meets.question.window();
  const double end = first ? whole.from : whole.to;
  if (meets({end, end})) return {end, end};
  const double fine = kMomentShare * (whole.to - whole.from);
  double low = first ? end : met, high = first ? met : end;
  while (high - low > fine) {
    const double middle = middle_of(low, high);
    if (!(low < middle && middle < high)) break;
    const bool is_outside = meets(first ? Window{low, middle} : Window{middle, high});
    (is_outside == first ? high : low) = middle;
  }
  return {low, high};
}

/// A moment that meets, found by halving. Nothing where only single moments meet, between the doubles.
std::optional<double> some_moment(const Meets& meets) {
  Window w = meets.question.window();
  const double fine = kMomentShare * (w.to - w.from);
  for (;;) {
    const double middle = middle_of(w.from, w.to);
    if (meets({middle, middle})) return middle;
    if (!(w.to - w.from > fine && w.from < middle && middle < w.to)) return std::nullopt;
    (meets({w.from, middle}) ? w.to : w.from) = middle;
  }
}

/// Encloses the clearance: `guess` comes first, each bound is confirmed exactly. No clearance is below -`reach`.
Bounds clearance_of(const Question& q, double guess, double size, double reach) {
  const Window whole = q.window();
  Bounds bounds{-reach, kInfinity};
  for (double by = kClearanceShare * size; std::isfinite(by); by *= 8.0) {
    const double low = guess - by;
    if (low <= -reach) break;
    if (q.compare_clearance(whole, low) != Encounter::overlap) {
      bounds.low = low;
      break;
    }
  }
  for (double by = kClearanceShare * size; std::isfinite(by); by *= 8.0) {
    const double high = guess + by;
    if (q.compare_clearance(whole, high) != Encounter::clear) {
      bounds.high = high;
      break;
    }
  }
  return bounds;
}

MotionVerdict examined(const Question& q) {
  MotionVerdict verdict;
  const Window whole = q.window();
  if (whole.from > whole.to) {
    verdict.clearance = {kInfinity, kInfinity};
    return verdict;
  }
  verdict.encounter = q.verdict();
  const motions::Nearest nearest = motions::nearest_of(q, whole);
  verdict.nearest_time = nearest.time;
  verdict.place = nearest.place;
  if (verdict.encounter != Encounter::contact)
    verdict.clearance = clearance_of(q, nearest.clearance, nearest.size, nearest.reach);
  if (verdict.encounter == Encounter::clear) {
    verdict.clearance.low = std::max(verdict.clearance.low, 0.0);
    return verdict;
  }
  verdict.clearance.high = std::min(verdict.clearance.high, 0.0);
  const Meets meets{q, verdict.encounter};
  const double t = nearest.time;
  const bool there = meets({t, t});
  verdict.first = outermost_moment(meets, there || meets({whole.from, t}) ? t : whole.to, true);
  verdict.last = outermost_moment(meets, there || meets({t, whole.to}) ? t : whole.from, false);
  if (there || verdict.encounter == Encounter::contact) return verdict;
  // Polygons that touch are as near as those that overlap: they may only touch at `t`.
  if (const std::optional<double> moment = some_moment(meets)) {
    verdict.nearest_time = *moment;
    verdict.place = motions::nearest_of(q, {*moment, *moment}).place;
  }
  return verdict;
}

}  // namespace

StraightMotion held(TimedPoint from, double until) {
  return {from, {until, from.at}};
}

CurvedMotion hermite_cubic(const TimedPoint& from, Vec2 velocity, const TimedPoint& to, Vec2 end_velocity) {
  EXACTVO_REQUIRE(is_finite(velocity) && is_finite(end_velocity), excerpt({velocity, end_velocity}));
  const double third = (to.time - from.time) / 3.0;
  return {CurveBasis::bezier,
          from.time,
          to.time,
          {from.at, from.at + third * velocity, to.at - third * end_velocity, to.at}};
}

Vec2 catmull_rom_velocity(const TimedPoint& before, const TimedPoint& after) {
  EXACTVO_REQUIRE(before.time < after.time, hex_text(before.time) + " " + hex_text(after.time));
  const Vec2 velocity = (after.at - before.at) / (after.time - before.time);
  return is_finite(velocity) ? velocity : Vec2{};
}

std::vector<CurvedMotion> b_spline_pieces(const std::vector<Vec2>& control_points, std::size_t degree, double start,
                                          double interval) {
  EXACTVO_REQUIRE(degree <= kMostDegree, std::to_string(degree));
  EXACTVO_REQUIRE(control_points.size() > degree, std::to_string(control_points.size()) + " control points");
  EXACTVO_REQUIRE(std::isfinite(start) && std::isfinite(interval) && interval > 0.0,
                  hex_text(start) + " " + hex_text(interval));
  std::vector<CurvedMotion> pieces;
  const auto knot = [&](std::size_t k) { return start + static_cast<double>(k) * interval; };
  for (std::size_t k = 0; k + degree < control_points.size(); ++k) {
    const auto first = control_points.begin() + static_cast<std::ptrdiff_t>(k);
    pieces.push_back({CurveBasis::b_spline, knot(k), knot(k + 1),
                      std::vector<Vec2>(first, first + static_cast<std::ptrdiff_t>(degree + 1))});
  }
  return pieces;
}

double start_of(const Motion& motion) {
  if (const auto* straight = std::get_if<StraightMotion>(&motion)) return straight->from.time;
  return std::get<CurvedMotion>(motion).start;
}

double end_of(const Motion& motion) {
  if (const auto* straight = std::get_if<StraightMotion>(&motion)) return straight->to.time;
  return std::get<CurvedMotion>(motion).end;
}

Vec2 position_at(const Motion& motion, double time) {
  EXACTVO_REQUIRE(start_of(motion) <= time && time <= end_of(motion), hex_text(time));
  const auto path = motions::path_of<detail::RunningError>(motion, {time, time});
  const double scale = path.scale.value;
  return motions::origin_of(motion) + Vec2{path.c[0].x.value / scale, path.c[0].y.value / scale};
}

RigidBody disc_body(double radius) {
  EXACTVO_REQUIRE(radius >= 0.0 && std::isfinite(radius), hex_text(radius));
  return {{{Vec2{}}, radius}};
}

RigidBody polygon_body(const Polygon& outline) {
  EXACTVO_REQUIRE(outline.holes.empty(), std::to_string(outline.holes.size()) + " holes");
  RigidBody body;
  for (const ConvexShape& piece : convex_cover(outline)) body.push_back({corners_of(piece), 0.0});
  return body;
}

RigidBody turned_body(RigidBody body, double angle) {
  EXACTVO_REQUIRE(std::isfinite(angle), hex_text(angle));
  if (angle == 0.0) return body;
  for (RoundedPolygon& part : body)
    for (Vec2& corner : part.corners) corner = rotated(corner, angle);
  return body;
}

Encounter encounter(const Motion& a, const RigidBody& body_a, const Motion& b, const RigidBody& body_b) {
  const Question q(a, body_a, b, body_b);
  return q.window().from > q.window().to ? Encounter::clear : q.verdict();
}

Encounter encounter(const Motion& a, const RigidBody& body_a, const Obstacle& obstacle) {
  return Question(a, body_a, obstacle).verdict();
}

MotionVerdict examine(const Motion& a, const RigidBody& body_a, const Motion& b, const RigidBody& body_b) {
  return examined(Question(a, body_a, b, body_b));
}

MotionVerdict examine(const Motion& a, const RigidBody& body_a, const Obstacle& obstacle) {
  return examined(Question(a, body_a, obstacle));
}

}  // namespace exactvo::geometry
