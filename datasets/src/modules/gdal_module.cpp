// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/vector_library.h"
#include "modules/module.h"

extern "C" __attribute__((visibility("default"))) exactvo::datasets::ModuleEntry exactvo_module() {
  return {exactvo::datasets::kBuild, "gdal", &exactvo::datasets::vector_library()};
}
