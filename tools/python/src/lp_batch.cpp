// SPDX-License-Identifier: GPL-3.0-or-later
// Many linear programs at once, on numpy arrays. The lanes of lp/batch.h want line k of all problems side by side: that
// is the order of n x m arrays in Fortran order, which are used where they lie; others are copied. Certificates have at
// most three terms each, every multiplier the exact sum of a few doubles.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>

#include "arguments.h"
#include "exactvo/vo/lp/batch.h"
#include "exactvo/vo/lp/certificate.h"
#include "exactvo/vo/lp/solvers.h"
#include "module.h"

namespace exactvo::python {

namespace {

// --- Problems ---

/// | |normal| - 1 | <= 2^-10, as lp/batch.h asks; squared, with room for the rounding of the square.
constexpr double kNormalError = 0x1p-9;

using Fortran = py::array_t<double, py::array::f_style | py::array::forcecast>;

/// One number for all problems, or one for each.
py::object for_each(py::handle object, py::ssize_t count) {
  const bool is_one = PyFloat_Check(object.ptr()) || PyLong_Check(object.ptr());
  return is_one ? py::module_::import("numpy").attr("full")(count, object) : py::reinterpret_borrow<py::object>(object);
}

/// The caller's arrays, or copies of them, and what they mean. Throws ArgumentError for what lp/batch.h does not
/// promise an answer for, and where an array would have to be copied and may not be. The last check needs no
/// interpreter: `require_in_range`.
class BatchArrays {
 public:
  BatchArrays(py::handle normals, py::handle offsets, py::handle preferred, py::handle max_speed, py::handle hard,
              bool may_copy)
      : may_copy_(may_copy) {
    const py::array n = in_fortran_order(normals, "normals", {-1, -1, 2});
    const py::ssize_t count = n.shape(0), lines = n.shape(1);
    problems.count = problems.block = static_cast<std::size_t>(count);
    problems.lines = static_cast<std::size_t>(lines);
    problems.normal_x = static_cast<const double*>(n.data());
    problems.normal_y = problems.normal_x + count * lines;
    problems.offset = static_cast<const double*>(in_fortran_order(offsets, "offsets", {count, lines}).data());
    problems.preferred_x = static_cast<const double*>(in_fortran_order(preferred, "preferred", {count, 2}).data());
    problems.preferred_y = problems.preferred_x + count;
    const Doubles speeds = doubles(for_each(max_speed, count), "max_speed", {count});
    kept_.push_back(speeds);
    problems.disc = speeds.data();
    take_hard(hard, count, lines);
  }

  std::size_t place(std::size_t problem, std::size_t line) const { return line * problems.count + problem; }

  lp::Problem at(std::size_t i) const {
    lp::Problem problem;
    for (std::size_t k = 0; k < problems.lines; ++k) {
      const std::size_t p = place(i, k);
      problem.constraints.push_back({{{problems.normal_x[p], problems.normal_y[p]}, problems.offset[p]},
                                     static_cast<std::int32_t>(k) < hard_[i] ? lp::Priority::hard : lp::Priority::soft,
                                     static_cast<int>(k)});
    }
    problem.preferred = {problems.preferred_x[i], problems.preferred_y[i]};
    problem.bound.disc = problems.disc[i];
    return problem;
  }

  /// What lp/batch.h requires: its lanes promise nothing else.
  void require_in_range() const {
    const lp::BatchProblems<double>& p = problems;
    for (std::size_t i = 0; i < p.count; ++i) {
      if (!std::isfinite(p.preferred_x[i]) || !std::isfinite(p.preferred_y[i]))
        throw ArgumentError("preferred", "a number that is not finite, in row " + std::to_string(i), "finite numbers");
      if (!std::isfinite(p.disc[i]) || !(p.disc[i] > 0.0))
        throw ArgumentError("max_speed", std::to_string(p.disc[i]) + " of problem " + std::to_string(i),
                            "a finite number above 0");
    }
    for (std::size_t k = 0; k < p.count * p.lines; ++k) {
      const double length = p.normal_x[k] * p.normal_x[k] + p.normal_y[k] * p.normal_y[k];
      if (std::fabs(length - 1.0) <= kNormalError && std::isfinite(p.offset[k])) continue;
      throw ArgumentError("normals",
                          "(" + std::to_string(p.normal_x[k]) + ", " + std::to_string(p.normal_y[k]) +
                              ") with offset " + std::to_string(p.offset[k]) + " at [" + std::to_string(k % p.count) +
                              ", " + std::to_string(k / p.count) + "]",
                          "unit normals (to 1e-3) and finite offsets; solve() takes normals of any length");
    }
  }

