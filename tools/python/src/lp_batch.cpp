// SPDX-License-Identifier: GPL-3.0-or-later
// Many linear programs at once, on numpy arrays. The lanes of lp/batch.h want line k of all problems side by side: that
// is the order of n x m arrays in Fortran order, which are used in place. Others are laid out in blocks first.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>

#include "exactvo/vo/lp/batch.h"
#include "exactvo/vo/lp/solvers.h"
#include "lp_values.h"
#include "module.h"

namespace exactvo::python {

namespace {

constexpr std::size_t kBlock = 16;
constexpr double kAlwaysHolds = -1e30;
/// | |normal| - 1 | <= 2^-10, as lp/batch.h asks; squared, with room for the rounding of the square.
constexpr double kNormalError = 0x1p-9;

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

double at(const py::array& array, std::size_t i, std::size_t k) {
  const auto* bytes = static_cast<const char*>(array.data());
  double value;
  std::copy_n(bytes + static_cast<py::ssize_t>(i) * array.strides(0) + static_cast<py::ssize_t>(k) * array.strides(1),
              sizeof value, reinterpret_cast<char*>(&value));
  return value;
}

double at(const py::array& array, std::size_t i, std::size_t k, std::size_t axis) {
  const auto* bytes = static_cast<const char*>(array.data());
  double value;
  std::copy_n(bytes + static_cast<py::ssize_t>(i) * array.strides(0) + static_cast<py::ssize_t>(k) * array.strides(1) +
                  static_cast<py::ssize_t>(axis) * array.strides(2),
              sizeof value, reinterpret_cast<char*>(&value));
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
                  static_cast<std::int32_t>(std::clamp<long long>(PyLong_AsLongLong(hard.ptr()), -1, 1LL << 31)));
    PyErr_Clear();
  } else {
    const auto array = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(hard);
    if (!array || array.ndim() != 1 || static_cast<std::size_t>(array.shape(0)) != b.count) {
      PyErr_Clear();
      throw ArgumentError("hard", shown(hard), "a whole number, or as many as problems");
    }
    for (std::size_t i = 0; i < b.count; ++i)
      b.hard.push_back(static_cast<std::int32_t>(std::clamp<std::int64_t>(array.data()[i], -1, std::int64_t{1} << 30)));
  }
  for (const std::int32_t h : b.hard)
    if (h < 0 || static_cast<std::size_t>(h) > b.lines)
      throw ArgumentError("hard", std::to_string(h), "0 to " + std::to_string(b.lines) + ", the number of lines");
  b.problems.hard = b.hard.data();
}

/// What lp/batch.h requires: its lanes promise nothing else.
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

/// Certificates as arrays: at most three terms each, every multiplier the exact sum of `parts` doubles.
struct CertificateArrays {
  py::array_t<bool> present;
  py::array_t<std::uint8_t> status;
  py::array_t<double> velocity, violation, gap;
  py::array_t<std::int32_t> bound, contradiction, vertex;
  py::array_t<double> bound_multiplier, contradiction_multiplier;
};

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

