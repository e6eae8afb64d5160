// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The readers of this room: how each knows its own, and how it hands a file to the collector.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "readers/raw_geometry.h"

namespace exactvo::datasets {

/// What a reader may look at to know its own: the name and the first bytes.
struct FormatProbe {
  std::filesystem::path path;
  std::string extension;  ///< lower case, with its dot
  std::string beginning;  ///< the first kProbeLength bytes
};
inline constexpr std::size_t kProbeLength = 4096;

struct Reader {
  const char* name;
  std::function<bool(const FormatProbe& probe)> matches;  ///< none where nothing in a file tells
  void (*read)(const std::filesystem::path& path, Collector& out);
};

/// In order of preference: the surest marks first.
const std::vector<Reader>& readers();

/// Collections within collections, in whatever format: each level is a call.
inline constexpr int kDeepestCollection = 64;

// wkt_reader.cpp
bool looks_like_wkt(const FormatProbe& probe);
void read_wkt(const std::filesystem::path& path, Collector& out);
/// The polygon is the walkable area: its shell is a wall, its holes are solid. Nothing in the text tells it from plain
/// WKT.
void read_jupedsim_wkt(const std::filesystem::path& path, Collector& out);
/// Well-known text within another file: places and ids begin with those given.
void read_wkt_text(std::string_view text, const std::string& place, const std::string& id, Collector& out);

// moving_ai.cpp
bool looks_like_moving_ai_map(const FormatProbe& probe);
void read_moving_ai_map(const std::filesystem::path& path, Collector& out);

// ros_map.cpp
bool looks_like_ros_map(const FormatProbe& probe);
void read_ros_map(const std::filesystem::path& path, Collector& out);
/// The picture that the map names, in the map's folder or below. Throws DataError as the reader does.
std::filesystem::path picture_of_ros_map(const std::filesystem::path& map);

// hits.cpp: hits become the cells that hold them
bool looks_like_carmen_log(const FormatProbe& probe);
void read_carmen_log(const std::filesystem::path& path, Collector& out);
bool looks_like_csm_log(const FormatProbe& probe);
void read_csm_log(const std::filesystem::path& path, Collector& out);
bool looks_like_points_csv(const FormatProbe& probe);
void read_points_csv(const std::filesystem::path& path, Collector& out);

// graph_formats.cpp
void read_graphml(const std::filesystem::path& path, Collector& out);
bool looks_like_counted_rings(const FormatProbe& probe);
void read_counted_rings(const std::filesystem::path& path, Collector& out);
bool looks_like_pslg(const FormatProbe& probe);
void read_pslg(const std::filesystem::path& path, Collector& out);

// planner_formats.cpp
bool looks_like_ompl_circles(const FormatProbe& probe);
void read_ompl_circles(const std::filesystem::path& path, Collector& out);
bool looks_like_ompl_grid(const FormatProbe& probe);
void read_ompl_grid(const std::filesystem::path& path, Collector& out);
void read_opentraj_xml(const std::filesystem::path& path, Collector& out);
/// 16 corners round the disc, tan(pi/16) / (pi/16) = 1.013 times its area; closed. The disc lies inside.
geometry::Ring polygon_round(geometry::Vec2 center, double radius);

// wkb_text.cpp, within another file: places and ids begin with those given
bool is_wkb_text(std::string_view text);
/// The SRID of the geometry; 0 if it names none.
int srid_of_wkb_text(std::string_view text);
void read_wkb_text(std::string_view text, const std::string& place, const std::string& id, Collector& out);

// json_formats.cpp
bool looks_like_scenario(const FormatProbe& probe);
void read_scenario_obstacles(const std::filesystem::path& path, Collector& out);
/// In the style of the earcut test files: [shell, hole, ...].
bool looks_like_rings_json(const FormatProbe& probe);
void read_rings_json(const std::filesystem::path& path, Collector& out);

// xml_file.cpp
/// Whether `element` is the first element of the text, comments and declarations skipped.
bool first_element_is(const std::string& text, const std::string& element);

// xml_formats.cpp
void read_menge_xml(const std::filesystem::path& path, Collector& out);
bool looks_like_sumo_poly(const FormatProbe& probe);
void read_sumo_poly(const std::filesystem::path& path, Collector& out);
void read_jupedsim_xml(const std::filesystem::path& path, Collector& out);
void read_jts_xml(const std::filesystem::path& path, Collector& out);
void read_barn_world(const std::filesystem::path& path, Collector& out);

/// What `read` hands to a collector; where its first geometry names a reference system, brought to metres.
ObstacleFile read_in_its_system(const std::string& name, const std::string& format, const ReadOptions& options,
                                const ObstacleStream* stream, const std::function<void(Collector&)>& read);

/// Calls `read` with collectors that bring what they take from EPSG:`srid` to metres and hand it on to `out`: once or
/// more for a look at all of it, then once more. gdal/ewkt_reader.cpp, or gdal_absent.cpp; called through
/// vector_library.h. Throws DataError (E_PROJECTION).
void read_in_system(int srid, const std::function<void(Collector&)>& read, Collector& out);

/// Pictures of maps as brightness. PGM is read in ros_map.cpp; PNG, BMP and JPEG by GDAL.
struct GreyImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<float> brightness;     ///< 0 to 255, the mean of the colour channels, top row first
  std::vector<bool> is_transparent;  ///< empty where the picture has no alpha channel
};
/// gdal_image.cpp, or gdal_absent.cpp; called through vector_library.h. Throws DataError: E_IMAGE, or E_SIZE for more
/// pixels than kMostCells.
GreyImage read_gdal_image(const std::filesystem::path& path);

// obstacle_file.cpp; gdal_reader.cpp, or gdal_absent.cpp in a build without GDAL, called through vector_library.h
bool looks_like_vector_file(const FormatProbe& probe);
void read_vector_file(const std::filesystem::path& path, Collector& out);

}  // namespace exactvo::datasets
