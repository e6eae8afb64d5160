// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/gdal_session.h"

#include <cpl_conv.h>

#include <mutex>
#include <string_view>
#include <system_error>
#include <utility>

#include "exactvo/datasets/input_text.h"
#include "gdal/json_memory.h"

namespace exactvo::datasets {
namespace {

const char* const kVectorDrivers[] = {
    "GeoJSON", "GeoJSONSeq", "TopoJSON", "ESRI Shapefile", "GPKG",   "FlatGeobuf", "CSV", "OSM", "DXF",
    "KML",     "GML",        "GPX",      "MapInfo File",   "SQLite", nullptr};

/// NATIVE_DATA keeps the members of a GeoJSON collection that GDAL has no place for, `units` among them.
const char* const kGeoJsonOptions[] = {"NATIVE_DATA=YES", nullptr};
/// What people call a column of WKT.
const char* const kCsvOptions[] = {"GEOM_POSSIBLE_NAMES=WKT,wkt,geometry,geom,the_geom,wkt_geom", nullptr};
const char* const kNoOptions[] = {nullptr};

/// A driver warns of options that it does not know.
const char* const* options_for(const std::string& name) {
  if (name == "CSV") return kCsvOptions;
  return name == "GeoJSON" ? kGeoJsonOptions : kNoOptions;
}

/// Of GDAL's estimate of a feature's size, measured on polygons of two digits a point.
constexpr double kBytesOfEstimated = 3.05;
constexpr const char* kSizeOption = "OGR_GEOJSON_MAX_OBJ_SIZE";  // MB
/// Properties are read from native data; as GDAL's fields they take quadratic time.
constexpr const char* kNoFieldsOption = "ATTRIBUTES_SKIP";

}  // namespace

GeoJsonParsing::GeoJsonParsing(const std::filesystem::path& path) {
  CPLSetThreadLocalConfigOption(kNoFieldsOption, "YES");
  std::error_code error;
  const auto size = static_cast<double>(std::filesystem::file_size(path, error));
  if (error) return;
  const double megabytes = parser_memory_for(size) / kBytesOfEstimated / 1e6;
  CPLSetThreadLocalConfigOption(kSizeOption, std::to_string(static_cast<long long>(megabytes)).c_str());
}

GeoJsonParsing::~GeoJsonParsing() {
  CPLSetThreadLocalConfigOption(kSizeOption, nullptr);
  CPLSetThreadLocalConfigOption(kNoFieldsOption, nullptr);
}

bool GeoJsonParsing::is_size_limit_in(const std::string& complaint) {
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

/// Words with a comma in them: what KML writes a point as, "longitude,latitude,height".
std::size_t count_of_points(std::string_view text) {
  std::size_t points = 0;
  bool has_comma = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (k % kWaitHookBytes == 0) call_wait_hook();
    const char c = text[k];
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

/// What GDAL parses whole as soon as it is opened.
void refuse_bulky(const std::filesystem::path& path, std::string_view driver) {
  if (driver == "KML") refuse_bulky_kml(path);
  if (const auto bulky = driver == "TopoJSON" ? bulky_json_file(path) : std::nullopt) throw *bulky;
}

}  // namespace

std::string vector_driver_of(const std::filesystem::path& path) {
  register_gdal_once();
  const GDALDriverH driver = GDALIdentifyDriverEx(path.c_str(), GDAL_OF_VECTOR, kVectorDrivers, nullptr);
  return driver == nullptr ? "" : GDALGetDriverShortName(driver);
}

std::unique_ptr<GDALDataset> open_vectors(const std::filesystem::path& path, const std::string& driver) {
  refuse_bulky(path, driver);
  return std::unique_ptr<GDALDataset>(
      GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, kVectorDrivers, options_for(driver), nullptr));
}

}  // namespace exactvo::datasets
