// SPDX-License-Identifier: GPL-3.0-or-later
#include "enclosure/ellipse_solver.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "exact/exact_number.h"
#include "exact/exact_vector.h"
#include "exact/running_error.h"
#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry::detail {
namespace {

/// The dual is solved when no point exceeds 3 by more: the area is then within a relative 1e-11 of the least.
constexpr double kOptimality = 1e-11;
/// Newton's decrement squared below which a further step changes the weights by less than they are rounded.
constexpr double kConverged = 1e-22;
/// Added to the Hessian's diagonal, relative: six or more points of one conic leave it singular.
constexpr double kRidge = 1e-13;
/// Rounds that the active set may take; random input needs about ten. Past it the candidate is used as it is.
constexpr int kMostRounds = 500;
/// Newton steps a round; from a warm start it takes three to six.
constexpr int kMostSteps = 60;
/// Five points determine an ellipse; two more may pass through.
constexpr std::size_t kMostActive = 7;

/// A symmetric 3 x 3 matrix.
struct Symmetric3 {
  double xx = 0.0, xy = 0.0, yy = 0.0, x1 = 0.0, y1 = 0.0, one = 0.0;

  void add(Vec2 p, double w) {
    xx += w * p.x * p.x;
    xy += w * p.x * p.y;
    yy += w * p.y * p.y;
    x1 += w * p.x;
    y1 += w * p.y;
    one += w;
  }

  double form(Vec2 p, Vec2 q) const {
    return p.x * (xx * q.x + xy * q.y + x1) + p.y * (xy * q.x + yy * q.y + y1) + (x1 * q.x + y1 * q.y + one);
  }

  Symmetric3 inverse() const {
    Symmetric3 adj;
    adj.xx = yy * one - y1 * y1;
    adj.xy = x1 * y1 - xy * one;
    adj.x1 = xy * y1 - yy * x1;
    adj.yy = xx * one - x1 * x1;
    adj.y1 = xy * x1 - xx * y1;
    adj.one = xx * yy - xy * xy;
    const double s = 1.0 / (xx * adj.xx + xy * adj.xy + x1 * adj.x1);
    return {s * adj.xx, s * adj.xy, s * adj.yy, s * adj.x1, s * adj.y1, s * adj.one};
  }
};

using Row = std::array<double, kMostActive>;

// Solves h d = g for the leading n x n block of a symmetric positive definite h, by Cholesky's method in place.
void solve_in_place(std::array<Row, kMostActive>& h, Row& d, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < j; ++k) h[j][j] -= h[j][k] * h[j][k];
    h[j][j] = std::sqrt(std::max(h[j][j], kRidge));
    for (std::size_t i = j + 1; i < n; ++i) {
      for (std::size_t k = 0; k < j; ++k) h[i][j] -= h[i][k] * h[j][k];
      h[i][j] /= h[j][j];
    }
    for (std::size_t k = 0; k < j; ++k) d[j] -= h[j][k] * d[k];
    d[j] /= h[j][j];
  }
  for (std::size_t j = n; j-- > 0;) {
    for (std::size_t k = j + 1; k < n; ++k) d[j] -= h[k][j] * d[k];
    d[j] /= h[j][j];
  }
}

// In the maximum norm: any long extent will do for a shear, and this one can't overflow.
Vec2 farthest_from(Vec2 from, const std::vector<Vec2>& points) {
  Vec2 farthest = from;
  double reach = 0.0;
  for (const Vec2 p : points) {
    const double distance = std::max(std::fabs(p.x - from.x), std::fabs(p.y - from.y));
    if (distance > reach) {
      reach = distance;
      farthest = p;
    }
  }
  return farthest;
}

// The dual on points that fill a unit box.
class Dual {
 public:
  explicit Dual(const std::vector<Vec2>& points) : points_(points) {
    start();
    for (int round = 0; round < kMostRounds; ++round) {
      maximise();
      const std::size_t worst = worst_point();
      const double excess = inverse_.form(points_[worst], points_[worst]) - 3.0;
      if (!(excess > kOptimality)) break;
      join(worst, excess);
    }
  }

  // The points that the weights are of, as they were given.
  std::vector<WeightedPoint> support_among(const std::vector<Vec2>& given) const {
    std::vector<WeightedPoint> support;
    for (std::size_t i = 0; i < count_; ++i) {
      const auto at = std::find(points_.begin(), points_.end(), active_[i]);
      support.push_back({given[static_cast<std::size_t>(at - points_.begin())], weight_[i]});
    }
    return support;
  }

