// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem_text.h"

#include <sstream>

namespace exactvo::lp {

std::string text_of(const Problem& problem) {
  std::ostringstream out;
  out << std::hexfloat << "disc " << problem.bound.disc << "\nbox " << problem.bound.box_x << ' ' << problem.bound.box_y
      << '\n';
  out << (problem.objective == Objective::nearest ? "preferred " : "farthest ") << problem.preferred.x << ' '
      << problem.preferred.y << '\n';
  for (const Constraint& c : problem.constraints)
    out << (c.priority == Priority::hard ? "hard " : "soft ") << c.half_plane.normal.x << ' ' << c.half_plane.normal.y
        << ' ' << c.half_plane.offset << '\n';
  return out.str();
}

}  // namespace exactvo::lp
