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

constexpr int kEnd = std::char_traits<char>::eof();

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

GeoJsonRecord record_of(std::string text, const std::string& file, const GeoJsonPlace& place, bool is_spoilt) {
  GeoJsonRecord record{words_of(place), nullptr, std::nullopt};
  record.fault = bulky_json(text, file, words_of(place));
  if (record.fault) return record;
  CPLJSONDocument document;
  if (is_spoilt || !document.LoadMemory(text)) {
    record.fault = syntax_fault(text, file, place);
    return record;
  }
  record.text = GeoJsonText(std::move(text));
  std::optional<GeoJsonFault> fault = record.text.fault_as_record();
  if (!fault) {
    record.shape = shape_of(document.GetRoot());
    if (record.shape == nullptr || record.shape->IsEmpty()) fault = record.text.fault(false);
  }
  if (!fault) return record;
  const std::string within = record.place + place_within(*fault);
  record.fault = DataError(DataCode::format_syntax, file, within, fault->found, fault->expected);
  return record;
}

}  // namespace

GeoJsonSequence::GeoJsonSequence(const std::filesystem::path& path)
    : name_(path.string()), file_(path, std::ios::binary) {
  skip_byte_order_mark(file_);
  spans_lines_ = first_record_spans_lines(file_);
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
    if (!is_begun && !is_json_blank(c)) {
      begin_record();
      is_begun = true;
    }
    text += static_cast<char>(c);
    nesting.take(static_cast<char>(c));
    is_spoilt_ = is_spoilt_ || (is_complete && !is_json_blank(c));
    is_complete = !is_spoilt_ && nesting.objects() == 0 && (is_complete || c == '}');
  }
  return text;
}

std::optional<GeoJsonRecord> GeoJsonSequence::next() {
  const std::string text = next_text();
  if (text.find_first_not_of(kBlanks) == std::string::npos) return std::nullopt;
  return record_of(text, name_, begin_, is_spoilt_);
}

}  // namespace exactvo::datasets
