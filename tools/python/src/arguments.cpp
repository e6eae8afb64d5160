// SPDX-License-Identifier: GPL-3.0-or-later
#include "arguments.h"

#include <algorithm>
#include <cmath>

#include "exactvo/formation/crowd.h"
#include "exactvo/formation/navigator.h"
#include "exactvo/geometry/routes.h"
#include "module.h"

namespace exactvo::python {

namespace {

constexpr std::size_t kLongest = 60;

/// Raises the class of that name of exactvo.errors.
void raise(const char* type, const py::tuple& arguments) {
  const py::object raised = py::module_::import("exactvo.errors").attr(type);
  const py::object error = raised(*arguments);
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
}

/// "FIELD: found FOUND, expected EXPECTED".
void raise_refused(const std::string& text) {
  const std::string found = ": found ", expected = ", expected ";
  const std::size_t first = text.find(found), last = text.rfind(expected);
  const std::size_t from = first + found.size();
  raise("ArgumentError",
        py::make_tuple(text.substr(0, first), text.substr(from, last - from), text.substr(last + expected.size())));
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const ArgumentError& e) {
    raise("ArgumentError", py::make_tuple(e.where, e.found, e.expected));
  } catch (const datasets::DataError& e) {
    raise(e.code() == datasets::DataCode::file_missing ? "MissingFileError" : "DataError", as_tuple(e));
  } catch (const formation::CrowdError& e) {
    raise("CrowdError", py::make_tuple(name(e.problem()), std::string(e.what())));
  } catch (const formation::NavigatorError& e) {
    raise_refused(e.what());
  } catch (const geometry::RouteNotProven& e) {
    raise("RouteNotProvenError", py::make_tuple(std::string(e.what())));
  } catch (const std::logic_error& e) {  // a requirement of the library's that was not asked here
    const std::string text = e.what();
    raise("ArgumentError", py::make_tuple(text.substr(0, text.find(':')), text, "what the message requires"));
  }
}

}  // namespace

ArgumentError::ArgumentError(std::string where_, std::string found_, std::string expected_)
    : std::invalid_argument(where_ + ": found " + found_ + ", expected " + expected_),
      where(std::move(where_)),
      found(std::move(found_)),
      expected(std::move(expected_)) {}

OneThread::OneThread(std::atomic<bool>& busy, const char* what) : busy_(busy) {
  if (busy_.exchange(true))
    throw ArgumentError(what, std::string("a ") + what + " that another thread is using",
                        "one thread at a time for each");
}

std::string shown(py::handle object) {
  if (py::isinstance<py::array>(object)) {
    const auto array = py::reinterpret_borrow<py::array>(object);
    return "an array of shape " + shape_words(array) + " and type " + std::string(py::str(array.dtype()));
  }
  std::string text = py::repr(object);
  for (char& c : text)
    if (c == '\n') c = ' ';
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

double number(py::handle object, const char* name) {
  const double value = PyFloat_AsDouble(object.ptr());
  if (value == -1.0 && PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    throw ArgumentError(name, shown(object), "a number");
  }
  return value;
}

double finite(py::handle object, const char* name) {
  const double value = number(object, name);
  if (!std::isfinite(value)) throw ArgumentError(name, shown(object), "a finite number");
  return value;
}

double at_least_zero(py::handle object, const char* name) {
  const double value = finite(object, name);
  if (value < 0.0) throw ArgumentError(name, shown(object), "a finite number, 0 or more");
  return value;
}

double positive(py::handle object, const char* name) {
  const double value = finite(object, name);
  if (!(value > 0.0)) throw ArgumentError(name, shown(object), "a finite number above 0");
  return value;
}

double positive_or_infinite(py::handle object, const char* name) {
  const double value = number(object, name);
  if (!(value > 0.0)) throw ArgumentError(name, shown(object), "a number above 0, or infinity");
  return value;
}

Vec2 vector(py::handle object, const char* name) {
  const auto refuse = [&]() -> Vec2 { throw ArgumentError(name, shown(object), "two finite numbers (x, y)"); };
  if (py::isinstance<py::str>(object) || PySequence_Check(object.ptr()) == 0) return refuse();
  const Py_ssize_t size = PySequence_Size(object.ptr());
  if (size < 0) PyErr_Clear();
  if (size != 2) return refuse();
  double xy[2];
  for (int k = 0; k < 2; ++k) {
    const auto item = py::reinterpret_steal<py::object>(PySequence_GetItem(object.ptr(), k));
    xy[k] = item ? PyFloat_AsDouble(item.ptr()) : -1.0;
    if (PyErr_Occurred() != nullptr) {
      PyErr_Clear();
      return refuse();
    }
  }
  if (!std::isfinite(xy[0]) || !std::isfinite(xy[1])) return refuse();
  return {xy[0], xy[1]};
}

void refuse_word(const std::string& text, const char* name, const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& w : words) list += (list.empty() ? "" : ", ") + ("\"" + w + "\"");
  throw ArgumentError(name, "\"" + text + "\"", "one of " + list);
}

