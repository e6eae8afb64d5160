// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Infinity, by a short name.

#include <limits>

namespace exactvo::geometry {

/// Positive infinity as a double.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace exactvo::geometry
