// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "exactvo/formation/recording.h"

namespace exactvo::datasets::test {

/// Bit for bit: NaN equals itself, 0.0 and -0.0 differ.
inline bool same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}
inline bool same_bits(geometry::Vec2 a, geometry::Vec2 b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y);
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b);

inline bool same_bits(const geometry::Polyline& a, const geometry::Polyline& b) {
  return same_bits(a.points, b.points);
}
inline bool same_bits(const geometry::Polygon& a, const geometry::Polygon& b) {
  return same_bits(a.outer, b.outer) && same_bits(a.holes, b.holes);
}
inline bool same_bits(const geometry::Disc& a, const geometry::Disc& b) {
  return same_bits(a.center, b.center) && same_bits(a.radius, b.radius);
}
inline bool same_bits(const geometry::Segment& a, const geometry::Segment& b) {
  return same_bits(a.a, b.a) && same_bits(a.b, b.b);
}
inline bool same_bits(const geometry::ConvexPolygon& a, const geometry::ConvexPolygon& b) {
  return same_bits(a.vertices, b.vertices);
}
inline bool same_bits(const geometry::Ellipse& a, const geometry::Ellipse& b) {
  return same_bits(a.center, b.center) && same_bits(a.l11, b.l11) && same_bits(a.l21, b.l21) && same_bits(a.l22, b.l22);
}

template <class... T>
bool same_bits(const std::variant<T...>& a, const std::variant<T...>& b) {
  if (a.index() != b.index()) return false;
  return std::visit([&](const auto& shape) { return same_bits(shape, std::get<std::decay_t<decltype(shape)>>(b)); }, a);
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!same_bits(a[i], b[i])) return false;
  }
  return true;
}

inline void expect_same(const formation::Robot& a, const formation::Robot& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_TRUE(same_bits(a.position, b.position)) << a.id;
  EXPECT_TRUE(same_bits(a.velocity, b.velocity)) << a.id;
  EXPECT_TRUE(same_bits(a.radius, b.radius)) << a.id;
  EXPECT_TRUE(same_bits(a.body_radius, b.body_radius)) << a.id;
  EXPECT_TRUE(same_bits(a.max_speed, b.max_speed)) << a.id;
  EXPECT_TRUE(same_bits(a.goals, b.goals)) << a.id;
  ASSERT_EQ(a.drive.has_value(), b.drive.has_value()) << a.id;
  if (!a.drive) return;
  const auto numbers = [](const formation::DifferentialDrive& d) {
    return std::vector<double>{d.wheel_separation,
                               d.max_wheel_speed,
                               d.max_wheel_acceleration,
                               d.max_angular_speed,
                               d.max_backward_speed,
                               d.reference,
                               d.heading,
                               d.axle.x,
                               d.axle.y,
                               d.body_radius};
  };
  EXPECT_TRUE(same_bits(numbers(*a.drive), numbers(*b.drive))) << a.id;
  EXPECT_TRUE(same_bits(a.drive->footprint, b.drive->footprint)) << a.id;
}

inline bool same_bits(const std::optional<geometry::Disc>& a, const std::optional<geometry::Disc>& b) {
  return a.has_value() == b.has_value() && (!a || same_bits(*a, *b));
}

inline void expect_same(const formation::MovingObstacle& a, const formation::MovingObstacle& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_TRUE(same_bits(a.shape, b.shape)) << a.id;
  EXPECT_TRUE(same_bits(a.disc, b.disc)) << a.id;
  EXPECT_TRUE(same_bits(a.motion.path, b.motion.path)) << a.id;
  EXPECT_TRUE(a.motion.profile.size() == b.motion.profile.size()) << a.id;
  EXPECT_TRUE(!a.motion.profile.empty() || same_bits(a.motion.speed, b.motion.speed)) << a.id;
}

