// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What is done with GDAL and SQLite, as one table of functions. With them come a hundred shared libraries, which take
/// longer to load than most questions to answer: a program either links the functions or loads them when it first needs
/// them (modules/loader.cpp), and the rest of the library calls them through this table alone.

#include <functional>
#include <string>
#include <vector>

#include "batch/formats/geopackage.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/local_plane.h"
#include "readers/readers.h"
#include "trajectories/jupedsim_sqlite.h"
#include "writers/writers.h"

namespace exactvo::datasets {

/// Metres of a plane to longitude and latitude, as a function: what local_plane.h has done by GDAL.
using PlaneTransform = std::function<std::vector<geometry::Vec2>(std::vector<geometry::Vec2>)>;

/// Throws as MetresToDegrees does. layer_plane.cpp, or gdal_absent.cpp in a build without GDAL.
PlaneTransform make_plane_transform(LocalPlane plane, std::string file);

struct VectorLibrary {
  decltype(&datasets::read_vector_file) read_vector_file;
  decltype(&datasets::read_in_system) read_in_system;
  decltype(&datasets::to_gdal_file) to_gdal_file;
  decltype(&datasets::read_gdal_image) read_gdal_image;
  decltype(&batch::make_geopackage) make_geopackage;
  decltype(&datasets::make_plane_transform) make_plane_transform;
  decltype(&datasets::read_jupedsim_sqlite_file) read_jupedsim_sqlite_file;
  decltype(&datasets::set_wait_hook) set_wait_hook;  ///< of the module's own copy of text_file.cpp
};

/// Throws DataError (E_FORMAT_UNAVAILABLE) where a program loads it and cannot.
const VectorLibrary& vector_library();

}  // namespace exactvo::datasets
