// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/motion_oracle.h"

#include <algorithm>
#include <cmath>

namespace exactvo::test {
namespace {

using geometry::CurveBasis;
using geometry::CurvedMotion;
using geometry::Encounter;
using geometry::Motion;
using geometry::RoundedPolygon;
using geometry::StraightMotion;
using geometry::Vec2;

using Polynomial = std::vector<Q>;

Q power_of_two(int exponent) {
  const Q two(2);
  Q result(1);
  for (int i = 0; i < std::abs(exponent); ++i) result *= two;
  return exponent < 0 ? Q(Q(1) / result) : result;
}

Q value_at(const Polynomial& p, const Q& x) {
  Q value(0);
  for (std::size_t k = p.size(); k-- > 0;) value = value * x + p[k];
  return value;
}
double rounded_value(const std::vector<double>& p, double x) {
  double value = 0.0;
  for (std::size_t k = p.size(); k-- > 0;) value = value * x + p[k];
  return value;
}
Polynomial times(const Polynomial& a, const Polynomial& b) {
  Polynomial c(a.size() + b.size() - 1, Q(0));
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k) c[i + k] += a[i] * b[k];
  return c;
}
Polynomial plus(Polynomial a, const Polynomial& b) {
  a.resize(std::max(a.size(), b.size()), Q(0));
  for (std::size_t k = 0; k < b.size(); ++k) a[k] += b[k];
  return a;
}
Polynomial scaled(const Q& by, Polynomial a) {
  for (Q& c : a) c *= by;
  return a;
}
Polynomial slope(const Polynomial& p) {
  Polynomial d;
  for (std::size_t k = 1; k < p.size(); ++k) d.push_back(p[k] * Q(static_cast<long>(k)));
  return d;
}

/// The polynomial through values at 0, 1/n, ..., 1: Newton's divided differences.
Polynomial through(const std::vector<Q>& values) {
  const std::size_t n = values.size();
  std::vector<Q> difference = values, at;
  for (std::size_t i = 0; i < n; ++i)
    at.push_back(n == 1 ? Q(0) : Q(Q(static_cast<long>(i)) / static_cast<long>(n - 1)));
  for (std::size_t k = 1; k < n; ++k)
    for (std::size_t i = n; i-- > k;) difference[i] = (difference[i] - difference[i - 1]) / (at[i] - at[i - k]);
  Polynomial p{difference[n - 1]};
  for (std::size_t i = n - 1; i-- > 0;) p = plus(times(p, {Q(-at[i]), Q(1)}), {difference[i]});
  return p;
}

using Z = boost::multiprecision::number<boost::multiprecision::gmp_int, boost::multiprecision::et_off>;

/// A polynomial over whole numbers, at m / 2^k without a division.
class WholePolynomial {
 public:
  explicit WholePolynomial(const Polynomial& p) {
    Z common(1);
    for (const Q& c : p) common = lcm(common, Z(denominator(c)));
    for (const Q& c : p) c_.push_back(Z(numerator(c)) * (common / Z(denominator(c))));
  }
  bool is_negative_at(const Z& m, unsigned k) const {
    Z value(0);
    unsigned shift = 0;
    for (std::size_t i = c_.size(); i-- > 0; shift += k) value = value * m + (c_[i] << shift);
    return value < 0;
  }

