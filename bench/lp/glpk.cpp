// SPDX-License-Identifier: GPL-3.0-or-later
// GLPK knows no quadratic objective: it maximises preferred . v over the lines and the box around the disc, which is as
// much work for its simplex as the real question.
#include <glpk.h>

#include "competitor.h"

namespace exactvo::bench {
namespace {

Answer glpk(const lp::Problem& problem) {
  glp_prob* lp = glp_create_prob();
  glp_set_obj_dir(lp, GLP_MAX);
  glp_add_cols(lp, 2);
  const double direction[] = {problem.preferred.x, problem.preferred.y};
  for (int axis = 0; axis < 2; ++axis) {
    glp_set_col_bnds(lp, axis + 1, GLP_DB, -problem.bound.disc, problem.bound.disc);
    glp_set_obj_coef(lp, axis + 1, direction[axis]);
  }
  if (!problem.constraints.empty()) glp_add_rows(lp, static_cast<int>(problem.constraints.size()));
  int row = 0;
  for (const lp::Constraint& c : problem.constraints) {
    const int columns[] = {0, 1, 2};
    const double values[] = {0.0, c.half_plane.normal.x, c.half_plane.normal.y};
    glp_set_mat_row(lp, ++row, 2, columns, values);
    glp_set_row_bnds(lp, row, GLP_LO, c.half_plane.offset, 0.0);
  }
  glp_smcp parameters;
  glp_init_smcp(&parameters);
  parameters.msg_lev = GLP_MSG_OFF;
  glp_simplex(lp, &parameters);
  const Answer answer = {{glp_get_col_prim(lp, 1), glp_get_col_prim(lp, 2)}, glp_get_status(lp) == GLP_OPT};
  glp_delete_prob(lp);
  return answer;
}

const Join joins("glpk", glpk, {true, false, 4096, true});

}  // namespace
}  // namespace exactvo::bench
