// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Linear programs between Python and C++: problems and certificates as Python values, and those of a batch as the
/// caller's numpy arrays have them. The lanes of lp/batch.h want line k of all problems side by side: that is the order
/// of n x m arrays in Fortran order, which are used in place. Others are laid out in blocks first. Certificates have at
/// most three terms each, every multiplier the exact sum of a few doubles.

#include <pybind11/numpy.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "arguments.h"
#include "exactvo/vo/lp/batch.h"
#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/problem.h"

namespace exactvo::python {

/// -1 - k in arrays of bindings: nothing, then the parts of the speed bound in the order of lp::BindingKind.
inline constexpr std::int32_t kNoBinding = -1;
std::int32_t as_number(const lp::Binding& binding);
/// The binding; an index of kNoBinding or out of range becomes one that `check` calls malformed.
lp::Binding binding_of(std::int64_t number);

py::tuple as_tuple(const lp::Certificate& certificate);
lp::Certificate certificate_of(py::handle fields);

/// Arrays of the caller's, or copies of them, and what they mean.
struct BatchArrays {
  std::size_t count = 0, lines = 0;
  std::vector<py::array> kept;  ///< alive while they are pointed to
  std::vector<double> normal_x, normal_y, offset, preferred, disc;
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

/// By name: present, status, velocity, violation, gap, bound, contradiction, vertex and their multipliers.
class CertificateArrays {
 public:
  explicit CertificateArrays(const std::vector<std::optional<lp::Certificate>>& all);
  /// From the caller. Throws ArgumentError where they do not fit each other.
  CertificateArrays(const py::dict& arrays, std::size_t count);

  /// Arrays that cannot be written.
  py::dict dict();
  bool has(std::size_t i) const { return present_.data()[i]; }
  /// Nothing where the status is none. Needs no interpreter. REQUIRES: has(i).
  std::optional<lp::Certificate> at(std::size_t i) const;

 private:
  template <class T>
  using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

  /// `take(name, array, shape)` of each.
  template <class Take>
  void each(py::ssize_t count, py::ssize_t parts, const Take& take);

  Array<bool> present_;
  Array<std::uint8_t> status_;
  Array<double> velocity_, violation_, gap_;
  Array<std::int32_t> bound_, contradiction_, vertex_;
  Array<double> bound_multiplier_, contradiction_multiplier_;  ///< every multiplier has as many doubles
};

}  // namespace exactvo::python
