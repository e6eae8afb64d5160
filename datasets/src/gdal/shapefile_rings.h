// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Polygons of a Shapefile from its rings. The format winds outer rings clockwise and holes counter-clockwise (ESRI
/// Shapefile Technical Description, "Polygon"), in any order; GDAL fills the holes of a record whose rings are all
/// wound alike, so it is asked for the rings as they stand.

#include <ogr_feature.h>

#include <string>
#include <vector>

#include "exactvo/geometry/shapes.h"
#include "gdal/gdal_session.h"

namespace exactvo::datasets {

/// While it lives, GDAL gives every ring of a Shapefile of polygons as a polygon of its own, in this thread.
struct RingsAsTheyStand : ConfigOption {
  RingsAsTheyStand() : ConfigOption("OGR_ORGANIZE_POLYGONS", "SKIP") {}
};

/// Whether GDAL warns that it did not group the rings of a record, as it was asked.
bool is_of_rings_as_they_stand(const std::string& warning);

/// The outer ring first, then its holes; in the order of the outer rings. A counter-clockwise ring is a hole of the
/// smallest clockwise one round it. One that is in none is wound wrongly: it is an outer ring unless an odd number of
/// others like it are round it.
std::vector<std::vector<geometry::Ring>> polygons_of_rings(const std::vector<geometry::Ring>& rings);

/// The feature's polygons, from the rings that GDAL gave.
void group_rings(OGRFeature& feature);

}  // namespace exactvo::datasets
