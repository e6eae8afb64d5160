// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/bodies.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "crowd/edge_rounding.h"
#include "exactvo/geometry/infinity.h"

namespace exactvo::formation::crowd {
namespace {

using namespace edge_rounding;
using geometry::dot;

/// Corners of the polygon round an ellipse: a turn from one to the next, 1 / cos(pi / 32), and how much it is grown so
/// that it is round the ellipse once rounded. Constants, since libraries do not agree on the last digit of a cosine.
constexpr int kEllipseCorners = 32;
constexpr Vec2 kTurn = {0.98078528040323044913, 0.19509032201612826785};
constexpr double kRoundIt = (1.0 + 0x1p-40) / 0.99518472667219688624;

/// Steps of Newton's method from a normal of that polygon to one of the ellipse, and the longest.
constexpr int kNewtonSteps = 4;
constexpr double kLongestTurn = 0.3;

/// In units of u of the magnitudes: velocities (2), two products, two sums.
constexpr double kVelocityError = 16.0 * kUnit;

using geometry::kInfinity;

/// Out of line, since GCC 12 drops such conversions where it sees two side by side.
[[gnu::noinline]] double rounded_to_float(double x) {
  return static_cast<double>(static_cast<float>(x));
}

double one_norm(Vec2 v) {
  return std::fabs(v.x) + std::fabs(v.y);
}

std::vector<Vec2> corners_round(const geometry::Ellipse& e) {
  std::vector<Vec2> corners;
  Vec2 w = {kRoundIt, 0.0};
  for (int k = 0; k < kEllipseCorners; ++k) {
    corners.push_back(e.center + Vec2{e.l11 * w.x, e.l21 * w.x + e.l22 * w.y});
    w = {kTurn.x * w.x - kTurn.y * w.y, kTurn.y * w.x + kTurn.x * w.y};
  }
  if (e.l11 * e.l22 < 0.0) std::reverse(corners.begin(), corners.end());
  return corners;
}

/// A body as a robot sees it.
class Sight {
 public:
  Sight(const Body& body, Vec2 from, Vec2 velocity, double time_step, const BodyQuery& query)
      : body_(body),
        from_(from),
        query_(query),
        ellipse_(std::get_if<geometry::Ellipse>(&body.shape)),
        velocity_(velocity),
        time_step_(time_step),
        horizon_(body.moves ? query.horizon : query.still_horizon) {
    for (const Vec2 corner : body.corners) size_ = std::max(size_, one_norm(corner - from_));
    if (ellipse_)  // computed from its own numbers, not from corners
      size_ += one_norm(ellipse_->center - from_) + std::fabs(ellipse_->l11) + one_norm({ellipse_->l21, ellipse_->l22});
    size_ += body.round + query.radius;
    error_ = kSupportError * size_;
    const double u = query.float_normals ? 0x1p-24 : kUnit;
    grown_ = query.radius + body.round + (kRoundingRoom * u + kSupportRoom) * size_;
  }

  bool is_beyond(double range) const { return geometry::norm(nearest({})) - body_.round - error_ > range; }

  BodyLine best_line() {
    const Vec2 way = horizon_ * (query_.velocity - velocity_);
    try_normal(refined(direction(way - nearest(way)), way), 0.0);
    if (is_inside(way))
      for (std::size_t k = 0; k < body_.normals.size(); ++k) try_face(k);
    try_leg(1.0);
    try_leg(-1.0);
    BodyLine line = line_with(found_);
    const double support = least_ < kInfinity ? support_above(line.normal) : 1.0;
    if (!(support <= 0.0)) return facing();
    set_offset(line, std::min(0.0, support / horizon_ * kTowardsZero));
    return line;
  }

 private:
  Vec2 corner(std::size_t k) const { return body_.corners[k] - from_; }

