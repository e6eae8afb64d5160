// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/geojson_sequence.h"

#include <cpl_json.h>

#include <algorithm>

#include "exactvo/datasets/input_text.h"
#include "files/text_file.h"
#include "gdal/geojson_shape.h"

namespace exactvo::datasets {
namespace {

constexpr char kRecordSeparator = '\x1e';
constexpr const char* kBlanks = " \t\r\n";
constexpr const char* kByteOrderMark = "\xef\xbb\xbf";

constexpr int kEnd = std::char_traits<char>::eof();

bool is_blank(int c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

void skip_byte_order_mark(std::ifstream& file) {
  char first[3] = {};
  file.read(first, 3);
  const bool is_mark = file.gcount() == 3 && std::string(first, 3) == kByteOrderMark;
  file.clear();
  if (!is_mark) file.seekg(0);
}

/// The outermost object, byte by byte: a string before a colon is a member's name, the one behind it its value.
class MembersOfObject {
 public:
  void take(char c) {
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
  const JsonNesting& nesting() const { return nesting_; }
  const std::string& type() const { return type_; }
  /// Between the entries of "features".
  bool is_among_features() const {
    return member_ == "features" && nesting_.objects() == 1 && nesting_.arrays() == 1 && !nesting_.in_string();
  }

 private:
  static constexpr std::size_t kLongestWord = 40;  ///< no name that is asked for is as long
  JsonNesting nesting_;
  std::string text_;
  std::string member_;
  std::string type_;
};

/// What begins so, in words.
std::string kind_of_value(int c) {
  if (c == '"') return "a string";
  if (c == '[') return "an array";
  if (c == 'n') return "null";
  return c == 't' || c == 'f' ? "true or false" : "a number";
}

/// What stands first, with its place, looked at byte by byte.
class FirstObject {
 public:
  explicit FirstObject(std::ifstream& file) : bytes_(*file.rdbuf()) {}

  /// Until the object's end, or until it is known to be none of a sequence and its name does not say so. False where it
  /// has no end.
  bool pass(bool whatever_type) {
    int c = skip_blanks();
    if (c != '{') return false;
    bool is_type_checked = false;
    for (std::size_t k = 0; c != kEnd; c = bytes_.snextc(), ++k) {
      if (k % kWaitHookBytes == 0) call_wait_hook();
      if (c == '\n' && members_.nesting().in_string()) return false;  // broken: strings have no line ends
      spans_lines_ = spans_lines_ || c == '\n';
      members_.take(static_cast<char>(c));
      if (!whatever_type && !is_type_checked && !type().empty()) {
        is_type_checked = true;
        if (!is_type_of_record(type())) return false;
      }
      if (members_.nesting().objects() == 0) break;
    }
    return c != kEnd && bytes_.snextc() != kEnd;
  }
  bool more_follows() { return skip_blanks() != kEnd; }
  bool spans_lines() const { return spans_lines_; }
  const std::string& type() const { return members_.type(); }

 private:
  int skip_blanks() {
    int c = bytes_.sgetc();
    while (is_blank(c)) c = bytes_.snextc();
    return c;
  }

  std::streambuf& bytes_;
  MembersOfObject members_;
  bool spans_lines_ = false;
};

std::string words_of(const GeoJsonPlace& place) {
  const std::string line = "line " + std::to_string(place.line);
  return place.column > 1 ? line + ", column " + std::to_string(place.column) : line;
}

/// What GDAL's parser does not take, in the words of ours, which says where.
DataError syntax_fault(const std::string& text, const std::string& file, const GeoJsonPlace& place) {
  try {
    parse_json_line(text, file, place.line);
  } catch (const DataError& error) {
    return place.column == 1 ? error : DataError(error.code(), file, words_of(place), error.found(), error.expected());
  }
  return {DataCode::format_syntax, file, words_of(place), excerpt(text, text.find_first_not_of(kBlanks)),
          "a feature or a geometry that GDAL reads"};
}

std::unique_ptr<OGRGeometry> shape_of(const CPLJSONObject& record) {
  const CPLJSONObject within = record.GetObj("geometry");
  const bool is_feature = EQUAL(record.GetString("type").c_str(), "Feature");
  if (is_feature && within.GetType() != CPLJSONObject::Type::Object) return nullptr;
  return std::unique_ptr<OGRGeometry>(OGRGeometryFactory::createFromGeoJson(is_feature ? within : record));
}

GeoJsonRecord record_of(const std::string& text, const std::string& file, const GeoJsonPlace& place, bool is_spoilt) {
  GeoJsonRecord record{words_of(place), nullptr, std::nullopt};
  record.fault = bulky_json(text, file, words_of(place));
  if (record.fault) return record;
  CPLJSONDocument document;
  if (is_spoilt || !document.LoadMemory(text)) {
    record.fault = syntax_fault(text, file, place);
    return record;
  }
  std::optional<GeoJsonFault> fault = fault_of_record(text);
  if (!fault) {
    record.shape = shape_of(document.GetRoot());
    if (record.shape == nullptr || record.shape->IsEmpty()) fault = geojson_fault(text, false);
  }
  if (!fault) return record;
  const std::string within = record.place + place_within(*fault);
  record.fault = DataError(DataCode::format_syntax, file, within, fault->found, fault->expected);
  return record;
}

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

GeoJsonSequence::GeoJsonSequence(const std::filesystem::path& path)
    : name_(path.string()), file_(path, std::ios::binary) {
  skip_byte_order_mark(file_);
  const std::streampos start = file_.tellg();
  FirstObject first(file_);
  spans_lines_ = first.pass(false) && first.spans_lines() && is_type_of_record(first.type());
  file_.clear();
  file_.seekg(start);
  has_separators_ = file_.peek() == kRecordSeparator;
}

/// Whether a line's end is the record's. Within a string it is one in any case: strings have no line ends.
bool GeoJsonSequence::ends_line(const JsonNesting& nesting) const {
  if (has_separators_) return false;
  return !spans_lines_ || nesting.in_string() || nesting.objects() <= 0;
}

/// The next byte, counted; kEnd at the end.
int GeoJsonSequence::take_byte() {
  if (++bytes_ % kWaitHookBytes == 0) call_wait_hook();
  const int c = file_.rdbuf()->sbumpc();
  column_ = c == '\n' ? 1 : column_ + 1;
  line_ += c == '\n' ? 1 : 0;
  return c;
}

/// REQUIRES: the byte that was taken last is the record's first one.
void GeoJsonSequence::begin_record() {
  const bool is_behind_another = has_begun_ && begin_.line == line_;
  begin_ = {line_, is_behind_another ? column_ - 1 : 1};
  has_begun_ = true;
}

/// Sets `begin_`. Blank at the end. What follows an object on its line is a record of its own if it is an object, and
/// spoils the record otherwise.
std::string GeoJsonSequence::next_text() {
  std::string text;
  JsonNesting nesting;
  bool is_begun = false;
  bool is_complete = false;
  is_spoilt_ = false;
  while (has_separators_ || !is_complete || file_.rdbuf()->sgetc() != '{') {
    const int c = take_byte();
    const bool is_end = (has_separators_ && c == kRecordSeparator) || (c == '\n' && (!is_begun || ends_line(nesting)));
    if (c == kEnd || (is_end && is_begun)) break;
    if (is_end) {
      text.clear();
      continue;
    }
    if (!is_begun && !is_blank(c)) {
      begin_record();
      is_begun = true;
    }
    text += static_cast<char>(c);
    nesting.take(static_cast<char>(c));
    is_spoilt_ = is_spoilt_ || (is_complete && !is_blank(c));
    is_complete = !is_spoilt_ && nesting.objects() == 0 && (is_complete || c == '}');
  }
  return text;
}

std::optional<GeoJsonRecord> GeoJsonSequence::next() {
  const std::string text = next_text();
  if (text.find_first_not_of(kBlanks) == std::string::npos) return std::nullopt;
  GeoJsonRecord record = record_of(text, name_, begin_, is_spoilt_);
  record.text = text;
  return record;
}

bool begins_as_sequence(const std::filesystem::path& path, bool name_says) {
  std::ifstream file(path, std::ios::binary);
  skip_byte_order_mark(file);
  FirstObject first(file);
  return first.pass(name_says) && (name_says || is_type_of_record(first.type())) && first.more_follows();
}

GeoJsonBeginning beginning_of_geojson(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  skip_byte_order_mark(file);
  GeoJsonBeginning beginning;
  MembersOfObject members;
  bool is_object = false, is_before_features = true;
  std::size_t bytes = 0;
  for (int c = file.rdbuf()->sgetc(); c != kEnd; c = file.rdbuf()->snextc()) {
    if (++bytes % kWaitHookBytes == 0) call_wait_hook();
    if (c == 0 || (!is_object && !is_blank(c) && c != '{')) break;  // no JSON object: sparse files have such bytes
    is_object = is_object || c == '{';
    members.take(static_cast<char>(c));
    is_before_features = is_before_features && !members.is_among_features();
    if (is_before_features) beginning.before_features.take(static_cast<char>(c));
    if (members.type().empty()) continue;
    if (beginning.type != members.type()) beginning.type = members.type();
    if (!(beginning.is_collection() && is_before_features)) break;
  }
  return beginning;
}

void for_each_stray_entry(const std::filesystem::path& path, const std::function<void(const DataError&)>& action) {
  std::ifstream file(path, std::ios::binary);
  skip_byte_order_mark(file);
  const std::streampos start = file.tellg();
  FirstObject first(file);
  first.pass(false);
  if (!EQUAL(first.type().c_str(), "FeatureCollection")) return;
  file.clear();
  file.seekg(start);
  MembersOfObject members;
  std::size_t number = 0;
  bool is_awaited = false;
  std::size_t bytes = 0;
  for (int c = file.rdbuf()->sgetc(); c != kEnd; c = file.rdbuf()->snextc()) {
    if (++bytes % kWaitHookBytes == 0) call_wait_hook();
    const bool is_among = members.is_among_features();
    members.take(static_cast<char>(c));
    if (is_awaited && !is_blank(c)) {
      if (c != '{' && c != ']') {
        action({DataCode::format_syntax, path.string(), "/features/" + std::to_string(number), kind_of_value(c),
                "a feature"});
      }
      ++number;
      is_awaited = false;
    }
    if (members.is_among_features() && (is_among ? c == ',' : c == '[')) is_awaited = true;
  }
}

}  // namespace exactvo::datasets
