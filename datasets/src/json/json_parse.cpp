// SPDX-License-Identifier: GPL-3.0-or-later
#include "json/json_text.h"

#include <algorithm>
#include <istream>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "exactvo/datasets/input_text.h"
#include "files/text_file.h"

namespace exactvo::datasets {

namespace {

/// Walks the text, notes how far the parser has come, since nlohmann does not say, and lets a signal
/// end a long parse.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, const char* begin, std::size_t* position)
      : at_(at), begin_(begin), position_(position) {}
  const char& operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++at_;
    *position_ = static_cast<std::size_t>(at_ - begin_);
    if (*position_ % kWaitHookBytes == 0) call_wait_hook();
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  const char* begin_;
  std::size_t* position_;
};

/// What stood where the parser stopped, by what it says it wanted: its words are for those who know its grammar.
std::string expected_instead(const std::string& message) {
  using Meaning = std::pair<const char*, const char*>;  // what is said, and what was expected
  static constexpr Meaning kOfTexts[] = {
      {"missing closing quote", "a closing double quote"},
      {"must be escaped", "text without line breaks and control characters (\\n and \\u000a stand for a line break)"},
      {"must be followed by 4 hex digits", "four hexadecimal digits after \\u"},
      {"forbidden character after backslash", "one of \" \\ / b f n r t u after a backslash"},
      {"surrogate", "a surrogate pair: \\ud800 to \\udbff, then \\udc00 to \\udfff"},
      {"ill-formed UTF-8", "text in UTF-8"},
      {"invalid BOM", "text in UTF-8"},
      {"invalid number", "a number as JSON writes it: 0.5, -3, 1e-9"}};
  static constexpr Meaning kOfTokens[] = {{"expected end of input", "the end of the file after one JSON value"},
                                          {"expected string literal", "a key in double quotes"},
                                          {"expected ':'", "a colon after the key"},
                                          {"expected ']'", "a comma or \"]\""},
                                          {"expected '}'", "a comma or \"}\""}};
  // What was read last is the file's, and may hold anything.
  const std::string reason = message.substr(0, message.find("last read: "));
  for (const auto& [said, expected] : kOfTexts)
    if (reason.find(said) != std::string::npos) return expected;
  const std::size_t last = message.rfind("; expected ");
  for (const auto& [said, expected] : kOfTokens)
    if (last != std::string::npos && message.compare(last + 2, std::string::npos, said) == 0) return expected;
  return "a JSON value: an object, a list, a number, text in double quotes, true, false or null";
}

/// "the number 1e999".
std::string number_in(const std::string& message) {
  const std::size_t first = message.find('\''), last = message.rfind('\'');
  return first < last ? "the number " + message.substr(first + 1, last - first - 1) : "a number that is too large";
}

/// What is wrong with a text, by line and column.
class SyntaxErrors {
 public:
  SyntaxErrors(std::string_view text, const std::string& file, const std::size_t& position)
      : text_(text), file_(file), position_(position) {}

  [[noreturn]] void refuse(std::size_t bytes, const nlohmann::detail::exception& error) const {
    if (dynamic_cast<const nlohmann::detail::out_of_range*>(&error) != nullptr)
      throw here(DataCode::number, number_in(error.what()), "a number that a finite double can hold");
    const std::size_t byte = bytes > 0 ? bytes - 1 : 0;
    throw DataError(DataCode::json_syntax, file_, line_and_column(text_, byte), excerpt(text_, byte),
                    expected_instead(error.what()));
  }
  DataError here(DataCode code, const std::string& found, const std::string& expected) const {
    return {code, file_, line_and_column(text_, position_), found, expected};
  }

 private:
  std::string_view text_;
  const std::string& file_;
  const std::size_t& position_;
};

/// Builds a value from the events of nlohmann's parser, in time linear in the text: the library's own builders compare
/// each key with all keys before it, or look at all siblings at the end of each object.
class JsonBuilder : public nlohmann::json_sax<Json> {
 public:
  Json take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // no part of JSON

