// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Obstacles to files, in metres.
///
/// Property (1): read_obstacles gives back the same shapes, bit for bit and in the same order.

#include <filesystem>
#include <string>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/formation/scenario.h"

namespace exactvo::datasets {

/// One geometry a line; rings closed. WKT holds no ids.
std::string to_wkt(const std::vector<formation::SceneObstacle>& obstacles);

/// A FeatureCollection with `"units": "m"`; ids become the property `id`.
std::string to_geojson(const std::vector<formation::SceneObstacle>& obstacles);

/// By extension: .wkt, .geojson or .json. Whole or not at all. Throws DataError: E_FORMAT_UNKNOWN for another
/// extension.
void write_obstacles(const std::filesystem::path& path, const std::vector<formation::SceneObstacle>& obstacles);

}  // namespace exactvo::datasets