py::dict as_arrays(const std::vector<std::optional<lp::Certificate>>& all) {
  const auto n = static_cast<py::ssize_t>(all.size());
  const std::size_t parts = most_parts(all);
  const auto p = static_cast<py::ssize_t>(parts);
  CertificateArrays a{py::array_t<bool>(n),
                      py::array_t<std::uint8_t>(n),
                      py::array_t<double>({n, py::ssize_t{2}}),
                      py::array_t<double>(n),
                      py::array_t<double>(n),
                      py::array_t<std::int32_t>({n, py::ssize_t{3}}),
                      py::array_t<std::int32_t>({n, py::ssize_t{3}}),
                      py::array_t<std::int32_t>({n, py::ssize_t{2}}),
                      py::array_t<double>({n, py::ssize_t{3}, p}),
                      py::array_t<double>({n, py::ssize_t{3}, p})};
  for (auto* bindings : {&a.bound, &a.contradiction, &a.vertex})
    std::fill_n(bindings->mutable_data(), bindings->size(), kNoBinding);
  for (auto* numbers : {&a.velocity, &a.violation, &a.gap, &a.bound_multiplier, &a.contradiction_multiplier})
    std::fill_n(numbers->mutable_data(), numbers->size(), 0.0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    a.present.mutable_data()[i] = all[i].has_value();
    a.status.mutable_data()[i] = 0;
    if (!all[i]) continue;
    const lp::Certificate& c = *all[i];
    a.status.mutable_data()[i] = static_cast<std::uint8_t>(c.status);
    a.velocity.mutable_data()[2 * i] = c.velocity.x;
    a.velocity.mutable_data()[2 * i + 1] = c.velocity.y;
    a.violation.mutable_data()[i] = c.violation;
    a.gap.mutable_data()[i] = c.gap;
    put_terms(c.bound, a.bound.mutable_data() + kTerms * i, a.bound_multiplier.mutable_data() + kTerms * parts * i,
              parts);
    put_terms(c.contradiction, a.contradiction.mutable_data() + kTerms * i,
              a.contradiction_multiplier.mutable_data() + kTerms * parts * i, parts);
    for (std::size_t v = 0; v < std::min<std::size_t>(c.vertex.size(), 2); ++v)
      a.vertex.mutable_data()[2 * i + v] = as_number(c.vertex[v]);
  }
  for (py::array array : {py::array(a.present), py::array(a.status), py::array(a.velocity), py::array(a.violation),
                          py::array(a.gap), py::array(a.bound), py::array(a.contradiction), py::array(a.vertex),
                          py::array(a.bound_multiplier), py::array(a.contradiction_multiplier)})
    make_read_only(array);
  py::dict result;
  result["present"] = a.present;
  result["status"] = a.status;
  result["velocity"] = a.velocity;
  result["violation"] = a.violation;
  result["gap"] = a.gap;
  result["bound"] = a.bound;
  result["bound_multiplier"] = a.bound_multiplier;
  result["contradiction"] = a.contradiction;
  result["contradiction_multiplier"] = a.contradiction_multiplier;
  result["vertex"] = a.vertex;
  return result;
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

template <class T>
py::array_t<T, py::array::c_style | py::array::forcecast> member(const py::dict& arrays, const char* name,
                                                                 const std::vector<py::ssize_t>& shape) {
  const auto array = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(arrays[name]);
  bool fits = array && array.ndim() == static_cast<py::ssize_t>(shape.size());
  for (std::size_t k = 0; fits && k < shape.size(); ++k)
    fits = shape[k] < 0 || array.shape(static_cast<py::ssize_t>(k)) == shape[k];
  if (!fits) {
    PyErr_Clear();
    throw ArgumentError(name, shown(arrays[name]), "as many as problems, in the shape that solve_batch gives");
  }
  return array;
}

/// 0 where a certificate proves its answer, else what is wrong with it: an lp::CertificateError; 255: there is none.
py::array_t<std::uint8_t> check_batch(py::handle normals, py::handle offsets, py::handle preferred,
                                      py::handle max_speed, py::handle hard, const py::dict& arrays) {
  BatchArrays b;
  take_lines(b, normals, offsets, true);
  take_preferred(b, preferred, true);
  take_speeds(b, max_speed);
  take_hard(b, hard);
  require_in_range(b);
  const auto n = static_cast<py::ssize_t>(b.count);
  const auto present = member<bool>(arrays, "present", {n});
  const auto status = member<std::uint8_t>(arrays, "status", {n});
  const auto velocity = member<double>(arrays, "velocity", {n, 2});
  const auto violation = member<double>(arrays, "violation", {n});
  const auto gap = member<double>(arrays, "gap", {n});
  const auto bound = member<std::int32_t>(arrays, "bound", {n, 3});
  const auto bound_multiplier = member<double>(arrays, "bound_multiplier", {n, 3, -1});
  const auto contradiction = member<std::int32_t>(arrays, "contradiction", {n, 3});
  const auto contradiction_multiplier = member<double>(arrays, "contradiction_multiplier", {n, 3, -1});
  const auto vertex = member<std::int32_t>(arrays, "vertex", {n, 2});
  py::array_t<std::uint8_t> result(n);
  std::uint8_t* const out = result.mutable_data();
  const py::gil_scoped_release released;
  for (std::size_t i = 0; i < b.count; ++i) {
    out[i] = 255;
    if (!present.data()[i]) continue;
    lp::Certificate c;
    out[i] = static_cast<std::uint8_t>(lp::CertificateError::malformed);
    if (status.data()[i] > static_cast<std::uint8_t>(lp::Status::no_interior)) continue;
    c.status = static_cast<lp::Status>(status.data()[i]);
    c.velocity = {velocity.data()[2 * i], velocity.data()[2 * i + 1]};
    c.violation = violation.data()[i];
    c.gap = gap.data()[i];
    c.bound = terms_at(bound, bound_multiplier, i);
    c.contradiction = terms_at(contradiction, contradiction_multiplier, i);
    for (std::size_t v = 0; v < 2; ++v)
      if (vertex.data()[2 * i + v] != kNoBinding) c.vertex.push_back(binding_of(vertex.data()[2 * i + v]));
    out[i] = static_cast<std::uint8_t>(check(problem_at(b, i), c));
  }
  return result;
}

/// The answers of a batch; its arrays are views of what it holds.
struct Batch {
  std::size_t count = 0;
  std::vector<double> velocity, violation;  ///< velocity: all v_x, then all v_y
  std::vector<std::uint8_t> status, proven;
  std::vector<std::int32_t> active;
  lp::BatchCounts counts;
  bool is_copied = false;
  py::object certificate_arrays = py::none();  ///< a dict, where they were asked for
};

/// Of the answer that the lanes gave, what binds; the disc, which they do not name, wherever it may.
lp::Solution solution_at(const Batch& batch, const BatchArrays& b, std::size_t i) {
  constexpr double kOnDisc = 1e-6;
  lp::Solution s;
  s.velocity = {batch.velocity[i], batch.velocity[batch.count + i]};
  s.status = static_cast<lp::Status>(batch.status[i]);
  s.violation = batch.violation[i];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t line = batch.active[k * batch.count + i];
    if (line != lp::kNoLine) s.active[s.active_count++].binding = lp::constraint_at(static_cast<std::size_t>(line));
  }
  const bool room = s.active_count < (s.status == lp::Status::optimal ? 2U : 3U);
  if (room && norm(s.velocity) > b.problems.disc[i] * (1.0 - kOnDisc)) s.active[s.active_count++].binding = lp::kDisc;
  return s;
}

