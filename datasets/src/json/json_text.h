// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// JSON in and out, for this room. Out: a writer that needs no tree and prints the shortest digits that read back to
/// the same double. In: nlohmann's parser, with line and column for what is wrong, duplicate keys refused, depth
/// bounded.
///
/// What goes both ways has its members listed once, in the order of the text, for a JsonWriter and a JsonCursor alike:
///
///     template <class Codec>
///     void members(Codec& json, For<Codec, PlanMove>& move) { json.member("robot", move.robot).member("to", move.to);
///     }

#include <cstdint>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <streambuf>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::geometry {

/// [x, y], for nlohmann's `get` and `value`.
inline void from_json(const nlohmann::ordered_json& pair, Vec2& v) {
  v = {pair.at(0).get<double>(), pair.at(1).get<double>()};
}

}  // namespace exactvo::geometry

namespace exactvo::datasets {

/// Keys keep the order of the text, so that messages and outputs do.
using Json = nlohmann::ordered_json;

/// No file of ours nests deeper than ten; the parser is iterative, but what walks the tree is not.
inline constexpr int kDeepestJson = 100;

/// Throws DataError (E_JSON_SYNTAX, E_JSON_DUPLICATE_KEY, E_NESTING, E_NUMBER) with line and column.
Json parse_json(std::string_view text, const std::string& file_name);

/// Throws DataError (E_JSON_SYNTAX, E_NUMBER) as `parse_json` does, and keeps nothing of the text.
void check_json_syntax(std::string_view text, const std::string& file_name);

/// A list that is not kept: each entry goes to `take` as soon as it is whole.
struct EntriesOf {
  std::string key;  ///< of the outermost object
  std::function<void(Json)> take;
};

enum class JsonEnd {
  whole,
  more_follows,  ///< behind the value, which is whole
  malformed,
  too_deep,  ///< more than kDeepestJson
  too_large  ///< for the memory allowed
};

struct ReadJson {
  Json value;  ///< as far as it was read
  JsonEnd end;
};

/// What `text` holds, in one pass. Repeated keys are no error, the last one counts. `most_bytes` of memory, estimated,
/// may be kept at once.
ReadJson read_json(std::streambuf& text, double most_bytes, const EntriesOf& entries = {});

/// `parse_json` of line `number` of a file of lines, each of which is JSON: places name that line.
Json parse_json_line(std::string_view line, const std::string& file_name, std::size_t number);

/// "a number", "text", ... with the value where it is short: what messages say was found.
std::string described(const Json& value);

/// The JSON pointer of a value that stands in `all`, searched by its address: only messages need it.
std::string pointer_to(const Json& value, const Json& all);

/// The type by which `members` takes a T: const for a writer.
template <class Codec, class T>
using For = std::conditional_t<Codec::kReads, T, const T>;

/// Whether lists of T, and objects with `members`, are written on one line even in an indented text.
template <class T>
inline constexpr bool kOnOneLine = false;
template <>
inline constexpr bool kOnOneLine<std::vector<double>> = true;
template <>
inline constexpr bool kOnOneLine<std::vector<geometry::Vec2>> = true;

/// How deep in objects and strings the next byte of a text of JSON stands.
class JsonNesting {
 public:
  void take(char c) {
    if (in_string_) {
      if (c == '"' && !is_escaped_) in_string_ = false;
      is_escaped_ = c == '\\' && !is_escaped_;
      return;
    }
    in_string_ = c == '"';
    objects_ += c == '{' ? 1 : c == '}' ? -1 : 0;
  }
  long objects() const { return objects_; }
  bool in_string() const { return in_string_; }

 private:
  long objects_ = 0;
  bool in_string_ = false, is_escaped_ = false;
};

/// The shortest text that reads back to the same finite double ("-0.0" keeps its sign). It stays until the thread asks
/// for that of another one.
std::string_view shortest_text(double number);

/// A text in the making. It is written a few bytes at a time, for which each call of std::string's costs too much.
class GrowingText {
 public:
  void add(char c) {
    *room(1) = c;
    ++size_;
  }
  void add(std::string_view bytes) {
    std::memcpy(room(bytes.size()), bytes.data(), bytes.size());
    size_ += bytes.size();
  }
  void add_number(double number) { add(shortest_text(number)); }

