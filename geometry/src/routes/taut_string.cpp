// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/taut_string.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/pi.h"

namespace exactvo::geometry::routing {
namespace {

/// The path keeps to circles this much larger than the disc, which pays for the rounding of its corners. A vertex that
/// the path cuts by no more than half of it needs no circle of its own: the other half still pays.
constexpr double kRadiusSlack = 1e-11;
constexpr double kCoordinateSlack = 0x1p-50;

/// In (-pi, pi].
double wrapped(double angle) {
  while (angle > kPi) angle -= 2.0 * kPi;
  while (angle <= -kPi) angle += 2.0 * kPi;
  return angle;
}

/// The ends of what lies within `reach` of the segment; some come several times.
template <typename F>
void for_each_vertex_near(const ClearancePlan& plan, Vec2 from, Vec2 to, double reach, const F& f) {
  plan.grid().for_each_near(from, to, reach, [&](int k) {
    const auto [a, b] = plan.map().ends_of(k);
    f(a);
    f(b);
    return true;
  });
}

}  // namespace

TautString::TautString(const ClearancePlan& plan, Vec2 from, Vec2 to, std::vector<Circle> circles)
    : plan_(plan), from_(from), to_(to), circles_(std::move(circles)) {
  const double size = std::max({std::fabs(from.x), std::fabs(from.y), std::fabs(to.x), std::fabs(to.y)});
  radius_ = plan.radius() * (1.0 + kRadiusSlack) + kCoordinateSlack * size;
}

bool TautString::pull() {
  constexpr int kMostRounds = 400;
  for (int round = 0; round < kMostRounds; ++round) {
    drop_loose_circles();
    tangents_.clear();
    for (std::size_t i = 0; i <= circles_.size(); ++i)
      tangents_.push_back(tangent(i > 0 ? &circles_[i - 1] : nullptr, i < circles_.size() ? &circles_[i] : nullptr));
    if (!take_up_cut_vertices()) return true;
  }
  return false;
}

std::vector<Point> TautString::corners(double step) const {
  std::vector<Point> out;
  for (std::size_t i = 0; i < circles_.size(); ++i) {
    const double turn = wrapped(tangents_[i + 1].angle - tangents_[i].angle);
    const int count = std::max(1, static_cast<int>(std::ceil(std::fabs(turn) / step)));
    const double half = 0.5 * turn / count, reach = radius_ / std::cos(half);
    for (int j = 0; j < count; ++j) {
      const double angle = tangents_[i].angle + (2 * j + 1) * half;
      const double out_of_centre = circles_[i].sense * reach;
      out.emplace_back(circles_[i].centre + Vec2{out_of_centre * std::sin(angle), -out_of_centre * std::cos(angle)});
    }
  }
  return out;
}

TautString::Tangent TautString::tangent(const Circle* from, const Circle* to) const {
  const Vec2 a = from ? from->centre : from_, b = to ? to->centre : to_;
  const double ra = from ? from->sense * radius_ : 0.0, rb = to ? to->sense * radius_ : 0.0;
  const double angle = std::atan2(b.y - a.y, b.x - a.x) + std::asin(std::clamp((ra - rb) / norm(b - a), -1.0, 1.0));
  const Vec2 right{std::sin(angle), -std::cos(angle)};
  return {angle, {a + ra * right, b + rb * right}};
}

/// Goes through the circles once: the string over those kept is taut before the next is looked at, which may let go
/// of some of the last.
void TautString::drop_loose_circles() {
  std::vector<Circle> kept;
  const auto is_loose = [&](const Circle* next) {
    constexpr double kAgainst = 1e-12;  // rad
    const Circle& last = kept.back();
    if (next && next->centre == last.centre) return true;
    const Circle* before = kept.size() > 1 ? &kept[kept.size() - 2] : nullptr;
    return wrapped(tangent(&last, next).angle - tangent(before, &last).angle) * last.sense < -kAgainst;
  };
  for (const Circle& next : circles_) {
    while (!kept.empty() && is_loose(&next)) kept.pop_back();
    kept.push_back(next);
  }
  while (!kept.empty() && is_loose(nullptr)) kept.pop_back();
  circles_ = std::move(kept);
}

/// The vertex that a straight piece cuts deepest becomes a circle of its own; one of each piece.
bool TautString::take_up_cut_vertices() {
  std::vector<Circle> all;
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    if (const std::optional<Circle> cut = deepest_cut(i)) all.push_back(*cut);
    if (i == circles_.size()) break;
    const std::optional<Circle> cut = cut_by_arc(i);
    const double angle = tangents_[i].angle;
    const Vec2 on{std::cos(angle), std::sin(angle)};  // of two vertices in a lump, the first along the way
    const bool before = cut && dot(cut->centre - circles_[i].centre, on) < 0.0;
    if (before) all.push_back(*cut);
    all.push_back(circles_[i]);
    if (cut && !before) all.push_back(*cut);
  }
  const bool any = all.size() > circles_.size();
  circles_ = std::move(all);
  return any;
}

