// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "gdal/vector_library.h"
#include "modules/module.h"
#include "mpi/rank_library.h"

namespace exactvo::datasets {

// Instead of the one in the archive, which would load MPI with this module: sources that share a unit with what the
// module needs refer to ranks, and it calls none of them.
const RankLibrary& rank_library() {
  throw std::logic_error("the module of GDAL has no ranks");
}

}  // namespace exactvo::datasets

extern "C" __attribute__((visibility("default"))) exactvo::datasets::ModuleEntry exactvo_module() {
  return {exactvo::datasets::kBuild, "gdal", &exactvo::datasets::vector_library()};
}
