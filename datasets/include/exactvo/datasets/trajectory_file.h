// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Trajectories from files: where each agent was at which time, whatever program wrote it. Rows go to the caller one by
/// one, so that memory grows with the number of agents and the longest line or tag, and not with the file; a file can
/// be read again. Lines are bounded (E_SIZE): 64 KiB in tables and in trajnet, 16 MiB in mapf-paths, where a line is
/// the whole way of an agent; so are the tags of sumo-fcd, 64 KiB. A file of mapf-yaml is kept whole while it is read.
///
/// The times of an agent rise in the order of the file. A row that repeats the one before it is left out and counted. A
/// time that goes back, a second place or heading at one time, and a number that is not finite are refused with file
/// and line.
///
/// Files of polynomials say how an agent moves at all times: their rows are samples, and `TrajectoryFile::curves` has
/// the motion itself.
///
/// See also: trajectory_survey.h (speeds, gaps and jumps of what was read), trajectory_pieces.h (motions between rows),
/// obstacle_file.h (maps).

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/motions.h"

namespace exactvo::datasets {

/// One agent at one time.
struct TrajectoryRow {
  std::size_t agent = 0;  ///< its number, in the order in which agents come up in the file
  double time = 0.0;      ///< s
  geometry::Vec2 at;      ///< m
  double heading = std::numeric_limits<double>::quiet_NaN();  ///< rad, counter-clockwise from x; NaN: not in the file
  geometry::Vec2 velocity = {std::numeric_limits<double>::quiet_NaN(), 0.0};  ///< m/s; NaN: not in the file
  std::uint64_t line = 0;  ///< in the file, from 1; of recordings the row, from 1
};

/// How a file is read.
struct TrajectoryOptions {
  std::string format;       ///< a name of `trajectory_formats()`; empty: chosen by content
  double frame_rate = 0.0;  ///< frames a second, of files that count frames; 0: as the file says, else 1
  double scale = 1.0;       ///< m, > 0: of the file's unit of length
  /// Recorded robots on wheels: rows have the axle's centre and the heading, without a velocity, and robots with a
  /// footprint are read too. Otherwise rows have the reference point, about which the disc of `TrajectoryFile::radii`
  /// is, and robots with a footprint are refused, since their disc is larger than their body.
  bool at_axles = false;
  bool one_velocity = false;  ///< a second velocity at one time and place is refused
};

/// What a file says besides its rows.
struct TrajectoryFile {
  std::string file;                                         ///< as the caller named it
  std::string format;                                       ///< the one that was used
  std::string row_word = "line";                            ///< what `TrajectoryRow::line` counts
  std::vector<std::string> agents;                          ///< their ids, by number
  std::vector<double> radii;                                ///< m, of the agents; empty where the file has none
  std::size_t on_wheels = 0;                                ///< how many agents are on wheels; of recordings only
  std::vector<formation::SceneObstacle> obstacles;          ///< that stand in the file; of recordings only
  std::vector<std::vector<geometry::CurvedMotion>> curves;  ///< of each agent, in time; only of files of polynomials
  bool in_cells = false;           ///< x counts columns and y rows of a grid, from the top; `scale` is a cell's side
  std::uint64_t repeated = 0;      ///< rows that repeat the one before, left out
  std::vector<std::string> notes;  ///< what a reader should know, in words
};

/// Rows in memory, one after the other; arrays of one length. Places are in the unit that `TrajectoryOptions::scale`
/// gives.
struct TrajectoryColumns {
  std::vector<std::string> names;  ///< ids of the agents
  std::vector<std::size_t> agent;  ///< of each row, its place among `names`
  std::vector<double> time;        ///< s, or with `in_frames` numbers of frames
  std::vector<double> x;           ///< of places
  std::vector<double> y;           ///< of places
  std::vector<double> heading;     ///< rad; empty: not known
  std::vector<double> vx;          ///< of velocities, in the unit of places a second; empty: not known
  std::vector<double> vy;          ///< as many as `vx`
  bool in_frames = false;          ///< `TrajectoryOptions::frame_rate` makes times of them
};

/// What the names of columns in a table say, as the header of CSV says it (docs/guide/check.md).
struct TrajectoryHeader {
  /// One that is known.
  struct Column {
    std::string meaning;  ///< t, frame, id, x, y, theta, vx, vy, qx, qy, qz or qw
    std::size_t at = 0;   ///< its place among the names
    double in_si = 1.0;   ///< how many of its unit make one s, m, m/s or rad
  };
  std::vector<Column> columns;     ///< those that are known, each meaning once
  std::vector<std::string> notes;  ///< what a reader should know, in words
};

/// Throws DataError where a column stands twice or a unit is ambiguous. `scale`: that of `TrajectoryOptions`.
TrajectoryHeader read_trajectory_header(const std::vector<std::string>& names, double scale = 1.0);

/// A file of trajectories that can be read several times. What comes through a pipe is kept in a temporary file.
class TrajectoryReader {
 public:
  /// "-" is standard input. Throws DataError: E_FILE_MISSING, E_FORMAT_UNKNOWN, E_OPTION, ...
  explicit TrajectoryReader(const std::string& file, TrajectoryOptions options = {});
  /// Several files of polynomials, each of which is one agent with the name of its file; or one file of any format.
  /// Throws DataError, for several files of another format E_OPTION. REQUIRES: at least one file.
  explicit TrajectoryReader(const std::vector<std::string>& files, TrajectoryOptions options = {});
  /// Rows that are in memory already; `name` stands for the file in messages. REQUIRES: arrays of one length, agents
  /// below the number of names.
  TrajectoryReader(TrajectoryColumns columns, const std::string& name, TrajectoryOptions options = {});
  ~TrajectoryReader();
  TrajectoryReader(const TrajectoryReader&) = delete;
  TrajectoryReader& operator=(const TrajectoryReader&) = delete;

  /// Reads the file from its beginning; `take` gets every row, in the order of the file. Throws DataError.
  const TrajectoryFile& read(const std::function<void(const TrajectoryRow&)>& take);
  /// What is known so far: while a file is read, its format and the agents that have come up.
  const TrajectoryFile& file() const;
  /// Throws DataError for a row.
  [[noreturn]] void refuse(DataCode code, std::uint64_t line, const std::string& found,
                           const std::string& expected) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The names that `TrajectoryOptions::format` takes.
std::vector<std::string> trajectory_formats();

/// The files that a folder stands for: the recording of the run in it, or else the files in it that are recognised, in
/// the order of their names. Throws DataError: E_FORMAT_UNKNOWN where there is none.
std::vector<std::string> trajectory_files_in(const std::filesystem::path& folder);

/// The name of the format by which a file would be read; empty where none is recognised, or the file can't be read
/// twice. Throws DataError: E_FILE_MISSING.
std::string recognised_trajectory_format(const std::string& file);

}  // namespace exactvo::datasets
