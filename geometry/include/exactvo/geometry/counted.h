// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Counts in messages: "1 file", "2 files".

#include <cstddef>
#include <string>

namespace exactvo::geometry {

/// "1 entry", "0 entries" for (n, "entry", "entries"); without `many` an s is added to `one`.
inline std::string counted(std::size_t n, const std::string& one, const std::string& many = {}) {
  return std::to_string(n) + " " + (n == 1 ? one : many.empty() ? one + "s" : many);
}

}  // namespace exactvo::geometry
