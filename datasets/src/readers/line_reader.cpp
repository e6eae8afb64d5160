// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/line_reader.h"

#include "files/text_file.h"

namespace exactvo::datasets {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";
}  // namespace

LineReader::LineReader(std::string text, const std::string& file)
    : LineAtHand(file), text_(std::move(text)), rest_(without_mark(text_)) {}

bool LineReader::next() {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
  ++number_;
  return true;
}

bool LineReader::next_filled() {
  while (next())
    if (!trimmed(line_).empty()) return true;
  return false;
}

bool TableLines::next_filled() {
  while (lines_.next(line_)) {
    number_ = lines_.number();
    line_ = trimmed(number_ == 1 ? without_mark(line_) : line_);
    if (!line_.empty() && line_.front() != '#') return true;
  }
  return false;
}

std::vector<std::string> TableLines::fields() const {
  if (line_.find(',') != std::string_view::npos) return LineAtHand::fields();
  const std::vector<std::string_view> words = words_of(line_);
  return {words.begin(), words.end()};
}

void TableLines::refuse(DataCode code, std::string_view found, const std::string& expected) const {
  constexpr std::size_t kShown = 60;
  LineAtHand::refuse(code, std::string(found.substr(0, kShown)) + (found.size() > kShown ? "..." : ""), expected);
}

double LineAtHand::to_number(std::string_view field) const {
  double value = 0.0;
  if (!parse_whole(field, value)) refuse(DataCode::number, excerpt(field, 0), "a number");
  return value;
}

std::int64_t LineAtHand::to_integer(std::string_view field) const {
  std::int64_t value = 0;
  if (!parse_whole(field, value)) refuse(DataCode::number, excerpt(field, 0), "a whole number");
  return value;
}

void LineAtHand::refuse(DataCode code, const std::string& found, const std::string& expected) const {
  throw DataError(code, file_, number_ == 0 ? "" : place(), found, expected);
}

std::vector<std::string> LineAtHand::fields() const {
  std::optional<std::vector<std::string>> fields = csv_fields_of(line_);
  if (!fields)
    refuse(DataCode::format_syntax, "a quotation mark that is not closed where its field ends",
           "fields as CSV quotes them: \"a, \"\"b\"\"\"");
  return std::move(*fields);
}

std::string_view without_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.substr(0, kMark.size()) == kMark ? text.substr(kMark.size()) : text;
}

void split(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  if (separator == ' ') {
    for (std::size_t at = 0; (at = line.find_first_not_of(kBlanks, at)) != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
      fields.push_back(line.substr(at, end - at));
      at = end;
    }
    return;
  }
  for (;;) {
    const std::size_t end = line.find(separator);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

std::vector<std::string_view> words_of(std::string_view line) {
  return fields_of(line, ' ');
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  split(line, separator, fields);
  return fields;
}

std::optional<std::vector<std::string>> csv_fields_of(std::string_view line, char separator) {
  std::vector<std::string> fields;
  for (;;) {
    const std::string_view rest =
        line.substr(std::min({line.find_first_not_of(kBlanks), line.find(separator), line.size()}));
    std::string field;
    if (!rest.empty() && rest.front() == '"') {
      std::size_t at = 1;
      for (;; ++at) {
        at = std::min(at, rest.size());
        if (at == rest.size()) return std::nullopt;
        if (rest[at] == '"' && rest.substr(at + 1, 1) != "\"") break;
        if (rest[at] == '"') ++at;
        field += rest[at];
      }
      line = rest.substr(at + 1);
      if (!trimmed(line.substr(0, line.find(separator))).empty()) return std::nullopt;
    } else {
      field = std::string(trimmed(line.substr(0, line.find(separator))));
    }
    fields.push_back(std::move(field));
    const std::size_t end = line.find(separator);
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace exactvo::datasets
