// SPDX-License-Identifier: GPL-3.0-or-later
// One linear program at a time.
#include <pybind11/stl.h>

#include <cmath>

#include "arguments.h"
#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/problem.h"
#include "exactvo/vo/lp/solve.h"
#include "exactvo/vo/lp/solvers.h"
#include "module.h"

namespace exactvo::python {

namespace {

lp::Status status_of(const std::string& text) {
  for (const auto status : {lp::Status::optimal, lp::Status::relaxed, lp::Status::infeasible, lp::Status::no_interior})
    if (text == name(status)) return status;
  refuse_word(text, "status", {"optimal", "relaxed", "infeasible", "no-interior"});
}

void require_finite(const Doubles& array, const char* name) {
  for (py::ssize_t k = 0; k < array.size(); ++k)
    if (!std::isfinite(array.data()[k]))
      throw ArgumentError(name, "a number that is not finite, at " + std::to_string(k), "finite numbers");
}

lp::Problem problem_of(py::handle normals, py::handle offsets, py::handle preferred, py::handle soft, py::handle disc,
                       py::handle box_x, py::handle box_y, const std::string& objective) {
  lp::Problem problem;
  const Doubles n = doubles(normals, "normals", {-1, 2});
  const Doubles c = doubles(offsets, "offsets", {n.shape(0)});
  require_finite(n, "normals");
  require_finite(c, "offsets");
  py::array_t<bool> s;
  if (!soft.is_none())
    s = array_of<bool>(soft, "soft", {n.shape(0)},
                       "as many truth values as constraints, " + std::to_string(n.shape(0)));
  for (py::ssize_t k = 0; k < n.shape(0); ++k) {
    const Vec2 normal{n.data()[2 * k], n.data()[2 * k + 1]};
    if (normal == Vec2{}) throw ArgumentError("normals", "(0, 0) in row " + std::to_string(k), "a direction");
    problem.constraints.push_back({{normal, c.data()[k]},
                                   !soft.is_none() && s.data()[k] ? lp::Priority::soft : lp::Priority::hard,
                                   static_cast<int>(k)});
  }
  problem.preferred = vector(preferred, "preferred");
  problem.bound = {positive_or_infinite(disc, "max_speed"), positive_or_infinite(box_x, "max_speed_x"),
                   positive_or_infinite(box_y, "max_speed_y")};
  require_word(objective, "objective", {"nearest", "farthest"});
  if (objective == "farthest") {
    problem.objective = lp::Objective::farthest;
    const lp::SpeedBound& b = problem.bound;
    if (std::isinf(b.disc) && (std::isinf(b.box_x) || std::isinf(b.box_y)))
      throw ArgumentError("max_speed", "no bound", "a finite speed bound for the objective \"farthest\"");
    if (problem.preferred == Vec2{})
      throw ArgumentError("preferred", "(0, 0)", "a direction for the objective \"farthest\"");
  }
  return problem;
}

py::tuple as_tuple_of_terms(const std::vector<lp::Term>& terms) {
  py::tuple result(terms.size());
  for (std::size_t k = 0; k < terms.size(); ++k)
    result[k] =
        py::make_tuple(name(terms[k].binding.kind), terms[k].binding.index, py::tuple(py::cast(terms[k].multiplier)));
  return result;
}

lp::BindingKind binding_kind(const std::string& text) {
  for (int k = 0; k <= static_cast<int>(lp::BindingKind::box_bottom); ++k)
    if (text == name(static_cast<lp::BindingKind>(k))) return static_cast<lp::BindingKind>(k);
  throw ArgumentError("kind", "\"" + text + "\"", "constraint, disc, box-right, box-left, box-top or box-bottom");
}

std::vector<lp::Term> terms_of(py::handle fields) {
  std::vector<lp::Term> result;
  for (const py::handle item : fields) {
    const auto term = py::cast<py::tuple>(item);
    result.push_back({{binding_kind(py::cast<std::string>(term[0])), py::cast<std::size_t>(term[1])},
                      py::cast<std::vector<double>>(term[2])});
  }
  return result;
}

py::tuple tuple_of(const lp::Certificate& c) {
  py::tuple vertex(c.vertex.size());
  for (std::size_t k = 0; k < c.vertex.size(); ++k)
    vertex[k] = py::make_tuple(name(c.vertex[k].kind), c.vertex[k].index);
  return py::make_tuple(name(c.status), as_tuple(c.velocity), c.violation, as_tuple_of_terms(c.contradiction),
                        as_tuple_of_terms(c.bound), c.gap, vertex);
}

lp::Certificate certificate_of(py::handle object) {
  const auto fields = py::cast<py::tuple>(object);
  lp::Certificate c;
  c.status = status_of(py::cast<std::string>(fields[0]));
  const auto velocity = py::cast<py::tuple>(fields[1]);  // any numbers: a broken certificate is answered, not refused
  c.velocity = {number(velocity[0], "velocity"), number(velocity[1], "velocity")};
  c.violation = number(fields[2], "violation");
  c.contradiction = terms_of(fields[3]);
  c.bound = terms_of(fields[4]);
  c.gap = number(fields[5], "gap");
  for (const py::handle item : fields[6]) {
    const auto binding = py::cast<py::tuple>(item);
    c.vertex.push_back({binding_kind(py::cast<std::string>(binding[0])), py::cast<std::size_t>(binding[1])});
  }
  return c;
}

py::tuple answer_of(const lp::Proven& proven) {
  const lp::Solution& s = proven.solution;
  py::tuple active(s.active_count);
  for (std::size_t k = 0; k < s.active_count; ++k)
    active[k] = py::make_tuple(name(s.active[k].binding.kind), s.active[k].binding.index, s.active[k].multiplier);
  return py::make_tuple(as_tuple(s.velocity), name(s.status), s.violation, active,
                        proven.certificate ? py::object(tuple_of(*proven.certificate)) : py::none(),
                        proven.exact_stage);
}

lp::Proven solved(const lp::Problem& problem, lp::Solver solver) {
  switch (solver) {
    case lp::Solver::certified:
      return solve_certified(problem);
    case lp::Solver::exact:
      return solve_exact(problem);
    case lp::Solver::batch:
      break;
  }
  return lp::solve_all(solver, {problem}).front();
}

}  // namespace

void bind_lp(py::module_& module) {
  module.def("lp_solve",
             [](py::handle normals, py::handle offsets, py::handle preferred, py::handle soft, py::handle disc,
                py::handle box_x, py::handle box_y, const std::string& objective, const std::string& solver) {
               const lp::Problem problem = problem_of(normals, offsets, preferred, soft, disc, box_x, box_y, objective);
               const auto chosen = word<lp::Solver>(solver, "solver", lp::solver_names(), &lp::parse);
               const lp::Proven proven = without_gil([&] { return solved(problem, chosen); });
               return answer_of(proven);
             });
  module.def("lp_check",
             [](py::handle normals, py::handle offsets, py::handle preferred, py::handle soft, py::handle disc,
                py::handle box_x, py::handle box_y, const std::string& objective, py::handle certificate) {
               const lp::Problem problem = problem_of(normals, offsets, preferred, soft, disc, box_x, box_y, objective);
               const lp::Certificate claimed = certificate_of(certificate);
               const py::gil_scoped_release released;
               return std::string(name(check(problem, claimed)));
             });
}

}  // namespace exactvo::python
