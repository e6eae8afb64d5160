// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a module that a program loads gives it. Both stand on the same headers, so that both must be of one build.

#include "exactvo_commit.h"

namespace exactvo::datasets {

inline constexpr const char* kBuild = EXACTVO_VERSION " " EXACTVO_COMMIT;

struct ModuleEntry {
  const char* build;    ///< `kBuild` of the module
  const char* name;     ///< "gdal", "mpi"
  const void* library;  ///< a VectorLibrary or a RankLibrary
};

/// The one name that a module exports: a function of this type.
using ModuleFunction = ModuleEntry();
inline constexpr const char* kModuleFunction = "exactvo_module";

}  // namespace exactvo::datasets
