// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/obstacle_file.h"

#include <algorithm>
#include <array>
#include <boost/algorithm/string/join.hpp>
#include <new>

#include "exactvo/geometry/names.h"
#include "exactvo/geometry/require.h"
#include "files/file_names.h"
#include "files/text_file.h"
#include "gdal/vector_library.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

constexpr std::array<const char*, 19> kVectorExtensions{
    ".geojson", ".json", ".shp", ".dbf", ".gpkg",     ".fgb",      ".csv",      ".osm",        ".pbf",   ".dxf",
    ".kml",     ".gml",  ".gpx", ".tab", ".topojson", ".geojsonl", ".geojsons", ".geojsonseq", ".ndjson"};

constexpr geometry::Names<Units, 3> kUnits{
    {{Units::automatic, "automatic"}, {Units::metres, "metres"}, {Units::degrees, "degrees"}}};

constexpr geometry::Names<UnknownCells, 2> kUnknownCells{
    {{UnknownCells::free, "free"}, {UnknownCells::blocked, "blocked"}}};

/// XML, by its first element, and where that is not enough what stands near it.
auto xml_of(const char* element, const char* besides = "") {
  return [=](const FormatProbe& probe) {
    return first_element_is(probe.beginning, element) && probe.beginning.find(besides) != std::string::npos;
  };
}

std::string all_names() {
  return boost::join(readable_formats(), ", ");
}

const Reader& reader_named(const std::string& name, const std::filesystem::path& path) {
  for (const Reader& reader : readers()) {
    if (name == reader.name) return reader;
  }
  throw DataError(DataCode::not_an_option, path.string(), "format", "\"" + name + "\"", "one of " + all_names());
}

/// What would help with a file that no reader takes by itself.
std::string hint_for(const FormatProbe& probe) {
  for (const char* image : {".pgm", ".png", ".pnm", ".bmp", ".tif"})
    if (probe.extension == image)
      return "; of a ROS map give the .yaml that names its image; for another picture write one: image, resolution (m "
             "a "
             "pixel), origin";
  if (probe.extension == ".svg") return "; of a drawing, its shapes in metres as WKT, GeoJSON or DXF";
  if (probe.extension == ".scen") return "; tasks of Moving AI are for exactvo route MAP --queries";
  return "; if its format is one of these, name it with --format (convert: --from; check, monitor: --map-format): " +
         all_names();
}

const Reader& reader_for(const std::filesystem::path& path) {
  const FormatProbe probe{path, lower_extension(path), read_beginning(path, kProbeLength)};
  for (const Reader& reader : readers()) {
    if (reader.matches && reader.matches(probe)) return reader;
  }
  throw DataError(DataCode::format_unknown, path.string(), "", excerpt(probe.beginning, 0),
                  "a file of obstacles" + hint_for(probe));
}

/// Missing and unreadable files are named before any reader is asked; an empty one holds nothing in any format.
void refuse_nothing(const std::filesystem::path& path, const ReadOptions& options) {
  if (!read_beginning(path, 1).empty()) return;
  const DataCode code = options.format.empty() ? DataCode::format_unknown : DataCode::format_syntax;
  throw DataError(code, path.string(), "", "an empty file", "a file of obstacles");
}

/// `name` is what messages call the file.
ObstacleFile read_regular(const std::filesystem::path& path, const std::string& name, const ReadOptions& options,
                          const ObstacleStream* stream) {
  try {
    refuse_nothing(path, options);
    const Reader& reader = options.format.empty() ? reader_for(path) : reader_named(options.format, path);
    return read_in_its_system(name, reader.name, options, stream, [&](Collector& out) { reader.read(path, out); });
  } catch (const DataError& error) {
    if (error.file() != path.string() || name == path.string()) throw;
    throw DataError(error.code(), name, error.place(), error.found(), error.expected());
  } catch (const std::bad_alloc&) {
    throw DataError(DataCode::size, name, "", "more than fits into memory", "a smaller file, or a machine with more");
  }
}

ObstacleFile read_into(const std::filesystem::path& path, const ReadOptions& options, const ObstacleStream* stream) {
  if (!is_pipe(path)) return read_regular(path, path.string(), options, stream);
  const CopyOfInput copy(path.string());  // readers look at a file more than once
  return read_regular(copy.path(), path.string(), options, stream);
}

}  // namespace