 private:
  std::vector<Z> c_;
};

/// The change of sign between low / 2^k and high / 2^k, to `bits` bits.
Q bisected(const WholePolynomial& p, Z low, Z high, unsigned k, unsigned bits) {
  const bool rises = p.is_negative_at(low, k);
  while (high - low > 1 || k < bits) {
    if (high - low <= 1) {
      low <<= 1;
      high <<= 1;
      ++k;
    }
    const Z middle = (low + high) >> 1;
    (p.is_negative_at(middle, k) == rises ? low : high) = middle;
  }
  return Q(low + high, Z(1) << (k + 1));
}
double rounded_bisected(const std::vector<double>& p, double low, double high) {
  const bool rises = rounded_value(p, low) < 0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    ((rounded_value(p, middle) < 0) == rises ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Where p and all its derivatives vanish in (0, 1), by bisection between what the next derivative gives; the points
/// themselves are among the answers, so that no double root is lost.
std::vector<Q> roots(Polynomial p, unsigned bits) {
  constexpr unsigned kBetween = 60;  // bits of the points between which roots are sought
  while (!p.empty() && p.back() == 0) p.pop_back();
  if (p.size() <= 1) return {};
  if (p.size() == 2) {
    const Q root = -p[0] / p[1];
    return root > 0 && root < 1 ? std::vector<Q>{root} : std::vector<Q>{};
  }
  std::vector<Q> found = roots(slope(p), kBetween);
  std::vector<Z> points{Z(0), Z(1) << kBetween};
  for (const Q& q : found) points.push_back((Z(numerator(q)) << kBetween) / Z(denominator(q)));
  std::sort(points.begin(), points.end());
  const WholePolynomial whole(p);
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    if (points[i] < points[i + 1] &&
        whole.is_negative_at(points[i], kBetween) != whole.is_negative_at(points[i + 1], kBetween))
      found.push_back(bisected(whole, points[i], points[i + 1], kBetween, bits));
  return found;
}
std::vector<double> rounded_roots(const std::vector<double>& p) {
  if (p.size() <= 1) return {};
  std::vector<double> derivative;
  for (std::size_t k = 1; k < p.size(); ++k) derivative.push_back(static_cast<double>(k) * p[k]);
  std::vector<double> found = rounded_roots(derivative), points{0.0};
  std::sort(found.begin(), found.end());
  points.insert(points.end(), found.begin(), found.end());
  points.push_back(1.0);
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    if ((rounded_value(p, points[i]) < 0) != (rounded_value(p, points[i + 1]) < 0))
      found.push_back(rounded_bisected(p, points[i], points[i + 1]));
  return found;
}

/// Stationary times: exactly of lines, to `bits` of others; in doubles where `bits` is 0.
void add_roots(const Polynomial& p, unsigned bits, std::vector<Q>& times) {
  if (bits > 0 || p.size() <= 2) {
    for (Q& root : roots(p, bits)) times.push_back(std::move(root));
    return;
  }
  std::vector<double> rounded;
  Q most(0);
  for (const Q& c : p) most = std::max(most, Q(abs(c)));
  if (most == 0) return;
  for (const Q& c : p) rounded.push_back(static_cast<double>(Q(c / most)));
  for (const double root : rounded_roots(rounded)) times.emplace_back(root);
}

using P = OraclePoint;
P operator-(const P& a, const P& b) {
  return {a.x - b.x, a.y - b.y};
}
P operator+(const P& a, const P& b) {
  return {a.x + b.x, a.y + b.y};
}
Q dot(const P& a, const P& b) {
  return a.x * b.x + a.y * b.y;
}
Q cross(const P& a, const P& b) {
  return a.x * b.y - a.y * b.x;
}
P exactly(Vec2 v) {
  return {Q(v.x), Q(v.y)};
}

Q squared_distance(const P& p, const P& a, const P& b) {
  const P e = b - a;
  const Q length2 = dot(e, e);
  Q t(0);
  if (length2 != 0) t = std::clamp(Q(dot(p - a, e) / length2), Q(0), Q(1));
  const P off{p.x - a.x - t * e.x, p.y - a.y - t * e.y};
  return dot(off, off);
}

/// The vertices of the hull, counter-clockwise, by gift wrapping.
std::vector<P> hull(const std::vector<Vec2>& corners) {
  std::vector<P> all;
  for (const Vec2 c : corners) {
    const P p = exactly(c);
    if (std::none_of(all.begin(), all.end(), [&](const P& q) { return p.x == q.x && p.y == q.y; })) all.push_back(p);
  }
  std::size_t first = 0;
  for (std::size_t i = 1; i < all.size(); ++i)
    if (all[i].y < all[first].y || (all[i].y == all[first].y && all[i].x < all[first].x)) first = i;
  std::vector<P> wrapped;
  for (std::size_t now = first;;) {
    wrapped.push_back(all[now]);
    std::size_t next = now;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i == now) continue;
      if (next == now) {
        next = i;
        continue;
      }
      const P e = all[next] - all[now], f = all[i] - all[now];
      const Q side = cross(e, f);
      if (side < 0 || (side == 0 && dot(f, f) > dot(e, e))) next = i;
    }
    if (next == first || next == now) break;
    now = next;
  }
  return wrapped;
}

/// De Boor on uniform knots ..., -1, 0, 1, 2, ...: the piece over [0, 1].
P de_boor(std::vector<P> d, const Q& u) {
  const std::size_t degree = d.size() - 1;
  for (std::size_t r = 1; r <= degree; ++r)
    for (std::size_t j = degree; j >= r; --j) {
      const Q knot = Q(static_cast<long>(j)) - Q(static_cast<long>(degree));
      const Q share = (u - knot) / Q(static_cast<long>(degree - r + 1));
      d[j] = {(Q(1) - share) * d[j - 1].x + share * d[j].x, (Q(1) - share) * d[j - 1].y + share * d[j].y};
    }
  return d[degree];
}
P de_casteljau(std::vector<P> d, const Q& u) {
  for (std::size_t n = d.size(); n > 1; --n)
    for (std::size_t i = 0; i + 1 < n; ++i)
      d[i] = {(Q(1) - u) * d[i].x + u * d[i + 1].x, (Q(1) - u) * d[i].y + u * d[i + 1].y};
  return d[0];
}

P position(const Motion& m, const Q& time, const Q& share) {
  const Q start(geometry::start_of(m)), end(geometry::end_of(m));
  const Q u = start == end ? share : Q((time - start) / (end - start));
  if (const auto* s = std::get_if<StraightMotion>(&m)) return de_casteljau({exactly(s->from.at), exactly(s->to.at)}, u);
  const auto& c = std::get<CurvedMotion>(m);
  std::vector<P> points;
  for (const Vec2 p : c.points) points.push_back(exactly(p));
  if (c.basis == CurveBasis::bezier) return de_casteljau(points, u);
  if (c.basis == CurveBasis::b_spline) return de_boor(points, u);
  P p{Q(0), Q(0)};
  for (std::size_t k = points.size(); k-- > 0;)
    p = {p.x * (time - start) + points[k].x, p.y * (time - start) + points[k].y};
  return p;
}

std::size_t degree_of(const Motion& m) {
  if (std::holds_alternative<StraightMotion>(m)) return 1;
  return std::get<CurvedMotion>(m).points.size() - 1;
}

using Edge = std::pair<P, P>;

/// For a pair of hulls, the segments from which the difference of the reference points keeps its distance.
std::vector<Edge> segments_of(const std::vector<P>& a, const std::vector<P>& b) {
  std::vector<Edge> segments;
  const auto next = [](const std::vector<P>& v, std::size_t i) { return v[(i + 1) % v.size()]; };
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) {
      segments.emplace_back(b[j] - a[i], next(b, j) - a[i]);
      if (a.size() > 1) segments.emplace_back(b[j] - a[i], b[j] - next(a, i));
    }
  return segments;
}

