// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What is done with GDAL and SQLite, as one table of functions. With them come a hundred shared libraries, which take
/// longer to load than most questions to answer: a program either links the functions or loads them when it first needs
/// them (modules/loader.cpp), and the rest of the library calls them through this table alone.

#include "batch/formats/geopackage.h"
#include "exactvo/datasets/input_text.h"
#include "gdal/plane_transform.h"
#include "readers/grey_image.h"
#include "readers/readers.h"
#include "writers/writers.h"

namespace exactvo::datasets {

struct VectorLibrary {
  decltype(&datasets::read_vector_file) read_vector_file;
  decltype(&datasets::to_gdal_file) to_gdal_file;
  decltype(&datasets::read_gdal_image) read_gdal_image;
  decltype(&batch::make_geopackage) make_geopackage;
  decltype(&datasets::make_plane_transform) make_plane_transform;
  decltype(&datasets::set_wait_hook) set_wait_hook;  ///< of the module's own copy of text_file.cpp
};

/// Throws DataError (E_FORMAT_UNAVAILABLE) where a program loads it and cannot.
const VectorLibrary& vector_library();

}  // namespace exactvo::datasets
