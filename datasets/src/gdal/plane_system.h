// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Reference systems of local planes, for GDAL's part of this room.

#include <ogr_spatialref.h>

#include <string>

#include "exactvo/datasets/local_plane.h"

namespace exactvo::datasets {

/// The azimuthal equidistant projection of `geographic` round `origin`.
OGRSpatialReference plane_round(const OGRSpatialReference& geographic, const ProjectionOrigin& origin);

/// On one line (WKT 2:2019); empty where it can't be told.
std::string wkt_of(const OGRSpatialReference& system);

}  // namespace exactvo::datasets
