// SPDX-License-Identifier: GPL-3.0-or-later
// The functions that are linked: with GDAL, or those that say that there is none.
#include "gdal/vector_library.h"

namespace exactvo::datasets {

const VectorLibrary& vector_library() {
  static constexpr VectorLibrary kLibrary{read_vector_file,          read_in_system,         to_gdal_file,
                                          read_gdal_image,           batch::make_geopackage, make_plane_transform,
                                          read_jupedsim_sqlite_file, set_wait_hook};
  return kLibrary;
}

}  // namespace exactvo::datasets
