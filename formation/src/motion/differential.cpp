// SPDX-License-Identifier: GPL-3.0-or-later
#include "motion/differential.h"

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/pi.h"

namespace exactvo::formation {

Vec2 heading_vector(double degrees) {
  const double quarter = std::remainder(degrees, 360.0) / 90.0;
  if (quarter == std::floor(quarter)) {
    constexpr Vec2 kExact[] = {{-1, 0}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}};
    return kExact[static_cast<int>(quarter) + 2];
  }
  const double angle = quarter * (0.5 * geometry::kPi);
  return {std::cos(angle), std::sin(angle)};
}

double stray_of(const DifferentialDrive& drive, double time_step) {
  constexpr double kRounding = 1.0 + 1e-12;
  const double way = drive.max_wheel_speed * time_step;
  return kRounding * (way * way / (4.0 * (2.0 * drive.reference - way)));
}

double obstacle_reach(const Robot& robot) {
  double reach = obstacle_radius(robot);
  if (robot.drive)
    for (const geometry::Disc& link : robot.drive->chain)
      reach = std::max(reach, std::fabs(robot.drive->reference - link.center.x) + link.radius);
  return reach;
}

geometry::Disc link_at(const DifferentialDrive& drive, std::size_t link, Vec2 position, Vec2 heading) {
  const geometry::Disc& disc = drive.chain[link];
  return {position + (disc.center.x - drive.reference) * heading, disc.radius};
}

namespace {

/// Discs of one radius on the axis, the first about the reference point, whose slabs tile a box round the footprint and
/// that point. `more`: m, added to the radius.
std::vector<geometry::Disc> chain_of(const DifferentialDrive& drive, double more) {
  constexpr double kLinks = 5.0, kRounding = 1.0 + 1e-12;
  double front = drive.reference, rear = drive.reference, half_width = 0.0;
  for (const Vec2 corner : drive.footprint) {
    front = std::max(front, corner.x);
    rear = std::min(rear, corner.x);
    half_width = std::max(half_width, std::fabs(corner.y));
  }
  const double slab = (front - rear) / kLinks, radius = kRounding * (std::hypot(0.5 * slab, half_width) + more);
  std::vector<geometry::Disc> chain{{{drive.reference, 0.0}, radius}};
  const auto tile = [&](double from, double to) {
    const double links = std::ceil((to - from) / slab - 1e-9);
    for (double k = 0.5; k < links; ++k) chain.push_back({{from + (to - from) * (k / links), 0.0}, radius});
  };
  tile(rear, drive.reference - 0.5 * slab);
  tile(drive.reference + 0.5 * slab, front);
  return chain;
}

}  // namespace

void put_on_wheels(Robot& robot, const DifferentialDrive& drive, double time_step, double tracking) {
  constexpr double kRounding = 1.0 + 0x1p-50;
  double body = drive.footprint.empty() ? drive.body_radius + drive.reference : 0.0;
  for (const Vec2 corner : drive.footprint) body = std::max(body, norm(corner - Vec2{drive.reference, 0.0}));
  robot.drive = drive;
  robot.position = drive.axle + drive.reference * heading_vector(drive.heading);
  robot.radius = kRounding * (body + stray_of(drive, time_step) + tracking);
  robot.drive->tracking = tracking;
  robot.drive->chain.clear();
  if (!drive.footprint.empty()) robot.drive->chain = chain_of(drive, stray_of(drive, time_step) + tracking);
  robot.max_speed = drive.max_wheel_speed;
}

