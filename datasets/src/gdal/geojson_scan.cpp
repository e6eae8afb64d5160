// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/geojson_scan.h"

#include <cpl_port.h>

#include "exactvo/datasets/input_text.h"
#include "gdal/geojson_sequence.h"

namespace exactvo::datasets {
namespace {

constexpr const char* kByteOrderMark = "\xef\xbb\xbf";

/// Calls `take(c)` for each byte from where the file stands until it gives false.
template <class Take>
void for_each_byte(std::ifstream& file, const Take& take) {
  std::streambuf& bytes = *file.rdbuf();
  std::size_t count = 0;
  for (int c = bytes.sgetc(); c != std::char_traits<char>::eof(); c = bytes.snextc()) {
    if (++count % kWaitHookBytes == 0) call_wait_hook();
    if (!take(static_cast<char>(c))) return;
  }
}

class Scanner {
 public:
  explicit Scanner(bool name_says_sequence) : name_says_sequence_(name_says_sequence), first_(name_says_sequence) {}

  /// False once the rest of the file does not matter.
  bool take(char c) {
    const bool was_in_string = members_.nesting().in_string(), was_among = members_.is_among_features();
    members_.take(c);
    if (!first_.is_over()) {
      first_.take(c, was_in_string, members_);
      found_.is_sequence = first_.more_follows() && (name_says_sequence_ || first_.is_record());
      if (found_.is_sequence) return false;
    }
    is_text_ = is_text_ && c != '\0';  // JSON has no such byte, but GDAL takes it within a string
    if (is_text_) take_memory(c);
    take_entry(c, was_among);
    zeros_ = c == '\0' ? zeros_ + 1 : 0;
    return zeros_ < kHole;
  }
  /// Before the first byte: of a byte order mark.
  void take_mark() {
    for (const char* c = kByteOrderMark; *c != '\0'; ++c) whole_.take(*c);
  }

  GeoJsonScan result() && {
    found_.memory = found_.is_collection() ? before_features_ : whole_;
    if (!EQUAL(first_.type().c_str(), "FeatureCollection")) found_.strays.clear();
    return std::move(found_);
  }

 private:
  /// Until the type is known, and of a collection the first entry has come.
  void take_memory(char c) {
    if (is_object_ == Answer::open && !is_json_blank(c)) is_object_ = c == '{' ? Answer::yes : Answer::no;
    if (!is_type_settled_ && is_object_ != Answer::no) {
      is_before_features_ = is_before_features_ && !members_.is_among_features();
      if (is_before_features_) before_features_.take(c);
      if (found_.type != members_.type()) found_.type = members_.type();
      is_type_settled_ = !found_.type.empty() && !(found_.is_collection() && is_before_features_);
    }
    if (!is_type_settled_ || !found_.is_collection()) whole_.take(c);
  }

  void take_entry(char c, bool was_among) {
    if (is_entry_awaited_ && !is_json_blank(c)) {
      if (c != '{' && c != ']') found_.strays.push_back({entries_, c});
      ++entries_;
      is_entry_awaited_ = false;
    }
    if (members_.is_among_features() && c == (was_among ? ',' : '[')) is_entry_awaited_ = true;
  }

  static constexpr std::size_t kHole = 1 << 16;  ///< zeros one after the other: a sparse file
  enum class Answer { open, yes, no };

  bool name_says_sequence_;
  GeoJsonScan found_;
  JsonMembers members_;
  FirstObject first_;
  JsonMemory before_features_, whole_;
  bool is_text_ = true;
  std::size_t zeros_ = 0;  ///< the last bytes
  Answer is_object_ = Answer::open;
  bool is_before_features_ = true, is_type_settled_ = false;
  bool is_entry_awaited_ = false;
  std::size_t entries_ = 0;
};

}  // namespace

void JsonNesting::take(char c) {
  if (in_string_) {
    if (c == '"' && !is_escaped_) in_string_ = false;
    is_escaped_ = c == '\\' && !is_escaped_;
    return;
  }
  in_string_ = c == '"';
  objects_ += c == '{' ? 1 : c == '}' ? -1 : 0;
  arrays_ += c == '[' ? 1 : c == ']' ? -1 : 0;
}

void JsonMembers::take(char c) {
  constexpr std::size_t kLongestWord = 40;  // no name that is asked for is as long
  const bool was_in_string = nesting_.in_string();
  nesting_.take(c);
  if (nesting_.objects() != 1 || nesting_.arrays() != 0) return;
  if (was_in_string && nesting_.in_string()) {
    if (text_.size() < kLongestWord) text_ += c;
  } else if (nesting_.in_string()) {
    text_.clear();
  } else if (was_in_string) {
    if (member_ == "type") type_ = text_;
  } else if (c == ':') {
    member_ = text_;
  } else if (c == ',') {
    member_.clear();
  }
}

void FirstObject::take(char c, bool in_string, const JsonMembers& members) {
  switch (stage_) {
    case Stage::before:
      if (is_json_blank(c)) return;
      stage_ = c == '{' ? Stage::inside : Stage::over;
      return;
    case Stage::inside:
      if (c == '\n' && in_string) {  // broken: strings have no line ends
        stage_ = Stage::over;
        return;
      }
      spans_lines_ = spans_lines_ || c == '\n';
      if (last_type_ != members.type()) last_type_ = members.type();
      if (first_type_.empty() && !last_type_.empty()) {
        first_type_ = last_type_;
        if (!whatever_type_ && !is_type_of_record(first_type_)) {
          stage_ = Stage::over;
          return;
        }
      }
      if (members.nesting().objects() == 0) stage_ = Stage::behind;
      return;
    case Stage::behind:
      is_complete_ = true;
      more_follows_ = !is_json_blank(c);
      if (more_follows_) stage_ = Stage::over;
      return;
    case Stage::over:
      return;
  }
}

bool FirstObject::is_record() const {
  return is_complete_ && is_type_of_record(first_type_) && is_type_of_record(last_type_);
}

const std::string& FirstObject::type() const {
  return first_type_.empty() || is_type_of_record(first_type_) ? last_type_ : first_type_;
}

GeoJsonScan scan_geojson(const std::filesystem::path& path, bool name_says_sequence) {
  std::ifstream file(path, std::ios::binary);
  skip_byte_order_mark(file);
  Scanner scanner(name_says_sequence);
  if (file.tellg() > 0) scanner.take_mark();
  for_each_byte(file, [&](char c) { return scanner.take(c); });
  return std::move(scanner).result();
}

bool first_record_spans_lines(std::ifstream& file) {
  const std::streampos start = file.tellg();
  JsonMembers members;
  FirstObject first(false);
  for_each_byte(file, [&](char c) {
    const bool in_string = members.nesting().in_string();
    members.take(c);
    first.take(c, in_string, members);
    return !first.is_over() && !first.is_record();
  });
  file.clear();
  file.seekg(start);
  return first.is_record() && first.spans_lines();
}

void skip_byte_order_mark(std::ifstream& file) {
  char first[3] = {};
  file.read(first, 3);
  const bool is_mark = file.gcount() == 3 && std::string(first, 3) == kByteOrderMark;
  file.clear();
  if (!is_mark) file.seekg(0);
}

}  // namespace exactvo::datasets