  /// max { n.s : s in S }, without the robot's radius.
  double support(Vec2 n) const {
    if (ellipse_) {
      const Vec2 pulled{ellipse_->l11 * n.x + ellipse_->l21 * n.y, ellipse_->l22 * n.y};
      return dot(n, ellipse_->center - from_) + std::sqrt(geometry::squared_norm(pulled));
    }
    double most = -kInfinity;
    for (const Vec2 c : body_.corners) most = std::max(most, dot(n, c - from_));
    return most;
  }

  /// At least h(n), exactly that of the doubles given.
  double support_above(Vec2 n) const {
    const double length = std::sqrt(geometry::squared_norm(n));
    return support(n) + (query_.radius + body_.round) * length + error_;
  }

  /// The point of the hull, not grown, that is nearest to x.
  Vec2 nearest(Vec2 x) const {
    Vec2 best;
    double least = kInfinity;
    for (std::size_t k = 0; k < body_.corners.size(); ++k) {
      const Vec2 p = nearest_on(corner(k), corner(k + 1 < body_.corners.size() ? k + 1 : 0), x);
      const double squared = geometry::squared_norm(x - p);
      if (squared < least) least = squared, best = p;
    }
    return is_inside(x) ? x : best;
  }

  /// Whether x is inside the hull by more than rounding; never where the hull has no interior.
  bool is_inside(Vec2 x) const {
    bool any = false;
    for (std::size_t k = 0; k < body_.normals.size(); ++k) {
      if (body_.normals[k] == Vec2{}) continue;
      if (!(dot(body_.normals[k], x - corner(k)) < -error_)) return false;
      any = true;
    }
    return any;
  }

  /// From a normal of the hull to that of the ellipse's point nearest to x: the least of g(n) = n.(s(n) - x), where
  /// g'' + g is the radius of curvature, det^2 / |L^T n|^3.
  Vec2 refined(Vec2 n, Vec2 x) const {
    if (!ellipse_ || n == Vec2{}) return n;
    const double det = ellipse_->l11 * ellipse_->l22;
    for (int k = 0; k < kNewtonSteps; ++k) {
      const Vec2 pulled{ellipse_->l11 * n.x + ellipse_->l21 * n.y, ellipse_->l22 * n.y};
      const double stretch = std::sqrt(geometry::squared_norm(pulled));
      const Vec2 away = ellipse_->center - from_ - x;
      const double g = dot(n, away) + stretch, bend = det * det / (stretch * stretch * stretch) - g;
      if (!(stretch > 0.0) || !(bend > 0.0) || g > 0.0) return n;
      const Vec2 pushed =
          1.0 / stretch * Vec2{ellipse_->l11 * pulled.x, ellipse_->l21 * pulled.x + ellipse_->l22 * pulled.y};
      const double turn = std::clamp(-dot(geometry::perp(n), away + pushed) / bend, -kLongestTurn, kLongestTurn);
      n = direction(n + turn * geometry::perp(n));
    }
    return n;
  }

  /// Valid where no point of the grown body lies on its side of the robot; `room` for what a leg is rounded by.
  void try_normal(Vec2 n, double room) {
    if (n == Vec2{}) return;
    take(n, support(n) + grown_, room);
  }
  void try_face(std::size_t k) {
    const Vec2 n = body_.normals[k];
    if (!(n == Vec2{})) take(n, dot(n, corner(k)) + grown_, 0.0);
  }
  void take(Vec2 n, double support, double room) {
    if (!(support <= room)) return;
    const double depth = support - horizon_ * dot(n, query_.velocity - velocity_);
    if (!(depth < least_)) return;
    least_ = depth;
    found_ = n;
  }