namespace detail {
namespace {

using geometry::HalfPlane;

/// Share of a limit that is left to roundings.
constexpr double kAimedAt = 1.0 - 1e-12;
constexpr int kLeastChords = 25, kMostChords = 201;
// Two edges from the apex, the greatest speed back, and the change of both wheels up and down.
static_assert(kMostChords + 2 + 1 + 4 == kMostHalfPlanesOfWheels);

Vec2 left_of(Vec2 v) {
  return {-v.y, v.x};
}

/// atan(t) / t.
double arc_of(double t) {
  return std::fabs(t) < 1e-6 ? 1.0 - t * t / 3.0 : std::atan(t) / t;
}

}  // namespace

TwistOfStep twist_of(const DifferentialDrive& drive, double time_step, Vec2 heading, Vec2 u) {
  const double x = time_step * dot(u, heading), y = time_step * dot(u, left_of(heading));
  const double t = y / (2.0 * drive.reference + x), arc = arc_of(t) / time_step;
  const double middle = x + y * t, across = drive.wheel_separation * t;
  return {t, {(middle - across) * arc, (middle + across) * arc}};
}

Vec2 turned(Vec2 heading, double turn) {
  const double whole = 1.0 + turn * turn, along = (1.0 - turn * turn) / whole, across = 2.0 * turn / whole;
  const Vec2 next = along * heading + across * left_of(heading);
  return next / norm(next);
}

Vec2 velocity_before(const DifferentialDrive& drive, double time_step, const OnWheels& now) {
  const double half = 0.5 * (now.speeds.right - now.speeds.left) * time_step / drive.wheel_separation;
  const double t = std::tan(half), middle = 0.5 * (now.speeds.left + now.speeds.right) * time_step / arc_of(t);
  const double ahead = 2.0 * drive.reference, x = (middle - ahead * t * t) / (1.0 + t * t), y = t * (ahead + x);
  const Vec2 before = turned(now.heading, -t);
  return (x * before + y * left_of(before)) / time_step;
}

Vec2 turned_aside(Vec2 heading, Vec2 preferred) {
  constexpr double kBehind = -0.9998;  // cos of 179 degrees
  if (dot(heading, preferred) > kBehind * norm(preferred)) return preferred;
  constexpr double kDegree = 0.0174533;
  return geometry::rotated(preferred, cross(heading, preferred) >= 0.0 ? -kDegree : kDegree);
}

std::array<Vec2, kVelocitiesAside> velocities_aside(Vec2 heading, Vec2 wish) {
  std::array<Vec2, kVelocitiesAside> all;
  const double angle = std::atan2(cross(wish, heading), dot(wish, heading));
  std::size_t n = 0;
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0})
    for (const double slower : {1.0, 0.5, 0.2})
      if (share > 0.0 || slower < 1.0) all[n++] = slower * geometry::rotated(wish, share * angle);
  std::sort(all.begin(), all.end(), [&](Vec2 a, Vec2 b) { return dot(a, wish) > dot(b, wish); });
  return all;
}

WheelLimits::WheelLimits(const DifferentialDrive& drive, double time_step, double braking_time)
    : drive_(drive), step_(time_step), beta_(drive.wheel_separation / (2.0 * drive.reference)) {
  const double q = drive.max_wheel_speed * time_step / (2.0 * drive.reference);
  arc_ = std::asin(std::min(q, 1.0)) / q * (1.0 + 1e-12);
  double most =
      std::min(drive.max_wheel_speed / std::hypot(1.0, beta_), drive.reference * drive.max_angular_speed) / arc_;
  double least = 0.0;
  if (can_brake(most, braking_time)) {
    side_ = most;
  } else {
    constexpr int kHalvings = 20;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (least + most);
      (can_brake(middle, braking_time) ? least : most) = middle;
    }
    side_ = least;
  }
  if (side_ > 0.0) make_polygon(braking_time);
}

