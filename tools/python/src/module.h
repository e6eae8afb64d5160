// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The extension module `exactvo._exactvo`: what the package's Python calls. One unit per topic; each adds its names
/// here. Arguments arrive as objects and are converted with their names (arguments.h), so that a message names the
/// argument.

#include <pybind11/pybind11.h>

namespace exactvo::python {

namespace py = pybind11;

void bind_errors(py::module_& module);
void bind_shapes(py::module_& module);
void bind_lp(py::module_& module);
void bind_lp_batch(py::module_& module);
void bind_vo(py::module_& module);
void bind_routes(py::module_& module);
void bind_crowd(py::module_& module);
void bind_simulate(py::module_& module);
void bind_navigator(py::module_& module);
void bind_monitor(py::module_& module);
void bind_obstacle_files(py::module_& module);
void bind_rvo2(py::module_& module);
void bind_check(py::module_& module);

}  // namespace exactvo::python
