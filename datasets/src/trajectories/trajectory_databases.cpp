// SPDX-License-Identifier: GPL-3.0-or-later
// JuPedSim's SQLite files, by the part of the library that has SQLite (jupedsim_sqlite.h).
#include <cmath>

#include "gdal/vector_library.h"
#include "trajectories/trajectory_readers.h"

namespace exactvo::datasets {

bool looks_like_sqlite(std::string_view beginning) {
  constexpr std::string_view kMark("SQLite format 3\0", 16);
  return beginning.substr(0, kMark.size()) == kMark;
}

void read_jupedsim_sqlite(const std::filesystem::path& path, TrajectorySink& out) {
  out.file().row_word = "row";
  double frame_rate = 0.0;
  SqliteTrajectories to;
  to.begin = [&](double found) {
    if (found > 0.0 && std::isfinite(found)) frame_rate = found;
    out.file().notes.emplace_back("the walkable area in the file is not taken for a map: --map names one");
  };
  to.take = [&](std::int64_t frame, std::int64_t id, geometry::Vec2 at, std::uint64_t row) {
    out.row(out.agent(std::to_string(id)), out.time_of_frame(static_cast<double>(frame), frame_rate), at, row);
  };
  vector_library().read_jupedsim_sqlite_file(path, to);
}

}  // namespace exactvo::datasets
