// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>

#include "json/json_text.h"

namespace exactvo::datasets {
namespace {

bool is_escaped(char c) {
  static constexpr std::array<bool, 256> kEscaped = [] {
    std::array<bool, 256> escaped{};
    for (std::size_t k = 0; k < 0x20; ++k) escaped[k] = true;
    escaped['"'] = escaped['\\'] = true;
    return escaped;
  }();
  return kEscaped[static_cast<unsigned char>(c)];
}

/// Texts of doubles that were written lately: a row has the same ones in its place and its anchor, the next row and the
/// table of rows again, and the shortest text of a double takes some hundred instructions.
class NumberTexts {
 public:
  std::string_view of(double number) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    Entry& entry = entries_[static_cast<std::size_t>(bits * 0x9e3779b97f4a7c15u >> 55)];
    if (entry.length == 0 || entry.bits != bits) entry.fill(bits, number);
    return {entry.text.data(), entry.length};
  }

 private:
  struct Entry {
    std::uint64_t bits;
    std::uint8_t length;  ///< 0: nothing yet
    std::array<char, 31> text;

    void fill(std::uint64_t new_bits, double number) {
      bits = new_bits;
      // Integer text would lose the sign of zero: readers take "-0" for an integer.
      const std::string_view negative_zero = "-0.0";
      char* end = number == 0.0 && std::signbit(number)
                      ? std::copy(negative_zero.begin(), negative_zero.end(), text.data())
                      : std::to_chars(text.data(), text.data() + text.size(), number).ptr;
      length = static_cast<std::uint8_t>(end - text.data());
    }
  };
  std::array<Entry, 512> entries_{};
};

}  // namespace

std::string_view shortest_text(double number) {
  // Not itself in the memory of the thread: a module that is loaded late gets little of that.
  thread_local const auto texts = std::make_unique<NumberTexts>();
  return texts->of(number);
}

void JsonWriter::new_line(std::size_t depth) {
  text_.add('\n');
  for (std::size_t k = 0; k < depth; ++k) text_.add("  ");
}

void JsonWriter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (levels_.empty()) return;
  Level& level = levels_.back();
  if (!level.empty) text_.add(',');
  if (level.layout == Layout::indented) {
    new_line(levels_.size());
  } else if (!level.empty && layout_ == Layout::indented) {
    text_.add(' ');
  }
  level.empty = false;
}

JsonWriter& JsonWriter::open(char bracket, Layout layout) {
  separate();
  text_.add(bracket);
  const bool nested_inline = !levels_.empty() && levels_.back().layout == Layout::compact;
  levels_.push_back({nested_inline ? Layout::compact : layout, true});
  return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
  const Level level = levels_.back();
  levels_.pop_back();
  if (level.layout == Layout::indented && !level.empty) new_line(levels_.size());
  text_.add(bracket);
  return *this;
}

void JsonWriter::add_quoted(std::string_view raw) {
  text_.add('"');
  const std::size_t plain = static_cast<std::size_t>(std::find_if(raw.begin(), raw.end(), is_escaped) - raw.begin());
  text_.add(raw.substr(0, plain));
  for (const char c : raw.substr(plain)) {
    switch (c) {
      case '"':
        text_.add("\\\"");
        break;
      case '\\':
        text_.add("\\\\");
        break;
      case '\n':
        text_.add("\\n");
        break;
      case '\t':
        text_.add("\\t");
        break;
      default:
        if (is_escaped(c)) {
          text_.add("\\u00");
          text_.add("0123456789abcdef"[(c >> 4) & 0xf]);
          text_.add("0123456789abcdef"[c & 0xf]);
        } else {
          text_.add(c);
        }
    }
  }
  text_.add('"');
}

JsonWriter& JsonWriter::key(std::string_view name) {
  separate();
  add_quoted(name);
  text_.add(layout_ == Layout::indented ? ": " : ":");
  after_key_ = true;
  return *this;
}

JsonWriter& JsonWriter::value(double number) {
  if (!std::isfinite(number)) return value(std::isnan(number) ? "nan" : number > 0.0 ? "inf" : "-inf");
  separate();
  text_.add_number(number);
  return *this;
}

JsonWriter& JsonWriter::value(bool truth) {
  return raw(truth ? "true" : "false");
}

JsonWriter& JsonWriter::value(std::string_view text) {
  separate();
  add_quoted(text);
  return *this;
}

JsonWriter& JsonWriter::value(geometry::Vec2 point) {
  if (layout_ == Layout::compact && std::isfinite(point.x) && std::isfinite(point.y)) {  // as below, without its calls
    separate();
    text_.add('[');
    text_.add_number(point.x);
    text_.add(',');
    text_.add_number(point.y);
    text_.add(']');
    return *this;
  }
  return begin_inline_array().value(point.x).value(point.y).end_array();
}

JsonWriter& JsonWriter::null() {
  return raw("null");
}

JsonWriter& JsonWriter::raw(std::string_view json) {
  separate();
  text_.add(json);
  return *this;
}

}  // namespace exactvo::datasets
