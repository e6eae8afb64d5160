// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/fields.h"

#include <algorithm>
#include <charconv>

namespace exactvo::tools {

namespace {

constexpr const char* kBlanks = " \t\r\n";

/// Where the first field ends, with its quotation marks as CSV has them: commas between them part no fields.
std::size_t end_of_field(std::string_view line) {
  bool is_quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"') is_quoted = !is_quoted;
    if (line[k] == ',' && !is_quoted) return k;
  }
  return std::string_view::npos;
}

std::string_view without_quotes(std::string_view field) {
  const bool is_quoted = field.size() >= 2 && field.front() == '"' && field.back() == '"';
  return is_quoted ? field.substr(1, field.size() - 2) : field;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string_view without_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.substr(0, kMark.size()) == kMark ? text.substr(kMark.size()) : text;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  const char* const separators = line.find(',') != std::string_view::npos ? "," : kBlanks;
  const bool by_blanks = separators == kBlanks;
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t end = by_blanks ? line.find_first_of(separators) : end_of_field(line);
    const std::string_view field = trimmed(line.substr(0, end));
    fields.push_back(by_blanks ? field : without_quotes(field));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(by_blanks ? std::min(line.find_first_not_of(separators, end), line.size()) : end + 1);
  }
}

std::optional<double> number_in(std::string_view field) {
  if (field.substr(0, 1) == "+" && field.substr(1, 1) != "-") field.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) return std::nullopt;
  return value;
}

bool TableLines::next() {
  while (lines_.next(line_)) {
    line_ = trimmed(number() == 1 ? without_mark(line_) : line_);
    if (!line_.empty() && line_.front() != '#') return true;
  }
  return false;
}

void TableLines::refuse(datasets::DataCode code, std::string_view found, const std::string& expected) const {
  constexpr std::size_t kShown = 60;
  throw datasets::DataError(code, file(), "line " + std::to_string(number()),
                            std::string(found.substr(0, kShown)) + (found.size() > kShown ? "..." : ""), expected);
}

}  // namespace exactvo::tools