const char* name(Units units) {
  return geometry::name_in(kUnits, units);
}

bool parse(const std::string& text, Units& out) {
  return geometry::parse_in(kUnits, text, out);
}

std::vector<std::string> unit_names() {
  return geometry::words_in(kUnits);
}

const char* name(UnknownCells unknown) {
  return geometry::name_in(kUnknownCells, unknown);
}

bool parse(const std::string& text, UnknownCells& out) {
  return geometry::parse_in(kUnknownCells, text, out);
}

std::vector<std::string> unknown_cells_names() {
  return geometry::words_in(kUnknownCells);
}

ObstacleFile read_in_its_system(const std::string& name, const std::string& format, const ReadOptions& options,
                                const ObstacleStream* stream, const std::function<void(Collector&)>& read) {
  Collector out(name, format, options, stream);
  try {
    read(out);
    return out.take();
  } catch (const ReferenceSystemMet& met) {
    Collector placed(name, format, options, stream);
    vector_library().read_in_system(met.srid, read, placed);
    return placed.take();
  }
}

bool may_be_another_format(const std::filesystem::path& path) {
  const FormatProbe probe{path, lower_extension(path), read_beginning(path, kProbeLength)};
  const std::string name = reader_for(path).name;
  if (name == "gdal") return probe.extension == ".json" || probe.extension == ".csv";
  constexpr std::array<const char*, 5> kLikely{"movingai-map", "counted-rings", "pslg", "ompl-circles", "points-csv"};
  return std::find(kLikely.begin(), kLikely.end(), name) != kLikely.end();
}

const std::vector<Reader>& readers() {
  static const std::vector<Reader> kReaders{
      {"wkt", looks_like_wkt, read_wkt},
      {"jupedsim-wkt", nullptr, read_jupedsim_wkt},
      {"movingai-map", looks_like_moving_ai_map, read_moving_ai_map},
      {"ros-map", looks_like_ros_map, read_ros_map},
      {"csm-log", looks_like_csm_log, read_csm_log},
      {"carmen-log", looks_like_carmen_log, read_carmen_log},
      {"menge-xml", xml_of("Experiment"), read_menge_xml},
      {"sumo-poly", looks_like_sumo_poly, read_sumo_poly},
      {"jupedsim-xml", xml_of("geometry"), read_jupedsim_xml},
      {"barn-world", xml_of("sdf", "<world"), read_barn_world},
      {"jts-xml", xml_of("run"), read_jts_xml},
      {"opentraj-xml", xml_of("Trial", "<obstacles"), read_opentraj_xml},
      {"graphml", xml_of("graphml"), read_graphml},
      {"counted-rings", looks_like_counted_rings, read_counted_rings},
      {"pslg", looks_like_pslg, read_pslg},
      {"ompl-circles", looks_like_ompl_circles, read_ompl_circles},
      {"ompl-grid", looks_like_ompl_grid, read_ompl_grid},
      {"scenario", looks_like_scenario, read_scenario_obstacles},
      {"rings-json", looks_like_rings_json, read_rings_json},
      {"points-csv", looks_like_points_csv, read_points_csv},
      {"gdal", looks_like_vector_file,
       [](const std::filesystem::path& path, Collector& out) { vector_library().read_vector_file(path, out); }},
  };
  return kReaders;
}

// By name alone, so that a build without GDAL can say what it lacks.
bool looks_like_vector_file(const FormatProbe& probe) {
  return std::find(kVectorExtensions.begin(), kVectorExtensions.end(), probe.extension) != kVectorExtensions.end();
}

ObstacleFile read_obstacles(const std::filesystem::path& path, const ReadOptions& options) {
  return read_into(path, options, nullptr);
}

ObstacleFile read_obstacles(const std::filesystem::path& path, const ReadOptions& options,
                            const ObstacleStream& stream) {
  EXACTVO_REQUIRE(stream.obstacle && stream.rejected, path.string());
  return read_into(path, options, &stream);
}

std::string format_of(const std::filesystem::path& path) {
  return reader_for(path).name;
}

std::vector<std::string> readable_formats() {
  std::vector<std::string> names;
  for (const Reader& reader : readers()) names.emplace_back(reader.name);
  return names;
}

}  // namespace exactvo::datasets
