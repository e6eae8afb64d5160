// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The problems of a batch as the caller's numpy arrays have them. The lanes of lp/batch.h want line k of all problems
/// side by side: that is the order of n x m arrays in Fortran order, which are used in place. Others are laid out in
/// blocks first.

#include <pybind11/numpy.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "exactvo/vo/lp/batch.h"
#include "exactvo/vo/lp/problem.h"

namespace exactvo::python {

namespace py = pybind11;

/// Arrays of the caller's, or copies of them, and what they mean.
struct BatchArrays {
  std::size_t count = 0, lines = 0;
  std::vector<py::array> kept;  ///< alive while they are pointed to
  std::vector<double> normal_x, normal_y, offset, preferred_x, preferred_y, disc;
  std::vector<std::int32_t> hard;
  lp::BatchProblems<double> problems;
  bool is_copied = false;

  std::size_t place(std::size_t problem, std::size_t line) const {
    return problem / problems.block * problems.block * lines + line * problems.block + problem % problems.block;
  }
};

/// Takes all of them. Throws ArgumentError for what lp/batch.h does not promise an answer for, and where an array would
/// have to be copied and may not be. The last check needs no interpreter: `require_in_range`.
BatchArrays batch_arrays(py::handle normals, py::handle offsets, py::handle preferred, py::handle max_speed,
                         py::handle hard, bool may_copy);

/// What lp/batch.h requires: its lanes promise nothing else.
void require_in_range(const BatchArrays& b);

lp::Problem problem_at(const BatchArrays& b, std::size_t i);

}  // namespace exactvo::python
