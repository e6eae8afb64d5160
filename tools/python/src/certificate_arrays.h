// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The certificates of a batch as numpy arrays: at most three terms each, every multiplier the exact sum of a few
/// doubles.

#include <pybind11/numpy.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "exactvo/vo/lp/certificate.h"

namespace exactvo::python {

namespace py = pybind11;

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