  // The moments with weights that add up to 1.
  Symmetric3 moments() const {
    Symmetric3 m;
    double total = 0.0;
    for (std::size_t i = 0; i < count_; ++i) total += weight_[i];
    for (std::size_t i = 0; i < count_; ++i) m.add(active_[i], weight_[i] / total);
    return m;
  }

 private:
  // A triangle of about the largest area, so that M is far from singular, and the extremes in x.
  void start() {
    const auto by_x = [](Vec2 a, Vec2 b) { return a.x < b.x; };
    const auto by_height = [](Vec2 a, Vec2 b) { return std::fabs(a.y) < std::fabs(b.y); };
    const Vec2 top = *std::max_element(points_.begin(), points_.end(), by_height);
    const Vec2 far = farthest_from(top, points_);
    const auto by_area = [&](Vec2 a, Vec2 b) {
      return std::fabs(cross(far - top, a - top)) < std::fabs(cross(far - top, b - top));
    };
    const Vec2 apex = *std::max_element(points_.begin(), points_.end(), by_area);
    const auto [left, right] = std::minmax_element(points_.begin(), points_.end(), by_x);
    for (const Vec2 p : {top, far, apex, *left, *right}) {
      if (std::find(active_.begin(), active_.begin() + count_, p) == active_.begin() + count_) active_[count_++] = p;
    }
    weight_.fill(1.0 / static_cast<double>(count_));
  }

  void maximise() {
    for (int step = 0; step < kMostSteps; ++step) {
      update_inverse();
      if (newton_step() < kConverged) break;
    }
    update_inverse();
  }

  void update_inverse() {
    Symmetric3 m;
    for (std::size_t i = 0; i < count_; ++i) m.add(active_[i], weight_[i]);
    inverse_ = m.inverse();
  }

  // One damped Newton step on log det M(w) - 3 sum w: its gradient is omega - 3, its Hessian -(q_i M^-1 q_j)^2. (The
  // second term keeps the weights' sum at 1 without a constraint.) Returns the squared decrement; a weight that
  // would turn negative stops the step and leaves.
  double newton_step() {
    std::array<Row, kMostActive> hessian;
    Row gradient;
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const double f = inverse_.form(active_[i], active_[j]);
        hessian[i][j] = f * f;
        if (i == j) gradient[i] = f - 3.0;
      }
      hessian[i][i] *= 1.0 + kRidge;
    }
    Row direction = gradient;
    solve_in_place(hessian, direction, count_);
    return move(gradient, direction);
  }

  double move(const Row& gradient, const Row& direction) {
    double decrement2 = 0.0;
    for (std::size_t i = 0; i < count_; ++i) decrement2 += gradient[i] * direction[i];
    // A full step is safe for a self-concordant function once the decrement is below 1/4.
    double t = decrement2 < 0.0625 ? 1.0 : 1.0 / (1.0 + std::sqrt(decrement2));
    std::size_t leaves = count_;
    for (std::size_t i = 0; i < count_; ++i) {
      if (weight_[i] + t * direction[i] > 0.0) continue;
      t = -weight_[i] / direction[i];
      leaves = i;
    }
    for (std::size_t i = 0; i < count_; ++i) weight_[i] += t * direction[i];
    if (leaves == count_) return decrement2;
    drop(leaves);
    return 1.0;
  }

  void drop(std::size_t i) {
    --count_;
    active_[i] = active_[count_];
    weight_[i] = weight_[count_];
  }

  std::size_t worst_point() const {
    std::size_t worst = 0;
    double largest = -1.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double omega = inverse_.form(points_[i], points_[i]);
      if (omega > largest) {
        largest = omega;
        worst = i;
      }
    }
    return worst;
  }

  // Khachiyan's step: the exact line search towards the new point.
  void join(std::size_t worst, double excess) {
    if (count_ == kMostActive) drop_lightest();
    const double t = excess / (3.0 * (excess + 2.0));
    for (std::size_t i = 0; i < count_; ++i) weight_[i] *= 1.0 - t;
    active_[count_] = points_[worst];
    weight_[count_++] = t;
  }

  void drop_lightest() {
    const auto lightest = std::min_element(weight_.begin(), weight_.begin() + count_);
    drop(static_cast<std::size_t>(lightest - weight_.begin()));
  }

  const std::vector<Vec2>& points_;
  std::array<Vec2, kMostActive> active_;
  Row weight_;
  std::size_t count_ = 0;
  Symmetric3 inverse_;
};

