// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whether golden bits can be expected: they depend on how the C library rounds its elementary functions.

#include <cmath>
#include <cstring>
#include <string>

#include "exactvo/datasets/provenance.h"

namespace exactvo::test {

inline void append_bits(std::string& bytes, double x) {
  char raw[sizeof x];
  std::memcpy(raw, &x, sizeof x);
  bytes.append(raw, sizeof x);
}

/// SHA-256 over what the C library's functions give here: two machines on which it agrees give the same recordings.
inline std::string library_fingerprint() {
  std::string bytes;
  for (int k = 1; k <= 2000; ++k) {
    const double x = 0.0137 * k;
    for (const double y : {std::sin(x), std::cos(x), std::atan2(x, 3.0 - x), std::exp(-x), std::expm1(-x), std::cbrt(x),
                           std::hypot(x, 1.0 / x), std::acos(1.0 / (1.0 + x))})
      append_bits(bytes, y);
  }
  return datasets::sha256_of(bytes);
}

inline constexpr const char* kRecordedLibrary = "3422fe293ac92e331750ef804244295409db88af78029ad65fa9eb723b649b1e";

/// Whether this C library gives what the one gave that golden bits were recorded with.
inline bool c_library_is_the_recorded_one() {
  return library_fingerprint() == kRecordedLibrary;
}

}  // namespace exactvo::test