/// Lemma 3, for twists: after any step within the set braking changes no wheel by more than its acceleration. Sampled:
/// a wheel that would break its limit by less is caught by `allows`.
bool WheelLimits::can_brake(double side, double braking_time) const {
  constexpr int kAngles = 180, kSpeeds = 8;
  constexpr double kSpare = 0.98;
  const double apex = drive_.max_wheel_speed / arc_, most = kSpare * drive_.max_wheel_acceleration * step_;
  const double touches = std::acos(std::min(1.0, side / apex));
  for (int a = 0; a <= kAngles; ++a) {
    const double angle = geometry::kPi * a / kAngles;
    const double reach = angle >= touches ? side : side / std::cos(touches - angle);
    for (int k = 1; k <= kSpeeds; ++k) {
      const Vec2 u = (reach * k / kSpeeds) * Vec2{std::cos(angle), std::sin(angle)}, heading{1.0, 0.0};
      const TwistOfStep now = twist_of(drive_, step_, heading, u);
      const TwistOfStep next = twist_of(drive_, step_, turned(heading, now.turn), (1.0 - step_ / braking_time) * u);
      if (std::fabs(next.wheels.left - now.wheels.left) > most ||
          std::fabs(next.wheels.right - now.wheels.right) > most)
        return false;
    }
  }
  return true;
}

/// The apex and chords of the arc, so many that braking by a step leads into it at every heading.
void WheelLimits::make_polygon(double braking_time) {
  const double apex = kAimedAt * drive_.max_wheel_speed / arc_, side = std::min(side_, apex);
  const double touches = std::acos(side / apex), arc = 2.0 * geometry::kPi - 2.0 * touches;
  const double left = 1.0 - step_ / braking_time;
  // An odd number: with a corner straight behind, a robot that is to turn round would back up instead.
  const double needed = std::ceil(0.5 * arc / std::acos(std::max(left, 0.5))) + 1.0;  // infinite where left is 1
  const int chords = static_cast<int>(std::clamp(needed, double{kLeastChords}, double{kMostChords})) | 1;
  std::vector<Vec2> corners{{apex, 0.0}};
  for (int k = 0; k <= chords; ++k) {
    const double angle = touches + arc * k / chords;
    corners.push_back(side * Vec2{std::cos(angle), std::sin(angle)});
  }
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec2 a = corners[k], along = corners[(k + 1) % corners.size()] - a;
    if (!(norm(along) > 0.0)) continue;
    const Vec2 inward = geometry::normalized(left_of(along));
    polygon_.push_back({inward, dot(inward, a)});
  }
  if (drive_.max_backward_speed < side_) polygon_.push_back({{1.0, 0.0}, -drive_.max_backward_speed});
}

void WheelLimits::half_planes(Vec2 heading, const WheelSpeeds& now, Vec2 braked, std::vector<HalfPlane>& out) const {
  out.clear();
  const Vec2 left = left_of(heading);
  for (const HalfPlane& h : polygon_) out.push_back({h.normal.x * heading + h.normal.y * left, h.offset});
  const double change = kAimedAt * drive_.max_wheel_acceleration * step_;
  const auto limit = [&](Vec2 wheel, double speed) {
    out.push_back({wheel, speed - change});
    out.push_back({-wheel, -speed - change});
  };
  limit(heading - beta_ * left, now.left);
  limit(heading + beta_ * left, now.right);
  // The wheels run otherwise at the end of a twist than at its beginning: braking is allowed all the same.
  for (HalfPlane& h : out) {
    constexpr double kRounding = 1e-12;
    const double at = dot(h.normal, braked);
    h.offset = std::min(h.offset, at - kRounding * (std::fabs(at) + drive_.max_wheel_speed));
  }
}

bool WheelLimits::allows(Vec2 heading, const WheelSpeeds& now, Vec2 u) const {
  const WheelSpeeds next = twist_of(drive_, step_, heading, u).wheels;
  const double change = kAimedAt * drive_.max_wheel_acceleration * step_, most = drive_.max_wheel_speed;
  return std::fabs(next.left) <= most && std::fabs(next.right) <= most && std::fabs(next.left - now.left) <= change &&
         std::fabs(next.right - now.right) <= change &&
         std::fabs(next.right - next.left) <= drive_.wheel_separation * drive_.max_angular_speed &&
         next.left + next.right >= -2.0 * drive_.max_backward_speed;
}

}  // namespace detail
}  // namespace exactvo::formation