Vec2 swapped_if(bool swap, Vec2 p) {
  return swap ? Vec2{p.y, p.x} : p;
}

Vec2 into(const EllipseFrame& f, Vec2 x) {
  const Vec2 d = swapped_if(f.swapped, x - f.center);
  const double u = d.x / f.k11;
  return {u, (d.y - f.k21 * u) / f.k22};
}

std::vector<Vec2> into(const EllipseFrame& f, const std::vector<Vec2>& points) {
  std::vector<Vec2> out;
  out.reserve(points.size());
  for (const Vec2 p : points) out.push_back(into(f, p));
  return out;
}

// A frame in which the points fill a box of about unit size: sheared along their longest extent p -> q.
EllipseFrame unit_box_frame(const std::vector<Vec2>& points) {
  const Vec2 p = farthest_from(points.front(), points);
  const Vec2 q = farthest_from(p, points);
  const Vec2 half = 0.5 * q - 0.5 * p;
  EllipseFrame f;
  f.center = 0.5 * p + 0.5 * q;
  f.swapped = std::fabs(half.y) > std::fabs(half.x);
  const Vec2 d = swapped_if(f.swapped, half);
  f.k11 = std::fabs(d.x);
  f.k21 = d.x > 0.0 ? d.y : -d.y;
  f.k22 = 1.0;
  double width = 0.0;
  for (const Vec2 x : points) width = std::max(width, std::fabs(into(f, x).y));
  f.k22 = std::max(width, 4.0 * kUnitRoundoff * largest_coordinate(points));  // coordinates are no finer than that
  return f;
}

// The ellipse of the dual's moments M: centre m, Sigma = 2 (M_xx - m m^T), as a frame within the unit box.
EllipseFrame frame_of_moments(const Symmetric3& m) {
  EllipseFrame f;
  f.center = {m.x1, m.y1};
  const double s11 = std::max(2.0 * (m.xx - m.x1 * m.x1), 0.0);
  const double s12 = 2.0 * (m.xy - m.x1 * m.y1);
  const double s22 = 2.0 * (m.yy - m.y1 * m.y1);
  f.k11 = std::sqrt(s11);
  f.k21 = s12 / f.k11;
  f.k22 = std::sqrt(std::max(s22 - f.k21 * f.k21, kUnitRoundoff));
  return f;
}

// Both maps are lower triangular in the same order of coordinates, so their product is.
EllipseFrame composed(const EllipseFrame& outer, const EllipseFrame& inner) {
  EllipseFrame f;
  const Vec2 shift = {outer.k11 * inner.center.x, outer.k21 * inner.center.x + outer.k22 * inner.center.y};
  f.center = outer.center + swapped_if(outer.swapped, shift);
  f.swapped = outer.swapped;
  f.k11 = outer.k11 * inner.k11;
  f.k21 = outer.k21 * inner.k11 + outer.k22 * inner.k21;
  f.k22 = outer.k22 * inner.k22;
  return f;
}

// Three points whose triangle is about the largest, weighted alike: where the dual's arithmetic says nothing.
std::vector<WeightedPoint> support_of_flat(const std::vector<Vec2>& points) {
  const Vec2 p = farthest_from(points.front(), points);
  const Vec2 q = farthest_from(p, points);
  const auto by_area = [&](Vec2 a, Vec2 b) { return doubled_area_below(p, q, a) < doubled_area_below(p, q, b); };
  return {{p, 1.0}, {q, 1.0}, {*std::max_element(points.begin(), points.end(), by_area), 1.0}};
}

// The dual's arithmetic can fail where points are collinear within the rounding of the box.
bool is_sound(const EllipseFrame& f) {
  return is_finite(f.center) && std::isfinite(f.k21) && f.k11 > 0.0 && std::isfinite(f.k11) && f.k22 > 0.0 &&
         std::isfinite(f.k22);
}

double largest_norm(const EllipseFrame& f, const std::vector<Vec2>& points) {
  double largest = 0.0;
  for (const Vec2 p : points) largest = std::max(largest, squared_norm(into(f, p)));
  return std::sqrt(largest);
}

EllipseFrame scaled(const EllipseFrame& f, double factor) {
  return {f.center, f.k11 * factor, f.k21 * factor, f.k22 * factor, f.swapped};
}

