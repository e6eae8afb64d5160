// SPDX-License-Identifier: GPL-3.0-or-later
// Many linear programs at once, on numpy arrays.
#include <algorithm>
#include <optional>
#include <string_view>

#include "exactvo/vo/lp/batch.h"
#include "exactvo/vo/lp/solvers.h"
#include "lp_values.h"
#include "module.h"

namespace exactvo::python {

namespace {

/// 0 where a certificate proves its answer, else what is wrong with it: an lp::CertificateError; 255: there is none.
py::array_t<std::uint8_t> check_batch(py::handle normals, py::handle offsets, py::handle preferred,
                                      py::handle max_speed, py::handle hard, const py::dict& arrays) {
  const BatchArrays b = batch_arrays(normals, offsets, preferred, max_speed, hard, true);
  require_in_range(b);
  const CertificateArrays certificates(arrays, b.count);
  py::array_t<std::uint8_t> result(static_cast<py::ssize_t>(b.count));
  std::uint8_t* const out = result.mutable_data();
  const py::gil_scoped_release released;
  for (std::size_t i = 0; i < b.count; ++i) {
    out[i] = 255;
    if (!certificates.has(i)) continue;
    const std::optional<lp::Certificate> c = certificates.at(i);
    out[i] = static_cast<std::uint8_t>(c ? check(problem_at(b, i), *c) : lp::CertificateError::malformed);
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
  BatchArrays b = batch_arrays(normals, offsets, preferred, max_speed, hard, copy);
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
  if (certificates) batch.certificate_arrays = CertificateArrays(proofs).dict();
  return batch;
}

/// A getter of so many numbers for each problem, column by column.
template <class T>
auto column(std::vector<T> Batch::*data, py::ssize_t columns) {
  return [data, columns](const py::object& self) {
    const auto& batch = self.cast<const Batch&>();
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(batch.count)};
    if (columns > 1) shape.push_back(columns);
    return view<py::array::f_style>((batch.*data).data(), std::move(shape), self);
  };
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
      .def_property_readonly("velocity", column(&Batch::velocity, 2))
      .def_property_readonly("violation", column(&Batch::violation, 1))
      .def_property_readonly("status", column(&Batch::status, 1))
      .def_property_readonly("active", column(&Batch::active, 3))
      .def_property_readonly("proven",
                             [](const py::object& self) -> py::object {
                               const auto& b = self.cast<const Batch&>();
                               if (b.proven.size() != b.count) return py::none();
                               return column(&Batch::proven, 1)(self).attr("view")(py::dtype::of<bool>());
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
