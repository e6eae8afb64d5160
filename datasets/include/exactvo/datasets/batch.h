// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A folder of maps in one go: every obstacle of every file read, judged, repaired if asked, decomposed and enclosed
/// (geometry/obstacle_shapes.h), with a verdict on every shape (docs/guide/batch.md).
///
/// Every file and every obstacle ends in exactly one of done, repaired and rejected with a code; a bad one never stops
/// the rest. What is written does not depend on the number of workers, shards or ranks, nor on how often the batch was
/// killed and resumed: the bytes are the same but for the times, which stand on one line of summary.json.
///
/// How: an ordered pipeline cuts inputs into chunks of obstacles; a chunk's results go to a file of their own under
/// OUT/.parts (temporary file, fsync, rename), and are merged in order: by one process while others are being made, or
/// when all are there (docs/adr/0014-batch-pipeline.md). Parts that are there are not made again. A streaming reader
/// (WKT, and what GDAL reads feature by feature) keeps no more than a chunk for each worker in memory.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/obstacle_shapes.h"

namespace exactvo::datasets {

/// A robot whose velocity obstacles are wanted.
struct BatchRobot {
  double radius = 0.0;                    ///< m, >= 0
  double time_horizon = 0.0;              ///< s, > 0
  geometry::Vec2 velocity;                ///< m/s; half-planes are the nearest to it
  std::vector<geometry::Vec2> positions;  ///< m, at least one
  std::optional<geometry::Vec2> goal;     ///< m; trap-free ellipses are then made for the way from the first position
};

/// What changes the results.
struct BatchConfiguration {
  /// The defaults below.
  BatchConfiguration() { shapes.partition = geometry::PartitionMethod::triangles; }

