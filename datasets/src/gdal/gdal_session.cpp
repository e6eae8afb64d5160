// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/gdal_session.h"

#include <cmath>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string_view>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_text.h"

namespace exactvo::datasets {
namespace {

const char* const kVectorDrivers[] = {
    "GeoJSON", "GeoJSONSeq", "TopoJSON", "ESRI Shapefile", "GPKG",   "FlatGeobuf", "CSV", "OSM", "DXF",
    "KML",     "GML",        "GPX",      "MapInfo File",   "SQLite", nullptr};

/// What people call a column of WKT.
const char* const kCsvOptions[] = {"GEOM_POSSIBLE_NAMES=WKT,wkt,geometry,geom,the_geom,wkt_geom", nullptr};
const char* const kNoOptions[] = {nullptr};

}  // namespace

double parser_memory_for(double input_bytes) {
  constexpr double kOfProcess = 60e6;  // libraries
  return 20.0 * input_bytes + 200e6 - kOfProcess;
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
  if (severity == CE_Failure && self.failure_.empty()) self.failure_ = words;
  if (severity == CE_Warning) self.warnings_.emplace_back(words);
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

/// What json-c, GDAL's parser, makes of a text, in bytes: measured with json-c 0.16 and GDAL 3.6 as the growth of the
/// program's peak with 100,000 equal tokens. Peaks jump where tables double.
class JsonMemory : public nlohmann::detail::json_sax_acceptor<nlohmann::json> {
 public:
  bool start_object(std::size_t) { return add(850.0); }  // its table has 16 places from the beginning
  bool start_array(std::size_t) { return add(170.0); }
  bool key(string_t&) { return add(200.0); }
  bool string(string_t&) { return add(250.0); }
  bool number_float(double, const string_t&) { return add(120.0); }  // its digits are kept too
  bool number_integer(std::int64_t) { return add(75.0); }
  bool number_unsigned(std::uint64_t) { return add(75.0); }
  bool boolean(bool) { return add(75.0); }
  bool null() { return add(75.0); }

  /// And of the copies of the text itself.
  double with_text(double characters) const { return bytes_ + 4.0 * characters; }

 private:
  bool add(double bytes) {
    if (++count_ % kBetweenCalls == 0) call_wait_hook();
    bytes_ += bytes;
    return true;
  }
  static constexpr std::size_t kBetweenCalls = 1 << 13;
  std::size_t count_ = 0;
  double bytes_ = 0.0;
};

void refuse_bulky_topojson(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  JsonMemory memory;
  nlohmann::json::sax_parse(file, &memory);  // what is malformed is for GDAL to refuse
  const auto size = static_cast<double>(std::filesystem::file_size(path));
  if (memory.with_text(size) <= parser_memory_for(size)) return;
  throw DataError(DataCode::size, path.string(), "",
                  "JSON whose parsing takes about " + std::to_string(std::llround(memory.with_text(size) / 1e6)) +
                      " MB, estimated from its objects, lists and values",
                  "another format, such as GeoJSON");
}

}  // namespace

std::string vector_driver_of(const std::filesystem::path& path) {
  register_gdal_once();
  const GDALDriverH driver = GDALIdentifyDriverEx(path.c_str(), GDAL_OF_VECTOR, kVectorDrivers, nullptr);
  return driver == nullptr ? "" : GDALGetDriverShortName(driver);
}

std::unique_ptr<GDALDataset> open_vectors(const std::filesystem::path& path, const std::string& driver) {
  // These GDAL parses whole as soon as they are opened.
  if (driver == "KML") refuse_bulky_kml(path);
  if (driver == "TopoJSON") refuse_bulky_topojson(path);
  return std::unique_ptr<GDALDataset>(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, kVectorDrivers,
                                                        driver == "CSV" ? kCsvOptions : kNoOptions, nullptr));
}

}  // namespace exactvo::datasets
