// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The certificates of a batch as numpy arrays: at most three terms each, every multiplier the exact sum of a few
/// doubles.

#include <pybind11/numpy.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "exactvo/vo/lp/certificate.h"

namespace exactvo::python {

namespace py = pybind11;

/// By name: present, status, velocity, violation, gap, bound, contradiction, vertex and their multipliers.
py::dict as_arrays(const std::vector<std::optional<lp::Certificate>>& all);

/// The same arrays from the caller. Throws ArgumentError where they do not fit each other.
class CertificateReader {
 public:
  CertificateReader(const py::dict& arrays, std::size_t count);
  bool has(std::size_t i) const { return present_.data()[i]; }
  /// Nothing where the status is none. Needs no interpreter. REQUIRES: has(i).
  std::optional<lp::Certificate> at(std::size_t i) const;

 private:
  template <class T>
  using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

  Array<bool> present_;
  Array<std::uint8_t> status_;
  Array<double> velocity_, violation_, gap_;
  Array<std::int32_t> bound_, contradiction_, vertex_;
  Array<double> bound_multiplier_, contradiction_multiplier_;
};

}  // namespace exactvo::python