void require_word(const std::string& text, const char* name, const std::vector<std::string>& words) {
  if (std::find(words.begin(), words.end(), text) == words.end()) refuse_word(text, name, words);
}

py::tuple as_tuple(const datasets::DataError& e) {
  return py::make_tuple(datasets::code_name(e.code()), e.file(), e.place(), e.found(), e.expected());
}

std::string shape_words(const py::array& array) {
  std::string text;
  for (py::ssize_t k = 0; k < array.ndim(); ++k) text += (k > 0 ? ", " : "") + std::to_string(array.shape(k));
  return "(" + text + (array.ndim() == 1 ? ",)" : ")");
}

std::string expected_shape(const std::vector<py::ssize_t>& shape) {
  std::string text;
  for (const py::ssize_t n : shape) text += (text.empty() ? "" : ", ") + (n < 0 ? std::string("n") : std::to_string(n));
  return "an array of numbers of shape (" + text + (shape.size() == 1 ? ",)" : ")");
}

bool has_shape(const py::array& array, const std::vector<py::ssize_t>& shape) {
  return std::equal(array.shape(), array.shape() + array.ndim(), shape.begin(), shape.end(),
                    [](py::ssize_t found, py::ssize_t wanted) { return wanted < 0 || found == wanted; });
}

Doubles doubles(py::handle object, const char* name, const std::vector<py::ssize_t>& shape) {
  const Doubles array = Doubles::ensure(object);
  if (!array) {
    PyErr_Clear();
    throw ArgumentError(name, shown(object), expected_shape(shape));
  }
  if (has_shape(array, shape)) return array;
  throw ArgumentError(name, "an array of shape " + shape_words(array), expected_shape(shape));
}

std::vector<Vec2> points(py::handle object, const char* name) {
  const Doubles array = doubles(object, name, {-1, 2});
  const double* xy = array.data();
  std::vector<Vec2> result(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = {xy[2 * k], xy[2 * k + 1]};
    if (!geometry::is_finite(result[k]))
      throw ArgumentError(name, "a row that is not finite, number " + std::to_string(k), "finite numbers");
  }
  return result;
}

py::array_t<double> as_array(const std::vector<Vec2>& points) {
  py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{2}});
  double* xy = array.mutable_data();
  for (const Vec2 p : points) {
    *xy++ = p.x;
    *xy++ = p.y;
  }
  return array;
}

void bind_errors(py::module_& module) {
  py::register_exception_translator(&translate);
  // For tests: no input is known for which the library throws these.
  module.def("throw_route_not_proven", [] { throw geometry::RouteNotProven("no way was proven"); });
  module.def("throw_requirement", [] { throw std::logic_error("radius: must not be negative"); });
}

}  // namespace exactvo::python
