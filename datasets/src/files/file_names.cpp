// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/file_names.h"

#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <random>

namespace exactvo::datasets {

std::string unique_word() {
  std::random_device source;
  const std::uint64_t bits = (std::uint64_t{source()} << 32) | source();
  char text[24];
  std::snprintf(text, sizeof text, "%016" PRIx64, bits);
  return text;
}

}  // namespace exactvo::datasets