/// Whether the open polygons a + p and b meet: no edge's line parts them.
bool open_hulls_meet(const std::vector<P>& a, const std::vector<P>& b, const P& p) {
  const auto parts = [&](const std::vector<P>& of, const std::vector<P>& from, const P& shift) {
    for (std::size_t i = 0; i < of.size() && of.size() > 1; ++i) {
      const P start = of[i], e = of[(i + 1) % of.size()] - start;
      if (std::all_of(from.begin(), from.end(), [&](const P& v) { return cross(e, v + shift - start) <= 0; }))
        return true;
    }
    return false;
  };
  return !parts(b, a, p) && !parts(a, b, {-p.x, -p.y});
}

}  // namespace

MotionOracle::MotionOracle(const MotionCase& c) : case_(c), from_(geometry::start_of(c.a)), to_(geometry::end_of(c.a)) {
  degree_ = std::max<std::size_t>(1, degree_of(c.a));
  if (c.b) {
    from_ = std::max(from_, Q(geometry::start_of(*c.b)));
    to_ = std::min(to_, Q(geometry::end_of(*c.b)));
    degree_ = std::max(degree_, degree_of(*c.b));
  }
  const auto add = [&](const RoundedPolygon& part, const std::vector<Vec2>& other, double radius, bool solid) {
    const std::vector<P> a = hull(part.corners), b = hull(other);
    Pair pair;
    pair.edges = segments_of(a, b);
    for (const Edge& e : pair.edges)
      pair.rounded.emplace_back(Vec2{static_cast<double>(e.first.x), static_cast<double>(e.first.y)},
                                Vec2{static_cast<double>(e.second.x), static_cast<double>(e.second.y)});
    pair.corners_a = a;
    pair.corners_b = b;
    pair.reach = Q(part.radius) + Q(radius);
    pair.thin = pair.reach == 0 && a.size() == 1 && b.size() <= 2 && !solid;
    pairs_.push_back(std::move(pair));
  };
  for (const RoundedPolygon& part : c.body_a) {
    if (c.b)
      for (const RoundedPolygon& other : c.body_b) add(part, other.corners, other.radius, false);
    else
      for (const geometry::Segment& e : geometry::edges_of(*c.obstacle))
        add(part, {e.a, e.b}, 0.0, geometry::has_interior(*c.obstacle));
  }
}