  /// The tangent from the robot to the grown hull on one side: that of the corner whose own leaves no other corner
  /// beyond it.
  void try_leg(double side) {
    Vec2 leg;
    for (std::size_t k = 0; k < body_.corners.size(); ++k) {
      const Vec2 c = corner(k);
      if (k > 0 && dot(leg, c) + grown_ <= 0.0) continue;
      const double squared = geometry::squared_norm(c), square = squared - grown_ * grown_;
      if (!(square > 0.0)) return;
      const double root = side * std::sqrt(square), scale = 1.0 / squared;
      leg = scale * Vec2{-(grown_ * c.x + root * c.y), root * c.x - grown_ * c.y};
    }
    try_normal(leg, error_);
  }

  /// With a normal of the precision asked for, and no offset yet.
  BodyLine line_with(Vec2 normal) const {
    BodyLine line;
    line.normal = query_.float_normals ? Vec2{rounded_to_float(normal.x), rounded_to_float(normal.y)} : normal;
    return line;
  }

  /// n.(v - w) >= relative, as a bound of n.v.
  void set_offset(BodyLine& line, double relative) const {
    line.offset = relative;
    if (!body_.moves) return;
    const double x = line.normal.x * velocity_.x, y = line.normal.y * velocity_.y;
    line.offset += x + y + kVelocityError * (std::fabs(relative) + std::fabs(x) + std::fabs(y));
  }

  /// Too near for anything else: not nearer to a body at rest; from one that moves away within the step.
  BodyLine facing() const {
    const Vec2 near = nearest({});
    Vec2 n = refined(direction(-near), {});
    double least = kInfinity;
    if (geometry::norm(near) <= error_)
      for (std::size_t k = 0; k < body_.normals.size(); ++k) {
        if (body_.normals[k] == Vec2{} || !(dot(body_.normals[k], corner(k)) < least)) continue;
        least = dot(body_.normals[k], corner(k));
        n = refined(body_.normals[k], {});
      }
    if (n == Vec2{}) n = {1.0, 0.0};
    BodyLine line = line_with(n);
    const double support = support_above(line.normal);
    line.touching = !(support <= 0.0);
    set_offset(line, body_.moves ? std::max(0.0, support) / time_step_ * kAwayFromZero : 0.0);
    return line;
  }