// Rounding the centre of a needle far from the origin can cost more than its width. The best ellipse round the centre
// as it is now is that of the points with their mirror images.
EllipseFrame fitted_round_center(Vec2 center, const std::vector<Vec2>& points) {
  std::vector<Vec2> mirrored;
  mirrored.reserve(2 * points.size());
  for (const Vec2 p : points) {
    mirrored.push_back(p - center);
    mirrored.push_back(center - p);
  }
  EllipseFrame frame = solve_smallest_ellipse(mirrored).frame;
  frame.center = center;
  return frame;
}

/// The rounding of the norm, of the two triangular solves and of ellipse_of, and room for the predicate's filter.
constexpr double kRoom = 64.0 * kUnitRoundoff;

Ellipse grown_until_certified(EllipseFrame frame, const std::vector<Vec2>& points) {
  const double ulp = kUnitRoundoff * std::max(frame.k11, std::fabs(frame.k21));
  for (double growth = 1.0;; growth *= 2.0) {
    const Ellipse ellipse = ellipse_of(frame);
    if (contains_all(ellipse, points)) return ellipse;
    frame = scaled(frame, 1.0 + growth * kRoom);
    frame.k22 += growth * ulp;
  }
}

}  // namespace

bool contains_all(const Ellipse& ellipse, const std::vector<Vec2>& points) {
  return std::all_of(points.begin(), points.end(), [&](Vec2 p) { return contains(ellipse, p); });
}

void require_places(const std::vector<Vec2>& points) {
  constexpr double kLargest = 0x1p1000;
  const auto is_place = [](Vec2 p) { return std::fabs(p.x) < kLargest && std::fabs(p.y) < kLargest; };
  EXACTVO_REQUIRE(!points.empty(), std::string("no point"));
  EXACTVO_REQUIRE(std::all_of(points.begin(), points.end(), is_place), excerpt(points));
}

//   swapped: (x, y) = (k21 w1 + k22 w2, k11 w1); the rotation that clears the upper right entry gives L.
Ellipse ellipse_of(const EllipseFrame& f) {
  if (!f.swapped) return {f.center, f.k11, f.k21, f.k22};
  const double l11 = std::hypot(f.k21, f.k22);
  if (!(l11 > 0.0)) return {f.center, 0.0, f.k11, 0.0};
  return {f.center, l11, f.k11 * (f.k21 / l11), f.k11 * (f.k22 / l11)};
}

// The dual needs three points that are not collinear; those that are keep their box.
EllipseCandidate solve_smallest_ellipse(const std::vector<Vec2>& points) {
  constexpr double kFlat = 0x1p-26;  // squares of it still count beside 1
  const EllipseFrame outer = unit_box_frame(points);
  const std::vector<Vec2> in_box = into(outer, points);
  const bool is_flat = std::all_of(in_box.begin(), in_box.end(), [](Vec2 p) { return std::fabs(p.y) <= kFlat; });
  if (is_flat) return {outer, support_of_flat(points)};
  const Dual dual(in_box);
  const EllipseFrame inner = frame_of_moments(dual.moments());
  if (!is_sound(inner)) return {outer, support_of_flat(points)};
  return {composed(outer, inner), dual.support_among(points)};
}

Ellipse certified_ellipse(const EllipseFrame& candidate, const std::vector<Vec2>& points) {
  // Beyond this the rounded centre, not the shape, decides the size.
  constexpr double kCenterMatters = 1.0 + 1e-9;
  double reach = largest_norm(candidate, points);
  EllipseFrame frame = candidate;
  if (reach > kCenterMatters) {
    frame = fitted_round_center(candidate.center, points);
    reach = largest_norm(frame, points);
  }
  return grown_until_certified(scaled(frame, reach * (1.0 + kRoom)), points);
}

std::optional<Ellipse> inflate_to_contain(Ellipse e, const std::vector<Vec2>& points) {
  constexpr double kFirstStep = 0x1p-50;
  for (double step = kFirstStep; step < 1.0; step *= 2.0) {
    if (contains_all(e, points)) return e;
    const double f = 1.0 + step;
    e = {e.center, e.l11 * f, e.l21 * f, e.l22 * f};
  }
  return std::nullopt;
}

