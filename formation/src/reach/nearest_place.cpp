// SPDX-License-Identifier: GPL-3.0-or-later
#include "reach/nearest_place.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/pi.h"

namespace exactvo::formation::detail {
namespace {

using geometry::Segment;

/// Where centres stand at an offset from an edge: on two pieces of lines and two circles.
struct Outline {
  Segment left, right;
  Vec2 circles[2];  ///< centres
};

Outline outline_of(const Segment& edge, double offset) {
  const Vec2 along = edge.b - edge.a;
  const Vec2 out = norm(along) > 0.0 ? (offset / norm(along)) * Vec2{-along.y, along.x} : Vec2{};
  return {{edge.a + out, edge.b + out}, {edge.a - out, edge.b - out}, {edge.a, edge.b}};
}

void cross_lines(const Segment& s, const Segment& t, std::vector<Vec2>& out) {
  const Vec2 d = s.b - s.a, e = t.b - t.a;
  const double area = cross(d, e);
  if (area == 0.0) return;
  const double along = cross(t.a - s.a, e) / area, other = cross(t.a - s.a, d) / area;
  if (along >= 0.0 && along <= 1.0 && other >= 0.0 && other <= 1.0) out.push_back(s.a + along * d);
}

void cross_line_circle(const Segment& s, Vec2 centre, double radius, std::vector<Vec2>& out) {
  const Vec2 d = s.b - s.a;
  const double length = norm(d);
  if (length == 0.0) return;
  const Vec2 unit = d / length;
  const double foot = dot(centre - s.a, unit), height = cross(centre - s.a, unit);
  if (!(std::fabs(height) < radius)) return;
  const double half = std::sqrt(radius * radius - height * height);
  for (const double along : {foot - half, foot + half})
    if (along >= 0.0 && along <= length) out.push_back(s.a + along * unit);
}

void cross_circles(Vec2 a, Vec2 b, double radius, std::vector<Vec2>& out) {
  const Vec2 between = b - a;
  const double apart = norm(between);
  if (apart == 0.0 || !(apart < 2.0 * radius)) return;
  const double height = std::sqrt(radius * radius - 0.25 * apart * apart);
  const Vec2 up = (height / apart) * Vec2{-between.y, between.x};
  out.push_back(a + 0.5 * between + up);
  out.push_back(a + 0.5 * between - up);
}

void cross_outlines(const Outline& s, const Outline& t, double offset, std::vector<Vec2>& out) {
  for (const Segment* side : {&s.left, &s.right}) {
    for (const Segment* other : {&t.left, &t.right}) cross_lines(*side, *other, out);
    for (const Vec2 centre : t.circles) cross_line_circle(*side, centre, offset, out);
  }
  for (const Vec2 centre : s.circles) {
    for (const Segment* other : {&t.left, &t.right}) cross_line_circle(*other, centre, offset, out);
    for (const Vec2 other : t.circles) cross_circles(centre, other, offset, out);
  }
}

}  // namespace

std::string words_of(const NearestPlace& nearest) {
  constexpr double kShown = 1e3;  // to the millimetre, the bound down
  const double least = std::floor(kShown * nearest.at_least) / kShown;
  const std::string at = metres(nearest.distance) + " from it";
  return least > 0.0 ? at + " (no place nearer than " + metres(least) + " can be reached)" : at;
}

/// The feet of the goal on the outlines of single edges. An edge that is `offset` away from a place nearer to the goal
/// is itself no farther than both together.
std::vector<NearestPlaces::Candidate> NearestPlaces::feet(double offset, Vec2 goal, double nearer_than) const {
  constexpr int kDirections = 16;  // about a vertex in which the goal lies: then all are as near
  std::vector<Candidate> all;
  const auto add = [&](Vec2 place) {
    if (norm(place - goal) < nearer_than) all.push_back({norm(place - goal), place});
  };
  const auto add_feet_of = [&](const Segment& edge) {
    const Outline outline = outline_of(edge, offset);
    for (const Segment& side : {outline.left, outline.right})
      if (!(side.a == side.b)) add(geometry::nearest_point(side, goal));
    for (const Vec2 centre : outline.circles) {
      const Vec2 towards = goal - centre;
      if (norm(towards) > 0.0) {
        add(centre + (offset / norm(towards)) * towards);
        continue;
      }
      for (int k = 0; k < kDirections; ++k)
        add(centre + geometry::rotated({offset, 0.0}, 2.0 * geometry::kPi * k / kDirections));
    }
  };
  if (std::isinf(nearer_than))
    for (const Segment& edge : reach_.edges().all()) add_feet_of(edge);
  else
    reach_.edges().grid().for_each_within(goal, nearer_than + offset,
                                          [&](std::size_t k) { add_feet_of(reach_.edges()[k]); });
  return all;
}

/// Where the outlines of two edges meet.
std::vector<NearestPlaces::Candidate> NearestPlaces::crossings(double offset, Vec2 goal, double nearer_than) const {
  std::vector<Candidate> all;
  std::vector<Vec2> points;
  reach_.edges().grid().for_each_within(goal, nearer_than + offset, [&](std::size_t i) {
    const Outline outline = outline_of(reach_.edges()[i], offset);
    points.clear();
    reach_.edges().grid().for_each_meeting(reach_.edges().grid().box(i).grown(2.0 * offset), [&](std::size_t k) {
      if (k < i) cross_outlines(outline, outline_of(reach_.edges()[k], offset), offset, points);
    });
    for (const Vec2 p : points)
      if (norm(p - goal) < nearer_than) all.push_back({norm(p - goal), p});
  });
  return all;
}

std::optional<NearestPlaces::Candidate> NearestPlaces::first_reachable(std::vector<Candidate> all, double radius,
                                                                       Vec2 from) {
  std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    if (a.distance != b.distance) return a.distance < b.distance;
    return a.place.x != b.place.x ? a.place.x < b.place.x : a.place.y < b.place.y;
  });
  const geometry::RoutePlan& plan = reach_.plan(radius);
  const auto has_room = [&](Vec2 place) {
    bool clear = true;
    reach_.edges().grid().for_each_within(
        place, radius, [&](std::size_t k) { clear = clear && geometry::distance(reach_.edges()[k], place) >= radius; });
    return clear;
  };
  for (const Candidate& c : all)
    if (has_room(c.place) && reach_.map().covers(c.place) && plan.is_reachable(from, c.place)) return c;
  return std::nullopt;
}