  const Body& body_;
  Vec2 from_;
  const BodyQuery& query_;
  const geometry::Ellipse* ellipse_;
  Vec2 velocity_;
  double time_step_, horizon_;
  double size_ = 0.0, error_ = 0.0, grown_ = 0.0;
  double least_ = kInfinity;
  Vec2 found_;
};

/// And by what its coordinates are rounded by.
geometry::Box grown(const geometry::Box& box, double by) {
  const double far = by + 0x1p-50 * (by + one_norm(box.low) + one_norm(box.high));
  return {box.low - Vec2{far, far}, box.high + Vec2{far, far}};
}

geometry::Box moved(const geometry::Box& box, Vec2 by) {
  const double rounding = 0x1p-50 * one_norm(by);
  return grown({box.low + by, box.high + by}, rounding);
}

}  // namespace

const Body* Bodies::find(ObstacleId id) const {
  const auto at = std::lower_bound(bodies_.begin(), bodies_.end(), id,
                                   [](const Body& b, ObstacleId wanted) { return b.id < wanted; });
  return at != bodies_.end() && at->id == id ? &*at : nullptr;
}

Body* Bodies::find(ObstacleId id) {
  return const_cast<Body*>(std::as_const(*this).find(id));
}

Body& Bodies::add(ObstacleId id, const geometry::ConvexShape& shape, bool moves) {
  Body& body = bodies_.emplace_back();
  body.id = id;
  body.shape = shape;
  body.moves = moves;
  if (const auto* disc = std::get_if<geometry::Disc>(&shape)) {
    body.corners = {disc->center};
    body.round = disc->radius;
  } else if (const auto* ellipse = std::get_if<geometry::Ellipse>(&shape)) {
    body.corners = corners_round(*ellipse);
  } else {
    body.corners = geometry::corners_of(shape);
  }
  const std::size_t count = body.corners.size();
  for (std::size_t k = 0; count > 1 && k < count; ++k)
    body.normals.push_back(-direction(geometry::perp(body.corners[(k + 1) % count] - body.corners[k])));
  for (const Vec2 c : body.corners) body.box.add(c);
  body.box = grown(body.box, body.round);
  changed_ = true;
  return body;
}

bool Bodies::remove(ObstacleId id) {
  const Body* body = find(id);
  if (!body) return false;
  bodies_.erase(bodies_.begin() + (body - bodies_.data()));
  return changed_ = true;
}

Vec2 Bodies::velocity_of(const Body& body) const {
  return {position_step_ * body.mx / time_step_, position_step_ * body.my / time_step_};
}

void Bodies::lay_out() {
  if (changed_) {
    std::vector<geometry::Box> boxes;
    still_number_.clear();
    moving_number_.clear();
    for (std::uint32_t k = 0; k < bodies_.size(); ++k) {
      (bodies_[k].moves ? moving_number_ : still_number_).push_back(k);
      if (!bodies_[k].moves) boxes.push_back(bodies_[k].box);
    }
    still_ = geometry::BoxGrid(std::move(boxes));
  }
  if (changed_ || moved_) {
    std::vector<geometry::Box> boxes;
    for (const std::uint32_t k : moving_number_) {
      const Body& b = bodies_[k];
      boxes.push_back(moved(b.box, position_step_ * Vec2{static_cast<double>(b.x), static_cast<double>(b.y)}));
    }
    moving_ = geometry::BoxGrid(std::move(boxes));
  }
  fastest_ = 0.0;
  for (const std::uint32_t k : moving_number_) fastest_ = std::max(fastest_, geometry::norm(velocity_of(bodies_[k])));
  changed_ = moved_ = false;
}

void Bodies::move() {
  for (const std::uint32_t k : moving_number_) {
    bodies_[k].x += bodies_[k].mx;
    bodies_[k].y += bodies_[k].my;
  }
  moved_ = moved_ || !moving_number_.empty();
}

std::size_t Bodies::bytes() const {
  std::size_t sum = bodies_.capacity() * (sizeof(Body) + 2 * sizeof(geometry::Box));
  for (const Body& b : bodies_) sum += (b.corners.capacity() + b.normals.capacity()) * sizeof(Vec2);
  return sum + 4 * (still_number_.capacity() + moving_number_.capacity());
}

void Bodies::add_line(std::uint32_t number, const BodyQuery& query, std::vector<BodyLine>& out) const {
  const Body& body = bodies_[number];
  // Exact: whole steps of the lattice, and a power of two.
  const Vec2 from = position_step_ * Vec2{static_cast<double>(query.x - body.x), static_cast<double>(query.y - body.y)};
  const Vec2 velocity = velocity_of(body);
  const double horizon = body.moves ? query.horizon : query.still_horizon;
  const double range = (horizon * (query.max_speed + geometry::norm(velocity)) + query.radius) * kWiden;
  Sight sight(body, from, velocity, time_step_, query);
  if (sight.is_beyond(range)) return;
  out.push_back(sight.best_line());
  out.back().obstacle = number;
}

std::size_t Bodies::lines(const BodyQuery& query, std::vector<std::uint32_t>& near, std::vector<BodyLine>& out) const {
  out.clear();
  const auto add = [&](const geometry::BoxGrid& grid, const std::vector<std::uint32_t>& numbers, double reach) {
    if (numbers.empty()) return;
    near.clear();
    grid.for_each_within(query.position, reach * kWiden, [&](std::size_t k) { near.push_back(numbers[k]); });
    std::sort(near.begin(), near.end());
    for (const std::uint32_t number : near) add_line(number, query, out);
  };
  add(still_, still_number_, query.still_horizon * query.max_speed + query.radius);
  const std::size_t still = out.size();
  add(moving_, moving_number_, query.horizon * (query.max_speed + fastest_) + query.radius);
  return still;
}

}  // namespace exactvo::formation::crowd