Ellipse ellipse_of_segment(Vec2 a, Vec2 b) {
  // Half-width in ulps of the coordinates. Rounding the middle moves the ends off the axis by one at most, which then
  // costs 2^-33 of the length.
  constexpr double kSliver = 0x1p16;
  const Vec2 half = 0.5 * b - 0.5 * a;
  const Vec2 middle = 0.5 * a + 0.5 * b;
  const Ellipse bare = half.x < 0.0 ? Ellipse{middle, -half.x, -half.y, 0.0} : Ellipse{middle, half.x, half.y, 0.0};
  if (contains_all(bare, {a, b})) return bare;
  EllipseFrame frame = unit_box_frame({a, b});
  frame.k22 = kSliver * kUnitRoundoff * largest_coordinate({a, b});
  return grown_until_certified(scaled(frame, 1.0 + 0x1p-30), {a, b});
}

// A certified lower bound of the area of every ellipse round given points.
//
// Let w >= 0 be weights of the points that add up to 1, m their weighted mean and C = sum w (p - m)(p - m)^T. An
// ellipse { x : |A x + b| <= 1 } round the points has tr(A C A^T) <= sum w |A p + b|^2 <= 1, hence
// 2 sqrt(det A C A^T) <= 1 (the geometric mean is at most the arithmetic one), and its area pi / det A is at least
// 2 pi sqrt(det C). By the formula of Cauchy and Binet
//
//   det C = sum over i < j < k of w_i w_j w_k D_ijk^2,   D_ijk twice the area of the triangle of three points:
//
// all terms are positive, and a sum of them is below det C as soon as each |D| is. For the best weights the bound is
// the least area itself, for three points 4 pi / (3 sqrt 3) of their triangle.

namespace {

template <typename Number>
Number doubled_area(Vec2 a, Vec2 b, Vec2 c) {
  const auto at = [](Vec2 p) { return Vector<Number>{Number(p.x), Number(p.y)}; };
  return cross(at(b) - at(a), at(c) - at(a));
}

}  // namespace

double doubled_area_below(Vec2 a, Vec2 b, Vec2 c) {
  constexpr double kPrecise = 0x1p-48, kLeast = 0x1p-1000;
  const RunningError filtered = doubled_area<RunningError>(a, b, c);
  const double size = std::fabs(filtered.value);
  // The rest of 2^-48 pays for the bound's own rounding (running_error.h), and for this subtraction.
  if (std::isfinite(size) && filtered.error < kPrecise * size && size > kLeast)
    return (size - filtered.error) * (1.0 - 0x1p-50);
  const double exact = std::fabs(CGAL::to_double(doubled_area<Exact>(a, b, c)));
  if (!(exact > kLeast) || !std::isfinite(exact)) return 0.0;
  return exact * (1.0 - 0x1p-50);  // it is rounded by one unit in the last place at most
}

double certified_least_area(const std::vector<WeightedPoint>& support) {
  const std::size_t n = support.size();
  std::vector<double> areas;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k)
        areas.push_back(doubled_area_below(support[i].point, support[j].point, support[k].point));
  const double largest = areas.empty() ? 0.0 : *std::max_element(areas.begin(), areas.end());
  if (!(largest > 0.0)) return 0.0;
  double total = 0.0, sum = 0.0;  // det C / largest^2: what underflows in it only makes it less
  for (const WeightedPoint& p : support) total += p.weight;
  std::size_t next = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      for (std::size_t k = j + 1; k < n; ++k) {
        const double share = areas[next++] / largest;
        sum += (support[i].weight / total) * (support[j].weight / total) * (support[k].weight / total) * share * share;
      }
    }
  }
  // At most seven points: 35 terms of less than a dozen roundings, a root and three products stay within 2^-46.
  constexpr double kRounding = 1.0 - 0x1p-46;
  const double bound = kRounding * 2.0 * kPi * std::sqrt(sum) * largest;
  return std::isfinite(bound) ? bound : 0.0;
}

}  // namespace exactvo::geometry::detail

namespace exactvo::geometry {

// Flat input here, the rest by Newton's method.
namespace {

FastEllipse of_collinear(const std::vector<Vec2>& points) {
  const auto [low, high] = std::minmax_element(points.begin(), points.end(), detail::lexicographically_less);
  if (*low == *high) return {{*low, 0.0, 0.0, 0.0}, 0.0};
  return {detail::ellipse_of_segment(*low, *high), 0.0};
}

}  // namespace

FastEllipse fast_smallest_ellipse(const std::vector<Vec2>& points) {
  detail::require_places(points);
  if (detail::on_one_line(points)) return of_collinear(points);
  const detail::EllipseCandidate candidate = detail::solve_smallest_ellipse(points);
  return {detail::certified_ellipse(candidate.frame, points), detail::certified_least_area(candidate.support)};
}

}  // namespace exactvo::geometry