  bool start_object(std::size_t) override { return open(Json::object()); }
  bool key(string_t& key) override {
    Open& object = open_.back();
    const std::size_t place = object.place_of(key);
    if (place < object.members().size()) {
      on_second(key);
      object.target = &object.members()[place].second;
      return true;
    }
    object.add_member(key);
    return true;
  }
  bool end_object() override { return close(); }

  bool start_array(std::size_t) override {
    Json list = Json::array();
    list.get_ref<Json::array_t&>().reserve(2);  // most are points
    return open(std::move(list));
  }
  bool end_array() override { return close(); }

 protected:
  /// Before an object or a list. False ends the parse, here and below.
  virtual bool on_open() = 0;
  /// After a value that has come to its end.
  virtual bool on_whole() { return true; }
  /// At a key that the object has already. Unless this throws, the last value counts.
  virtual void on_second(const std::string& /*key*/) {}

  /// How many objects and lists have not ended yet.
  std::size_t depth() const { return open_.size(); }
  Json& innermost() const { return *open_.back().value; }

 private:
  /// An object or a list whose end has not come yet. What contains it does not grow until then, so that it stays where
  /// it is.
  struct Open {
    Json* value;
    Json* target = nullptr;                                 ///< of an object: the value that comes next
    std::unordered_map<std::string, std::size_t> places{};  ///< of an object of many members: its keys

    using Members = Json::object_t::Container;
    Members& members() const { return value->get_ref<Json::object_t&>(); }

    /// The number of members where the key is new.
    std::size_t place_of(const std::string& key) {
      const Members& all = members();
      if (all.size() >= kFew) {
        if (places.empty())
          for (std::size_t k = 0; k < all.size(); ++k) places.emplace(all[k].first, k);
        const auto found = places.find(key);
        return found == places.end() ? all.size() : found->second;
      }
      std::size_t k = 0;
      while (k < all.size() && all[k].first != key) ++k;
      return k;
    }
    void add_member(const std::string& key) {
      Members& all = members();
      if (!places.empty()) places.emplace(key, all.size());
      if (all.size() == all.capacity()) grow(all);
      all.emplace_back(key, Json());
      target = &all.back().second;
    }

    /// The vector's own growth copies the values, with all that is in them: pairs with a constant key cannot be moved.
    static void grow(Members& all) {
      Members more;
      more.reserve(std::max<std::size_t>(4, 2 * all.size()));
      for (auto& [key, value] : all) more.emplace_back(key, std::move(value));
      all.swap(more);
    }

    static constexpr std::size_t kFew = 16;  ///< members that are searched one by one
  };

  template <class Value>
  bool add(Value&& value) {
    place_for(Json(std::forward<Value>(value)));
    return on_whole();
  }
  bool open(Json value) {
    if (!on_open()) return false;
    open_.push_back({place_for(std::move(value))});
    return true;
  }
  bool close() {
    open_.pop_back();
    return on_whole();
  }

  Json* place_for(Json value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    if (open_.back().value->is_array()) {
      auto& entries = open_.back().value->get_ref<Json::array_t&>();
      entries.push_back(std::move(value));
      return &entries.back();
    }
    *open_.back().target = std::move(value);
    return open_.back().target;
  }

  Json root_;
  std::vector<Open> open_;
};

/// Refuses what the parser would accept: duplicate keys and bottomless nesting.
class GuardedBuilder : public JsonBuilder {
 public:
  explicit GuardedBuilder(const SyntaxErrors& errors) : errors_(errors) {}

  bool parse_error(std::size_t bytes, const std::string&, const nlohmann::detail::exception& error) override {
    errors_.refuse(bytes, error);
  }

 private:
  bool on_open() override {
    if (depth() >= kDeepestJson)
      throw errors_.here(DataCode::nesting, "more than 100 levels of nesting", "a file that nests less deeply");
    return true;
  }
  void on_second(const std::string& key) override {
    throw errors_.here(DataCode::json_duplicate_key, "the key \"" + key + "\" a second time",
                       "each key once in an object");
  }

