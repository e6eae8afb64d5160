// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp_batch_arrays.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "arguments.h"

namespace exactvo::python {

namespace {

constexpr std::size_t kBlock = 16;
constexpr double kAlwaysHolds = -1e30;
/// | |normal| - 1 | <= 2^-10, as lp/batch.h asks; squared, with room for the rounding of the square.
constexpr double kNormalError = 0x1p-9;

py::array array_of_doubles(py::handle object, const char* name, int dimensions, const char* expected) {
  py::array array =
      py::isinstance<py::array>(object) ? py::reinterpret_borrow<py::array>(object) : py::array::ensure(object);
  if (!array) {
    PyErr_Clear();
    throw ArgumentError(name, shown(object), expected);
  }
  if (array.ndim() != dimensions) throw ArgumentError(name, shown(array), expected);
  if (!py::isinstance<py::array_t<double>>(array)) {
    if (array.dtype().kind() == 'O' || array.dtype().kind() == 'U' || array.dtype().kind() == 'S')
      throw ArgumentError(name, shown(array), expected);
    array = py::array_t<double, py::array::f_style | py::array::forcecast>::ensure(array);
    if (!array) throw py::error_already_set();
  }
  return array;
}

bool is_in_place(const py::array& array, const void* given) {
  return array.ptr() == given && (array.flags() & py::array::f_style) != 0;
}

void refuse_copy(const char* name, const py::array& array) {
  throw ArgumentError(name, shown(array) + ((array.flags() & py::array::f_style) != 0 ? "" : " in another order"),
                      "a float64 array in Fortran order, since copy=False");
}

/// The number at these indices, whatever the order of the array.
template <class... Indices>
double at(const py::array& array, Indices... indices) {
  py::ssize_t axis = 0, offset = 0;
  ((offset += static_cast<py::ssize_t>(indices) * array.strides(axis++)), ...);
  double value;
  std::memcpy(&value, static_cast<const char*>(array.data()) + offset, sizeof value);
  return value;
}

void take_lines(BatchArrays& b, py::handle normals, py::handle offsets, bool may_copy) {
  const py::array n = array_of_doubles(normals, "normals", 3, "an array of numbers of shape (problems, lines, 2)");
  if (n.shape(2) != 2) throw ArgumentError("normals", shown(n), "an array of numbers of shape (problems, lines, 2)");
  const py::array c = array_of_doubles(offsets, "offsets", 2, "an array of numbers of shape (problems, lines)");
  if (c.shape(0) != n.shape(0) || c.shape(1) != n.shape(1))
    throw ArgumentError(
        "offsets", shown(c),
        "shape (" + std::to_string(n.shape(0)) + ", " + std::to_string(n.shape(1)) + "), as normals have");
  b.count = static_cast<std::size_t>(n.shape(0));
  b.lines = static_cast<std::size_t>(n.shape(1));
  const bool in_place = is_in_place(n, normals.ptr()) && is_in_place(c, offsets.ptr());
  if (in_place) {
    b.problems.block = std::max<std::size_t>(b.count, 1);
    b.problems.normal_x = static_cast<const double*>(n.data());
    b.problems.normal_y = b.problems.normal_x + b.count * b.lines;
    b.problems.offset = static_cast<const double*>(c.data());
    b.kept = {n, c};
    return;
  }
  if (!may_copy)
    refuse_copy(is_in_place(n, normals.ptr()) ? "offsets" : "normals", is_in_place(n, normals.ptr()) ? c : n);
  b.is_copied = true;
  b.problems.block = kBlock;
  const std::size_t size = (b.count + kBlock - 1) / kBlock * kBlock * b.lines;
  b.normal_x.assign(size, 1.0);
  b.normal_y.assign(size, 0.0);
  b.offset.assign(size, kAlwaysHolds);
  for (std::size_t i = 0; i < b.count; ++i) {
    for (std::size_t k = 0; k < b.lines; ++k) {
      const std::size_t place = b.place(i, k);
      b.normal_x[place] = at(n, i, k, 0);
      b.normal_y[place] = at(n, i, k, 1);
      b.offset[place] = at(c, i, k);
    }
  }
  b.problems.normal_x = b.normal_x.data();
  b.problems.normal_y = b.normal_y.data();
  b.problems.offset = b.offset.data();
}

void take_preferred(BatchArrays& b, py::handle preferred, bool may_copy) {
  const py::array p = array_of_doubles(preferred, "preferred", 2, "an array of numbers of shape (problems, 2)");
  if (static_cast<std::size_t>(p.shape(0)) != b.count || p.shape(1) != 2)
    throw ArgumentError("preferred", shown(p), "shape (" + std::to_string(b.count) + ", 2)");
  if (is_in_place(p, preferred.ptr())) {
    b.problems.preferred_x = static_cast<const double*>(p.data());
    b.problems.preferred_y = b.problems.preferred_x + b.count;
    b.kept.push_back(p);
    return;
  }
  if (!may_copy) refuse_copy("preferred", p);
  b.is_copied = true;
  for (std::size_t i = 0; i < b.count; ++i) {
    b.preferred_x.push_back(at(p, i, 0));
    b.preferred_y.push_back(at(p, i, 1));
  }
  b.problems.preferred_x = b.preferred_x.data();
  b.problems.preferred_y = b.preferred_y.data();
}

/// One number for all, or an array of one for each.
void take_speeds(BatchArrays& b, py::handle max_speed) {
  if (PyFloat_Check(max_speed.ptr()) || PyLong_Check(max_speed.ptr())) {
    b.disc.assign(b.count, positive(max_speed, "max_speed"));
  } else {
    const Doubles array = doubles(max_speed, "max_speed", {static_cast<py::ssize_t>(b.count)});
    b.problems.disc = array.data();
    b.kept.push_back(array);
    return;
  }
  b.problems.disc = b.disc.data();
}

void take_hard(BatchArrays& b, py::handle hard) {
  if (hard.is_none()) {
    b.hard.assign(b.count, static_cast<std::int32_t>(b.lines));
  } else if (PyLong_Check(hard.ptr())) {
    b.hard.assign(b.count,
                  static_cast<std::int32_t>(std::clamp<long long>(PyLong_AsLongLong(hard.ptr()), -1, 1LL << 30)));
    PyErr_Clear();
  } else {
    const auto array = array_of<std::int64_t>(hard, "hard", {static_cast<py::ssize_t>(b.count)},
                                              "a whole number, or as many as problems");
    for (std::size_t i = 0; i < b.count; ++i)
      b.hard.push_back(static_cast<std::int32_t>(std::clamp<std::int64_t>(array.data()[i], -1, std::int64_t{1} << 30)));
  }
  for (const std::int32_t h : b.hard)
    if (h < 0 || static_cast<std::size_t>(h) > b.lines)
      throw ArgumentError("hard", std::to_string(h), "0 to " + std::to_string(b.lines) + ", the number of lines");
  b.problems.hard = b.hard.data();
}

}  // namespace

BatchArrays batch_arrays(py::handle normals, py::handle offsets, py::handle preferred, py::handle max_speed,
                         py::handle hard, bool may_copy) {
  BatchArrays b;
  take_lines(b, normals, offsets, may_copy);
  take_preferred(b, preferred, may_copy);
  take_speeds(b, max_speed);
  take_hard(b, hard);
  return b;
}

void require_in_range(const BatchArrays& b) {
  const lp::BatchProblems<double>& p = b.problems;
  for (std::size_t i = 0; i < b.count; ++i) {
    if (!std::isfinite(p.preferred_x[i]) || !std::isfinite(p.preferred_y[i]))
      throw ArgumentError("preferred", "a number that is not finite, in row " + std::to_string(i), "finite numbers");
    if (!std::isfinite(p.disc[i]) || !(p.disc[i] > 0.0))
      throw ArgumentError("max_speed", std::to_string(p.disc[i]) + " of problem " + std::to_string(i),
                          "a finite number above 0");
  }
  // Line by line where they lie side by side. In blocks the padding is in range too.
  const std::size_t size = b.is_copied && p.block == kBlock ? b.normal_x.size() : b.count * b.lines;
  std::size_t bad = size;
  for (std::size_t k = 0; k < size; ++k) {
    const double length = p.normal_x[k] * p.normal_x[k] + p.normal_y[k] * p.normal_y[k];
    if (std::fabs(length - 1.0) <= kNormalError && std::isfinite(p.offset[k])) continue;
    bad = k;
    break;
  }
  if (bad == size) return;
  for (std::size_t i = 0; i < b.count; ++i)
    for (std::size_t k = 0; k < b.lines; ++k)
      if (b.place(i, k) == bad)
        throw ArgumentError("normals",
                            "(" + std::to_string(p.normal_x[bad]) + ", " + std::to_string(p.normal_y[bad]) +
                                ") with offset " + std::to_string(p.offset[bad]) + " at [" + std::to_string(i) + ", " +
                                std::to_string(k) + "]",
                            "unit normals (to 1e-3) and finite offsets; solve() takes normals of any length");
}

lp::Problem problem_at(const BatchArrays& b, std::size_t i) {
  lp::Problem problem;
  for (std::size_t k = 0; k < b.lines; ++k) {
    const std::size_t place = b.place(i, k);
    problem.constraints.push_back(
        {{{b.problems.normal_x[place], b.problems.normal_y[place]}, b.problems.offset[place]},
         static_cast<std::int32_t>(k) < b.problems.hard[i] ? lp::Priority::hard : lp::Priority::soft,
         static_cast<int>(k)});
  }
  problem.preferred = {b.problems.preferred_x[i], b.problems.preferred_y[i]};
  problem.bound.disc = b.problems.disc[i];
  return problem;
}

}  // namespace exactvo::python
