// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// TurtleBot3 Burgers (docs/guide/wheels.md), and random edits of what a recording says of their wheels.

#include <algorithm>
#include <cmath>
#include <string>

#include "exactvo/datasets/recording_file.h"
#include "exactvo/datasets/run_info.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/vec2.h"
#include "motion/differential.h"
#include "support/seeded_random.h"

namespace exactvo::formation::test_scenes {

inline DifferentialDrive burger() {
  DifferentialDrive d;
  d.wheel_separation = 0.16;
  d.max_wheel_speed = 0.22;
  d.max_wheel_acceleration = 1.0;
  d.reference = 0.08;
  d.body_radius = 0.105;
  return d;
}

inline Vec2 polar(double length, double angle) {
  return length * Vec2{std::cos(angle), std::sin(angle)};
}

inline void add_burger(Scenario& s, Vec2 reference, double heading, std::vector<Vec2> goals) {
  Robot r;
  r.id = "R" + std::to_string(s.robots.size() + 1);
  DifferentialDrive d = burger();
  d.heading = heading;
  d.axle = reference - d.reference * heading_vector(heading);
  put_on_wheels(r, d, s.time_step, tracking_error_of(s));
  r.goals = std::move(goals);
  s.robots.push_back(std::move(r));
}

/// Each crosses a circle of reference points to the opposite place. `is_turned`: the headings at the start are random.
/// `tracking`: m.
inline Scenario burgers_on_circle(int robots, double radius, bool is_turned, std::uint64_t seed = 5,
                                  double tracking = 0.0) {
  Scenario s;
  if (tracking > 0.0) s.uncertainty = Uncertainty{tracking};
  s.name = "burgers";
  s.time_limit = 90.0;
  s.arrival_tolerance = 0.02;
  s.braking_time = 0.5;
  s.margins.robot = 0.0;
  test::SeededRandom random(seed);
  for (int k = 0; k < robots; ++k) {
    const double angle = 2.0 * geometry::kPi * k / robots;
    const double heading = angle + geometry::kPi + (is_turned ? random.uniform(-3.1, 3.1) : 0.0);
    add_burger(s, polar(radius, angle), 180.0 / geometry::kPi * heading, {polar(-radius, angle)});
  }
  return s;
}

inline void add_pillars(Scenario& s) {
  for (const double angle : {0.2, 2.3, 4.4}) {
    const Vec2 at = polar(0.9, angle);
    constexpr double kHalf = 0.1;
    s.obstacles.push_back({"pillar" + std::to_string(s.obstacles.size() + 1),
                           geometry::Polygon{{at + Vec2{-kHalf, -kHalf}, at + Vec2{kHalf, -kHalf},
                                              at + Vec2{kHalf, kHalf}, at + Vec2{-kHalf, kHalf}},
                                             {}}});
  }
}

/// 24 with random goals, one after the other, in a room of 5 m with three pillars: so full that half-planes contradict
/// each other.
inline Scenario crowded_room(test::SeededRandom& random) {
  constexpr double kHalf = 2.5, kInside = kHalf - 0.2;
  Scenario s = burgers_on_circle(0, 1.0, false);
  s.name = "crowded room";
  s.time_limit = 30.0;
  s.guidance = random.integer(0, 1) == 0 ? Guidance::route : Guidance::none;
  s.obstacles.push_back(
      {"room",
       geometry::Polyline{{{-kHalf, -kHalf}, {kHalf, -kHalf}, {kHalf, kHalf}, {-kHalf, kHalf}, {-kHalf, -kHalf}}}});
  add_pillars(s);
  const auto is_free = [&](Vec2 place) {
    for (const double angle : {0.2, 2.3, 4.4})
      if (norm(place - polar(0.9, angle)) < 0.4) return false;
    return std::all_of(s.robots.begin(), s.robots.end(),
                       [&](const Robot& r) { return norm(r.position - place) > 0.4; });
  };
  const auto place = [&] {
    for (;;)
      if (const Vec2 at = random.in_box(kInside); is_free(at)) return at;
  };
  while (s.robots.size() < 24) {
    const Vec2 at = place();
    std::vector<Vec2> goals;
    for (int k = 0; k < 30; ++k) goals.push_back(random.in_box(kInside));
    add_burger(s, at, random.uniform(-180.0, 180.0), std::move(goals));
  }
  return s;
}

inline datasets::RecordingFile recorded(const Scenario& s) {
  return {datasets::run_info(s, {}, {}), s, simulate(s)};
}

/// s: from when on all robots are at their goals.
inline double last_arrival(const datasets::RecordingFile& file) {
  double last = 0.0;
  for (const Step& row : file.recording.steps)
    for (std::size_t i = 0; i < row.robots.size(); ++i)
      if (norm(row.robots[i].position - file.scenario.robots[i].goals.back()) > file.scenario.arrival_tolerance)
        last = row.time + file.scenario.time_step;
  return last;
}

inline std::size_t relaxed_in(const Recording& run) {
  std::size_t relaxed = 0;
  for (std::size_t k = 0; k + 1 < run.steps.size(); ++k)
    for (const RobotStep& r : run.steps[k].robots) relaxed += r.status != lp::Status::optimal;
  return relaxed;
}

constexpr int kKindsOfEdit = 7;

/// Changes a heading, a wheel, a choice, or a choice with the whole step that follows from it, by a millionth to one.
/// `kind`: 0 to kKindsOfEdit - 1. Returns what it did.
inline std::string edit_wheels(datasets::RecordingFile& file, int kind, test::SeededRandom& random) {
  const int last = static_cast<int>(file.recording.steps.size()) - 1;
  const auto row = static_cast<std::size_t>(random.integer(0, last - 1));
  const auto i = static_cast<std::size_t>(random.integer(0, static_cast<int>(file.scenario.robots.size()) - 1));
  RobotStep& robot = file.recording.steps[row].robots[i];
  const double by = std::pow(10.0, random.uniform(-6.0, 0.0)) * (random.integer(0, 1) == 0 ? -1.0 : 1.0);
  constexpr const char* kWords[kKindsOfEdit] = {"heading turned", "heading.y", "left wheel", "right wheel",
                                                "choice.x",       "choice.y",  "twist"};
  if (kind == 0) robot.wheels->heading = geometry::rotated(robot.wheels->heading, by);
  if (kind == 1) robot.wheels->heading.y += by;
  if (kind == 2) robot.wheels->speeds.left += by;
  if (kind == 3) robot.wheels->speeds.right += by;
  if (kind == 4) robot.chosen.x += by;
  if (kind == 5) robot.chosen.y += by;
  if (kind == 6) {
    const Scenario& s = file.scenario;
    robot.chosen += 0.1 * by * random.direction();
    RobotStep& next = file.recording.steps[row + 1].robots[i];
    const detail::TwistOfStep twist =
        detail::twist_of(*s.robots[i].drive, s.time_step, robot.wheels->heading, robot.chosen);
    next.wheels = OnWheels{detail::turned(robot.wheels->heading, twist.turn), twist.wheels};
    next.velocity = next.anchor_velocity = robot.chosen;
    next.position = next.anchor = robot.position + s.time_step * robot.chosen;
  }
  return std::string(kWords[kind]) + " of robot " + std::to_string(i) + " in row " + std::to_string(row) + " by " +
         std::to_string(by);
}

}  // namespace exactvo::formation::test_scenes
