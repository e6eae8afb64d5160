// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/shape_numbers.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry {
namespace {

bool valid(const Disc& d) {
  return is_finite(d.center) && std::isfinite(d.radius) && d.radius >= 0.0;
}
bool valid(const Segment& s) {
  return is_finite(s.a) && is_finite(s.b);
}

// One point, a segment, or once round; a vertex may be listed twice running, which only the slow path looks into.
bool bounds_a_convex_set(const std::vector<Vec2>& vertices) {
  if (detail::is_convex_ccw(vertices) || detail::on_one_line(vertices)) return true;
  std::vector<Vec2> distinct = vertices;
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  if (distinct.front() == distinct.back()) distinct.pop_back();
  return detail::is_convex_ccw(distinct);
}

bool valid(const ConvexPolygon& p) {
  return !p.vertices.empty() && std::all_of(p.vertices.begin(), p.vertices.end(), is_finite) &&
         bounds_a_convex_set(p.vertices);
}
bool valid(const Ellipse& e) {
  return is_finite(e.center) && std::isfinite(e.l11) && std::isfinite(e.l21) && std::isfinite(e.l22);
}

void append_chain(const std::vector<Vec2>& points, std::vector<Segment>& out) {
  for (std::size_t i = 1; i < points.size(); ++i) out.push_back({points[i - 1], points[i]});
}

void append_ring(const Ring& ring, std::vector<Segment>& out) {
  append_chain(ring, out);
  if (ring.size() > 1) out.push_back({ring.back(), ring.front()});
}

std::string text(Vec2 p) {
  return hex_text(p.x) + " " + hex_text(p.y);
}

}  // namespace

// M = R diag(a, b) maps the unit disc to the ellipse; L is M times the rotation that clears the upper right entry:
//   [a c, -b s]     [l11   0 ]        l11 = hypot(a c, b s),  l21 = (a^2 - b^2) s c / l11,  l22 = a b / l11.
//   [a s,  b c] Q = [l21  l22]
Ellipse ellipse_from_axes(Vec2 center, EllipseAxes axes) {
  const double a = axes.a;
  const double b = axes.b;
  EXACTVO_REQUIRE(std::isfinite(a) && b >= 0.0 && a >= b && std::isfinite(axes.angle) && is_finite(center),
                  "a = " + hex_text(a) + ", b = " + hex_text(b) + ", angle = " + hex_text(axes.angle));
  const double c = std::cos(axes.angle);
  const double s = std::sin(axes.angle);
  const double l11 = std::hypot(a * c, b * s);
  if (!(l11 > 0.0)) return {center, 0.0, a, 0.0};  // underflow: the ellipse is its a axis, upright or a point
  return {center, l11, ((a - b) * s) * ((a + b) / l11 * c), a * (b / l11)};
}

EllipseAxes axes_of(const Ellipse& ellipse) {
  // What the squares below are scaled by, so that none over- or underflows.
  const double scale = std::max({std::fabs(ellipse.l11), std::fabs(ellipse.l21), std::fabs(ellipse.l22)});
  if (!(scale > 0.0)) return {};
  const double x = ellipse.l11 / scale;
  const double y = ellipse.l21 / scale;
  const double z = ellipse.l22 / scale;
  const double a = 0.5 * (std::hypot(x + z, y) + std::hypot(x - z, y));
  const double b = std::min(a, std::fabs(x * z) / a);  // det / a: no cancellation for needles
  double angle = 0.5 * std::atan2(2.0 * x * y, (x - y) * (x + y) - z * z);
  if (angle <= -0.5 * kPi) angle = 0.5 * kPi;
  return {a * scale, b * scale, angle};
}

double area(const Ellipse& ellipse) {
  return kPi * std::fabs(ellipse.l11 * ellipse.l22);
}

bool is_valid(const ConvexShape& shape) {
  return std::visit([](const auto& s) { return valid(s); }, shape);
}

std::vector<Vec2> corners_of(const ConvexShape& shape) {
  if (const auto* s = std::get_if<Segment>(&shape)) return {s->a, s->b};
  if (const auto* p = std::get_if<ConvexPolygon>(&shape)) return p->vertices;
  return {};
}

std::vector<Segment> edges_of(const Obstacle& obstacle) {
  std::vector<Segment> edges;
  if (const auto* polyline = std::get_if<Polyline>(&obstacle)) {
    append_chain(polyline->points, edges);
    return edges;
  }
  const auto& polygon = std::get<Polygon>(obstacle);
  append_ring(polygon.outer, edges);
  for (const Ring& hole : polygon.holes) append_ring(hole, edges);
  return edges;
}

std::vector<Vec2> vertices_of(const Obstacle& obstacle) {
  if (const auto* polyline = std::get_if<Polyline>(&obstacle)) return polyline->points;
  const auto& polygon = std::get<Polygon>(obstacle);
  std::vector<Vec2> vertices = polygon.outer;
  for (const Ring& hole : polygon.holes) vertices.insert(vertices.end(), hole.begin(), hole.end());
  return vertices;
}

void shift(Obstacle& obstacle, Vec2 by) {
  const auto shift_all = [by](std::vector<Vec2>& points) {
    for (Vec2& p : points) p += by;
  };
  if (auto* polyline = std::get_if<Polyline>(&obstacle)) return shift_all(polyline->points);
  auto& polygon = std::get<Polygon>(obstacle);
  shift_all(polygon.outer);
  for (Ring& hole : polygon.holes) shift_all(hole);
}

std::string hex_text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%a", value);
  return buffer;
}

std::string to_string(const std::vector<Vec2>& points) {
  std::string out = std::to_string(points.size());
  for (const Vec2 p : points) out += " " + text(p);
  return out;
}

std::string excerpt(const std::vector<Vec2>& points) {
  if (points.size() <= kVerticesShown) return to_string(points);
  std::string out = std::to_string(points.size()) + " points, first";
  for (std::size_t i = 0; i < kVerticesShown; ++i) out += " " + text(points[i]);
  return out + " ...";
}

std::string to_string(const ConvexShape& shape) {
  constexpr const char* kKinds[] = {"disc", "segment", "convex_polygon", "ellipse"};
  std::string out = kKinds[shape.index()];
  if (const auto* polygon = std::get_if<ConvexPolygon>(&shape)) return out + " " + to_string(polygon->vertices);
  for (const double x : numbers_of(shape)) out += " " + hex_text(x);
  return out;
}

std::vector<double> numbers_of(const ConvexShape& shape) {
  if (const auto* d = std::get_if<Disc>(&shape)) return {d->center.x, d->center.y, d->radius};
  if (const auto* e = std::get_if<Ellipse>(&shape)) return {e->center.x, e->center.y, e->l11, e->l21, e->l22};
  std::vector<double> all;
  for (const Vec2 v : corners_of(shape)) all.insert(all.end(), {v.x, v.y});
  return all;
}

std::optional<ConvexShape> shape_of(std::size_t kind, const std::vector<double>& v) {
  if (kind == 0 && v.size() == 3) return Disc{{v[0], v[1]}, v[2]};
  if (kind == 1 && v.size() == 4) return Segment{{v[0], v[1]}, {v[2], v[3]}};
  if (kind == 3 && v.size() == 5) return Ellipse{{v[0], v[1]}, v[2], v[3], v[4]};
  if (kind != 2 || v.size() % 2 != 0) return std::nullopt;
  ConvexPolygon polygon;
  for (std::size_t k = 0; k < v.size(); k += 2) polygon.vertices.push_back({v[k], v[k + 1]});
  return polygon;
}

}  // namespace exactvo::geometry
