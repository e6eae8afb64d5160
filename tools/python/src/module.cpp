// SPDX-License-Identifier: GPL-3.0-or-later
#include "module.h"

PYBIND11_MODULE(_exactvo, module) {
  using namespace exactvo::python;
  module.doc() = "What the package exactvo calls; use the package.";
  module.attr("version") = EXACTVO_VERSION;
  bind_errors(module);
  bind_shapes(module);
  bind_lp(module);
  bind_lp_batch(module);
  bind_vo(module);
  bind_routes(module);
  bind_crowd(module);
  bind_simulate(module);
  bind_navigator(module);
  bind_monitor(module);
  bind_obstacle_files(module);
  bind_rvo2(module);
  bind_check(module);
}