  std::string_view view() const { return {memory_.data(), size_}; }
  std::string take() {
    memory_.resize(std::exchange(size_, 0));
    return std::move(memory_);
  }
  void clear() { size_ = 0; }

 private:
  /// For `count` bytes behind the text.
  char* room(std::size_t count) {
    if (memory_.size() - size_ < count) {
      memory_.reserve(size_ + count);
      memory_.resize(memory_.capacity());
    }
    return memory_.data() + size_;
  }

  std::string memory_;
  std::size_t size_ = 0;  ///< of the text; what follows is free
};

/// Appends JSON to a text.
class JsonWriter {
 public:
  static constexpr bool kReads = false;
  enum class Layout {
    compact,  ///< everything on one line
    indented  ///< two spaces a level
  };
  explicit JsonWriter(Layout layout) : layout_(layout) {}

  JsonWriter& begin_object() { return open('{', layout_); }
  JsonWriter& end_object() { return close('}'); }
  JsonWriter& begin_array() { return open('[', layout_); }
  JsonWriter& end_array() { return close(']'); }
  /// Containers that stand on one line, with all that is in them, even in an indented text.
  JsonWriter& begin_inline_object() { return open('{', Layout::compact); }
  JsonWriter& begin_inline_array() { return open('[', Layout::compact); }

  JsonWriter& key(std::string_view name);
  /// Non-finite numbers become the strings "nan", "inf" and "-inf".
  JsonWriter& value(double number);
  JsonWriter& value(bool truth);
  template <class Integer, std::enable_if_t<std::is_integral_v<Integer>, int> = 0>
  JsonWriter& value(Integer number) {
    return raw(std::to_string(number));
  }
  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(geometry::Vec2 point);  ///< [x, y]
  JsonWriter& null();
  /// Text that already is JSON.
  JsonWriter& raw(std::string_view json);

  /// Whatever `append_value` appends: what `value` takes, optional values (null where there is none), lists, and what
  /// has `members`.
  template <class T>
  JsonWriter& member(std::string_view name, const T& v) {
    key(name);
    append_value(*this, v);
    return *this;
  }
  /// A member that may be missing when it is read; always written.
  template <class T>
  JsonWriter& optional(std::string_view name, const T& v) {
    return member(name, v);
  }
  /// Left out where there is none.
  template <class T>
  JsonWriter& optional(std::string_view name, const std::optional<T>& v) {
    return v ? member(name, *v) : *this;
  }
  /// Written where `is_told`; may be missing when it is read.
  template <class T>
  JsonWriter& member_if(bool is_told, std::string_view name, const T& v) {
    return is_told ? member(name, v) : *this;
  }
  /// An object whose members `append` appends to this.
  template <class Append>
  JsonWriter& object(std::string_view name, const Append& append) {
    key(name).begin_object();
    append(*this);
    return end_object();
  }
  /// What `append` appends of it, or null.
  template <class T, class Append>
  JsonWriter& member(std::string_view name, const std::optional<T>& v, const Append& append) {
    key(name);
    if (!v) return null();
    append(*v);
    return *this;
  }
  /// What `append` appends of each entry.
  template <class List, class Append>
  JsonWriter& list(std::string_view name, const List& entries, const Append& append) {
    key(name).begin_array();
    for (const auto& entry : entries) append(entry);
    return end_array();
  }

  std::string_view text() const { return text_.view(); }
  std::string take() { return text_.take(); }
  void clear() { text_.clear(); }

 private:
  struct Level {
    Layout layout;
    bool empty;
  };
  JsonWriter& open(char bracket, Layout layout);
  JsonWriter& close(char bracket);
  void separate();
  void new_line(std::size_t depth);
  void add_quoted(std::string_view raw);

  Layout layout_;
  GrowingText text_;
  std::vector<Level> levels_;
  bool after_key_ = false;
};

inline void append_number(std::string& text, double number) {
  text += shortest_text(number);
}
inline std::string number_text(double number) {
  return std::string(shortest_text(number));
}

/// A place in a JSON value that can find out how it was reached: what it can't give it names, with file, line and
/// pointer.
class JsonCursor {
 public:
  static constexpr bool kReads = true;
  /// Keys that are not asked for.
  enum class OtherKeys { pass, refused };

