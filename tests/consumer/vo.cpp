// SPDX-License-Identifier: GPL-3.0-or-later
#include <exactvo/vo/lp/solve.h>
#include <exactvo/vo/velocity_obstacle.h>
#include <iostream>
int main() {
  // A wall, seen by a robot at the origin: its radius is 0.5 m, and it looks 2 s ahead (the horizon).
  const exactvo::vo::VelocityObstacle wall(exactvo::geometry::Segment{{4, -3}, {4, 3}}, {0, 0}, 0.5, 2.0);
  exactvo::lp::Problem problem;
  problem.preferred = {3, 0};
  problem.bound.disc = 3.0;
  const auto safe = wall.half_plane(problem.preferred);
  if (!safe) return 1;  // the robot touches the wall: contact_half_plane() leads away from it
  problem.constraints.push_back({*safe});
  const auto best = exactvo::lp::solve(problem);
  std::cout << best.velocity.x << " " << best.velocity.y << "\n";  // 1.75 0: 3.5 m in 2 s
}
