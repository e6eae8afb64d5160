// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/geojson_sequence.h"

#include <cpl_json.h>
#include <cpl_port.h>

#include <algorithm>
#include <utility>

#include "exactvo/datasets/input_text.h"
#include "files/text_file.h"
#include "gdal/properties.h"
#include "readers/readers.h"

namespace exactvo::datasets {

namespace {

// --- What is wrong with a record ---

using Fault = std::optional<GeoJsonFault>;

/// How deep the positions of a type lie below `coordinates`; -1 of collections.
struct Type {
  const char* name;
  int depth;
};
constexpr Type kTypes[] = {{"Point", 0},   {"MultiPoint", 1},   {"LineString", 1},         {"MultiLineString", 2},
                           {"Polygon", 2}, {"MultiPolygon", 3}, {"GeometryCollection", -1}};
const char* const kTypeNames =
    "Point, MultiPoint, LineString, MultiLineString, Polygon, MultiPolygon or GeometryCollection";

/// GDAL takes names in any case.
bool is_name(const Json& value, const char* name) {
  return value.is_string() && EQUAL(value.get_ref<const std::string&>().c_str(), name);
}

const Type* type_of(const Json& geometry) {
  const auto type = geometry.find("type");
  if (type == geometry.end()) return nullptr;
  for (const Type& known : kTypes) {
    if (is_name(*type, known.name)) return &known;
  }
  return nullptr;
}

/// A height may follow; what comes after it has no meaning (RFC 7946, 3.1.1).
bool is_position(const Json& value) {
  if (!value.is_array() || value.size() < 2) return false;
  for (std::size_t k = 0; k < std::min<std::size_t>(value.size(), 3); ++k) {
    if (!value[k].is_number()) return false;
  }
  return true;
}

Fault fault_of_coordinates(const Json& value, int depth, const std::string& pointer) {
  if (depth == 0) {
    if (is_position(value)) return std::nullopt;
    return GeoJsonFault{pointer, value.dump().substr(0, 40), "a position: [x, y], numbers"};
  }
  if (!value.is_array()) {
    return GeoJsonFault{pointer, described(value), depth == 1 ? "an array of positions" : "an array of arrays"};
  }
  for (std::size_t k = 0; k < value.size(); ++k) {
    if (Fault fault = fault_of_coordinates(value[k], depth - 1, pointer + "/" + std::to_string(k))) return fault;
  }
  return std::nullopt;
}

Fault fault_of_geometry(const Json& geometry, const std::string& pointer, int depth);

Fault fault_of_collection(const Json& geometry, const std::string& pointer, int depth) {
  const auto parts = geometry.find("geometries");
  if (parts == geometry.end() || !parts->is_array()) {
    return GeoJsonFault{pointer + "/geometries", parts == geometry.end() ? "nothing" : described(*parts),
                        "an array of geometries"};
  }
  for (std::size_t k = 0; k < parts->size(); ++k) {
    const std::string place = pointer + "/geometries/" + std::to_string(k);
    if (Fault fault = fault_of_geometry((*parts)[k], place, depth + 1)) return fault;
  }
  return std::nullopt;
}

Fault fault_of_geometry(const Json& geometry, const std::string& pointer, int depth) {
  if (geometry.is_null() || depth > kDeepestCollection) return std::nullopt;
  if (!geometry.is_object()) return GeoJsonFault{pointer, described(geometry), "a geometry or null"};
  const Type* type = type_of(geometry);
  if (type == nullptr) {
    const auto word = geometry.find("type");
    return GeoJsonFault{pointer + "/type", word == geometry.end() ? "nothing" : described(*word), kTypeNames};
  }
  if (type->depth < 0) return fault_of_collection(geometry, pointer, depth);
  const auto coordinates = geometry.find("coordinates");
  if (coordinates == geometry.end()) return GeoJsonFault{pointer + "/coordinates", "nothing", "an array"};
  const bool is_empty_point = type->depth == 0 && coordinates->is_array() && coordinates->empty();
  if (is_empty_point) return std::nullopt;
  return fault_of_coordinates(*coordinates, type->depth, pointer + "/coordinates");
}

/// GDAL takes attributes in any encoding; the shape needs only ASCII.
Json parsed_as_ascii(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0x80) != 0; }, '?');
  return parse_json_if_any(text);
}

bool holds_position(const Json& geometry) {
  const Type* type = type_of(geometry);
  return type != nullptr && type->depth >= 0 && geometry.contains("coordinates") && !geometry["coordinates"].empty();
}

bool is_feature_or_geometry(const Json& json) {
  if (!json.is_object() || !json.contains("type")) return false;
  return is_name(json["type"], "Feature") || type_of(json) != nullptr;
}

Fault fault_of_feature(const Json& record) {
  if (!record.is_object()) return GeoJsonFault{"", described(record), "a feature"};
  const auto geometry = record.find("geometry");
  if (geometry != record.end()) return fault_of_geometry(*geometry, "/geometry", 0);
  const bool stands_alone = record.contains("coordinates") || record.contains("geometries") || type_of(record);
  return stands_alone ? fault_of_geometry(record, "", 0) : std::nullopt;
}

Fault fault_where_read(const Json& record, bool read) {
  const bool bare = !read && record.is_object() && !record.contains("geometry") && holds_position(record);
  return bare ? GeoJsonFault{"", "a geometry", "a feature"} : fault_of_feature(record);
}

Fault fault_in_sequence(const Json& record) {
  if (is_feature_or_geometry(record)) return fault_of_feature(record);
  const bool named = record.is_object() && record.contains("type");
  return GeoJsonFault{named ? "/type" : "", described(named ? record["type"] : record), "a feature or a geometry"};
}

// --- Sequences ---

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

GeoJsonText::GeoJsonText(std::string text) : text_(std::move(text)), json_(parse_json_if_any(text_)) {
  is_utf8_ = !json_.is_discarded();
  if (!is_utf8_) json_ = parsed_as_ascii(text_);
}

// What is quoted from a text is ASCII in any case.

std::optional<GeoJsonFault> GeoJsonText::fault(bool read) const {
  if (json_.is_discarded()) {
    if (read || text_.find("\"coordinates\"") == std::string::npos) return std::nullopt;
    return GeoJsonFault{"", "coordinates that are no JSON", "finite numbers"};
  }
  const Fault fault = fault_where_read(json_, read);
  return fault && is_utf8_ ? fault_where_read(parsed_as_ascii(text_), read) : fault;
}

std::optional<GeoJsonFault> GeoJsonText::fault_as_record() const {
  if (json_.is_discarded()) return std::nullopt;
  const Fault fault = fault_in_sequence(json_);
  return fault && is_utf8_ ? fault_in_sequence(parsed_as_ascii(text_)) : fault;
}

FeatureProperties GeoJsonText::properties() const {
  return is_utf8_ ? properties_of_geojson(json_) : FeatureProperties{};
}

bool is_type_of_record(const std::string& type) {
  return is_feature_or_geometry(Json{{"type", type}});
}

std::string place_within(const GeoJsonFault& fault) {
  return fault.pointer.empty() ? "" : ", " + fault.pointer;
}

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
