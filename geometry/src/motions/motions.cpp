// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/motions.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/pieces.h"
#include "exactvo/geometry/require.h"
#include "motions/nearest.h"
#include "motions/question.h"

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

/// The first moment that meets. `met` is a moment by which there has been one.
Bounds first_moment(const Meets& meets, double met) {
  const Window whole = meets.question.window();
  if (meets({whole.from, whole.from})) return {whole.from, whole.from};
  const double fine = kMomentShare * (whole.to - whole.from);
  double low = whole.from, high = met;
  while (high - low > fine) {
    const double middle = middle_of(low, high);
    if (!(low < middle && middle < high)) break;
    (meets({low, middle}) ? high : low) = middle;
  }
  return {low, high};
}

/// The last moment that meets. `met` is a moment from which on there has been one.
Bounds last_moment(const Meets& meets, double met) {
  const Window whole = meets.question.window();
  if (meets({whole.to, whole.to})) return {whole.to, whole.to};
  const double fine = kMomentShare * (whole.to - whole.from);
  double low = met, high = whole.to;
  while (high - low > fine) {
    const double middle = middle_of(low, high);
    if (!(low < middle && middle < high)) break;
    (meets({middle, high}) ? low : high) = middle;
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
  verdict.first = first_moment(meets, there || meets({whole.from, t}) ? t : whole.to);
  verdict.last = last_moment(meets, there || meets({t, whole.to}) ? t : whole.from);
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
