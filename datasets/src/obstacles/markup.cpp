// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/markup.h"

namespace exactvo::datasets {
namespace {

bool is_allowed(char c) {
  return static_cast<unsigned char>(c) >= 0x20 || c == '\t' || c == '\n' || c == '\r';
}

}  // namespace

std::string escaped_markup(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += is_allowed(c) ? c : '?';
    }
  }
  return out;
}

}  // namespace exactvo::datasets
