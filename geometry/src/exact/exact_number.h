// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The exact number of the predicates: CGAL's Mpzf, integers times powers of two, closed under + - *. A finite
/// double converts without rounding. NaN and infinity are taken silently, so callers check for them first.

#include <gmpxx.h>

#include <CGAL/Mpzf.h>

#include "exactvo/geometry/predicates.h"

#ifndef CGAL_HAS_MPZF
#error "CGAL was configured without Mpzf; a 64-bit platform with GMP is needed"
#endif

namespace exactvo::geometry::detail {

using Exact = CGAL::Mpzf;

inline Sign sign_of(const Exact& x) {
  return static_cast<Sign>(static_cast<int>(CGAL::sign(x)));
}
inline Sign sign_of(const mpq_class& x) {
  return static_cast<Sign>(sgn(x));
}

}  // namespace exactvo::geometry::detail
