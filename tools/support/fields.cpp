// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/fields.h"

#include <algorithm>
#include <charconv>

namespace exactvo::tools {

namespace {

constexpr const char* kBlanks = " \t\r";

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string_view without_mark(std::string_view line, std::size_t number) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return number == 1 && line.substr(0, kMark.size()) == kMark ? line.substr(kMark.size()) : line;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  const char* const separators = line.find(',') != std::string_view::npos ? "," : kBlanks;
  const bool by_blanks = separators == kBlanks;
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t end = line.find_first_of(separators);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(by_blanks ? std::min(line.find_first_not_of(separators, end), line.size()) : end + 1);
  }
}

std::optional<double> number_in(std::string_view field) {
  if (!field.empty() && field.front() == '+') field.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) return std::nullopt;
  return value;
}

}  // namespace exactvo::tools
