// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's exact QP solver. It knows no disc: the speed bound is the box around it, so its optimum is compared only where
// the disc does not bind.
#include <CGAL/Gmpzf.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>

#include "competitor.h"

namespace exactvo::bench {
namespace {

using Program = CGAL::Quadratic_program<double>;
using Result = CGAL::Quadratic_program_solution<CGAL::Gmpzf>;

Program program_of(const lp::Problem& problem) {
  Program program(CGAL::LARGER, false, 0, false, 0);
  for (const int axis : {0, 1}) {
    program.set_l(axis, true, -problem.bound.disc);
    program.set_u(axis, true, problem.bound.disc);
    program.set_d(axis, axis, 2.0);  // D holds twice the quadratic form
  }
  program.set_c(0, -2.0 * problem.preferred.x);
  program.set_c(1, -2.0 * problem.preferred.y);
  int row = 0;
  for (const lp::Constraint& c : problem.constraints) {
    program.set_a(0, row, c.half_plane.normal.x);
    program.set_a(1, row, c.half_plane.normal.y);
    program.set_b(row++, c.half_plane.offset);
  }
  return program;
}

Answer cgal_qp(const lp::Problem& problem) {
  const Result result = CGAL::solve_quadratic_program(program_of(problem), CGAL::Gmpzf());
  if (result.is_infeasible()) return {};
  auto value = result.variable_values_begin();
  const double x = CGAL::to_double(*value++);
  return {{x, CGAL::to_double(*value)}, true};
}

const Join joins("cgal-qp-Gmpzf", cgal_qp, {true, false, 256, true});

}  // namespace
}  // namespace exactvo::bench
