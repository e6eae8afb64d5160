// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "exactvo/geometry/require.h"
#include "membership/answers.h"

namespace exactvo::bench {
namespace {

using geometry::cross;
using geometry::dot;
using geometry::Ellipse;
using geometry::GrownShape;
using geometry::squared_norm;
using geometry::Vec2;

struct Plain {
  const GrownShape& s;
  Vec2 v;
  double t_max;

  bool operator()(const geometry::Disc& d) const {
    const Vec2 p = d.center - s.origin;
    const double reach = d.radius + s.radius;
    const double r2 = reach * reach;
    const double speed2 = squared_norm(v);
    const double c = cross(v, p);
    if (c * c > r2 * speed2) return false;
    const double pv = dot(p, v);
    const double beyond = t_max * speed2;
    if (pv > 0.0 && pv < beyond) return true;
    const Vec2 q = pv >= beyond ? t_max * v : Vec2{};
    return squared_norm(p - q) <= r2;
  }

  bool operator()(const Ellipse& e) const {
    const Vec2 p = e.center - s.origin;
    const double np = cross(v, p);
    const Vec2 ln{e.l21 * v.x - e.l11 * v.y, e.l22 * v.x};
    const double speed2 = squared_norm(v);
    const double root = std::sqrt(squared_norm(ln));
    const double reach = s.radius * std::sqrt(speed2);
    if (std::fabs(np) > root + reach) return false;
    const Vec2 ld{e.l11 * v.x + e.l21 * v.y, e.l22 * v.y};
    const double width = root * root + root * reach;
    const double at_start = dot(p, v) * width - np * dot(ld, ln);
    const double at_end = at_start - t_max * speed2 * width;
    if (at_start > 0.0 && at_end < 0.0) return true;
    return holds(e, at_end >= 0.0 ? p - t_max * v : p);
  }

  bool operator()(const geometry::Segment& g) const {
    const Vec2 ends[2] = {g.a, g.b};
    return polygon(ends, 2);
  }
  bool operator()(const geometry::ConvexPolygon& p) const { return polygon(p.vertices.data(), p.vertices.size()); }

 private:
  bool holds(const Ellipse& e, Vec2 u) const {
    const double R = s.radius * s.radius;
    const double trace = e.l11 * e.l11 + e.l21 * e.l21 + e.l22 * e.l22;
    const double det = e.l11 * e.l22;
    const double D = det * det;
    const double x = e.l22 * u.x, y = e.l11 * u.y - e.l21 * u.x;
    const double b = trace + R - squared_norm(u);
    const double c = D + R * trace - (x * x + y * y);
    if (b >= 0.0 && c >= 0.0) return true;
    const double d = R * D;
    return 18.0 * b * c * d - 4.0 * b * b * b * d + b * b * c * c - 4.0 * c * c * c - 27.0 * d * d <= 0.0;
  }

  bool near(Vec2 q, Vec2 a, Vec2 b) const {
    const Vec2 e = b - a, d = q - a;
    const double r2 = s.radius * s.radius;
    const double along = dot(d, e);
    if (along <= 0.0) return squared_norm(d) <= r2;
    const double length2 = squared_norm(e);
    if (along >= length2) return squared_norm(q - b) <= r2;
    const double c = cross(e, d);
    return c * c <= r2 * length2;
  }
  Vec2 vertex(const Vec2* vertices, std::size_t count, std::size_t i) const {
    return vertices[i < count ? i : i - count] - s.origin;
  }
  /// -1 misses, 1 meets, 0 neither is plain; says then whether the ends are clear.
  int slab(const Vec2* vertices, std::size_t count, bool& start_is_clear, bool& end_is_clear) const {
    const double infinity = std::numeric_limits<double>::infinity();
    double left = -infinity, right = infinity, ahead = -infinity, behind = infinity;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec2 p = vertices[i] - s.origin;
      left = std::max(left, cross(v, p));
      right = std::min(right, cross(v, p));
      ahead = std::max(ahead, dot(v, p));
      behind = std::min(behind, dot(v, p));
    }
    const double speed2 = squared_norm(v);
    const double reach = s.radius * std::sqrt(speed2);
    const double beyond = t_max * speed2;
    if ((right > reach) | (left < -reach) | (ahead < -reach) | (behind > beyond + reach)) return -1;
    start_is_clear = behind > reach;
    end_is_clear = ahead < beyond - reach;
    return static_cast<int>((right < reach) & (left > -reach) & (behind > 0.0) & (ahead < beyond));
  }
  bool holds_point(const Vec2* vertices, std::size_t count, Vec2 q) const {
    bool inside = true;
    Vec2 a = vertex(vertices, count, 0);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec2 b = vertex(vertices, count, i + 1);
      if (cross(b - a, q - a) <= 0.0) {
        inside = false;
        if (near(q, a, b)) return true;
      }
      a = b;
    }
    return inside;
  }
  bool polygon(const Vec2* vertices, std::size_t count) const {
    bool start_is_clear = false, end_is_clear = false;
    const int quick = slab(vertices, count, start_is_clear, end_is_clear);
    if (quick != 0) return quick > 0;
    const Vec2 end = t_max * v;
    if (!start_is_clear && holds_point(vertices, count, {})) return true;
    if (!end_is_clear && holds_point(vertices, count, end)) return true;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec2 a = vertex(vertices, count, i), b = vertex(vertices, count, i + 1);
      if (near(a, {}, end)) return true;
      if (cross(b - a, -a) * cross(b - a, end - a) < 0.0 && cross(end, a) * cross(end, b) < 0.0) return true;
    }
    return false;
  }
};

}  // namespace

bool plain_meets(const GrownShape& s, Vec2 v, double t_max) {
  EXACTVO_REQUIRE(geometry::is_finite(v) && t_max >= 0.0 && std::isfinite(t_max), std::to_string(t_max));
  return std::visit(Plain{s, v, t_max}, s.shape);
}

}  // namespace exactvo::bench
