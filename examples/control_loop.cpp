// SPDX-License-Identifier: GPL-3.0-or-later
// A control loop: a robot round a wall, past another one that comes towards it. Where its sensors would tell, two lines
// move both; a node of ROS has them in its callbacks.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "exactvo/formation/navigator.h"

using namespace exactvo;
using namespace exactvo::formation;

int main() {
  NavigatorSetup setup;
  setup.radius = 0.3;
  setup.max_speed = 1.5;
  setup.obstacles = {{"wall", geometry::Polyline{{{3.0, -2.0}, {3.0, 1.0}}}}};
  Navigator navigator(setup, {{6.0, 0.0}});

  NavigatorState me{0.0, {0.0, 0.0}, {0.0, 0.0}};
  std::vector<Neighbour> others{{1, {6.0, 2.5}, {-0.8, 0.0}, 0.3, 1.0, /*cooperates=*/false}};
  double nearest = 1e9;
  for (; !navigator.has_arrived() && me.time < 30.0; me.time += setup.time_step) {
    const Decision& decision = navigator.decide(me, others);
    if (decision.status != lp::Status::optimal || decision.uncertified > 0) return 1;  // nothing is promised: brake
    me.velocity = decision.chosen;                                                     // what the wheels are told
    me.position += setup.time_step * me.velocity;
    others[0].position += setup.time_step * others[0].velocity;
    nearest = std::min(nearest, geometry::norm(me.position - others[0].position) - 0.6);
  }
  std::printf("arrived after %.2f s, never nearer than %.3f m to the other robot\n", me.time, nearest);
  return navigator.has_arrived() && nearest > 0.0 ? 0 : 1;
}
