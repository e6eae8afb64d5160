// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The writers of this room: obstacles to the bytes of a file, and what of them did not go in.

#include <functional>
#include <string>
#include <vector>

#include "exactvo/datasets/obstacle_write.h"
#include "exactvo/formation/scenario.h"
#include "json/json_text.h"

namespace exactvo::datasets {

using Obstacles = std::vector<formation::SceneObstacle>;

struct Written {
  std::string bytes;
  std::vector<std::string> losses;
};

/// Adds where the plane lies, if that is known.
void add_plane_losses(const WriteOptions& options, const char* format, std::vector<std::string>& losses);
/// The same, after "3 properties (name, height, use) of 12 obstacles: WKT has no place for them", and the like of
/// feature ids.
void add_losses(const WriteOptions& options, const char* format, std::vector<std::string>& losses);

/// What is written of points: the same, or degrees.
using Placement = std::function<std::vector<geometry::Vec2>(std::vector<geometry::Vec2>)>;

/// All rings of a shape at once: where it crosses the antimeridian they lie on the same side.
std::vector<geometry::Ring> placed(std::vector<geometry::Ring> rings, const Placement& place);

/// The members "type" and "coordinates" of GeoJSON.
void append_geojson(JsonWriter& json, bool is_polygon, const std::vector<geometry::Ring>& courses);
std::string wkt_of(const geometry::Obstacle& shape);

// simulator_formats.cpp
Written to_rings_json(const Obstacles& obstacles, const WriteOptions& options, const std::string& file);
Written to_menge_xml(const Obstacles& obstacles, const WriteOptions& options, const std::string& file);
Written to_sumo_poly(const Obstacles& obstacles, const WriteOptions& options, const std::string& file);

// gdal_writer.cpp, or gdal_absent.cpp in a build without GDAL; called through vector_library.h. `driver`: GDAL's name.
Written to_gdal_file(const Obstacles& obstacles, const WriteOptions& options, const std::string& driver,
                     const std::string& file);

}  // namespace exactvo::datasets