  ReadOptions reading;            ///< keep_going is implied
  geometry::ShapeOptions shapes;  ///< pieces by triangles: a tenth more of them than at best, some forty times quicker
  /// Bytes for obstacles under way; 0: no limit but the chunks' own. Files that are read whole and larger than a 20th
  /// of it are refused: so it changes what is written.
  std::uint64_t memory_limit = 0;
  std::optional<BatchRobot> robot;      ///< none: no half-planes
  bool geopackage = built_with_gdal();  ///< obstacles.gpkg; E_FORMAT_UNAVAILABLE in a build without GDAL
  bool geojson = true;                  ///< obstacles.geojson, facades.geojson, ...; without GDAL E_FORMAT_UNAVAILABLE,
                                        ///< unless `geojson_in_metres`
  bool geojson_in_metres = false;       ///< coordinates in metres; other programs will read them as degrees
  bool pictures = true;                 ///< index.html
};

/// How it is run; none of it changes the results.
struct BatchRun {
  std::vector<std::filesystem::path> paths;  ///< files, and folders whose files are taken (`EarlierBatch`)
  std::filesystem::path out;                 ///< folder of the outputs
  int workers = 0;                           ///< 0: as many as there are processors
  bool resume = false;                       ///< go on with what is in `out`
  std::size_t shard = 1;                     ///< this process's share of the inputs, from 1
  std::size_t shards = 1;                    ///< how many processes share the inputs
  std::vector<std::string> command_line;     ///< for provenance, without what does not change the results
};

/// How far a batch is.
struct BatchProgress {
  std::size_t inputs = 0;         ///< of this process
  std::uint64_t input_bytes = 0;  ///< of them
  std::size_t inputs_done = 0;    ///< of them, read to the end
  double share_done = 0.0;        ///< 0 to 1, by size of the inputs
  std::uint64_t obstacles = 0;    ///< so far, in this run
  std::string doing;              ///< the file under way
  int rank = 0;                   ///< of this process among those of mpirun
  int ranks = 1;                  ///< how many there are
};

/// How many, by how they ended.
struct BatchTally {
  std::uint64_t read = 0;                         ///< done + repaired + all of rejected
  std::uint64_t done = 0;                         ///< as they were
  std::uint64_t repaired = 0;                     ///< after a repair
  std::map<std::string, std::uint64_t> rejected;  ///< by code
  /// The sum of `rejected` over all codes.
  std::uint64_t rejected_in_all() const;
};

/// A file of which nothing could be used.
struct RejectedFile {
  std::string path;  ///< as it was given or found in a folder
  std::string code;  ///< "E_FORMAT_UNKNOWN"
};

/// A note on whole files, printed once for all files that it holds for.
struct BatchNote {
  std::string text;       ///< "taken as metres: names no reference system"
  std::string file;       ///< the first that it holds for
  std::size_t files = 0;  ///< how many it holds for
};

/// What a batch came to: the numbers of its summary.json.
struct BatchSummary {
  BatchTally files;                          ///< by how their reading ended
  std::vector<RejectedFile> rejected_files;  ///< in the order of the inputs
  std::vector<BatchNote> notes;              ///< each text once, a thousand at most
  BatchTally obstacles;                      ///< by how their processing ended
  std::uint64_t passed_over = 0;             ///< points and empty geometries: no obstacles, not among `read`
  std::uint64_t obstacles_out = 0;           ///< of what was done or repaired; a repair may make several of one
  std::uint64_t certified = 0;               ///< of them
  std::uint64_t uncertified = 0;             ///< of them, with a failed verdict
  std::uint64_t vertices = 0;                ///< of `obstacles_out`
  std::uint64_t no_half_plane = 0;           ///< null among the robot's half-planes: it overlaps the shape
  double seconds = 0.0;                      ///< of this run
  std::uint64_t obstacles_now = 0;           ///< processed in this run; less than all after a resumption
  std::uint64_t vertices_now = 0;            ///< of `obstacles_now`
};

/// How a batch ended.
enum class BatchEnd {
  complete,    ///< everything is in `out`
  incomplete,  ///< this shard, or this rank, is complete; others are not
  interrupted  ///< `keep_going` said no; --resume goes on
};

/// A folder among those of `BatchRun::paths` and below that holds what a batch has written, finished or not. Its files
/// are not read: they are outputs, and their obstacles come from other files. It is known by the summary.json of a
/// finished batch or the .parts/run.json of an unfinished one. `BatchRun::out` is never read and never listed here.
struct EarlierBatch {
  std::string folder;     ///< its path
  std::size_t files = 0;  ///< that are not read, as far as they can be counted
};

/// How a batch ended, with what it came to.
struct BatchResult {
  BatchEnd end = BatchEnd::complete;  ///< complete, incomplete or interrupted
  BatchSummary summary;               ///< of a complete one
  bool was_complete = false;  ///< nothing was left to do, or another process of the same batch was quicker to end it
  bool was_merged_ahead = false;        ///< the outputs grew while parts were being made
  std::vector<EarlierBatch> earlier{};  ///< met on the way to the inputs; of ranks, the first one's
};

/// Called from time to time, by one thread at a time; false stops the batch after what is under way.
using BatchWatch = std::function<bool(const BatchProgress&)>;

/// Runs it. Throws DataError where something can't be done at all: a path does not exist, or the paths hold no file to
/// read (E_FILE_MISSING), a place that can't be written (E_FILE_UNWRITABLE: full, removed
/// under the batch), an output of other inputs, another configuration or another version, or an input that changes
/// under the batch (E_OTHER_RUN). Whatever is thrown, what was finished stays for a resumption.
BatchResult run_batch(const BatchConfiguration& configuration, const BatchRun& run, const BatchWatch& watch = {});

/// Whether this process is one of several that mpirun has started, in a build with MPI.
bool under_mpi();

/// The same over all ranks: each processes a share of the inputs, about equal by their sizes, and calls its own watch;
/// the first rank merges the parts. The result is that of the first rank; the others' is `incomplete`. REQUIRES:
/// under_mpi().
BatchResult run_batch_over_ranks(const BatchConfiguration& configuration, const BatchRun& run,
                                 const BatchWatch& watch = {});

}  // namespace exactvo::datasets
