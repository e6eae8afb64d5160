// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate_arrays.h"

#include <algorithm>
#include <string>

#include "arguments.h"
#include "exactvo/vo/lp/problem.h"
#include "lp_values.h"

namespace exactvo::python {

namespace {

/// Every multiplier has `parts` doubles.
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

}  // namespace

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

CertificateReader::CertificateReader(const py::dict& arrays, std::size_t count) {
  const auto n = static_cast<py::ssize_t>(count);
  present_ = member<bool>(arrays, "present", {n});
  status_ = member<std::uint8_t>(arrays, "status", {n});
  velocity_ = member<double>(arrays, "velocity", {n, 2});
  violation_ = member<double>(arrays, "violation", {n});
  gap_ = member<double>(arrays, "gap", {n});
  bound_ = member<std::int32_t>(arrays, "bound", {n, 3});
  bound_multiplier_ = member<double>(arrays, "bound_multiplier", {n, 3, -1});
  contradiction_ = member<std::int32_t>(arrays, "contradiction", {n, 3});
  contradiction_multiplier_ = member<double>(arrays, "contradiction_multiplier", {n, 3, -1});
  vertex_ = member<std::int32_t>(arrays, "vertex", {n, 2});
}

std::optional<lp::Certificate> CertificateReader::at(std::size_t i) const {
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