/// Whether it has these places, and the disc is free at the first. REQUIRES of all that follows: it is.
bool NearestPlaces::is_map_for(double radius, Vec2 from, Vec2 goal) {
  if (!reach_.map().covers(from) || !reach_.map().covers(goal)) return false;
  return reach_.plan(radius).is_reachable(from, from);
}

/// From edges: half of the room is left for rounding.
double offset_for(double radius, double room) {
  return radius + 1.5 * room;
}

std::optional<NearestPlace> NearestPlaces::nearest(double radius, double room, Vec2 from, Vec2 goal) {
  if (!is_map_for(radius + room, from, goal)) return std::nullopt;
  const double offset = offset_for(radius, room);
  std::vector<Candidate> all = feet(offset, goal, std::numeric_limits<double>::infinity());
  all.push_back({norm(from - goal), from});
  std::optional<Candidate> best = first_reachable(std::move(all), radius + room, from);
  if (!best) return std::nullopt;
  all = crossings(offset, goal, best->distance);
  all.push_back(*best);
  best = first_reachable(std::move(all), radius + room, from);
  return NearestPlace{best->place, best->distance, std::min(best->distance, reach_.at_least(radius, from, goal))};
}

std::optional<Vec2> NearestPlaces::within_reach(double radius, double room, Vec2 from, const Destination& to) {
  constexpr double kWithin = 0.999;  // of the reach, for rounding
  if (!is_map_for(radius + room, from, to.place)) return std::nullopt;
  const double offset = offset_for(radius, room);
  std::vector<Candidate> all = feet(offset, to.place, kWithin * to.reach);
  for (const Candidate& c : crossings(offset, to.place, kWithin * to.reach)) all.push_back(c);
  const std::optional<Candidate> best = first_reachable(std::move(all), radius + room, from);
  return best ? std::optional(best->place) : std::nullopt;
}

}  // namespace exactvo::formation::detail