inline void expect_same(const formation::FormationSpec& a, const formation::FormationSpec& b) {
  EXPECT_TRUE(same_bits(a.topology.adjacency, b.topology.adjacency));
  EXPECT_TRUE(same_bits(a.topology.pinning, b.topology.pinning));
  EXPECT_TRUE(same_bits(a.offsets, b.offsets));
  EXPECT_EQ(a.recentre, b.recentre);
  EXPECT_TRUE(same_bits(a.leader.path, b.leader.path));
  EXPECT_TRUE(same_bits(a.leader.speed, b.leader.speed));
  ASSERT_EQ(a.leader.profile.size(), b.leader.profile.size());
  for (std::size_t k = 0; k < a.leader.profile.size(); ++k) {
    EXPECT_TRUE(same_bits(a.leader.profile[k].time, b.leader.profile[k].time));
    EXPECT_TRUE(same_bits(a.leader.profile[k].speed, b.leader.profile[k].speed));
  }
  for (const formation::ControllerSwitch& s : formation::controller_switches())
    EXPECT_EQ(a.controller_options.*s.asked, b.controller_options.*s.asked) << s.name;
  EXPECT_EQ(a.controller_options.acceleration_bound, b.controller_options.acceleration_bound);
  EXPECT_TRUE(same_bits(std::vector<double>{a.gains.k1, a.gains.k2, a.gains.k3, a.gains.kappa},
                        std::vector<double>{b.gains.k1, b.gains.k2, b.gains.k3, b.gains.kappa}));
  EXPECT_TRUE(same_bits(a.catch_up_speed, b.catch_up_speed));
}

inline std::vector<double> numbers_of(const formation::Scenario& s) {
  return {s.horizons.least,  s.horizons.most,     s.horizons.speed_floor, s.horizons.orca,
          s.horizons.robots, s.margins.obstacle,  s.margins.robot,        s.time_step,
          s.time_limit,      s.arrival_tolerance, s.neighbour_distance};
}

inline void expect_same(const formation::Scenario& a, const formation::Scenario& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.description, b.description);
  ASSERT_EQ(a.robots.size(), b.robots.size());
  for (std::size_t i = 0; i < a.robots.size(); ++i) expect_same(a.robots[i], b.robots[i]);
  ASSERT_EQ(a.obstacles.size(), b.obstacles.size());
  for (std::size_t k = 0; k < a.obstacles.size(); ++k) {
    EXPECT_EQ(a.obstacles[k].id, b.obstacles[k].id);
    EXPECT_TRUE(same_bits(a.obstacles[k].shape, b.obstacles[k].shape)) << a.obstacles[k].id;
    EXPECT_TRUE(same_bits(a.obstacles[k].disc, b.obstacles[k].disc)) << a.obstacles[k].id;
  }
  ASSERT_EQ(a.moving_obstacles.size(), b.moving_obstacles.size());
  for (std::size_t k = 0; k < a.moving_obstacles.size(); ++k) expect_same(a.moving_obstacles[k], b.moving_obstacles[k]);
  ASSERT_EQ(a.formation.has_value(), b.formation.has_value());
  if (a.formation) expect_same(*a.formation, *b.formation);
  EXPECT_TRUE(a.formation || a.guidance == b.guidance);
  EXPECT_TRUE(a.formation || a.unreachable == b.unreachable);
  EXPECT_TRUE(a.formation || a.liveness == b.liveness);
  EXPECT_EQ(a.separate, b.separate);
  EXPECT_EQ(a.speed_bound, b.speed_bound);
  EXPECT_TRUE(same_bits(numbers_of(a), numbers_of(b)));
  ASSERT_EQ(a.acceleration.has_value(), b.acceleration.has_value());
  EXPECT_TRUE(!a.acceleration || same_bits(a.acceleration->max, b.acceleration->max));
  EXPECT_EQ(a.braking_time, b.braking_time);
  EXPECT_TRUE(same_bits(tracking_error_of(a), tracking_error_of(b)));
  ASSERT_EQ(measures_others(a), measures_others(b));
  if (measures_others(a)) {
    const formation::Measurements &x = *a.uncertainty->measurements, &y = *b.uncertainty->measurements;
    EXPECT_TRUE(same_bits(x.position, y.position) && same_bits(x.velocity, y.velocity) && same_bits(x.age, y.age));
  }
}

}  // namespace exactvo::datasets::test
