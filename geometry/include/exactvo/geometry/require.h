// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Preconditions. A caller's mistake is a `std::logic_error` that names the broken condition, the place and the values;
/// an answer ("infeasible", "overlapping") is a value and never comes this way; bad data is a `datasets::DataError`.

#include <stdexcept>
#include <string>

namespace exactvo::geometry::detail {

[[noreturn]] inline void requirement_failed(const char* condition, const char* where, const std::string& found) {
  throw std::logic_error(std::string(where) + ": requires " + condition + "; found " + found);
}

}  // namespace exactvo::geometry::detail

/// Throws `std::logic_error` unless `condition` holds. `found` is an expression convertible to std::string; it is
/// evaluated only on failure.
#define EXACTVO_REQUIRE(condition, found)                                                      \
  do {                                                                                         \
    if (!(condition)) ::exactvo::geometry::detail::requirement_failed(#condition, __func__, (found)); \
  } while (false)