  const SyntaxErrors& errors_;
};

/// Hands entries of a list on, and counts the memory of what it keeps.
class EntryBuilder : public JsonBuilder {
 public:
  EntryBuilder(double most_bytes, const EntriesOf& entries) : most_bytes_(most_bytes), entries_(entries) {}

  bool string(string_t& value) override {
    bytes_ += kOfText + static_cast<double>(value.size());
    return JsonBuilder::string(value);
  }
  bool key(string_t& key) override {
    bytes_ += kOfMember + static_cast<double>(key.size());
    if (depth() == 1) is_in_list_ = key == entries_.key;
    return JsonBuilder::key(key);
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    end_ = is_whole_ ? JsonEnd::more_follows : JsonEnd::malformed;
    return false;
  }
  JsonEnd end() const { return end_; }

 private:
  // Bytes beside the characters of texts: no less than the growth of the program's peak with a million equal tokens, on
  // a machine of 64 bits. Most are of lists that double.
  static constexpr double kOfValue = 48.0, kOfContainer = 96.0, kOfMember = 96.0, kOfText = 48.0;

  bool on_open() override {
    bytes_ += kOfContainer;
    if (depth() >= kDeepestJson) end_ = JsonEnd::too_deep;
    return end_ == JsonEnd::whole;
  }
  bool on_whole() override {
    bytes_ += kOfValue;
    is_whole_ = depth() == 0;
    if (bytes_ > most_bytes_) end_ = JsonEnd::too_large;
    if (depth() == 2 && is_in_list_ && innermost().is_array()) hand_on(innermost().get_ref<Json::array_t&>());
    if (depth() < 2) bytes_of_rest_ = bytes_;
    return end_ == JsonEnd::whole;
  }
  void hand_on(Json::array_t& list) {
    if (entries_.take) entries_.take(std::move(list.back()));
    list.clear();
    bytes_ = bytes_of_rest_;
  }

  double most_bytes_;
  const EntriesOf& entries_;
  bool is_in_list_ = false, is_whole_ = false;
  double bytes_ = 0.0, bytes_of_rest_ = 0.0;  ///< in all; of what is kept beside the entries
  JsonEnd end_ = JsonEnd::whole;
};

/// Keeps nothing.
class SyntaxCheck : public nlohmann::detail::json_sax_acceptor<Json> {
 public:
  explicit SyntaxCheck(const SyntaxErrors& errors) : errors_(errors) {}

  bool parse_error(std::size_t bytes, const std::string&, const nlohmann::detail::exception& error) {
    errors_.refuse(bytes, error);
  }

 private:
  const SyntaxErrors& errors_;
};

template <class Events>
bool parse_into(Events& events, std::string_view text, std::size_t& position) {
  const char* begin = text.data();
  return Json::sax_parse(CountingIterator(begin, begin, &position),
                         CountingIterator(begin + text.size(), begin, &position), &events);
}

/// `key` as a JSON pointer's token: ~ and / escaped (RFC 6901).
std::string pointer_token(std::string_view key) {
  std::string token;
  for (const char c : key) {
    if (c == '~') {
      token += "~0";
    } else if (c == '/') {
      token += "~1";
    } else {
      token += c;
    }
  }
  return token;
}

std::optional<std::string> pointer_within(const Json& value, const Json& all) {
  if (&value == &all) return "";
  if (!all.is_structured()) return std::nullopt;
  std::size_t number = 0;
  for (auto entry = all.begin(); entry != all.end(); ++entry, ++number)
    if (const auto rest = pointer_within(value, *entry))
      return "/" + (all.is_object() ? pointer_token(entry.key()) : std::to_string(number)) + *rest;
  return std::nullopt;
}

/// The bit of a member; 0 beyond the 64th, which no object of ours has.
std::uint64_t bit_of(std::size_t member) {
  return member < 64 ? std::uint64_t{1} << member : 0;
}

}  // namespace

Json parse_json(std::string_view text, const std::string& file_name) {
  std::size_t position = 0;
  const SyntaxErrors errors(text, file_name, position);
  GuardedBuilder builder(errors);
  parse_into(builder, text, position);
  return builder.take();
}

