// SPDX-License-Identifier: GPL-3.0-or-later
#include "modules/module.h"
#include "mpi/rank_library.h"

extern "C" __attribute__((visibility("default"))) exactvo::datasets::ModuleEntry exactvo_module() {
  return {exactvo::datasets::kBuild, "mpi", &exactvo::datasets::rank_library()};
}
