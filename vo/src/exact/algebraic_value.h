// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What an AlgebraicDirection holds, and the signs that are asked of it in rationals.

#include <memory>
#include <utility>

#include "exact/algebraic_root.h"
#include "exact/exact_vector.h"
#include "exactvo/vo/algebraic_direction.h"

namespace exactvo::vo::detail {

using RationalVector = geometry::detail::Vector<Rational>;

struct AlgebraicValue {
  Root slope;             ///< -1 < t <= 1
  int quarter_turns = 0;  ///< 0 to 3
};

/// Access key: makes and reads an AlgebraicDirection, for this folder alone.
struct AlgebraicAccess {
  static AlgebraicDirection direction(AlgebraicValue value) {
    return AlgebraicDirection(std::make_shared<const AlgebraicValue>(std::move(value)));
  }
  static const AlgebraicValue& value(const AlgebraicDirection& a) { return *a.value_; }
};

inline const AlgebraicValue& value_of(const AlgebraicDirection& a) {
  return AlgebraicAccess::value(a);
}

/// Counter-clockwise by k quarter turns, k of any sign.
RationalVector turned(const RationalVector& v, int k);

/// REQUIRES: v not zero.
AlgebraicDirection direction_of(const RationalVector& v);
AlgebraicDirection direction_of(Root slope, int quarter_turns);

}  // namespace exactvo::vo::detail
