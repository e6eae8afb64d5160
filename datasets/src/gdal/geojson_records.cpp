// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/geojson_records.h"

#include <cpl_json.h>

#include <system_error>
#include <utility>

#include "exactvo/datasets/input_text.h"
#include "files/text_file.h"
#include "gdal/geojson_shape.h"
#include "gdal/json_memory.h"

namespace exactvo::datasets {
namespace {

constexpr char kRecordSeparator = '\x1e';
constexpr const char* kBlanks = " \t\r\n";

constexpr int kEnd = std::char_traits<char>::eof();

/// What begins so, in words.
std::string kind_of_value(char c) {
  if (c == '"') return "a string";
  if (c == '[') return "an array";
  if (c == 'n') return "null";
  return c == 't' || c == 'f' ? "true or false" : "a number";
}

/// Whether it is JSON, or may be but for numbers that GDAL's parser takes and JSON has not.
bool is_json(const GeoJsonText& record, const std::string& text) {
  return !record.json().is_discarded() || text.find("NaN") != std::string::npos ||
         text.find("Infinity") != std::string::npos;
}

bool is_blank(const std::string& text) {
  return text.find_first_not_of(kBlanks) == std::string::npos;
}

std::string text_at(const Json& json, const char* pointer) {
  const Json::json_pointer place(pointer);
  if (!json.is_object() || !json.contains(place)) return "";
  const Json& value = json.at(place);
  return value.is_string() ? value.get<std::string>() : value.is_number() ? value.dump() : "";
}

}  // namespace

GeoJsonRecords::GeoJsonRecords(const std::filesystem::path& path, bool is_sequence, bool name_says_sequence)
    : path_(path), name_(path.string()) {
  GeoJsonScan scan;
  scan.is_sequence = true;
  if (!is_sequence) scan = scan_geojson(path, name_says_sequence);
  if (!scan.is_sequence) {
    head_ = GeoJsonText(scan.head).json();
    const bool is_collection = EQUAL(scan.type.c_str(), "FeatureCollection");
    kind_ = is_collection ? Kind::collection : Kind::alone;
    is_geojson_ = is_collection || is_type_of_record(scan.type);
    if (is_geojson_ && (scan.is_broken || (is_collection && head_.is_discarded()))) {
      check_json_syntax(read_text_file(path), name_);
      throw DataError(DataCode::format_syntax, name_, "", "no JSON object", "GeoJSON");
    }
    if (is_collection && (!head_.contains("features") || head_["features"].is_null()))
      throw DataError(DataCode::format_syntax, name_, "/features", "nothing", "an array of features");
    if (!is_collection) text_ = std::move(scan.head);
  }
  rewind();
}

OGRSpatialReference GeoJsonRecords::reference_system() const {
  const std::string type = text_at(head_, "/crs/type");
  std::string name;
  if (EQUAL(type.c_str(), "name")) name = text_at(head_, "/crs/properties/name");
  if (EQUAL(type.c_str(), "EPSG")) name = "EPSG:" + text_at(head_, "/crs/properties/code");
  if (EQUAL(type.c_str(), "OGC")) name = text_at(head_, "/crs/properties/urn");
  if (EQUAL(type.c_str(), "link") || EQUAL(type.c_str(), "url"))
    throw DataError(DataCode::projection, name_, "/crs", "a link to a reference system",
                    "its name: no link is followed");
  const char* const without_files[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
  OGRSpatialReference system;
  if (name.empty() || system.SetFromUserInput(name.c_str(), without_files) != OGRERR_NONE)
    return *OGRSpatialReference::GetWGS84SRS();
  // x comes first in GeoJSON, whatever the system says.
  if (OGR_SRSNode* geographic = system.GetAttrNode("GEOGCS")) geographic->StripNodes("AXIS");
  return system;
}

void GeoJsonRecords::rewind() {
  file_ = std::ifstream(path_, std::ios::binary);
  skip_byte_order_mark(file_);
  line_ = column_ = 1;
  begin_line_ = 0;
  bytes_ = records_ = entries_ = 0;
  members_ = JsonMembers();
  if (kind_ != Kind::sequence) return;
  spans_lines_ = first_record_spans_lines(file_);
  has_separators_ = file_.peek() == kRecordSeparator;
}

/// What GDAL's parser does not take, in the words of ours, which says where. Throws it of a collection.
DataError GeoJsonRecords::syntax_fault(const GeoJsonRecord& record, const std::string& text) const {
  if (kind_ != Kind::sequence) check_json_syntax(read_text_file(path_), name_);
  try {
    parse_json_line(text, name_, begin_line_);
  } catch (const DataError& error) {
    return begin_column_ == 1 ? error : DataError(error.code(), name_, record.place, error.found(), error.expected());
  }
  return {DataCode::format_syntax, name_, record.place, excerpt(text, text.find_first_not_of(kBlanks)),
          "a feature or a geometry that GDAL reads"};
}

void GeoJsonRecords::fill(GeoJsonRecord& record, const std::string& text, bool is_spoilt) const {
  std::error_code error;
  const bool is_all_of_it = kind_ == Kind::sequence;
  const double size = static_cast<double>(is_all_of_it ? text.size() : std::filesystem::file_size(path_, error));
  record.fault = bulky_json(text, size, name_, record.place);
  if (record.fault && kind_ != Kind::sequence) throw *record.fault;
  if (record.fault) return;
  CPLJSONDocument document;
  record.text = GeoJsonText(text);
  const bool is_strict = kind_ != Kind::sequence;  // elsewhere a bad line leaves the others
  if (is_spoilt || !document.LoadMemory(text) || (is_strict && !is_json(record.text, text))) {
    record.fault = syntax_fault(record, text);
    return;
  }
  std::optional<GeoJsonFault> fault;
  if (kind_ == Kind::sequence) fault = record.text.fault_as_record();
  if (!fault) {
    const CPLJSONObject root = document.GetRoot(), within = root.GetObj("geometry");
    const bool is_feature = kind_ == Kind::collection || EQUAL(root.GetString("type").c_str(), "Feature");
    if (!is_feature || within.GetType() == CPLJSONObject::Type::Object)
      record.shape.reset(OGRGeometryFactory::createFromGeoJson(is_feature ? within : root));
    const bool is_read = record.shape != nullptr && !record.shape->IsEmpty();
    if (kind_ != Kind::sequence || !is_read) fault = record.text.fault(is_read);
  }
  if (fault)
    record.fault =
        DataError(DataCode::format_syntax, name_, record.place + place_within(*fault), fault->found, fault->expected);
}

/// Whether a line's end is the record's. Within a string it is one in any case: strings have no line ends.
bool GeoJsonRecords::ends_line(const JsonNesting& nesting) const {
  if (has_separators_) return false;
  return !spans_lines_ || nesting.in_string() || nesting.objects() <= 0;
}

/// The next byte, counted; kEnd at the end.
int GeoJsonRecords::take_byte() {
  if (++bytes_ % kWaitHookBytes == 0) call_wait_hook();
  const int c = file_.rdbuf()->sbumpc();
  column_ = c == '\n' ? 1 : column_ + 1;
  line_ += c == '\n' ? 1 : 0;
  return c;
}

/// REQUIRES: the byte that was taken last is the record's first one.
void GeoJsonRecords::begin_record() {
  begin_column_ = begin_line_ == line_ ? column_ - 1 : 1;
  begin_line_ = line_;
}

/// Blank at the end. What follows an object on its line is a record of its own if it is an object, and
/// spoils the record otherwise.
std::string GeoJsonRecords::next_text() {
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

/// The next entry of "features", or nothing between two commas; blank at the end.
std::string GeoJsonRecords::next_entry() {
  std::string text;
  JsonNesting nesting;
  is_spoilt_ = false;
  for (int c = take_byte(); c != kEnd; c = take_byte()) {
    const bool was_among = members_.is_among_features(), was_within = members_.is_in_features();
    members_.take(static_cast<char>(c));
    const bool is_end = was_within && (!members_.is_in_features() || (was_among && c == ','));
    if (is_end && !is_blank(text)) return text;
    if (is_end && c == ',') break;  // nothing before it
    if (!was_within || is_end) continue;
    is_spoilt_ = is_spoilt_ || (!is_blank(text) && was_among && !is_json_blank(c));
    text += static_cast<char>(c);
  }
  if (members_.is_in_features()) check_json_syntax(read_text_file(path_), name_);
  return "";
}

std::optional<GeoJsonRecord> GeoJsonRecords::next_of_collection() {
  const std::string text = next_entry();
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string::npos) return std::nullopt;
  const std::string entry = "/features/" + std::to_string(entries_++);
  GeoJsonRecord record;
  if (text[begin] != '{') {
    if (!is_json(GeoJsonText(text), text)) check_json_syntax(read_text_file(path_), name_);
    record.fault = DataError(DataCode::format_syntax, name_, entry, kind_of_value(text[begin]), "a feature");
    return record;
  }
  record.number = records_++;
  record.place = "feature " + std::to_string(record.number);
  fill(record, text, is_spoilt_);
  return record;
}

std::optional<GeoJsonRecord> GeoJsonRecords::next_of_sequence() {
  const std::string text = next_text();
  if (is_blank(text)) return std::nullopt;
  GeoJsonRecord record;
  record.number = records_++;
  record.place = "line " + std::to_string(begin_line_);
  if (begin_column_ > 1) record.place += ", column " + std::to_string(begin_column_);
  fill(record, text, is_spoilt_);
  return record;
}

std::optional<GeoJsonRecord> GeoJsonRecords::next() {
  if (kind_ == Kind::sequence) return next_of_sequence();
  if (kind_ == Kind::collection) return next_of_collection();
  if (records_++ > 0) return std::nullopt;
  GeoJsonRecord record;
  record.place = "feature 0";
  fill(record, text_, false);
  return record;
}

}  // namespace exactvo::datasets
