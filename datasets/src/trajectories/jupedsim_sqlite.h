// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// JuPedSim's SQLite files: table trajectory_data (frame, id, pos_x, pos_y, ...) and table metadata (key, value) with
/// "fps". Read by the part of the library that has SQLite.

#include <cstdint>
#include <filesystem>
#include <functional>

#include "exactvo/geometry/vec2.h"

namespace exactvo::datasets {

struct SqliteTrajectories {
  /// Before the rows: frames a second, 0 where the file does not say.
  std::function<void(double frame_rate)> begin;
  /// Row by row, by frame.
  std::function<void(std::int64_t frame, std::int64_t id, geometry::Vec2 at, std::uint64_t row)> take;
};

/// Throws DataError: E_FORMAT_SYNTAX, E_NUMBER; E_FORMAT_UNAVAILABLE in a build without SQLite.
void read_jupedsim_sqlite_file(const std::filesystem::path& path, const SqliteTrajectories& to);

}  // namespace exactvo::datasets
