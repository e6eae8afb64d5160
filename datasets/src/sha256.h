// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// SHA-256 (FIPS 180-4), a block at a time.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace exactvo::datasets {

class Sha256 {
 public:
  void add(std::string_view bytes);
  /// Lower-case hexadecimal. The object is spent afterwards.
  std::string digest();

 private:
  void compress(const unsigned char* block);

  std::array<std::uint32_t, 8> state_{0x6a09e667u, 0xbb67ae85u, 0x3c6ef372u, 0xa54ff53au,
                                      0x510e527fu, 0x9b05688cu, 0x1f83d9abu, 0x5be0cd19u};
  std::string pending_;
  std::uint64_t length_ = 0;  ///< bytes
};

}  // namespace exactvo::datasets
