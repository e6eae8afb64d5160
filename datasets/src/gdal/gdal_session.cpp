// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/gdal_session.h"

#include <cpl_conv.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "exactvo/datasets/input_text.h"
#include "text_file.h"

namespace exactvo::datasets {
namespace {

const char* const kDrivers[] = {
    "GeoJSON", "GeoJSONSeq", "TopoJSON", "ESRI Shapefile", "GPKG",   "FlatGeobuf", "CSV", "OSM", "DXF",
    "KML",     "GML",        "GPX",      "MapInfo File",   "SQLite", nullptr};

/// NATIVE_DATA keeps the members of a GeoJSON collection that GDAL has no place for, `units` among them.
const char* const kGeoJsonOptions[] = {"NATIVE_DATA=YES", nullptr};
/// What people call a column of WKT.
const char* const kCsvOptions[] = {"GEOM_POSSIBLE_NAMES=WKT,wkt,geometry,geom,the_geom,wkt_geom", nullptr};
const char* const kNoOptions[] = {nullptr};

/// A driver warns of options that it does not know.
const char* const* options_for(GDALDriverH driver) {
  const std::string name = driver == nullptr ? "" : GDALGetDriverShortName(driver);
  if (name == "CSV") return kCsvOptions;
  return name == "GeoJSON" ? kGeoJsonOptions : kNoOptions;
}

double parser_memory_for(double input_bytes) {
  constexpr double kOfProcess = 60e6;  // libraries and the text itself
  return 20.0 * input_bytes + 200e6 - kOfProcess;
}

/// Measured with json-c 0.16: a list of two numbers takes 305 bytes.
constexpr double kBytesOfList = 305.0;
/// Of GDAL's estimate of a feature's size, measured on polygons of two digits a point.
constexpr double kBytesOfEstimated = 3.05;
constexpr const char* kSizeOption = "OGR_GEOJSON_MAX_OBJ_SIZE";  // MB

}  // namespace

std::optional<DataError> bulky_json(std::string_view text, const std::string& file, const std::string& place) {
  const auto lists = static_cast<double>(std::count(text.begin(), text.end(), '['));
  if (kBytesOfList * lists <= parser_memory_for(static_cast<double>(text.size()))) return std::nullopt;
  return DataError(DataCode::size, file, place,
                   std::to_string(static_cast<long long>(lists)) + " lists in one JSON text",
                   "fewer at a time: features of their own, a line each, or another format");
}

GeoJsonSizeLimit::GeoJsonSizeLimit(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = static_cast<double>(std::filesystem::file_size(path, error));
  if (error) return;
  const double megabytes = parser_memory_for(size) / kBytesOfEstimated / 1e6;
  CPLSetThreadLocalConfigOption(kSizeOption, std::to_string(static_cast<long long>(megabytes)).c_str());
}

GeoJsonSizeLimit::~GeoJsonSizeLimit() {
  CPLSetThreadLocalConfigOption(kSizeOption, nullptr);
}

bool GeoJsonSizeLimit::is_said_in(const std::string& complaint) {
  return complaint.find("too complex/large") != std::string::npos;
}

void register_gdal_once() {
  static std::once_flag done;
  std::call_once(done, [] { GDALAllRegister(); });
}

GdalComplaints::GdalComplaints() {
  CPLPushErrorHandlerEx(&GdalComplaints::hear, this);
}

GdalComplaints::~GdalComplaints() {
  CPLPopErrorHandler();
}

void CPL_STDCALL GdalComplaints::hear(CPLErr severity, CPLErrorNum, const char* words) {
  auto& self = *static_cast<GdalComplaints*>(CPLGetErrorHandlerUserData());
  if (severity == CE_Failure) {
    std::string& first = std::string_view(words).rfind("Invalid ", 0) == 0 ? self.malformed_ : self.failure_;
    if (first.empty()) first = words;
  }
  if (severity == CE_Warning) self.warnings_.emplace_back(words);
}

std::string GdalComplaints::take_failure() {
  const std::string malformed = take_malformed();
  const std::string failure = std::exchange(failure_, {});
  return failure.empty() ? malformed : failure;
}

std::string GdalComplaints::take_malformed() {
  return std::exchange(malformed_, {});
}

std::vector<std::string> GdalComplaints::take_warnings() {
  return std::exchange(warnings_, {});
}

namespace {

constexpr std::size_t kBeginning = 4096;

/// Words with a comma in them: what KML writes a point as, "longitude,latitude,height".
std::size_t count_of_points(std::string_view text) {
  std::size_t points = 0;
  bool has_comma = false;
  for (const char c : text) {
    const bool is_blank = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    points += is_blank && has_comma ? 1 : 0;
    has_comma = !is_blank && (has_comma || c == ',');
  }
  return points;
}

void refuse_bulky_kml(const std::filesystem::path& path) {
  constexpr double kBytesOfPoint = 180.0;  // measured, of the whole reading
  const std::string text = read_text_file(path);
  const std::size_t points = count_of_points(text);
  if (kBytesOfPoint * static_cast<double>(points) <= parser_memory_for(static_cast<double>(text.size()))) return;
  throw DataError(DataCode::size, path.string(), "", std::to_string(points) + " points of so few characters",
                  "fewer points in a file, or another format, such as WKT");
}

/// What GDAL parses as soon as it is opened: all of TopoJSON or of a single feature or geometry, and every line of a
/// sequence.
void refuse_bulky(const std::filesystem::path& path, std::string_view driver) {
  // Of a collection GeoJSON's driver takes one feature after the other, and minds its own limit.
  const bool is_whole =
      driver == "TopoJSON" ||
      (driver == "GeoJSON" && read_beginning(path, kBeginning).find("\"features\"") == std::string::npos);
  if (is_whole) {
    if (const auto bulky = bulky_json(read_text_file(path), path.string(), "")) throw *bulky;
  }
  if (driver == "KML") refuse_bulky_kml(path);
  if (driver != "GeoJSONSeq") return;
  std::ifstream file(path, std::ios::binary);
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number)
    if (const auto bulky = bulky_json(line, path.string(), "line " + std::to_string(number))) throw *bulky;
}

}  // namespace

std::unique_ptr<GDALDataset> open_vectors(const std::filesystem::path& path) {
  register_gdal_once();
  const GDALDriverH driver = GDALIdentifyDriverEx(path.c_str(), GDAL_OF_VECTOR, kDrivers, nullptr);
  refuse_bulky(path, driver == nullptr ? "" : GDALGetDriverShortName(driver));
  return std::unique_ptr<GDALDataset>(
      GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, kDrivers, options_for(driver), nullptr));
}

}  // namespace exactvo::datasets
