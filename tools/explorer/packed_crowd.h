// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A recording of a crowd (datasets/crowd_recording.h) as a packed run: positions and which robots kept their
/// half-planes, without goals and decisions, which such recordings do not have.
///
/// Neighbours: packed_run.h (the packing, and which rows are left out of a long run).

#include <filesystem>
#include <string>

#include "explorer/packed_run.h"

namespace exactvo::tools {

struct PackedCrowd {
  std::string scenario;     ///< its name
  std::string packed;       ///< RunPacker::finish
  bool is_cut_off = false;  ///< after its last whole row, which the page says too
};

/// Read row by row, in memory bounded by the limits. Throws datasets::DataError.
PackedCrowd packed_crowd(const std::filesystem::path& path, const PackedRunLimits& limits = {});

}  // namespace exactvo::tools
