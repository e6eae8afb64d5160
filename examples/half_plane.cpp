// SPDX-License-Identifier: GPL-3.0-or-later
// From an obstacle to a half-plane of safe velocities, and the proof that it is one.
#include <cstdio>

#include "exactvo/geometry/predicates.h"
#include "exactvo/vo/velocity_obstacle.h"

int main() {
  // A robot of radius 0.5 m at the origin, an ellipse 6 m ahead, velocities to be safe for 2 s.
  const auto ellipse = exactvo::geometry::ellipse_from_axes({6.0, 0.5}, {3.0, 1.0, 1.2});
  const double horizon = 2.0;
  const exactvo::vo::VelocityObstacle obstacle(ellipse, {0.0, 0.0}, 0.5, horizon);

  const exactvo::geometry::Vec2 wanted{3.0, 0.0};
  std::printf("(%g, %g) m/s collides within %g s: %s\n", wanted.x, wanted.y, horizon,
              obstacle.contains(wanted) ? "yes" : "no");

  const auto safe = obstacle.half_plane(wanted);
  if (!safe) return 1;  // only where the robot touches the obstacle
  std::printf("safe: %g v_x %+g v_y >= %g\n", safe->normal.x, safe->normal.y, safe->offset);

  // Exact, whatever rounding went into the half-plane: it is disjoint from the interior of the velocity obstacle.
  const bool proven = exactvo::geometry::half_plane_is_safe(obstacle.grown(), horizon, *safe);
  std::printf("proven: %s\n", proven ? "yes" : "no");
  return proven && obstacle.contains(wanted) ? 0 : 1;
}
