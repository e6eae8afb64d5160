// SPDX-License-Identifier: GPL-3.0-or-later
// A control loop with a monitor: whatever drives the robot wants to go straight on, the monitor lets pass what is
// proven clear. The exact verdict of each step shows that nothing was touched: the margin keeps the robot out of
// contact, where a step may go a nanometre deeper.
#include <algorithm>
#include <cstdio>

#include "exactvo/formation/monitor.h"
#include "exactvo/geometry/turning_motions.h"

using namespace exactvo;
using namespace exactvo::formation;

int main() {
  MonitorSetup setup;
  setup.footprint = {{{{-0.3, -0.25}, {0.7, -0.25}, {0.7, 0.25}, {-0.3, 0.25}}, 0.0}};
  setup.period = 0.1;
  setup.latency = 0.0;  // the command takes effect at once, and the next one 0.1 s later
  setup.margin = 0.001;
  setup.obstacles = {{"wall", geometry::Polyline{{{4.0, -3.0}, {4.0, 3.0}}}}};
  Monitor monitor(setup);

  geometry::Pose pose{{0.0, 0.0}, 0.3};
  double nearest = 1e9;
  for (int step = 0; step < 100; ++step) {
    const Command wanted{{{1.5, 0.0}, -0.2}, false};  // from a planner, a joystick, a policy
    const MonitorVerdict verdict = monitor.judge(pose, wanted);
    const geometry::Twist driven{verdict.share * wanted.twist.velocity, verdict.share * wanted.twist.turn};

    geometry::RigidBody body = setup.footprint;
    for (geometry::Vec2& corner : body[0].corners) corner = geometry::rotated(corner, pose.heading);
    const geometry::TurningMotion drive{
        0.0, setup.period, pose.at, {geometry::rotated(driven.velocity, pose.heading), driven.turn}};
    if (encounter(drive, body, setup.obstacles[0].shape) != geometry::Encounter::clear) return 1;

    pose = pose_after(pose, driven, setup.period);
    for (const geometry::Vec2 c : setup.footprint[0].corners)
      nearest = std::min(nearest, 4.0 - (pose.at + geometry::rotated(c, pose.heading)).x);
  }
  std::printf("stopped %.4f m before the wall\n", nearest);
  return nearest > 0.0009 && nearest < 0.01 ? 0 : 1;
}