/// A vertex so near to the circle's own that the search took both for one corner, and that the arc cuts though no
/// straight piece does: the way out to it from the centre leads through the arc.
std::optional<Circle> TautString::cut_by_arc(std::size_t i) const {
  const Circle& circle = circles_[i];
  const double slack = 0.5 * (radius_ - plan_.radius());
  constexpr double kLump = 1e-3;  // of the radius; more is a corner of its own to the search
  const double turn = wrapped(tangents_[i + 1].angle - tangents_[i].angle);
  const auto is_neighbour = [&](int v) {
    return v == circle.vertex || (i > 0 && circles_[i - 1].vertex == v) ||
           (i + 1 < circles_.size() && circles_[i + 1].vertex == v);
  };
  double deepest = slack;
  std::optional<Circle> found;
  const auto consider = [&](int v) {
    const Vec2 out = plan_.map().vertex(v).rounded() - circle.centre;
    const double depth = norm(out);
    if (!(depth > deepest) || depth > kLump * radius_ || is_neighbour(v)) return;
    // The route's direction where it passes the point of the arc that is farthest out towards the vertex.
    const double direction = std::atan2(circle.sense * out.x, -circle.sense * out.y);
    const double after = wrapped(direction - tangents_[i].angle) * circle.sense;
    if (!(after > 0.0 && after < std::fabs(turn))) return;
    deepest = depth;
    found = Circle{plan_.map().vertex(v).rounded(), circle.sense, v};
  };
  if (!(turn * circle.sense > 0.0)) return found;
  for_each_vertex_near(plan_, circle.centre, circle.centre, kLump * radius_, consider);
  return found;
}

std::optional<Circle> TautString::deepest_cut(std::size_t i) const {
  const CellMap& map = plan_.map();
  const Segment piece = tangents_[i].piece;
  const Vec2 d = piece.b - piece.a;
  const double length = norm(d);
  double deepest = 0.5 * (radius_ - plan_.radius());
  std::optional<Circle> found;
  if (!(length > 0.0)) return found;
  const auto consider = [&](int v) {
    if ((i > 0 && circles_[i - 1].vertex == v) || (i < circles_.size() && circles_[i].vertex == v)) return;
    const Vec2 p = map.vertex(v).rounded() - piece.a;
    const double on = dot(p, d) / length, left = cross(d, p) / length;
    if (on <= 0.0 || on >= length || !(radius_ - std::fabs(left) > deepest)) return;
    deepest = radius_ - std::fabs(left);
    found = Circle{map.vertex(v).rounded(), left > 0.0 ? 1 : -1, v};
  };
  for_each_vertex_near(plan_, piece.a, piece.b, radius_, consider);
  return found;
}

}  // namespace exactvo::geometry::routing