  lp::BatchProblems<double> problems;
  bool is_copied = false;

 private:
  /// Stays alive with this object.
  py::array in_fortran_order(py::handle object, const char* name, const std::vector<py::ssize_t>& shape) {
    const py::array given = py::array::ensure(object);
    const bool is_text = given && std::strchr("OUS", given.dtype().kind()) != nullptr;
    if (!given || is_text || !has_shape(given, shape)) {
      PyErr_Clear();
      throw ArgumentError(name, shown(given ? py::handle(given) : object), expected_shape(shape));
    }
    const py::array array = Fortran::ensure(given);
    if (!array) throw py::error_already_set();
    if (array.data() != given.data() || !py::isinstance<py::array>(object)) {
      if (!may_copy_)
        throw ArgumentError(name, shown(given) + ((given.flags() & py::array::f_style) != 0 ? "" : " in another order"),
                            "a float64 array in Fortran order, since copy=False");
      is_copied = true;
    }
    kept_.push_back(array);
    return array;
  }

  void take_hard(py::handle hard, py::ssize_t count, py::ssize_t lines) {
    if (hard.is_none()) {
      hard_.assign(problems.count, static_cast<std::int32_t>(lines));
    } else {
      const auto array =
          array_of<std::int64_t>(for_each(hard, count), "hard", {count}, "a whole number, or as many as problems");
      for (py::ssize_t i = 0; i < count; ++i) {
        if (array.data()[i] < 0 || array.data()[i] > lines)
          throw ArgumentError("hard", std::to_string(array.data()[i]),
                              "0 to " + std::to_string(lines) + ", the number of lines");
        hard_.push_back(static_cast<std::int32_t>(array.data()[i]));
      }
    }
    problems.hard = hard_.data();
  }

