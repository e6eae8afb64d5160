// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <type_traits>

#include "arguments.h"
#include "lp_values.h"

namespace exactvo::python {

namespace {

// --- Problems ---

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
    b.kept.push_back(p);
  } else {
    if (!may_copy) refuse_copy("preferred", p);
    b.is_copied = true;
    for (const int xy : {0, 1})
      for (std::size_t i = 0; i < b.count; ++i) b.preferred.push_back(at(p, i, xy));
    b.problems.preferred_x = b.preferred.data();
  }
  b.problems.preferred_y = b.problems.preferred_x + b.count;
}

/// One number for all, or an array of one for each.
void take_speeds(BatchArrays& b, py::handle max_speed) {
  if (PyFloat_Check(max_speed.ptr()) || PyLong_Check(max_speed.ptr())) {
    b.disc.assign(b.count, positive(max_speed, "max_speed"));
    b.problems.disc = b.disc.data();
  } else {
    const Doubles array = doubles(max_speed, "max_speed", {static_cast<py::ssize_t>(b.count)});
    b.problems.disc = array.data();
    b.kept.push_back(array);
  }
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

// --- Certificates ---

constexpr std::size_t kTerms = 3;

void put_terms(const std::vector<lp::Term>& terms, std::int32_t* bindings, double* multipliers, std::size_t parts) {
  for (std::size_t t = 0; t < std::min(terms.size(), kTerms); ++t) {
    bindings[t] = as_number(terms[t].binding);
    std::copy(terms[t].multiplier.begin(), terms[t].multiplier.end(), multipliers + t * parts);
  }
}

std::size_t most_parts(const std::vector<std::optional<lp::Certificate>>& all) {
  std::size_t most = 1;
  for (const auto& c : all) {
    if (!c) continue;
    for (const auto* terms : {&c->bound, &c->contradiction})
      for (const lp::Term& term : *terms) most = std::max(most, term.multiplier.size());
  }
  return most;
}

std::vector<lp::Term> terms_at(const py::array_t<std::int32_t>& bindings, const Doubles& multipliers, std::size_t i) {
  std::vector<lp::Term> terms;
  const auto parts = static_cast<std::size_t>(multipliers.shape(2));
  for (std::size_t t = 0; t < kTerms; ++t) {
    const std::int32_t number = bindings.data()[kTerms * i + t];
    if (number == kNoBinding) continue;
    const double* m = multipliers.data() + (kTerms * i + t) * parts;
    lp::Term term{binding_of(number), {}};
    for (std::size_t k = 0; k < parts; ++k)
      if (k == 0 || m[k] != 0.0) term.multiplier.push_back(m[k]);
    terms.push_back(std::move(term));
  }
  return terms;
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
  const std::size_t size = b.normal_x.empty() ? b.count * b.lines : b.normal_x.size();
  std::size_t bad = size;
  for (std::size_t k = 0; k < size; ++k) {
    const double length = p.normal_x[k] * p.normal_x[k] + p.normal_y[k] * p.normal_y[k];
    if (std::fabs(length - 1.0) <= kNormalError && std::isfinite(p.offset[k])) continue;
    bad = k;
    break;
  }
  if (bad == size) return;
  const std::size_t i = bad / (p.block * b.lines) * p.block + bad % p.block, k = bad / p.block % b.lines;
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

template <class Take>
void CertificateArrays::each(py::ssize_t count, py::ssize_t parts, const Take& take) {
  using Shape = std::vector<py::ssize_t>;
  take("present", present_, Shape{count});
  take("status", status_, Shape{count});
  take("velocity", velocity_, Shape{count, 2});
  take("violation", violation_, Shape{count});
  take("gap", gap_, Shape{count});
  take("bound", bound_, Shape{count, 3});
  take("bound_multiplier", bound_multiplier_, Shape{count, 3, parts});
  take("contradiction", contradiction_, Shape{count, 3});
  take("contradiction_multiplier", contradiction_multiplier_, Shape{count, 3, parts});
  take("vertex", vertex_, Shape{count, 2});
}

CertificateArrays::CertificateArrays(const std::vector<std::optional<lp::Certificate>>& all) {
  const std::size_t parts = most_parts(all);
  each(static_cast<py::ssize_t>(all.size()), static_cast<py::ssize_t>(parts), [](const char*, auto& array, auto shape) {
    using Number = typename std::remove_reference_t<decltype(array)>::value_type;
    array = std::remove_reference_t<decltype(array)>(shape);
    const int empty = std::is_same_v<Number, std::int32_t> ? kNoBinding : 0;
    std::fill_n(array.mutable_data(), array.size(), static_cast<Number>(empty));
  });
  for (std::size_t i = 0; i < all.size(); ++i) {
    present_.mutable_data()[i] = all[i].has_value();
    if (!all[i]) continue;
    const lp::Certificate& c = *all[i];
    status_.mutable_data()[i] = static_cast<std::uint8_t>(c.status);
    velocity_.mutable_data()[2 * i] = c.velocity.x;
    velocity_.mutable_data()[2 * i + 1] = c.velocity.y;
    violation_.mutable_data()[i] = c.violation;
    gap_.mutable_data()[i] = c.gap;
    put_terms(c.bound, bound_.mutable_data() + kTerms * i, bound_multiplier_.mutable_data() + kTerms * parts * i,
              parts);
    put_terms(c.contradiction, contradiction_.mutable_data() + kTerms * i,
              contradiction_multiplier_.mutable_data() + kTerms * parts * i, parts);
    for (std::size_t v = 0; v < std::min<std::size_t>(c.vertex.size(), 2); ++v)
      vertex_.mutable_data()[2 * i + v] = as_number(c.vertex[v]);
  }
}

CertificateArrays::CertificateArrays(const py::dict& arrays, std::size_t count) {
  each(static_cast<py::ssize_t>(count), -1, [&](const char* name, auto& array, const auto& shape) {
    using Number = typename std::remove_reference_t<decltype(array)>::value_type;
    array = array_of<Number>(arrays[name], name, shape, "as many as problems, in the shape that solve_batch gives");
  });
}

py::dict CertificateArrays::dict() {
  py::dict result;
  each(0, 0, [&](const char* name, auto& array, const auto&) {
    make_read_only(array);
    result[name] = array;
  });
  return result;
}

std::optional<lp::Certificate> CertificateArrays::at(std::size_t i) const {
  if (status_.data()[i] > static_cast<std::uint8_t>(lp::Status::no_interior)) return std::nullopt;
  lp::Certificate c;
  c.status = static_cast<lp::Status>(status_.data()[i]);
  c.velocity = {velocity_.data()[2 * i], velocity_.data()[2 * i + 1]};
  c.violation = violation_.data()[i];
  c.gap = gap_.data()[i];
  c.bound = terms_at(bound_, bound_multiplier_, i);
  c.contradiction = terms_at(contradiction_, contradiction_multiplier_, i);
  for (std::size_t v = 0; v < 2; ++v)
    if (vertex_.data()[2 * i + v] != kNoBinding) c.vertex.push_back(binding_of(vertex_.data()[2 * i + v]));
  return c;
}

}  // namespace exactvo::python