MotionOracle::Point MotionOracle::relative(const Q& from, const Q& to, const Q& share) const {
  const Q time = from + share * (to - from);
  P p = position(case_.a, time, share);
  if (case_.b) p = p - position(*case_.b, time, share);
  return p;
}

bool MotionOracle::is_far(const Pair& pair, const Point& p, const Q& reach) const {
  // In doubles, whose errors are nothing beside the margin of a millionth.
  constexpr double kMargin = 1e-6;
  const Vec2 at{static_cast<double>(p.x), static_cast<double>(p.y)};
  for (std::size_t i = 0; i < pair.edges.size(); ++i) {
    const auto [a, b] = pair.rounded[i];
    const Vec2 e = b - a;
    const double length2 = squared_norm(e);
    const double share = length2 > 0.0 ? std::clamp(geometry::dot(at - a, e) / length2, 0.0, 1.0) : 0.0;
    const double distance = norm(at - a - share * e);
    if (!(distance > static_cast<double>(reach) + kMargin * (distance + norm(at) + norm(a) + norm(b)))) return false;
  }
  return true;
}

bool MotionOracle::interiors_meet(const Pair& pair, const Point& p) const {
  if (pair.corners_a.size() < 2 && pair.corners_b.size() < 2) return false;
  const std::vector<P>&a = pair.corners_a, &b = pair.corners_b;
  if (a.size() < 3 && b.size() < 3) {
    // The difference of two segments has an interior if it is a parallelogram. That of a point and a segment has none.
    if (a.size() < 2 || b.size() < 2) return false;
    const P e = a[1] - a[0], f = b[1] - b[0];
    if (cross(e, f) == 0) return false;
    const P off = b[0] - a[0] - p;
    const Q s = cross(off, f) / cross(e, f), t = cross(off, e) / cross(e, f);
    return s > 0 && s < 1 && t > 0 && t < 1;
  }
  return open_hulls_meet(a, b, p);
}