std::vector<std::optional<lp::Certificate>> certify(Batch& batch, const BatchArrays& b) {
  std::vector<std::optional<lp::Certificate>> certificates(batch.count);
  for (std::size_t i = 0; i < batch.count; ++i) {
    lp::Proven answer{solution_at(batch, b, i), std::nullopt, false};
    prove(problem_at(b, i), answer);
    certificates[i] = std::move(answer.certificate);
    const lp::Solution& s = answer.solution;
    if (answer.exact_stage) {
      batch.velocity[i] = s.velocity.x;
      batch.velocity[batch.count + i] = s.velocity.y;
      batch.violation[i] = s.violation;
      batch.status[i] = static_cast<std::uint8_t>(s.status);
      for (std::size_t k = 0; k < 3; ++k) {
        const bool is_line = k < s.active_count && !is_speed_bound(s.active[k].binding);
        batch.active[k * batch.count + i] =
            is_line ? static_cast<std::int32_t>(s.active[k].binding.index) : lp::kNoLine;
      }
      ++batch.counts.exact;
    }
    batch.proven[i] = certificates[i].has_value();
  }
  return certificates;
}

Batch solve_batch(py::handle normals, py::handle offsets, py::handle preferred, py::handle max_speed, py::handle hard,
                  bool prove, bool certificates, bool copy, bool parallel) {
  BatchArrays b;
  take_lines(b, normals, offsets, copy);
  take_preferred(b, preferred, copy);
  take_speeds(b, max_speed);
  take_hard(b, hard);
  b.problems.count = b.count;
  b.problems.lines = b.lines;
  Batch batch;
  batch.count = b.count;
  batch.is_copied = b.is_copied;
  batch.velocity.resize(2 * b.count);
  batch.violation.resize(b.count);
  batch.status.resize(b.count);
  batch.active.assign(3 * b.count, lp::kNoLine);
  if (prove || certificates) batch.proven.resize(b.count);
  constexpr std::size_t kLarge = 64;  // from about 10 microseconds on
  std::optional<py::gil_scoped_release> released;
  if (b.count * b.lines > kLarge || certificates) released.emplace();
  require_in_range(b);
  std::vector<std::optional<lp::Certificate>> proofs;
  if (b.count > 0) {
    const lp::BatchAnswers<double> answers{batch.velocity.data(),
                                           batch.velocity.data() + b.count,
                                           batch.violation.data(),
                                           batch.status.data(),
                                           batch.active.data(),
                                           b.count,
                                           prove ? batch.proven.data() : nullptr};
    batch.counts =
        parallel ? solve_batch_parallel(b.problems, answers) : lp::solve_batch(b.problems, answers, 0, b.count);
    if (certificates) proofs = certify(batch, b);
  }
  released.reset();
  if (certificates) batch.certificate_arrays = as_arrays(proofs);
  return batch;
}

