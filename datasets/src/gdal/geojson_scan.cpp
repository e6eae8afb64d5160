// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/geojson_scan.h"

#include <system_error>
#include <utility>

#include "exactvo/datasets/input_text.h"
#include "gdal/geojson_shape.h"
#include "gdal/json_memory.h"

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
  Scanner(bool name_says_sequence, double file_size)
      : name_says_sequence_(name_says_sequence), limit_(parser_memory_for(file_size)), first_(name_says_sequence) {}

  /// False once the rest of the file does not matter.
  bool take(char c) {
    const bool was_in_string = members_.nesting().in_string(), was_in_features = members_.is_in_features();
    members_.take(c);
    if (!first_.is_over()) {
      first_.take(c, was_in_string, members_);
      found_.is_sequence = first_.more_follows() && (name_says_sequence_ || first_.is_record());
      if (found_.is_sequence) return false;
    }
    if (!was_in_features || !members_.is_in_features()) take_head(c);
    has_more_ = has_more_ || (is_complete_ && !is_json_blank(c));
    is_complete_ = members_.nesting().objects() == 0 && (is_complete_ || c == '}');
    zeros_ = c == '\0' ? zeros_ + 1 : 0;
    return zeros_ < kHole;
  }

  GeoJsonScan result(const std::string& file) && {
    if (!found_.is_sequence && memory_.bytes() > limit_) throw too_bulky(memory_, file, "");
    found_.is_broken = !is_complete_ || has_more_;
    found_.type = members_.type();
    return std::move(found_);
  }

 private:
  void take_head(char c) {
    memory_.take(c);
    if (memory_.bytes() <= limit_) found_.head += c;
  }

  static constexpr std::size_t kHole = 1 << 16;  ///< zeros one after the other: a sparse file

  bool name_says_sequence_;
  double limit_;
  GeoJsonScan found_;
  JsonMembers members_;
  FirstObject first_;
  JsonMemory memory_;  ///< of the head
  bool is_complete_ = false, has_more_ = false;
  std::size_t zeros_ = 0;  ///< the last bytes
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
  const bool was_in_string = nesting_.in_string(), was_at_members = is_at(0);
  nesting_.take(c);
  if (was_at_members && !was_in_string && c == '[') is_in_features_ = member_ == "features";
  if (!is_at(0)) return;
  is_in_features_ = false;
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

GeoJsonScan scan_geojson(const std::filesystem::path& path, bool name_says_sequence) {
  std::error_code error;
  std::ifstream file(path, std::ios::binary);
  skip_byte_order_mark(file);
  Scanner scanner(name_says_sequence, static_cast<double>(std::filesystem::file_size(path, error)));
  for_each_byte(file, [&](char c) { return scanner.take(c); });
  return std::move(scanner).result(path.string());
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