bool MotionOracle::is_inside(const Point& p) const {
  // Some point that is in the interior of a part, at its place.
  for (const RoundedPolygon& part : case_.body_a) {
    const std::vector<P> corners = hull(part.corners);
    P at{Q(0), Q(0)};
    for (const P& c : corners) at = at + c;
    const Q n(static_cast<long>(corners.size()));
    at = {at.x / n + p.x, at.y / n + p.y};
    bool inside = false, on_edge = false;
    for (const geometry::Segment& s : geometry::edges_of(*case_.obstacle)) {
      const P a = exactly(s.a), b = exactly(s.b);
      if (squared_distance(at, a, b) == 0) on_edge = true;
      if ((a.y > at.y) == (b.y > at.y)) continue;
      if (at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
    if (inside && !on_edge) return true;
  }
  return false;
}

Encounter MotionOracle::decide(const Q& from, const Q& to, const Q& more, bool thin_counts, unsigned bits) const {
  // The way as polynomials of the share of the span.
  std::vector<Q> xs, ys;
  for (std::size_t i = 0; i <= degree_; ++i) {
    const Point p = relative(from, to, Q(static_cast<long>(i)) / static_cast<long>(degree_));
    xs.push_back(p.x);
    ys.push_back(p.y);
  }
  const Polynomial x = through(xs), y = through(ys);
  std::vector<Q> times_of_interest{Q(0), Q(1)};
  const bool solid = case_.obstacle && geometry::has_interior(*case_.obstacle);
  for (const Pair& pair : pairs_) {
    for (const auto& edge : pair.edges) {
      const P &a = edge.first, e = edge.second - a;
      const Polynomial u = plus(x, {Q(-a.x)}), v = plus(y, {Q(-a.y)});
      add_roots(slope(plus(times(u, u), times(v, v))), bits, times_of_interest);
      if (dot(e, e) == 0) continue;
      const Polynomial across = plus(scaled(Q(-e.y), u), scaled(e.x, v));
      add_roots(across, bits, times_of_interest);
      add_roots(slope(across), bits, times_of_interest);
      const Polynomial along = plus(scaled(e.x, u), scaled(e.y, v));
      add_roots(along, bits, times_of_interest);
      add_roots(plus(along, {Q(-dot(e, e))}), bits, times_of_interest);
      const P b = a + e;
      const Polynomial u2 = plus(x, {Q(-b.x)}), v2 = plus(y, {Q(-b.y)});
      add_roots(slope(plus(times(u2, u2), times(v2, v2))), bits, times_of_interest);
    }
  }
  std::sort(times_of_interest.begin(), times_of_interest.end());
  const std::size_t ends = times_of_interest.size();
  for (std::size_t i = 0; i + 1 < ends; ++i)
    times_of_interest.emplace_back((times_of_interest[i] + times_of_interest[i + 1]) / 2);
  const bool exact = degree_ == 1;
  Q way2(0);
  for (std::size_t i = 0; i <= degree_; ++i)
    way2 = std::max(way2, dot(P{xs[i], ys[i]} - P{xs[0], ys[0]}, P{xs[i], ys[i]} - P{xs[0], ys[0]}));
  bool touches = false, unsure = false;
  for (const Q& share : times_of_interest) {
    const P p{value_at(x, share), value_at(y, share)};
    for (const Pair& pair : pairs_) {
      const Q reach = pair.reach + more;
      if (reach < 0) continue;
      if (interiors_meet(pair, p)) return Encounter::overlap;
      if (is_far(pair, p, reach)) continue;
      Q nearest2(-1), pair_size2 = std::max(Q(reach * reach), way2);
      for (const auto& edge : pair.edges) {
        const Q d2 = squared_distance(p, edge.first, edge.second);
        if (nearest2 < 0 || d2 < nearest2) nearest2 = d2;
        pair_size2 = std::max(pair_size2, dot(edge.second - edge.first, edge.second - edge.first));
      }
      const Q gap = nearest2 - reach * reach;
      const Q nothing = exact ? Q(0) : Q(pair_size2 * power_of_two(bits > 0 ? -100 : -42));
      if (gap < -nothing) return Encounter::overlap;
      if (gap > nothing) continue;
      if (bits == 0 && !exact) unsure = true;
      touches = true;
      if (pair.thin && thin_counts && (exact || bits > 0)) return Encounter::overlap;
    }
    if (solid) {
      const bool counts = std::any_of(pairs_.begin(), pairs_.end(), [&](const Pair& q) { return q.reach + more >= 0; });
      if (counts && is_inside(p)) return Encounter::overlap;
    }
  }
  if (unsure) return decide(from, to, more, thin_counts, 130);
  return touches ? Encounter::contact : Encounter::clear;
}

Encounter MotionOracle::encounter(const Q& from, const Q& to) const {
  return from > to ? Encounter::clear : decide(from, to, Q(0), true, 0);
}

int MotionOracle::compare_clearance(const Q& number) const {
  const Encounter e = decide(from_, to_, number, false, 0);
  return e == Encounter::overlap ? -1 : e == Encounter::contact ? 0 : 1;
}

}  // namespace exactvo::test
