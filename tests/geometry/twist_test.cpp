// SPDX-License-Identifier: GPL-3.0-or-later
// Constant twists against an oracle of 50 digits.
#include "exactvo/geometry/twist.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <stdexcept>

#include "exactvo/geometry/pi.h"
#include "support/seeded_random.h"

namespace exactvo::test {
namespace {

using geometry::Displacement;
using geometry::Pose;
using geometry::ReferenceTwist;
using geometry::Twist;
using geometry::Vec2;
using Number = boost::multiprecision::cpp_bin_float_50;

struct Far {
  Number x, y;
};

/// Turns about the instantaneous centre; straight on without a turn.
Far moved_exactly(const Twist& twist, Vec2 q, double time) {
  const Number w(twist.turn), t(time), a = w * t;
  const Number vx(twist.velocity.x), vy(twist.velocity.y), qx(q.x), qy(q.y);
  if (w == 0) return {qx + t * vx, qy + t * vy};
  const Number cx = -vy / w, cy = vx / w;  // the centre
  const Number rx = qx - cx, ry = qy - cy;
  return {cx + cos(a) * rx - sin(a) * ry, cy + sin(a) * rx + cos(a) * ry};
}

double distance(const Far& a, const Far& b) {
  return static_cast<double>(sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)));
}

TEST(Twist, PointsAreWithinTheBoundOfRounding) {
  SeededRandom random(seed_of_run(71));
  double most = 0.0;
  int judged = 0;
  for (int i = 0; i < 4000; ++i) {
    const double size = std::ldexp(1.0, static_cast<int>(random.uniform(-20.0, 20.0)));
    const double turn =
        i % 10 == 0 ? 0.0 : std::ldexp(random.uniform(-1.0, 1.0), static_cast<int>(random.uniform(-40.0, 4.0)));
    const Twist twist{size * random.in_box(1.0), turn};
    const Vec2 q = random.in_box(2.0);
    const double time = random.uniform(0.0, 5.0);
    const Vec2 p = displacement_after(twist, time).moved(q);
    const double off = distance({Number(p.x), Number(p.y)}, moved_exactly(twist, q, time));
    const double bound = twist_rounding(twist, q, time);
    ASSERT_LE(off, bound) << twist.turn << " " << time;
    most = std::max(most, off / bound);
    ++judged;
  }
  EXPECT_EQ(judged, 4000);
  EXPECT_GE(most, 0.05) << "the bound is not of another order than the error";
}

TEST(Twist, StrayBoundsTheDistanceFromTheChordAndIsNearlyReached) {
  SeededRandom random(seed_of_run(72));
  double most = 0.0;
  for (int i = 0; i < 500; ++i) {
    const Twist twist{random.in_box(1.0), random.uniform(-1.0, 1.0)};
    const Vec2 q = random.in_box(1.0);
    const double time = random.uniform(0.01, 1.0);
    const Far from = moved_exactly(twist, q, 0.0), to = moved_exactly(twist, q, time);
    for (int k = 1; k < 32; ++k) {
      const Number share = Number(k) / 32;
      const Far on_chord{from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)};
      const double off = distance(moved_exactly(twist, q, time * k / 32.0), on_chord);
      ASSERT_LE(off, stray_of(twist, q, time));
      most = std::max(most, off / stray_of(twist, q, time));
    }
  }
  EXPECT_GE(most, 0.99);
}

TEST(Twist, BetweenTwoPosesLeadsFromOneToTheOther) {
  SeededRandom random(seed_of_run(73));
  for (int i = 0; i < 1000; ++i) {
    const Pose from{random.in_box(3.0), random.uniform(-9.0, 9.0)}, to{random.in_box(3.0), random.uniform(-9.0, 9.0)};
    const double time = random.uniform(0.1, 3.0);
    const Twist twist = twist_between(from, to, time);
    const Pose reached = pose_after(from, twist, time);
    ASSERT_NEAR(reached.at.x, to.at.x, 1e-12);
    ASSERT_NEAR(reached.at.y, to.at.y, 1e-12);
    ASSERT_NEAR(std::remainder(reached.heading - to.heading, 2.0 * geometry::kPi), 0.0, 1e-13);
    ASSERT_LE(std::fabs(twist.turn) * time, geometry::kPi * (1.0 + 1e-15));
  }
}

TEST(Twist, OfAReferencePointLeadsItStraightWhereItShouldBe) {
  SeededRandom random(seed_of_run(74));
  for (int i = 0; i < 1000; ++i) {
    const double ahead = random.uniform(0.05, 0.5), time = random.uniform(0.02, 0.2);
    const Vec2 u = random.in_box(1.3 * ahead / time);
    const ReferenceTwist r = reference_twist(u, ahead, time);
    const Displacement d = geometry::displacement_after({{r.forward, 0.0}, r.turn}, time);
    const Vec2 reached = d.moved({ahead, 0.0});
    ASSERT_NEAR(reached.x, ahead + time * u.x, 1e-14);
    ASSERT_NEAR(reached.y, time * u.y, 1e-14);
    const double t = r.half_tangent;
    ASSERT_NEAR(d.cosine, (1 - t * t) / (1 + t * t), 1e-14);
  }
  EXPECT_THROW(geometry::reference_twist({2.0, 0.0}, 0.1, 0.1), std::logic_error) << "as far as the point is ahead";
}

TEST(Twist, WheelsDifferByTheTurn) {
  const geometry::WheelSpeeds w = geometry::wheel_speeds(1.0, 0.5, 0.4);
  EXPECT_DOUBLE_EQ(w.left, 0.9);
  EXPECT_DOUBLE_EQ(w.right, 1.1);
}

}  // namespace
}  // namespace exactvo::test
