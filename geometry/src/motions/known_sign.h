// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Signs that may be unknown, so that one formula serves the filter (RunningError) and the exact stages.

#include "exact/exact_number.h"
#include "exact/running_error.h"

namespace exactvo::geometry::motions {

using detail::Exact;
using detail::RunningError;
using detail::Vector;

enum class Known { negative, zero, positive, unknown };

inline Known opposite(Known s) {
  return s == Known::negative ? Known::positive : s == Known::positive ? Known::negative : s;
}
inline Known known(Sign s) {
  return s == Sign::negative ? Known::negative : s == Sign::zero ? Known::zero : Known::positive;
}
inline Known sign_of(const RunningError& x) {
  if (detail::decided(x)) return x.value > 0.0 ? Known::positive : Known::negative;
  return detail::is_exact_zero(x) ? Known::zero : Known::unknown;
}
inline Known sign_of(const Exact& x) {
  return known(detail::sign_of(x));
}
inline Known sign_of(const mpq_class& x) {
  return known(detail::sign_of(x));
}

/// The sign of the least of several numbers.
inline Known least(Known a, Known b) {
  if (a == Known::negative || b == Known::negative) return Known::negative;
  if (a == Known::unknown || b == Known::unknown) return Known::unknown;
  return a == Known::zero || b == Known::zero ? Known::zero : Known::positive;
}
/// The sign of the greatest of several numbers.
inline Known greatest(Known a, Known b) {
  return opposite(least(opposite(a), opposite(b)));
}

inline bool is_zero(const Vector<RunningError>& v) {
  return detail::is_exact_zero(v.x) && detail::is_exact_zero(v.y);
}

}  // namespace exactvo::geometry::motions
