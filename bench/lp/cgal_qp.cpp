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

class CgalQp : public Competitor {
 public:
  explicit CgalQp(const std::vector<lp::Problem>& problems) : answers_(problems.size()) {
    for (const lp::Problem& p : problems) programs_.push_back(program_of(p));
  }
  std::size_t count() const override { return answers_.size(); }
  Answer answer(std::size_t i) const override { return answers_[i]; }
  void run() override {
    for (std::size_t i = 0; i < programs_.size(); ++i) answers_[i] = solve(programs_[i]);
  }

 private:
  static Answer solve(const Program& program) {
    const Result result = CGAL::solve_quadratic_program(program, CGAL::Gmpzf());
    if (result.is_infeasible()) return {};
    auto value = result.variable_values_begin();
    const double x = CGAL::to_double(*value++);
    return {{x, CGAL::to_double(*value)}, true};
  }

  std::vector<Program> programs_;
  std::vector<Answer> answers_;
};

}  // namespace

std::unique_ptr<Competitor> make_cgal_qp(const std::vector<lp::Problem>& problems) {
  return std::make_unique<CgalQp>(problems);
}

}  // namespace exactvo::bench
