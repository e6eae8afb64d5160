// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Python objects as arguments, each with its name: what does not fit becomes an `exactvo.ArgumentError` that says
/// which argument, what was found and what was expected. And values as Python objects.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <atomic>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/geometry/half_plane.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::python {

namespace py = pybind11;
using geometry::Vec2;

/// Becomes exactvo.ArgumentError (arguments.cpp).
struct ArgumentError : std::invalid_argument {
  ArgumentError(std::string where, std::string found, std::string expected);
  std::string where, found, expected;
};

/// What `compute` gives; meanwhile other threads of Python run.
template <class Compute>
auto without_gil(const Compute& compute) {
  const py::gil_scoped_release released;
  return compute();
}

/// One thread at a time in an object of Python's: another that calls meanwhile, while the interpreter's lock is
/// released, is refused with an ArgumentError.
class OneThread {
 public:
  /// `what` names the object: "crowd".
  OneThread(std::atomic<bool>& busy, const char* what);
  ~OneThread() { busy_ = false; }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  std::atomic<bool>& busy_;
};

/// repr(object), shortened to a line.
std::string shown(py::handle object);

double number(py::handle object, const char* name);
double finite(py::handle object, const char* name);
double at_least_zero(py::handle object, const char* name);
double positive(py::handle object, const char* name);
double positive_or_infinite(py::handle object, const char* name);
Vec2 vector(py::handle object, const char* name);

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// An array of doubles with this many dimensions, C order; -1 among `shape` is any length. Copies where it must.
Doubles doubles(py::handle object, const char* name, const std::vector<py::ssize_t>& shape);
/// The rows of an n x 2 array, finite.
std::vector<Vec2> points(py::handle object, const char* name);

/// "(3, 2)".
std::string shape_words(const py::array& array);
/// "an array of numbers of shape (n, 2)"; -1 is any length.
std::string expected_shape(const std::vector<py::ssize_t>& shape);
/// Whether it has that shape, in which -1 is any length.
bool has_shape(const py::array& array, const std::vector<py::ssize_t>& shape);

/// `object` as an array of T of that shape, in C order; an ArgumentError says that `expected` was. Copies where it
/// must.
template <class T>
py::array_t<T, py::array::c_style | py::array::forcecast> array_of(py::handle object, const char* name,
                                                                   const std::vector<py::ssize_t>& shape,
                                                                   const std::string& expected) {
  const auto array = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(object);
  if (array && has_shape(array, shape)) return array;
  PyErr_Clear();
  throw ArgumentError(name, shown(object), expected);
}

py::tuple as_tuple(const datasets::DataError& error);
inline py::tuple as_tuple(Vec2 v) {
  return py::make_tuple(v.x, v.y);
}
inline py::tuple as_tuple(const geometry::HalfPlane& h) {
  return py::make_tuple(as_tuple(h.normal), h.offset);
}
/// Takes the right to write away. (The attribute `flags` does the same, a microsecond slower.)
inline void make_read_only(py::array& array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
}
/// What an answer shows of its memory: an array in that order that keeps `owner` alive.
template <int order = py::array::c_style, class T>
py::array view(const T* data, std::vector<py::ssize_t> shape, const py::object& owner, bool is_writable = false) {
  py::array_t<T, order> array(std::move(shape), data, owner);
  if (!is_writable) make_read_only(array);
  return std::move(array);
}
/// n x 2.
py::array_t<double> as_array(const std::vector<Vec2>& points);

/// Throws the ArgumentError of a word that is none of `words`.
[[noreturn]] void refuse_word(const std::string& text, const char* name, const std::vector<std::string>& words);
void require_word(const std::string& text, const char* name, const std::vector<std::string>& words);

/// The word's value, or an ArgumentError that lists `words`.
template <class T>
T word(const std::string& text, const char* name, const std::vector<std::string>& words,
       bool (*parse)(const std::string&, T&)) {
  T value{};
  if (parse(text, value)) return value;
  refuse_word(text, name, words);
}

}  // namespace exactvo::python