  /// `line` is put before the pointer in messages: "line 3" in JSON Lines, "" elsewhere.
  JsonCursor(const Json& value, const std::string& file, std::string line, OtherKeys others = OtherKeys::pass)
      : root_(&value), value_(&value), file_(&file), place_(std::move(line)), others_(others) {}

  bool has(const std::string& key) const { return value_->is_object() && value_->contains(key); }
  bool is_null() const { return value_->is_null(); }
  JsonCursor at(const std::string& key) const;
  JsonCursor at(std::size_t index) const;
  std::size_t size() const;  ///< of a list

  double number() const;  ///< also "nan", "inf", "-inf"
  geometry::Vec2 point() const;
  const std::string& text() const;
  bool truth() const;
  std::uint64_t count() const;
  int integer() const;
  const Json& json() const { return *value_; }

  void get(double& v) const { v = number(); }
  void get(geometry::Vec2& v) const { v = point(); }
  void get(std::string& v) const { v = text(); }
  void get(bool& v) const { v = truth(); }
  void get(std::uint64_t& v) const { v = count(); }
  void get(int& v) const { v = integer(); }

  // What JsonWriter writes under the same names.
  template <class T>
  const JsonCursor& member(const char* key, T& v) const {
    read_value(at(key), v);
    return *this;
  }
  template <class T>
  const JsonCursor& optional(const char* key, T& v) const {
    return has(key) ? member(key, v) : *this;
  }
  /// null is refused, not taken for an empty value.
  template <class T>
  const JsonCursor& optional(const char* key, std::optional<T>& v) const {
    return has(key) ? member(key, v.emplace()) : *this;
  }
  template <class T>
  const JsonCursor& member_if(bool /*is_told*/, const char* key, T& v) const {
    return optional(key, v);
  }
  template <class Read>
  const JsonCursor& object(const char* key, const Read& read) const {
    const JsonCursor there = at(key);
    read(there);
    there.end_of_object();
    return *this;
  }
  /// To be called when an object has been read: refuses a key that `at` was not asked for, unless others pass.
  void end_of_object() const;

  [[noreturn]] void refuse(const std::string& expected, DataCode code = DataCode::wrong_type) const;

 private:
  JsonCursor child(const Json& value) const;
  std::string place() const;  ///< for messages: line and pointer

  const Json* root_;
  const Json* value_;
  const std::string* file_;
  std::string place_;
  OtherKeys others_;
  mutable std::uint64_t asked_ = 0;  ///< members of the object, a bit each; no object of ours has more than 64
};

// What members can be. Other files have more: shapes, words of enumerations.

template <class T>
auto append_value(JsonWriter& json, const T& v) -> decltype(json.value(v), void()) {
  json.value(v);
}
template <class T>
auto append_value(JsonWriter& json, const T& v) -> decltype(members(json, v)) {
  kOnOneLine<T> ? json.begin_inline_object() : json.begin_object();
  members(json, v);
  json.end_object();
}
template <class T>
void append_value(JsonWriter& json, const std::optional<T>& v) {
  v ? append_value(json, *v) : void(json.null());
}
template <class T>
void append_value(JsonWriter& json, const std::vector<T>& entries) {
  kOnOneLine<std::vector<T>> ? json.begin_inline_array() : json.begin_array();
  for (const T& entry : entries) append_value(json, entry);
  json.end_array();
}

template <class T>
auto read_value(const JsonCursor& at, T& v) -> decltype(at.get(v)) {
  at.get(v);
}
template <class T>
auto read_value(const JsonCursor& at, T& v) -> decltype(members(at, v)) {
  members(at, v);
  at.end_of_object();
}
template <class T>
void read_value(const JsonCursor& at, std::optional<T>& v) {
  at.is_null() ? v.reset() : read_value(at, v.emplace());
}
template <class T>
void read_value(const JsonCursor& at, std::vector<T>& entries) {
  entries.clear();  // one by one: a long list of what is no entry ends at the first
  for (std::size_t k = 0; k < at.size(); ++k) read_value(at.at(k), entries.emplace_back());
}

}  // namespace exactvo::datasets
