// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate_arrays.h"

#include <algorithm>
#include <type_traits>

#include "arguments.h"
#include "exactvo/vo/lp/problem.h"
#include "lp_values.h"

namespace exactvo::python {

namespace {

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
    using Number = std::remove_reference_t<decltype(*array.mutable_data())>;
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
    array = std::remove_reference_t<decltype(array)>::ensure(arrays[name]);
    if (array && has_shape(array, shape)) return;
    PyErr_Clear();
    throw ArgumentError(name, shown(arrays[name]), "as many as problems, in the shape that solve_batch gives");
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
