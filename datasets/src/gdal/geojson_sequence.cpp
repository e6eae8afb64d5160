// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/geojson_sequence.h"

#include <cpl_json.h>

#include <algorithm>

#include "gdal/geojson_shape.h"
#include "text_file.h"

namespace exactvo::datasets {
namespace {

constexpr char kRecordSeparator = '\x1e';
constexpr const char* kBlanks = " \t\r\n";
constexpr const char* kByteOrderMark = "\xef\xbb\xbf";

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// What GDAL's parser does not take, in the words of ours, which says where.
DataError syntax_fault(const std::string& text, const std::string& file, std::size_t line) {
  try {
    parse_json_line(text, file, line);
  } catch (const DataError& error) {
    return error;
  }
  return {DataCode::format_syntax, file, "line " + std::to_string(line), excerpt(text, text.find_first_not_of(kBlanks)),
          "a feature or a geometry that GDAL reads"};
}

std::unique_ptr<OGRGeometry> shape_of(const CPLJSONObject& record) {
  const CPLJSONObject within = record.GetObj("geometry");
  const bool is_feature = EQUAL(record.GetString("type").c_str(), "Feature");
  if (is_feature && within.GetType() != CPLJSONObject::Type::Object) return nullptr;
  return std::unique_ptr<OGRGeometry>(OGRGeometryFactory::createFromGeoJson(is_feature ? within : record));
}

GeoJsonRecord record_of(const std::string& text, const std::string& file, std::size_t line) {
  GeoJsonRecord record{"line " + std::to_string(line), nullptr, std::nullopt};
  CPLJSONDocument document;
  if (!document.LoadMemory(text)) {
    record.fault = syntax_fault(text, file, line);
    return record;
  }
  std::optional<GeoJsonFault> fault = fault_of_record(text);
  if (!fault) {
    record.shape = shape_of(document.GetRoot());
    if (record.shape == nullptr || record.shape->IsEmpty()) fault = geojson_fault(text, false);
  }
  if (!fault) return record;
  const std::string place = record.place + place_within(*fault);
  record.fault = DataError(DataCode::format_syntax, file, place, fault->found, fault->expected);
  return record;
}

}  // namespace

GeoJsonSequence::GeoJsonSequence(const std::filesystem::path& path)
    : name_(path.string()), file_(path, std::ios::binary) {
  if (file_.peek() == kRecordSeparator) separator_ = kRecordSeparator;
}

std::optional<GeoJsonRecord> GeoJsonSequence::next() {
  for (std::string text; std::getline(file_, text, separator_);) {
    if (lines_ == 0 && text.rfind(kByteOrderMark, 0) == 0) text.erase(0, 3);
    const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
    const std::size_t line = lines_ + 1 + lines_in(text.substr(0, begin));
    lines_ += lines_in(text) + (separator_ == '\n' ? 1 : 0);
    if (begin < text.size()) return record_of(text, name_, line);
  }
  return std::nullopt;
}

bool begins_as_sequence(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string first;
  while (std::getline(file, first) && first.find_first_not_of(kBlanks) == std::string::npos) continue;
  const bool more_follows = static_cast<bool>(file >> std::ws) && file.peek() != std::ifstream::traits_type::eof();
  return more_follows && is_record(first);
}

}  // namespace exactvo::datasets
