// SPDX-License-Identifier: GPL-3.0-or-later
#include <exactvo/vo/lp/solve.h>
#include <exactvo/vo/velocity_obstacle.h>
#include <iostream>
int main() {
  const exactvo::vo::VelocityObstacle wall(exactvo::geometry::Segment{{4, -3}, {4, 3}}, {0, 0}, 0.5, 2.0);
  exactvo::lp::Problem problem;
  problem.preferred = {3, 0};
  problem.bound.disc = 3.0;
  problem.constraints.push_back({*wall.half_plane(problem.preferred)});
  const auto best = exactvo::lp::solve(problem);
  std::cout << best.velocity.x << " " << best.velocity.y << "\n";
}
