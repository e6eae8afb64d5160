// SPDX-License-Identifier: GPL-3.0-or-later
#include "vo/free/oracle.h"

#include <gmpxx.h>
#include <algorithm>
#include <array>
#include <boost/multiprecision/mpfr.hpp>
#include <cmath>
#include <numeric>
#include <utility>

namespace exactvo::test {
namespace {

using boost::multiprecision::allocate_stack;
using boost::multiprecision::et_off;
using boost::multiprecision::mpfr_float_backend;
using boost::multiprecision::number;
using geometry::Vec2;
using Real = number<mpfr_float_backend<200, allocate_stack>, et_off>;

Real power_of_two(int exponent) {
  return ldexp(Real(1), exponent);
}
const Real kZero = power_of_two(-380);        // below: nothing
const Real kSomething = power_of_two(-300);   // above: something
const Real kBeside = power_of_two(-200);      // m/s, of a sample from its stretch
const Real kRound = power_of_two(-150);       // m/s, the circle on which stretches are sorted
const Real kSamePoint = power_of_two(-260);   // m/s
const Real kOtherPoint = power_of_two(-145);  // m/s

/// -1, 0 or 1; throws between nothing and something.
int sign_of(const Real& x) {
  const Real size = abs(x);
  if (size < kZero) return 0;
  if (size < kSomething) throw Ambiguous("a number of size " + size.str(3));
  return x > 0 ? 1 : -1;
}

struct Point {
  Real x, y;
};
Point operator+(const Point& a, const Point& b) {
  return {a.x + b.x, a.y + b.y};
}
Point operator-(const Point& a, const Point& b) {
  return {a.x - b.x, a.y - b.y};
}
Point operator*(const Real& s, const Point& a) {
  return {s * a.x, s * a.y};
}
Real dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y;
}
Real cross(const Point& a, const Point& b) {
  return a.x * b.y - a.y * b.x;
}
Point left_of(const Point& a) {
  return {-a.y, a.x};
}
Point unit(const Point& a) {
  return (1 / sqrt(dot(a, a))) * a;
}
Point exact(Vec2 v) {
  return {Real(v.x), Real(v.y)};
}

/// Grows with the angle from 0 to 4.
Real turn_of(const Point& d) {
  const Real s = d.y / (abs(d.x) + abs(d.y));
  return d.x >= 0 ? (s >= 0 ? s : 4 + s) : 2 - s;
}

// --- The plain shapes ---

std::vector<Vec2> points_of(const geometry::ConvexShape& shape) {
  if (const auto* disc = std::get_if<geometry::Disc>(&shape)) return {disc->center};
  if (const auto* segment = std::get_if<geometry::Segment>(&shape)) return {segment->a, segment->b};
  return std::get<geometry::ConvexPolygon>(shape).vertices;
}

/// S = hull(points) (+) D(0, radius), the points being all sums of a vertex of the obstacle with one of the mirrored
/// robot.
template <class Scalar, class Vector>
struct GrownPoints {
  std::vector<Vector> points;
  Scalar radius;
};

template <class Scalar, class Vector>
GrownPoints<Scalar, Vector> grown(const SceneCone& cone) {
  const auto* disc = std::get_if<geometry::Disc>(&cone.shape);
  GrownPoints<Scalar, Vector> out{{}, Scalar(disc ? disc->radius : 0.0)};
  if (cone.robot.empty()) out.radius += Scalar(cone.radius);
  const std::vector<Vec2> robot = cone.robot.empty() ? std::vector<Vec2>{{}} : cone.robot;
  for (const Vec2 p : points_of(cone.shape))
    for (const Vec2 q : robot)
      out.points.push_back({Scalar(Scalar(p.x) - Scalar(q.x)), Scalar(Scalar(p.y) - Scalar(q.y))});
  return out;
}

/// Corners only, counter-clockwise.
std::vector<Point> hull_of(std::vector<Point> points) {
  const auto same = [](const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; };
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  if (points.size() < 3) return points;
  std::vector<Point> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t first = hull.size();
    for (const Point& p : points) {
      while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

// --- Curves ---

struct Curve {
  bool is_circle = false;
  Point at;         // a point of the line; the centre
  Point direction;  // of the line, a unit vector
  Real radius;
};

Curve line(const Point& at, const Point& direction) {
  return {false, at, unit(direction), 0};
}
Curve circle(const Point& centre, const Real& radius) {
  return {true, centre, {}, radius};
}

bool are_one(const Curve& a, const Curve& b) {
  if (a.is_circle != b.is_circle) return false;
  const Point between = b.at - a.at;
  if (a.is_circle) return sign_of(a.radius - b.radius) == 0 && sign_of(between.x) == 0 && sign_of(between.y) == 0;
  return sign_of(cross(a.direction, b.direction)) == 0 && sign_of(cross(a.direction, between)) == 0;
}

/// foot +- sqrt(height2) across.
std::vector<Point> pair_of(const Point& foot, const Real& height2, const Point& across) {
  const int sign = sign_of(height2);
  if (sign < 0) return {};
  if (sign == 0) return {foot};
  const Point d = sqrt(height2) * across;
  return {foot - d, foot + d};
}

std::vector<Point> common_points(const Curve& a, const Curve& b) {
  if (!a.is_circle && b.is_circle) return common_points(b, a);
  const Point between = b.at - a.at;
  if (!a.is_circle) {
    const Real det = cross(a.direction, b.direction);
    if (sign_of(det) == 0) return {};
    return {a.at + (cross(between, b.direction) / det) * a.direction};
  }
  if (!b.is_circle) {
    const Real along = dot(a.at - b.at, b.direction), away = cross(b.direction, a.at - b.at);
    return pair_of(b.at + along * b.direction, a.radius * a.radius - away * away, b.direction);
  }
  const Real d2 = dot(between, between);
  if (sign_of(d2) == 0) return {};
  const Real along = (d2 + a.radius * a.radius - b.radius * b.radius) / (2 * d2);
  return pair_of(a.at + along * between, a.radius * a.radius / d2 - along * along, left_of(between));
}

// --- A cone ---

class OracleCone {
 public:
  explicit OracleCone(const SceneCone& cone)
      : apex_(exact(cone.apex)), is_truncated_(std::isfinite(cone.time_horizon)) {
    const auto s = grown<Real, Point>(cone);
    hull_ = hull_of(s.points);
    radius_ = s.radius;
    if (is_truncated_) horizon_ = cone.time_horizon;
    left_ = leg(1);
    right_ = leg(-1);
  }

  /// Whole lines and circles: the boundary is part of them.
  void add_curves(std::vector<Curve>& out) const {
    out.push_back(line(apex_, left_));
    out.push_back(line(apex_, right_));
    // Seen end on, a cone is a ray, and no other curve passes where it begins.
    if (radius_ == 0) out.push_back(line(apex_, left_of(left_ + right_)));
    if (radius_ == 0 && is_truncated_)
      for (const Point& c : hull_) out.push_back(line(apex_ + (1 / horizon_) * c, left_of(c)));
    if (!is_truncated_) return;
    for (std::size_t i = 0; i < hull_.size(); ++i) {
      if (radius_ > 0) out.push_back(circle(apex_ + (1 / horizon_) * hull_[i], radius_ / horizon_));
      if (hull_.size() == 1) continue;
      const Point edge = hull_[(i + 1) % hull_.size()] - hull_[i];
      out.push_back(line(apex_ + (1 / horizon_) * (hull_[i] - radius_ * left_of(unit(edge))), edge));
    }
  }

  /// Whether the closed cone has v.
  bool contains(const Point& v) const {
    const Point w = v - apex_;
    const int of_left = sign_of(cross(left_, w)), of_right = sign_of(cross(right_, w));
    if (of_left > 0 || of_right < 0) return false;
    const int ahead = sign_of(dot(w, left_ + right_));
    if (ahead < 0) return false;
    if (ahead == 0 || !is_truncated_) return true;  // ahead == 0: the apex, or beside it by less than anything
    return sign_of(horizon_ - first_contact(w)) >= 0;
  }

 private:
  /// side 1: the left leg's direction. Of the tangents to the discs round the corners the one that all lie right of.
  Point leg(int side) const {
    Point best;
    Real least = -1;
    for (const Point& c : hull_) {
      const Real d2 = dot(c, c), s = radius_ / sqrt(d2), k = sqrt(1 - s * s);
      const Point u = unit(c), tangent = k * u + (side * s) * left_of(u);
      Real most = 0;
      for (const Point& other : hull_) most = std::max<Real>(most, side * cross(tangent, other) + radius_);
      if (least >= 0 && most >= least) continue;
      least = most;
      best = tangent;
    }
    if (sign_of(least) != 0) throw Ambiguous("no leg");
    return best;
  }

  /// The least t > 0 with t w in S. REQUIRES: there is one, to rounding.
  Real first_contact(const Point& w) const {
    Real first = -1;
    const auto take = [&first](const Real& t) {
      if (t > 0 && (first < 0 || t < first)) first = t;
    };
    const Real w2 = dot(w, w);
    for (std::size_t i = 0; i < hull_.size(); ++i) {
      const Point& c = hull_[i];
      const Real wc = dot(w, c), across = cross(w, c), rest = radius_ * radius_ * w2 - across * across;
      const int sign = sign_of(rest);
      if (sign >= 0) take((wc - (sign > 0 ? sqrt(rest) : Real(0))) / w2);
      if (hull_.size() == 1) continue;
      const Point edge = hull_[(i + 1) % hull_.size()] - c, outward = Real(-1) * left_of(edge);
      const Real speed = dot(outward, w);
      if (sign_of(speed) >= 0) continue;
      const Real t = (dot(outward, c) + radius_ * sqrt(dot(edge, edge))) / speed;
      const Real along = dot(t * w - c, edge);
      if (sign_of(along) >= 0 && sign_of(along - dot(edge, edge)) <= 0) take(t);
    }
    if (first < 0) throw Ambiguous("no contact");
    return first;
  }

  Point apex_;
  bool is_truncated_;
  Real horizon_, radius_;
  std::vector<Point> hull_;
  Point left_, right_;
};

// --- The arrangement ---

struct Edge {
  std::size_t curve, from, to;  // `from`, `to`: vertices
  Point middle, left;           // left: a unit vector
  bool is_free = false;
  std::array<bool, 2> side_is_free{};  // left, right
};

class Faces {
 public:
  explicit Faces(const FreeScene& scene) : max_speed_(scene.max_speed) {
    for (const SceneCone& cone : scene.cones) cones_.emplace_back(cone);
    std::vector<Curve> all{circle({}, max_speed_)};
    for (const OracleCone& cone : cones_) cone.add_curves(all);
    for (const Curve& c : all) add(c);
    // Through each centre, in directions that nothing else in a scene has.
    for (std::size_t k = 0, n = curves_.size(); k < n; ++k)
      if (curves_[k].is_circle) add(line(curves_[k].at, {Real(1), Real("0.7548776662466927") + Real(int(k)) / 977}));
    intersect();
    for (std::size_t k = 0; k < curves_.size(); ++k) cut(k);
    parent_.resize(2 * edges_.size());
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (edges_[e].is_free) unite(2 * e, 2 * e + 1);
    for (std::size_t v = 0; v < vertices_.size(); ++v) unite_round(v);
  }

  std::vector<OracleFace> all() {
    std::vector<std::size_t> roots;
    std::vector<Real> areas, perimeters;
    for (std::size_t side = 0; side < parent_.size(); ++side) {
      const Edge& e = edges_[side / 2];
      if (!e.side_is_free[side % 2]) continue;
      const std::size_t root = find(side);
      std::size_t k = std::find(roots.begin(), roots.end(), root) - roots.begin();
      if (k == roots.size()) {
        roots.push_back(root);
        areas.emplace_back(0);
        perimeters.emplace_back(0);
      }
      if (e.is_free) continue;
      const auto [twice, length] = measure(e);
      areas[k] += side % 2 == 0 ? twice / 2 : -twice / 2;
      perimeters[k] += length;
    }
    std::vector<OracleFace> faces;
    for (std::size_t k = 0; k < roots.size(); ++k) {
      const double rounded = areas[k].convert_to<double>();
      OracleFace face{rounded, rounded, perimeters[k].convert_to<double>()};
      if (areas[k] < face.area_low) face.area_low = std::nextafter(rounded, -HUGE_VAL);
      if (areas[k] > face.area_high) face.area_high = std::nextafter(rounded, HUGE_VAL);
      faces.push_back(face);
    }
    std::sort(faces.begin(), faces.end(),
              [](const OracleFace& a, const OracleFace& b) { return a.area_low > b.area_low; });
    return faces;
  }

 private:
  void add(const Curve& c) {
    if (std::none_of(curves_.begin(), curves_.end(), [&](const Curve& other) { return are_one(c, other); }))
      curves_.push_back(c);
  }

  bool is_beyond_reach(const Point& p) const { return sign_of(dot(p, p) - max_speed_ * max_speed_) > 0; }

  bool is_free_point(const Point& p) const {
    return sign_of(max_speed_ * max_speed_ - dot(p, p)) > 0 &&
           std::none_of(cones_.begin(), cones_.end(), [&](const OracleCone& c) { return c.contains(p); });
  }

  std::size_t vertex_of(const Point& p) {
    const double x = p.x.convert_to<double>(), y = p.y.convert_to<double>();
    for (std::size_t k = 0; k < vertices_.size(); ++k) {
      if (std::fabs(rounded_[k].x - x) > 1e-9 || std::fabs(rounded_[k].y - y) > 1e-9) continue;
      const Point between = vertices_[k] - p;
      const Real apart = std::max<Real>(abs(between.x), abs(between.y));
      if (apart < kSamePoint) return k;
      if (apart < kOtherPoint) throw Ambiguous("points " + apart.str(3) + " apart");
    }
    vertices_.push_back(p);
    rounded_.push_back({x, y});
    return vertices_.size() - 1;
  }

  void intersect() {
    on_.resize(curves_.size());
    for (std::size_t a = 0; a < curves_.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        for (const Point& p : common_points(curves_[a], curves_[b])) {
          if (is_beyond_reach(p)) continue;
          const std::size_t v = vertex_of(p);
          on_[a].push_back(v);
          on_[b].push_back(v);
        }
      }
    }
  }

  /// The stretches of a curve between its points, both sides sampled.
  void cut(std::size_t k) {
    const Curve& c = curves_[k];
    std::vector<std::size_t>& on = on_[k];
    std::sort(on.begin(), on.end());
    on.erase(std::unique(on.begin(), on.end()), on.end());
    std::vector<std::pair<Real, std::size_t>> order;
    for (const std::size_t v : on) {
      const Point d = vertices_[v] - c.at;
      order.emplace_back(c.is_circle ? turn_of(d) : dot(d, c.direction), v);
    }
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i + (c.is_circle ? 0 : 1) < order.size(); ++i)
      add_edge(k, order[i].second, order[(i + 1) % order.size()].second);
  }

  void add_edge(std::size_t k, std::size_t from, std::size_t to) {
    const Curve& c = curves_[k];
    Edge e{k, from, to, {}, {}};
    if (c.is_circle) {
      const Point a = vertices_[from] - c.at, b = vertices_[to] - c.at;
      const Real turn = from == to ? Real(-1) : cross(a, b);
      Point m = from == to ? Real(-1) * a : abs(turn) < kZero && dot(a, b) < 0 ? left_of(a) : a + b;
      if (from != to && turn < 0 && abs(turn) >= kZero) m = Real(-1) * m;
      m = unit(m);
      e.middle = c.at + c.radius * m;
      e.left = Real(-1) * m;
    } else {
      e.middle = Real(0.5) * (vertices_[from] + vertices_[to]);
      e.left = left_of(c.direction);
    }
    if (is_beyond_reach(e.middle)) return;
    e.is_free = is_free_point(e.middle);
    e.side_is_free = {is_free_point(e.middle + kBeside * e.left), is_free_point(e.middle - kBeside * e.left)};
    if (e.is_free && !(e.side_is_free[0] && e.side_is_free[1]))
      throw Ambiguous("a free stretch with a side that is not");
    edges_.push_back(e);
  }

  /// A point of the curve near one of its vertices, ahead of it or behind.
  Point beside(const Edge& e, std::size_t vertex, int ahead) const {
    const Curve& c = curves_[e.curve];
    if (!c.is_circle) return vertices_[vertex] + (ahead * kRound) * c.direction;
    const Point from_centre = vertices_[vertex] - c.at;
    const Real t = kRound / c.radius, cosine = 1 - t * t / 2, sine = ahead * (t - t * t * t / 6);
    return c.at + cosine * from_centre + sine * left_of(from_centre);
  }

  void unite_round(std::size_t v) {
    struct Ray {
      Real turn;
      std::size_t left, right;  // sides, seen from the vertex
    };
    std::vector<Ray> rays;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (edges_[e].from == v) rays.push_back({turn_of(beside(edges_[e], v, 1) - vertices_[v]), 2 * e, 2 * e + 1});
      if (edges_[e].to == v) rays.push_back({turn_of(beside(edges_[e], v, -1) - vertices_[v]), 2 * e + 1, 2 * e});
    }
    std::sort(rays.begin(), rays.end(), [](const Ray& a, const Ray& b) { return a.turn < b.turn; });
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray &ray = rays[i], &next = rays[(i + 1) % rays.size()];
      if (i + 1 < rays.size() && next.turn - ray.turn < kSomething) throw Ambiguous("two curves in one direction");
      const auto flag = [this](std::size_t side) { return edges_[side / 2].side_is_free[side % 2]; };
      if (flag(ray.left) != flag(next.right)) throw Ambiguous("a sector free at one side");
      unite(ray.left, next.right);
    }
    if (is_free_point(vertices_[v]))
      for (const Ray& ray : rays) unite(ray.left, rays.front().left);
  }

  /// The integral of x dy - y dx along the edge, and its length.
  std::pair<Real, Real> measure(const Edge& e) const {
    const Curve& c = curves_[e.curve];
    const Point &a = vertices_[e.from], &b = vertices_[e.to];
    if (!c.is_circle) return {cross(a, b), sqrt(dot(b - a, b - a))};
    const Point u = a - c.at, w = b - c.at, m = e.middle - c.at;
    const Real angle = 2 * atan2(cross(u, m), dot(u, m));  // the middle is less than half a turn ahead
    const Real full = 2 * atan2(Real(0), Real(-1));
    const Real t = e.from == e.to ? full : angle < 0 ? Real(angle + full) : angle;
    return {c.radius * c.radius * t + cross(c.at, w - u), c.radius * t};
  }

  std::size_t find(std::size_t k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  void unite(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

  Real max_speed_;
  std::vector<OracleCone> cones_;
  std::vector<Curve> curves_;
  std::vector<Point> vertices_;
  std::vector<Vec2> rounded_;
  std::vector<std::vector<std::size_t>> on_;  // of each curve, vertices
  std::vector<Edge> edges_;
  std::vector<std::size_t> parent_;  // of each edge's left side, then its right one
};

// --- Membership in rationals ---

struct RationalPoint {
  mpq_class x, y;
};
RationalPoint operator-(const RationalPoint& a, const RationalPoint& b) {
  return {a.x - b.x, a.y - b.y};
}
mpq_class dot(const RationalPoint& a, const RationalPoint& b) {
  return a.x * b.x + a.y * b.y;
}
mpq_class cross(const RationalPoint& a, const RationalPoint& b) {
  return a.x * b.y - a.y * b.x;
}

/// Squared, of p from { from + t along : 0 <= t <= 1 }, or 0 <= t where it is a ray.
mpq_class squared_distance(const RationalPoint& p, const RationalPoint& from, const RationalPoint& along, bool is_ray) {
  const mpq_class length2 = dot(along, along);
  mpq_class t = sgn(length2) == 0 ? mpq_class(0) : mpq_class(dot(p - from, along) / length2);
  if (sgn(t) < 0) t = 0;
  if (!is_ray && t > 1) t = 1;
  const RationalPoint away{p.x - from.x - t * along.x, p.y - from.y - t * along.y};
  return dot(away, away);
}

/// Whether { t w : 0 <= t <= 1 }, or the ray, crosses the segment from a to b in their insides.
bool cross_each_other(const RationalPoint& w, bool is_ray, const RationalPoint& a, const RationalPoint& b) {
  const RationalPoint edge = b - a;
  const mpq_class det = cross(w, edge);
  if (sgn(det) == 0) return false;
  const mpq_class t = cross(a, edge) / det, s = cross(a, w) / det;
  return sgn(t) >= 0 && (is_ray || t <= 1) && sgn(s) >= 0 && s <= 1;
}

// 0 is not in S, so that t = 0 adds nothing. The segments between all pairs of points make up the hull's edges and
// more, all of it within S.
bool is_in_cone(const SceneCone& cone, Vec2 v) {
  auto s = grown<mpq_class, RationalPoint>(cone);
  const bool is_ray = std::isinf(cone.time_horizon);
  const mpq_class horizon(is_ray ? 1.0 : cone.time_horizon);
  const RationalPoint w{horizon * (mpq_class(v.x) - mpq_class(cone.apex.x)),
                        horizon * (mpq_class(v.y) - mpq_class(cone.apex.y))};
  const mpq_class r2 = s.radius * s.radius;
  const RationalPoint origin{0, 0};
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    if (squared_distance(s.points[i], origin, w, is_ray) <= r2) return true;
    for (std::size_t k = 0; k < i; ++k) {
      const RationalPoint edge = s.points[i] - s.points[k];
      if (cross_each_other(w, is_ray, s.points[k], s.points[i])) return true;
      if (squared_distance(origin, s.points[k], edge, false) <= r2) return true;
      if (!is_ray && squared_distance(w, s.points[k], edge, false) <= r2) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<OracleFace> free_faces(const FreeScene& scene) {
  return Faces(scene).all();
}

bool is_free(const FreeScene& scene, Vec2 v) {
  const mpq_class x(v.x), y(v.y), speed(scene.max_speed);
  return x * x + y * y <= speed * speed &&
         std::none_of(scene.cones.begin(), scene.cones.end(), [v](const SceneCone& c) { return is_in_cone(c, v); });
}

}  // namespace exactvo::test