void check_json_syntax(std::string_view text, const std::string& file_name) {
  std::size_t position = 0;
  const SyntaxErrors errors(text, file_name, position);
  SyntaxCheck check(errors);
  parse_into(check, text, position);
}

ReadJson read_json(std::streambuf& text, double most_bytes, const EntriesOf& entries) {
  EntryBuilder builder(most_bytes, entries);
  std::istream stream(&text);
  Json::sax_parse(stream, &builder);
  return {builder.take(), builder.end()};
}

Json parse_json_line(std::string_view line, const std::string& file_name, std::size_t number) {
  try {
    return parse_json(line, file_name);
  } catch (const DataError& error) {
    const std::string column = error.place().substr(error.place().find(", ") + 2);
    throw DataError(error.code(), file_name, "line " + std::to_string(number) + ", " + column, error.found(),
                    error.expected());
  }
}

std::string described(const Json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "a list of " + std::to_string(value.size());
  constexpr std::size_t kLongest = 60;
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

std::string pointer_to(const Json& value, const Json& all) {
  return pointer_within(value, all).value_or("");
}

JsonCursor JsonCursor::child(const Json& value) const {
  JsonCursor cursor = *this;
  cursor.value_ = &value;
  cursor.asked_ = 0;
  return cursor;
}

JsonCursor JsonCursor::at(const std::string& key) const {
  if (!value_->is_object()) refuse("an object");
  const Json::object_t::Container& all = value_->get_ref<const Json::object_t&>();
  const auto member = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.first == key; });
  if (member == all.end()) refuse("the key \"" + key + "\"", DataCode::key_missing);
  asked_ |= bit_of(static_cast<std::size_t>(member - all.begin()));
  return child(member->second);
}

void JsonCursor::end_of_object() const {
  if (others_ == OtherKeys::pass || !value_->is_object()) return;
  std::size_t number = 0;
  for (auto member = value_->begin(); member != value_->end(); ++member, ++number)
    if ((asked_ & bit_of(number)) == 0)
      throw DataError(DataCode::key_unknown, *file_, child(*member).place(), "an unknown key \"" + member.key() + "\"",
                      "the keys that this format has");
}

JsonCursor JsonCursor::at(std::size_t index) const {
  if (index >= size())
    refuse("at least " + std::to_string(index + 1) + (index == 0 ? " entry" : " entries"), DataCode::wrong_count);
  return child((*value_)[index]);
}

std::size_t JsonCursor::size() const {
  if (!value_->is_array()) refuse("a list");
  return value_->size();
}

double JsonCursor::number() const {
  if (value_->is_number()) return value_->get<double>();
  if (*value_ == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (*value_ == "inf") return std::numeric_limits<double>::infinity();
  if (*value_ == "-inf") return -std::numeric_limits<double>::infinity();
  refuse("a number");
}

geometry::Vec2 JsonCursor::point() const {
  if (size() != 2) refuse("[x, y]", DataCode::wrong_count);
  return {at(std::size_t{0}).number(), at(std::size_t{1}).number()};
}

const std::string& JsonCursor::text() const {
  if (!value_->is_string()) refuse("text in quotes");
  return value_->get_ref<const std::string&>();
}

bool JsonCursor::truth() const {
  if (!value_->is_boolean()) refuse("true or false");
  return value_->get<bool>();
}

std::uint64_t JsonCursor::count() const {
  if (!value_->is_number_unsigned()) refuse("a whole number, not negative");
  return value_->get<std::uint64_t>();
}

int JsonCursor::integer() const {
  if (!value_->is_number_integer()) refuse("a whole number");
  return value_->get<int>();
}

std::string JsonCursor::place() const {
  const std::string pointer = pointer_to(*value_, *root_);
  return place_.empty() || pointer.empty() ? place_ + pointer : place_ + ", " + pointer;
}

void JsonCursor::refuse(const std::string& expected, DataCode code) const {
  throw DataError(code, *file_, place(), described(*value_), expected);
}

}  // namespace exactvo::datasets
