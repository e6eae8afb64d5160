// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The writers of this room: obstacles to the bytes of a file, and what of them did not go in.

#include <string>
#include <vector>

#include "exactvo/datasets/obstacle_write.h"
#include "exactvo/formation/scenario.h"

namespace exactvo::datasets {

using Obstacles = std::vector<formation::SceneObstacle>;

struct Written {
  std::string bytes;
  std::vector<std::string> losses;
};

/// "3 properties (name, height, use) of 12 obstacles: WKT has no place for them", and the like of feature ids.
std::vector<std::string> property_losses(const WriteOptions& options, const char* format);
/// Where the plane lies, if that is known.
std::vector<std::string> plane_losses(const WriteOptions& options, const char* format);
/// All of these.
std::vector<std::string> losses_beside_shapes(const WriteOptions& options, const char* format);

geometry::Ring closed(geometry::Ring ring);

/// The outer ring, then the holes, each closed.
std::vector<geometry::Ring> closed_rings_of(const geometry::Polygon& polygon);
std::string wkt_of(const geometry::Obstacle& shape);

// simulator_formats.cpp
Written to_rings_json(const Obstacles& obstacles, const WriteOptions& options, const std::string& file);
Written to_menge_xml(const Obstacles& obstacles, const WriteOptions& options, const std::string& file);
Written to_sumo_poly(const Obstacles& obstacles, const WriteOptions& options, const std::string& file);

// gdal_writer.cpp, or gdal_absent.cpp in a build without GDAL; called through vector_library.h. `driver`: GDAL's name.
Written to_gdal_file(const Obstacles& obstacles, const WriteOptions& options, const std::string& driver,
                     const std::string& file);

}  // namespace exactvo::datasets
