// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/markup.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace exactvo::datasets {
namespace {

constexpr std::pair<char, const char*> kEntities[] = {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};

bool is_allowed(char c) {
  return static_cast<unsigned char>(c) >= 0x20 || c == '\t' || c == '\n' || c == '\r';
}

}  // namespace

std::string escaped_markup(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto* known = std::find_if(std::begin(kEntities), std::end(kEntities), [&](auto& e) { return e.first == c; });
    if (known != std::end(kEntities)) {
      out += known->second;
    } else {
      out += is_allowed(c) ? c : '?';
    }
  }
  return out;
}

}  // namespace exactvo::datasets
