// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A double with a running bound of its own error: the filter stage of the predicates that are evaluated as one
/// polynomial. After any sequence of + - *, |value - true| <= error (1 + 2^-40) as long as fewer than 2^10 operations
/// were chained: every update of `error` rounds at most six times, each by a factor within 1 +- 2^-53.

#include <cmath>

#include "exact/exact_vector.h"
#include "exact/stages.h"

namespace exactvo::geometry::detail {

struct RunningError {
  double value = 0.0;
  double error = 0.0;

  RunningError() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a double is exact, and the formulas are shared with exact types.
  RunningError(double v) : value(v) {}
  RunningError(double v, double e) : value(v), error(e) {}
};

inline constexpr double kHalfUlp = 0x1p-53;
/// More than any rounding error of a product that underflows (2^-1075).
inline constexpr double kUnderflow = 0x1p-1070;

inline RunningError operator+(RunningError a, RunningError b) {
  const double v = a.value + b.value;
  return {v, a.error + b.error + kHalfUlp * std::fabs(v)};
}
inline RunningError operator-(RunningError a, RunningError b) {
  const double v = a.value - b.value;
  return {v, a.error + b.error + kHalfUlp * std::fabs(v)};
}
inline RunningError operator-(RunningError a) {
  return {-a.value, a.error};
}
/// Known without error, as the difference of equal doubles is.
inline bool is_exact_zero(RunningError a) {
  return a.value == 0.0 && a.error == 0.0;
}
/// An exact zero times anything finite is one.
inline RunningError operator*(RunningError a, RunningError b) {
  const double v = a.value * b.value;
  const double underflow = is_exact_zero(a) || is_exact_zero(b) ? 0.0 : kUnderflow;
  return {v, std::fabs(a.value) * b.error + std::fabs(b.value) * a.error + a.error * b.error + kHalfUlp * std::fabs(v) +
                 underflow};
}

/// Whether the sign of the value is beyond doubt; overflow and NaN are doubt.
inline bool decided(RunningError a) {
  constexpr double kSlack = 1.0 + 0x1p-40;
  return std::isfinite(a.value) && std::fabs(a.value) > a.error * kSlack;
}

/// Evaluates `formula(number<T>)` in tracked doubles and, where the sign stays in doubt, exactly. `formula` is generic
/// and uses + - * only. Counts which stage answered.
template <typename Formula>
Sign filtered_sign(const Formula& formula) {
  const RunningError approx = formula(RunningError{});
  if (decided(approx)) {
    count_filter();
    return sign_of_double(approx.value);
  }
  count_exact();
  return sign_of(formula(Exact{}));
}

}  // namespace exactvo::geometry::detail