  bool may_copy_;
  std::vector<py::array> kept_;  ///< alive while they are pointed to
  std::vector<std::int32_t> hard_;
};

// --- Certificates ---

/// -1 - k in arrays of bindings: nothing, then the parts of the speed bound in the order of lp::BindingKind.
constexpr std::int32_t kNoBinding = -1;
constexpr std::size_t kTerms = 3;

std::int32_t as_number(const lp::Binding& binding) {
  if (!is_speed_bound(binding)) return static_cast<std::int32_t>(binding.index);
  return kNoBinding - static_cast<std::int32_t>(binding.kind);
}

/// The binding; an index of kNoBinding or out of range becomes one that `check` calls malformed.
lp::Binding binding_of(std::int64_t number) {
  const std::int64_t kind = kNoBinding - number;
  if (kind > 0 && kind <= static_cast<std::int64_t>(lp::BindingKind::box_bottom))
    return {static_cast<lp::BindingKind>(kind), 0};
  return lp::constraint_at(number < 0 ? std::numeric_limits<std::size_t>::max() : static_cast<std::size_t>(number));
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

/// By name: present, status, velocity, violation, gap, bound, contradiction, vertex and their multipliers.
class CertificateArrays {
 public:
  explicit CertificateArrays(const std::vector<std::optional<lp::Certificate>>& all) {
    const std::size_t parts = most_parts(all);
    each(static_cast<py::ssize_t>(all.size()), static_cast<py::ssize_t>(parts),
         [](const char*, auto& array, auto shape) {
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
      put_terms(c.bound, i, bound_, bound_multiplier_);
      put_terms(c.contradiction, i, contradiction_, contradiction_multiplier_);
      for (std::size_t v = 0; v < std::min<std::size_t>(c.vertex.size(), 2); ++v)
        vertex_.mutable_data()[2 * i + v] = as_number(c.vertex[v]);
    }
  }

  /// From the caller. Throws ArgumentError where they do not fit each other.
  CertificateArrays(const py::dict& arrays, py::ssize_t count) {
    each(count, -1, [&](const char* name, auto& array, const auto& shape) {
      using Number = typename std::remove_reference_t<decltype(array)>::value_type;
      array = array_of<Number>(arrays[name], name, shape, "as many as problems, in the shape that solve_batch gives");
    });
  }

  /// Arrays that cannot be written.
  py::dict dict() {
    py::dict result;
    each(0, 0, [&](const char* name, auto& array, const auto&) {
      make_read_only(array);
      result[name] = array;
    });
    return result;
  }

  bool has(std::size_t i) const { return present_.data()[i]; }

  /// Nothing where the status is none. Needs no interpreter. REQUIRES: has(i).
  std::optional<lp::Certificate> at(std::size_t i) const {
    if (status_.data()[i] > static_cast<std::uint8_t>(lp::Status::no_interior)) return std::nullopt;
    lp::Certificate c;
    c.status = static_cast<lp::Status>(status_.data()[i]);
    c.velocity = {velocity_.data()[2 * i], velocity_.data()[2 * i + 1]};
    c.violation = violation_.data()[i];
    c.gap = gap_.data()[i];
    c.bound = terms_at(i, bound_, bound_multiplier_);
    c.contradiction = terms_at(i, contradiction_, contradiction_multiplier_);
    for (std::size_t v = 0; v < 2; ++v)
      if (vertex_.data()[2 * i + v] != kNoBinding) c.vertex.push_back(binding_of(vertex_.data()[2 * i + v]));
    return c;
  }

 private:
  template <class T>
  using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

  /// `take(name, array, shape)` of each.
  template <class Take>
  void each(py::ssize_t count, py::ssize_t parts, const Take& take) {
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

  static void put_terms(const std::vector<lp::Term>& terms, std::size_t i, Array<std::int32_t>& bindings,
                        Array<double>& multipliers) {
    const auto parts = static_cast<std::size_t>(multipliers.shape(2));
    for (std::size_t t = 0; t < std::min(terms.size(), kTerms); ++t) {
      bindings.mutable_data()[kTerms * i + t] = as_number(terms[t].binding);
      std::copy(terms[t].multiplier.begin(), terms[t].multiplier.end(),
                multipliers.mutable_data() + (kTerms * i + t) * parts);
    }
  }

  static std::vector<lp::Term> terms_at(std::size_t i, const Array<std::int32_t>& bindings,
                                        const Array<double>& multipliers) {
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

  Array<bool> present_;
  Array<std::uint8_t> status_;
  Array<double> velocity_, violation_, gap_;
  Array<std::int32_t> bound_, contradiction_, vertex_;
  Array<double> bound_multiplier_, contradiction_multiplier_;  ///< every multiplier has as many doubles
};

/// 0 where a certificate proves its answer, else what is wrong with it: an lp::CertificateError; 255: there is none.
py::array_t<std::uint8_t> check_batch(py::handle normals, py::handle offsets, py::handle preferred,
                                      py::handle max_speed, py::handle hard, const py::dict& arrays) {
  const BatchArrays b(normals, offsets, preferred, max_speed, hard, true);
  b.require_in_range();
  const auto count = static_cast<py::ssize_t>(b.problems.count);
  const CertificateArrays certificates(arrays, count);
  py::array_t<std::uint8_t> result(count);
  std::uint8_t* const out = result.mutable_data();
  const py::gil_scoped_release released;
  for (std::size_t i = 0; i < b.problems.count; ++i) {
    out[i] = 255;
    if (!certificates.has(i)) continue;
    const std::optional<lp::Certificate> c = certificates.at(i);
    out[i] = static_cast<std::uint8_t>(c ? check(b.at(i), *c) : lp::CertificateError::malformed);
  }
  return result;
}

// --- Answers ---

/// What binds in the answer that the lanes gave; the disc, which they do not name, wherever it may.
lp::Solution solution_at(const lp::BatchAnswers<double>& answers, double disc, std::size_t i) {
  constexpr double kOnDisc = 1e-6;
  lp::Solution s;
  s.velocity = {answers.velocity_x[i], answers.velocity_y[i]};
  s.status = static_cast<lp::Status>(answers.status[i]);
  s.violation = answers.violation[i];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t line = answers.active[k * answers.stride + i];
    if (line != lp::kNoLine) s.active[s.active_count++].binding = lp::constraint_at(static_cast<std::size_t>(line));
  }
  const bool room = s.active_count < (s.status == lp::Status::optimal ? 2U : 3U);
  if (room && norm(s.velocity) > disc * (1.0 - kOnDisc)) s.active[s.active_count++].binding = lp::kDisc;
  return s;
}

/// Proves the answers, exactly where that takes it. Returns the certificates and counts the exact ones.
std::vector<std::optional<lp::Certificate>> certify(const BatchArrays& b, const lp::BatchAnswers<double>& answers,
                                                    std::size_t& exact) {
  std::vector<std::optional<lp::Certificate>> certificates(b.problems.count);
  for (std::size_t i = 0; i < certificates.size(); ++i) {
    lp::Proven answer{solution_at(answers, b.problems.disc[i], i), std::nullopt, false};
    prove(b.at(i), answer);
    certificates[i] = std::move(answer.certificate);
    answers.proven[i] = certificates[i].has_value();
    if (!answer.exact_stage) continue;
    ++exact;
    const lp::Solution& s = answer.solution;
    answers.velocity_x[i] = s.velocity.x;
    answers.velocity_y[i] = s.velocity.y;
    answers.violation[i] = s.violation;
    answers.status[i] = static_cast<std::uint8_t>(s.status);
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_line = k < s.active_count && !is_speed_bound(s.active[k].binding);
      answers.active[k * answers.stride + i] =
          is_line ? static_cast<std::int32_t>(s.active[k].binding.index) : lp::kNoLine;
    }
  }
  return certificates;
}

/// What exactvo.lp.BatchSolution has, by name; arrays that cannot be written.
py::dict solve_batch(py::handle normals, py::handle offsets, py::handle preferred, py::handle max_speed,
                     py::handle hard, bool prove, bool certificates, bool copy, bool parallel) {
  using namespace py::literals;
  const BatchArrays b(normals, offsets, preferred, max_speed, hard, copy);
  const std::size_t n = b.problems.count;
  const auto count = static_cast<py::ssize_t>(n);
  py::array_t<double, py::array::f_style> velocity({count, py::ssize_t{2}});
  py::array_t<std::int32_t, py::array::f_style> active({count, py::ssize_t{3}});
  py::array_t<double> violation(count);
  py::array_t<std::uint8_t> status(count);
  py::array_t<bool> proven(count);
  std::fill_n(active.mutable_data(), 3 * n, lp::kNoLine);
  lp::BatchAnswers<double> answers{velocity.mutable_data(),
                                   velocity.mutable_data() + n,
                                   violation.mutable_data(),
                                   status.mutable_data(),
                                   active.mutable_data(),
                                   n,
                                   reinterpret_cast<std::uint8_t*>(proven.mutable_data())};
  constexpr std::size_t kLarge = 64;  // from about 10 microseconds on
  std::optional<py::gil_scoped_release> released;
  if (n * b.problems.lines > kLarge || certificates) released.emplace();
  b.require_in_range();
  lp::BatchCounts counts;
  std::vector<std::optional<lp::Certificate>> proofs;
  if (n > 0) {
    lp::BatchAnswers<double> of_lanes = answers;
    if (!prove) of_lanes.proven = nullptr;
    counts = parallel ? solve_batch_parallel(b.problems, of_lanes) : lp::solve_batch(b.problems, of_lanes, 0, n);
    if (certificates) proofs = certify(b, answers, counts.exact);
  }
  released.reset();
  for (py::array* array : std::initializer_list<py::array*>{&velocity, &active, &violation, &status, &proven})
    make_read_only(*array);
  return py::dict("velocity"_a = velocity, "violation"_a = violation, "status"_a = status, "active"_a = active,
                  "proven"_a = prove || certificates ? py::object(proven) : py::none(),
                  "certificates"_a = certificates ? py::object(CertificateArrays(proofs).dict()) : py::none(),
                  "copied"_a = b.is_copied, "scalar_count"_a = counts.scalar, "exact_count"_a = counts.exact);
}

}  // namespace

void bind_lp_batch(py::module_& module) {
  module.def("lp_solve_batch", &solve_batch);
  module.def("lp_check_batch", &check_batch);
}

}  // namespace exactvo::python
