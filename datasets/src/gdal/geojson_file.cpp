// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/geojson_file.h"

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>

#include "exactvo/datasets/input_text.h"
#include "files/file_names.h"
#include "files/text_file.h"
#include "gdal/gdal_session.h"

namespace exactvo::datasets {
namespace {

constexpr int kEnd = std::char_traits<char>::eof();
constexpr char kRecordSeparator = '\x1e';
constexpr const char* kBlanks = " \t\r\n";

bool is_json_blank(int c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// The bytes of a file, made such that a parser of JSON takes them.
class LenientJson : public std::streambuf {
 public:
  explicit LenientJson(const std::filesystem::path& path) : file_(path, std::ios::binary) {}

 private:
  int_type underflow() override {
    constexpr std::size_t kLongestWord = 9;
    do {
      call_wait_hook();
      const std::size_t kept = in_.size();
      in_.resize(kept + kWaitHookBytes);
      file_.read(in_.data() + kept, static_cast<std::streamsize>(kWaitHookBytes));
      in_.resize(kept + static_cast<std::size_t>(file_.gcount()));
      const std::size_t end = file_ ? in_.size() - kLongestWord : in_.size();
      out_.clear();
      std::size_t at = 0;
      while (at < end) {
        const std::size_t plain = plain_from(at, end);
        out_.append(in_, at, plain);
        at += plain;
        is_escaped_ = is_escaped_ && plain == 0;
        if (at < end) at += take(at);
      }
      in_.erase(0, at);
    } while (out_.empty() && file_);
    setg(out_.data(), out_.data(), out_.data() + out_.size());
    return out_.empty() ? traits_type::eof() : traits_type::to_int_type(out_.front());
  }

  /// How many bytes from there on are to be read as they stand, whatever is around them.
  std::size_t plain_from(std::size_t at, std::size_t end) const {
    const auto is_plain = [](char c) { return c >= ' ' && c != '"' && c != '\\' && c != '-' && c != 'N' && c != 'I'; };
    std::size_t k = at;
    while (k < end && is_plain(in_[k])) ++k;
    return k - at;
  }

  /// Appends what the parser is to read; the number of bytes that it stands for.
  std::size_t take(std::size_t at) {
    const char c = in_[at];
    if (!in_string_ && (c == 'N' || c == 'I' || c == '-'))
      for (const std::string_view word : {"NaN", "Infinity", "-Infinity"})
        if (in_.compare(at, word.size(), word) == 0) return out_ += "null", word.size();
    if (c == '\0' || static_cast<unsigned char>(c) >= 0x80) {
      auto next = in_.cbegin() + static_cast<std::ptrdiff_t>(at);
      const auto begin = next;
      if (c != '\0' &&
          boost::locale::utf::is_valid_codepoint(boost::locale::utf::utf_traits<char>::decode(next, in_.cend()))) {
        out_.append(begin, next);
        return static_cast<std::size_t>(next - begin);
      }
      out_ += '?';
      return 1;
    }
    if (c == '\n' || (c == '"' && !is_escaped_)) in_string_ = c == '"' && !in_string_;  // no string has a line end
    is_escaped_ = in_string_ && c == '\\' && !is_escaped_;
    if (in_string_ && c < ' ') {
      char escaped[8];
      std::snprintf(escaped, sizeof escaped, "\\u%04x", static_cast<unsigned>(c));
      out_ += escaped;
    } else {
      out_ += c;
    }
    return 1;
  }

  std::ifstream file_;
  std::string in_, out_;
  bool in_string_ = false, is_escaped_ = false;
};

/// Bytes that a file's records may take, each by itself.
double memory_for(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  return parser_memory_for(error ? 0.0 : static_cast<double>(size));
}

DataError too_large(const std::string& file, const std::string& place) {
  return {DataCode::size, file, place, "a feature or member of more JSON than is read at a time",
          "fewer points in a feature, or another format, such as WKT"};
}

DataError error_of(const GeoJsonFault& fault, const std::string& file, const std::string& record) {
  const std::string comma = record.empty() || fault.pointer.empty() ? "" : ", ";
  return {DataCode::format_syntax, file, record + comma + fault.pointer, fault.found, fault.expected};
}

/// What is wrong with a whole file, in the words of the strict parser, which says where.
[[noreturn]] void refuse_whole(const std::filesystem::path& path, JsonEnd end) {
  if (end == JsonEnd::too_large) throw too_large(path.string(), "");
  if (end == JsonEnd::too_deep)
    throw DataError(DataCode::nesting, path.string(), "", "more than 100 levels of nesting",
                    "a file that nests less deeply");
  check_json_syntax(read_text_file(path), path.string());
  throw DataError(DataCode::json_syntax, path.string(), "", "zero bytes", "a text in JSON");
}

// --- Sequences ---

class Sequence {
 public:
  /// `begins_with_record`: the first one is whole.
  Sequence(const std::filesystem::path& path, bool begins_with_record)
      : name_(path.string()), bytes_(path), spans_lines_(begins_with_record && first_spans_lines(path)) {
    constexpr int kByteOrderMark[] = {0xef, 0xbb, 0xbf};
    for (const int c : kByteOrderMark)
      if (bytes_.sgetc() == c) bytes_.sbumpc();
    has_separators_ = bytes_.sgetc() == kRecordSeparator;
  }

  /// Memory is that of one record.
  void for_each(const TakeRecord& take) {
    for (std::size_t number = 0;; ++number) {
      const std::string text = next_text();
      if (text.find_first_not_of(kBlanks) == std::string::npos) return;
      take_record(number, text, take);
    }
  }

 private:
  static bool first_spans_lines(const std::filesystem::path& path) {
    LenientJson bytes(path);
    JsonNesting nesting;
    bool is_begun = false;
    for (int c = bytes.sgetc(); c != kEnd && (c != '\n' || !is_begun); c = bytes.snextc()) {
      nesting.take(static_cast<char>(c));
      if (c == '}' && nesting.objects() == 0 && !nesting.in_string()) return false;
      is_begun = is_begun || c == '{';
    }
    return true;
  }

  /// Whether a line's end is the record's. Within a string it is one in any case: strings have no line ends.
  bool ends_line(const JsonNesting& nesting) const {
    return !has_separators_ && (!spans_lines_ || nesting.in_string() || nesting.objects() <= 0);
  }

  /// The next byte, counted; kEnd at the end.
  int take_byte() {
    const int c = bytes_.sbumpc();
    column_ = c == '\n' ? 1 : column_ + 1;
    line_ += c == '\n' ? 1 : 0;
    return c;
  }

  /// Sets where it begins. Blank at the end. What follows an object on its line is a record of its own if it is an
  /// object, and spoils the record otherwise.
  std::string next_text() {
    std::string text;
    JsonNesting nesting;
    bool is_begun = false, is_complete = false;
    is_spoilt_ = false;
    while (has_separators_ || !is_complete || bytes_.sgetc() != '{') {
      const int c = take_byte();
      const bool is_end =
          (has_separators_ && c == kRecordSeparator) || (c == '\n' && (!is_begun || ends_line(nesting)));
      if (c == kEnd || (is_end && is_begun)) break;
      if (is_end) {
        text.clear();
        continue;
      }
      if (!is_begun && !is_json_blank(c)) {
        const bool is_behind_another = begin_line_ == line_;
        begin_column_ = is_behind_another ? column_ - 1 : 1;
        begin_line_ = line_;
        is_begun = true;
      }
      text += static_cast<char>(c);
      nesting.take(static_cast<char>(c));
      is_spoilt_ = is_spoilt_ || (is_complete && !is_json_blank(c));
      is_complete = !is_spoilt_ && nesting.objects() == 0 && (is_complete || c == '}');
    }
    return text;
  }

  void take_record(std::size_t number, const std::string& text, const TakeRecord& take) {
    std::stringbuf bytes(text, std::ios::in);
    const ReadJson read = read_json(bytes, parser_memory_for(static_cast<double>(text.size())));
    const std::string line = "line " + std::to_string(begin_line_);
    GeoJsonRecord record{number, begin_column_ > 1 ? line + ", column " + std::to_string(begin_column_) : line,
                         read.value};
    if (read.end == JsonEnd::too_large) {
      record.fault = too_large(name_, record.place);
    } else if (is_spoilt_ || read.end != JsonEnd::whole) {
      record.fault = syntax_fault(text, record.place);
    } else if (const auto fault = fault_of_record(read.value)) {
      record.fault = error_of(*fault, name_, record.place);
    }
    take(record);
  }

  /// In the words of the strict parser, which says where.
  DataError syntax_fault(const std::string& text, const std::string& place) const {
    try {
      parse_json_line(text, name_, begin_line_);
    } catch (const DataError& error) {
      return begin_column_ == 1 ? error : DataError(error.code(), name_, place, error.found(), error.expected());
    }
    return {DataCode::format_syntax, name_, place, excerpt(text, text.find_first_not_of(kBlanks)),
            "a feature or a geometry"};
  }

  std::string name_;
  LenientJson bytes_;
  bool has_separators_ = false;        ///< RS before each record
  bool spans_lines_ = false;           ///< the first one does: then only the end of an object ends a record
  std::size_t line_ = 1, column_ = 1;  ///< of the next byte
  std::size_t begin_line_ = 0,
              begin_column_ = 1;  ///< of the record that was read last; beyond column 1 only behind another
  bool is_spoilt_ = false;        ///< more than white space follows its object
};

}  // namespace

bool is_sequence_name(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  const char* const known[] = {".geojsonl", ".geojsons", ".geojsonseq", ".ndjson"};
  return std::find(std::begin(known), std::end(known), extension) != std::end(known);
}

GeoJsonFile::GeoJsonFile(const std::filesystem::path& path) : path_(path) {
  LenientJson bytes(path);
  if (bytes.sgetc() == kRecordSeparator) return;
  DegreeBox box;
  const Visitor box_taker = taker_of_rings(box);
  const auto add = [&](const Json& entry) {
    const Json* geometry = fault_of_entry(entry) ? nullptr : geometry_of(entry);
    if (geometry) visit(*geometry, box_taker);
  };
  ReadJson first = read_json(bytes, memory_for(path), {"features", add});
  const bool is_whole = first.end == JsonEnd::whole, is_collection = is_feature_collection(first.value);
  const bool more_follows = first.end == JsonEnd::more_follows;
  begins_with_record_ = (is_whole || more_follows) && is_feature_or_geometry(first.value);
  if (is_sequence_name(path) ? !is_whole || !is_collection : more_follows && begins_with_record_) return;
  if (!is_whole) refuse_whole(path, first.end);
  if (const auto fault = fault_of_file(first.value)) throw error_of(*fault, path.string(), "");
  members_ = std::move(first.value);
  layout_ = is_collection ? Layout::collection : Layout::one_record;
  if (is_collection) box_ = box;
}

void GeoJsonFile::for_each(const TakeRecord& take) const {
  if (layout_ == Layout::sequence) return Sequence(path_, begins_with_record_).for_each(take);
  if (layout_ == Layout::one_record) return take_feature(0, members_, fault_of_record(members_), take);
  LenientJson bytes(path_);
  std::size_t number = 0;
  const auto take_entry = [&](const Json& entry) { take_feature(number++, entry, fault_of_entry(entry), take); };
  const JsonEnd end = read_json(bytes, memory_for(path_), {"features", take_entry}).end;
  if (end != JsonEnd::whole) refuse_whole(path_, end);
}

void GeoJsonFile::take_feature(std::size_t number, const Json& json, const std::optional<GeoJsonFault>& fault,
                               const TakeRecord& take) const {
  GeoJsonRecord record{number, (json.is_object() ? "feature " : "/features/") + std::to_string(number), json};
  if (fault) record.fault = error_of(*fault, path_.string(), record.place);
  take(record);
}

}  // namespace exactvo::datasets
