// SPDX-License-Identifier: GPL-3.0-or-later
// Half-planes and a preferred velocity in, the nearest allowed velocity out; and what happens when nothing is allowed.
#include <cstdio>

#include "exactvo/vo/lp/solve.h"

using namespace exactvo;

namespace {

void print(const char* what, const lp::Solution& s) {
  std::printf("%s: (%.4f, %.4f) m/s, %s", what, s.velocity.x, s.velocity.y, lp::name(s.status));
  if (s.status == lp::Status::relaxed) std::printf(", a soft constraint gives by %.4f m/s", s.violation);
  std::printf("\n");
}

}  // namespace

int main() {
  lp::Problem problem;
  problem.preferred = {3.0, 0.0};
  problem.bound.disc = 3.0;
  problem.constraints = {{{{-1.0, 0.0}, -1.0}, lp::Priority::hard, 0},  // v_x <= 1: a wall ahead
                         {{{0.0, 1.0}, 0.5}, lp::Priority::soft, 1}};   // v_y >= 0.5: a robot on the right
  const lp::Solution both = lp::solve(problem);
  print("wall and robot", both);

  problem.constraints.push_back({{{0.0, -1.0}, 0.0}, lp::Priority::hard, 2});  // v_y <= 0: a wall on the left
  const lp::Solution squeezed = lp::solve(problem);
  print("squeezed", squeezed);

  const bool as_expected = both.status == lp::Status::optimal && squeezed.status == lp::Status::relaxed;
  return as_expected ? 0 : 1;
}
