// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Metres of a plane to longitude and latitude, as a function: what local_plane.h has done by GDAL.

#include <functional>
#include <string>
#include <vector>

#include "exactvo/datasets/local_plane.h"

namespace exactvo::datasets {

using PlaneTransform = std::function<std::vector<geometry::Vec2>(std::vector<geometry::Vec2>)>;

/// Throws as MetresToDegrees does. local_plane.cpp, or gdal_absent.cpp in a build without GDAL; called through
/// vector_library.h.
PlaneTransform make_plane_transform(LocalPlane plane, std::string file);

}  // namespace exactvo::datasets
