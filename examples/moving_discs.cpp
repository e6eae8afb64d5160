// SPDX-License-Identifier: GPL-3.0-or-later
// Two robots whose samples are clear of each other collide between them; a third is proven clear.
#include <cstdio>

#include "exactvo/geometry/motion_certificate.h"
#include "exactvo/geometry/motions.h"

using namespace exactvo::geometry;

int main() {
  // One sample a second: at t = 0 and at t = 1 the robots are 7 m apart. Both have a radius of 0.25 m.
  const StraightMotion east{{0.0, {0.0, 0.0}}, {1.0, {10.0, 0.0}}};
  const StraightMotion north{{0.0, {5.0, -5.0}}, {1.0, {5.0, 5.0}}};
  const RigidBody robot = disc_body(0.25);

  const MotionVerdict v = examine(east, robot, north, robot);
  std::printf("overlap: %s, from %.6f s to %.6f s, up to %.3f m deep, at (%.2f, %.2f)\n",
              v.encounter == Encounter::overlap ? "yes" : "no", v.first.low, v.last.high, -v.clearance.low, v.place.x,
              v.place.y);

  // A third robot brakes on a parabola and stays clear. The certificate is checked in rationals.
  const CurvedMotion braking{CurveBasis::powers, 0.0, 1.0, {{5.0, -5.0}, {0.0, 8.0}, {0.0, -4.0}}};
  const auto certificate = certify(east, robot, braking, robot);
  const bool proven = certificate && proves_clear(*certificate, east, robot, braking, robot);
  std::printf("clear by at least %.6f m: %s\n", examine(east, robot, braking, robot).clearance.low,
              proven ? "proven" : "not proven");
  return v.encounter == Encounter::overlap && proven ? 0 : 1;
}
