// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Numbers and texts as bytes, in this machine's order.

#include <cstring>
#include <string>
#include <string_view>

#include "exactvo/geometry/require.h"

namespace exactvo::datasets::batch {

template <class T>
void append_raw(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// The text after its length.
template <class Length>
void append_text(std::string& bytes, std::string_view text) {
  append_raw(bytes, static_cast<Length>(text.size()));
  bytes += text;
}

/// So much off the front. REQUIRES: it is there.
inline std::string_view take_bytes(std::string_view& bytes, std::size_t length) {
  EXACTVO_REQUIRE(bytes.size() >= length, std::to_string(bytes.size()) + " bytes are left");
  const std::string_view taken = bytes.substr(0, length);
  bytes.remove_prefix(length);
  return taken;
}

template <class T>
T take_raw(std::string_view& bytes) {
  T value;
  std::memcpy(&value, take_bytes(bytes, sizeof(T)).data(), sizeof(T));
  return value;
}

template <class Length>
std::string_view take_text(std::string_view& bytes) {
  return take_bytes(bytes, take_raw<Length>(bytes));
}

}  // namespace exactvo::datasets::batch