/// A view of `count` x `columns` numbers, column by column, that keeps `owner` alive and cannot be written.
template <class T>
py::array view(const std::vector<T>& data, std::size_t count, std::size_t columns, const py::object& owner) {
  const auto n = static_cast<py::ssize_t>(count);
  const auto size = static_cast<py::ssize_t>(sizeof(T));
  py::array array = columns == 1 ? py::array(py::dtype::of<T>(), {n}, {size}, data.data(), owner)
                                 : py::array(py::dtype::of<T>(), {n, static_cast<py::ssize_t>(columns)},
                                             {size, n * size}, data.data(), owner);
  make_read_only(array);
  return array;
}

const Batch& batch_of(const py::object& self) {
  return self.cast<const Batch&>();
}

// --- Pickled ---

template <class T>
py::bytes bytes_of(const std::vector<T>& data) {
  return {reinterpret_cast<const char*>(data.data()), data.size() * sizeof(T)};
}

template <class T>
std::vector<T> numbers_of(const py::handle& bytes, std::size_t count) {
  const auto text = bytes.cast<std::string_view>();
  if (text.size() != count * sizeof(T)) throw py::value_error("not a pickled BatchSolution: numbers are missing");
  std::vector<T> data(count);
  std::copy(text.begin(), text.end(), reinterpret_cast<char*>(data.data()));
  return data;
}

py::tuple state_of(const Batch& b) {
  return py::make_tuple(b.count, bytes_of(b.velocity), bytes_of(b.violation), bytes_of(b.status), bytes_of(b.proven),
                        bytes_of(b.active), b.counts.scalar, b.counts.exact, b.is_copied, b.certificate_arrays);
}

Batch batch_from(const py::tuple& state) {
  if (state.size() != 10) throw py::value_error("not a pickled BatchSolution: of another version");
  Batch b;
  b.count = state[0].cast<std::size_t>();
  b.velocity = numbers_of<double>(state[1], 2 * b.count);
  b.violation = numbers_of<double>(state[2], b.count);
  b.status = numbers_of<std::uint8_t>(state[3], b.count);
  b.proven = numbers_of<std::uint8_t>(state[4], py::len(state[4]) == 0 ? 0 : b.count);
  b.active = numbers_of<std::int32_t>(state[5], 3 * b.count);
  b.counts.scalar = state[6].cast<std::size_t>();
  b.counts.exact = state[7].cast<std::size_t>();
  b.is_copied = state[8].cast<bool>();
  b.certificate_arrays = state[9];
  return b;
}

}  // namespace

void bind_lp_batch(py::module_& module) {
  py::class_<Batch>(module, "Batch")
      .def("__len__", [](const Batch& b) { return b.count; })
      .def_property_readonly(
          "velocity",
          [](const py::object& self) { return view(batch_of(self).velocity, batch_of(self).count, 2, self); })
      .def_property_readonly(
          "violation",
          [](const py::object& self) { return view(batch_of(self).violation, batch_of(self).count, 1, self); })
      .def_property_readonly(
          "status", [](const py::object& self) { return view(batch_of(self).status, batch_of(self).count, 1, self); })
      .def_property_readonly(
          "active", [](const py::object& self) { return view(batch_of(self).active, batch_of(self).count, 3, self); })
      .def_property_readonly("proven",
                             [](const py::object& self) -> py::object {
                               const Batch& b = batch_of(self);
                               if (b.proven.size() != b.count) return py::none();
                               py::array array = view(b.proven, b.count, 1, self);
                               return array.attr("view")(py::dtype::of<bool>());
                             })
      .def_readonly("copied", &Batch::is_copied)
      .def_property_readonly("scalar_count", [](const Batch& b) { return b.counts.scalar; })
      .def_property_readonly("exact_count", [](const Batch& b) { return b.counts.exact; })
      .def("certificate_arrays", [](const Batch& b) { return b.certificate_arrays; })
      .def(py::pickle(&state_of, &batch_from));
  module.def("lp_solve_batch", &solve_batch);
  module.def("lp_check_batch", &check_batch);
}

}  // namespace exactvo::python
