// SPDX-License-Identifier: GPL-3.0-or-later
// Two TurtleBot3 Burgers change places, each by a navigator of its own. What is proven is the motion of a reference
// pose, which each sends to the other; the robot follows its reference with wheels that slip and lag, by poses that are
// noisy and 0.1 s old. As long as no axle strays from its reference by more than kTube, the bodies keep clear.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "exactvo/formation/navigator.h"

using namespace exactvo;
using namespace exactvo::formation;
using geometry::Vec2;

constexpr double kStep = 0.05;   // s
constexpr double kTube = 0.03;   // m: a part of the radius
constexpr std::size_t kAge = 2;  // steps, of a measured pose

struct Pose {
  Vec2 axle;
  double heading;  // radians
};

/// What a drive does in `seconds`.
Pose driven(Pose from, double linear, double angular, double seconds) {
  const double half = 0.5 * angular * seconds, chord = std::fabs(half) < 1e-9 ? 1.0 : std::sin(half) / half;
  const double along = from.heading + half;
  return {from.axle + linear * seconds * chord * Vec2{std::cos(along), std::sin(along)}, from.heading + 2.0 * half};
}

OnWheels on_wheels(const Pose& pose, WheelSpeeds wheels) {
  return {{std::cos(pose.heading), std::sin(pose.heading)}, wheels};
}

DifferentialDrive burger() {
  DifferentialDrive drive;
  drive.wheel_separation = 0.16;
  drive.max_wheel_speed = 0.2;         // of 0.22 m/s: the rest is for corrections
  drive.max_wheel_acceleration = 0.8;  // of 1 m/s^2
  drive.reference = 0.08;
  drive.body_radius = 0.105 + kTube;
  return drive;
}

NavigatorSetup setup_of(std::size_t id) {
  NavigatorSetup setup;
  setup.id = id;
  setup.time_step = kStep;
  setup.arrival_tolerance = 0.02;
  setup.drive = burger();
  return setup;
}

struct Burger {
  Burger(std::size_t number, Pose start, Vec2 goal)
      : id(number), navigator(setup_of(number), {goal}), reference(start), body(start), past(kAge + 1, start) {}

  std::size_t id;
  Navigator navigator;
  Pose reference, body;
  WheelSpeeds told{}, running{};  // of the reference, and of the body
  std::vector<Pose> past;         // references, the latest first: a measured pose is held against the one of its time
  std::vector<Pose> seen{};       // bodies, the same
};

/// The reference's twist and what brings the body back to it: from a pose that was measured kAge steps ago.
Twist follow(const Burger& robot, Twist twist, std::mt19937& random) {
  const auto noise = [&](double most) { return most * (2.0 * static_cast<double>(random()) / 4294967295.0 - 1.0); };
  if (robot.seen.size() <= kAge) return twist;
  const Pose& was = robot.seen[kAge];
  const Pose& meant = robot.past[kAge];
  const Vec2 off = meant.axle - (was.axle + Vec2{noise(0.005), noise(0.005)});
  const Vec2 ahead{std::cos(was.heading), std::sin(was.heading)};
  const double turn = std::remainder(meant.heading - (was.heading + noise(0.01)), 6.283185307179586);
  twist.linear += 0.8 * dot(ahead, off);
  twist.angular += 1.5 * turn + 8.0 * twist.linear * cross(ahead, off);
  return twist;
}

/// Wheels lag, and slip by up to 3 %.
void drive(Burger& robot, Twist twist, std::mt19937& random) {
  const double half = 0.5 * burger().wheel_separation;
  const auto slip = [&] { return 1.0 - 0.03 * static_cast<double>(random()) / 4294967295.0; };
  constexpr int kParts = 10;
  constexpr double kLag = 0.02;  // s
  for (int k = 0; k < kParts; ++k) {
    const double share = kStep / kParts / kLag;
    robot.running.left += share * (std::clamp(twist.linear - half * twist.angular, -0.22, 0.22) - robot.running.left);
    robot.running.right += share * (std::clamp(twist.linear + half * twist.angular, -0.22, 0.22) - robot.running.right);
    const double left = slip() * robot.running.left, right = slip() * robot.running.right;
    robot.body = driven(robot.body, 0.5 * (left + right), (right - left) / (2.0 * half), kStep / kParts);
  }
}

int main() {
  std::mt19937 random(1);
  const DifferentialDrive one = burger();
  std::array<Burger, 2> robots{Burger{0, {{0.0, 0.0}, 0.0}, {2.0, 0.0}},
                               Burger{1, {{2.0, 0.1}, 3.141592653589793}, {0.0, 0.1}}};
  // Sent at the last step, for this one: a message may take as long as a step.
  std::array<Neighbour, 2> inbox;
  const auto send = [&](const Burger& from) {
    inbox[1 - from.id] =
        neighbour_on_wheels(from.id, one, kStep, from.reference.axle, on_wheels(from.reference, from.told));
  };
  for (const Burger& robot : robots) send(robot);
  double least_gap = 1e9, most_off = 0.0, time = 0.0;
  for (; time < 60.0 && !(robots[0].navigator.has_arrived() && robots[1].navigator.has_arrived()); time += kStep) {
    const std::array<Neighbour, 2> received = inbox;
    for (Burger& robot : robots) {
      const OnWheels now = on_wheels(robot.reference, robot.told);
      const Decision& decision = robot.navigator.decide({time, robot.reference.axle, {}, now}, {received[robot.id]});
      if (decision.status != lp::Status::optimal || decision.uncertified > 0) return 1;  // nothing is promised: stop
      const Twist twist = robot.navigator.twist();
      robot.reference = driven(robot.reference, twist.linear, twist.angular, kStep);
      robot.told = twist.wheels;
      send(robot);
      robot.seen.insert(robot.seen.begin(), robot.body);
      drive(robot, follow(robot, twist, random), random);
      robot.past.insert(robot.past.begin(), robot.reference);
      most_off = std::max(most_off, norm(robot.body.axle - robot.reference.axle));
    }
    least_gap = std::min(least_gap, norm(robots[0].body.axle - robots[1].body.axle) - 2.0 * 0.105);
  }
  std::printf("arrived after %.2f s; bodies never nearer than %.3f m, %.3f m off their references at most\n", time,
              least_gap, most_off);
  return time < 60.0 && least_gap > 0.0 && most_off <= kTube ? 0 : 1;
}
