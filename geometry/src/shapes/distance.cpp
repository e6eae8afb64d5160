// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/require.h"
#include "shapes/edge_crossing.h"

namespace exactvo::geometry {
namespace {

double length(Vec2 d) {
  return std::hypot(d.x, d.y);
}

// How far a computed distance is from the true one, in units of u M: u = 2^-53, M the largest coordinate; to first
// order.
//
// nearest_point. w = (x - a) / scale and e = along / scale have 2 u in each entry, so w.e has 6 u |w||e|, e.e 6 u and
// the quotient u more: t is off by 13 u |w| / |e|, and t along by 13 u |x - a| <= 13 u 2 sqrt(2) M < 37 u M along the
// segment; clamping t to [0, 1] does not add to it. As t <= 1/2 from the nearer end, the point itself is rounded by at
// most (u + u) M + u M in each entry. distance. x - p is rounded by 2 u M in each entry, together 5 sqrt(2) u M < 8 u
// M; hypot (within an ulp) by another 2 u 2 sqrt(2) M < 6 u M. The sum is 51 u M. Between segments it is the least of
// four such, or an exact 0. swept_distance of two paths: the differences of coordinates are up to 2 M, hence 102, and
// rounded by 2 u M in each entry, hence 105 in all. 128 leaves room for the terms of second order.
constexpr double kRoundingOfDistance = 128 * 0x1p-53;
// Products and quotients that underflow are off by less than this in all.
constexpr double kUnderflowOfDistance = 0x1p-1020;

bool boxes_are_apart(const Segment& s, const Segment& t) {
  return std::max(s.a.x, s.b.x) < std::min(t.a.x, t.b.x) || std::max(t.a.x, t.b.x) < std::min(s.a.x, s.b.x) ||
         std::max(s.a.y, s.b.y) < std::min(t.a.y, t.b.y) || std::max(t.a.y, t.b.y) < std::min(s.a.y, s.b.y);
}

// Whether the line of s has the ends of t on both sides or touches one. For collinear segments whose boxes meet, true.
bool line_separates(const Segment& s, const Segment& t) {
  return static_cast<int>(orientation(s.a, s.b, t.a)) * static_cast<int>(orientation(s.a, s.b, t.b)) <= 0;
}

// Calls `visit` with every edge, without building a list: these functions run in every step of a simulation.
template <class Visit>
void for_each_edge(const Ring& ring, const Visit& visit) {
  for (std::size_t i = 0, last = ring.size() - 1; i < ring.size(); last = i++) visit(Segment{ring[last], ring[i]});
}

template <class Visit>
void for_each_edge(const Polygon& polygon, const Visit& visit) {
  for_each_edge(polygon.outer, visit);
  for (const Ring& hole : polygon.holes) for_each_edge(hole, visit);
}

template <class Visit>
void for_each_edge(const Polyline& polyline, const Visit& visit) {
  const auto& points = polyline.points;
  if (points.size() == 1) visit(Segment{points[0], points[0]});
  for (std::size_t i = 1; i < points.size(); ++i) visit(Segment{points[i - 1], points[i]});
}

template <class Query>
double edge_distance(const Obstacle& obstacle, const Query& query) {
  double least = kInfinity;
  const auto look_at = [&](const Segment& edge) { least = std::min(least, distance(edge, query)); };
  std::visit([&](const auto& shape) { for_each_edge(shape, look_at); }, obstacle);
  return least;
}

bool is_inside(const Obstacle& obstacle, Vec2 x) {
  const auto* polygon = std::get_if<Polygon>(&obstacle);
  return polygon != nullptr && contains(*polygon, x);
}

double signed_distance(const Obstacle& obstacle, Vec2 x, bool inside) {
  const double d = edge_distance(obstacle, x);
  return inside ? -d : d;
}

/// The least of the four lengths. Only those are taken that its square, which is quick, does not show to be longer.
double least_length(const std::array<Vec2, 4>& all) {
  constexpr double kRounding = 1.0 + 1e-12;
  constexpr double kLeastSquare = 0x1p-900, kMostSquare = 0x1p900;
  const double squares[] = {squared_norm(all[0]), squared_norm(all[1]), squared_norm(all[2]), squared_norm(all[3])};
  const double least_square = *std::min_element(std::begin(squares), std::end(squares));
  const bool is_sound = least_square > kLeastSquare && least_square < kMostSquare;
  double least = kInfinity;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!is_sound || squares[i] <= kRounding * least_square) least = std::min(least, length(all[i]));
  return least;
}

}  // namespace

// Differences are scaled by the longer side, so neither a tiny nor a huge segment loses its squares.
Vec2 nearest_point(const Segment& s, Vec2 x) {
  const Vec2 along = s.b - s.a;
  const double scale = std::max(std::fabs(along.x), std::fabs(along.y));
  if (!(scale > 0.0)) return s.a;
  const Vec2 e = along / scale;
  const double t = dot((x - s.a) / scale, e) / dot(e, e);
  if (!(t > 0.0)) return s.a;
  if (!(t < 1.0)) return s.b;
  return t <= 0.5 ? s.a + t * along : s.b - (1.0 - t) * along;
}

double distance(const Segment& s, Vec2 x) {
  return length(x - nearest_point(s, x));
}

bool intersect(const Segment& s, const Segment& t) {
  return !boxes_are_apart(s, t) && line_separates(s, t) && line_separates(t, s);
}

double distance(const Segment& s, const Segment& t) {
  if (intersect(s, t)) return 0.0;
  return least_length({t.a - nearest_point(s, t.a), t.b - nearest_point(s, t.b), s.a - nearest_point(t, s.a),
                       s.b - nearest_point(t, s.b)});
}

double signed_distance(const Obstacle& obstacle, Vec2 x) {
  EXACTVO_REQUIRE(is_finite(x), hex_text(x.x) + " " + hex_text(x.y));
  return signed_distance(obstacle, x, is_inside(obstacle, x));
}

double swept_distance(const Obstacle& obstacle, const Segment& path) {
  EXACTVO_REQUIRE(is_valid(path), to_string(path));
  const bool starts_inside = is_inside(obstacle, path.a);
  const bool ends_inside = is_inside(obstacle, path.b);
  if (!starts_inside && !ends_inside) return edge_distance(obstacle, path);
  return std::min(signed_distance(obstacle, path.a, starts_inside), signed_distance(obstacle, path.b, ends_inside));
}

double swept_distance(const Segment& path_a, const Segment& path_b) {
  return distance(Segment{path_a.a - path_b.a, path_a.b - path_b.b}, Vec2{});
}

double rounding_of_distance(double largest_coordinate) {
  EXACTVO_REQUIRE(std::isfinite(largest_coordinate) && largest_coordinate >= 0.0, hex_text(largest_coordinate));
  return kRoundingOfDistance * largest_coordinate + kUnderflowOfDistance;
}

Place locate(const Polygon& polygon, Vec2 x) {
  EXACTVO_REQUIRE(is_finite(x), hex_text(x.x) + " " + hex_text(x.y));
  return detail::even_odd_place(x, [&](const auto& visit) { for_each_edge(polygon, visit); });
}

bool contains(const Polygon& polygon, Vec2 x) {
  return locate(polygon, x) != Place::outside;
}

}  // namespace exactvo::geometry
