// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <iterator>
#include <string>

namespace exactvo::tools {

/// "52 kB", three digits.
inline std::string size_text(double bytes) {
  const char* const units[] = {"B", "kB", "MB", "GB", "TB"};
  std::size_t k = 0;
  for (; bytes >= 1000.0 && k + 1 < std::size(units); ++k) bytes /= 1000.0;
  return fmt::format("{:.3g} {}", bytes, units[k]);
}

}  // namespace exactvo::tools
