// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Recordings of crowds, `.evr`: positions of many robots on their lattice, every n-th step, without loss, in columns
/// (docs/guide/crowd-recordings.md has the format). Written and read row by row: memory does not grow with the
/// run.
///
/// Properties (tests quote the numbers):
///  (1) what is read is what was written, every position and every mark;
///  (2) a file that was cut off reads up to its last whole row, and says that it was cut off; a changed one is refused.

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/formation/crowd.h"
#include "exactvo/formation/run_sink.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::datasets {

/// What a recording keeps of a kind of robots.
struct CrowdKindRecord {
  double radius = 0.0;                                ///< m
  double max_speed = 0.0;                             ///< m/s
  std::optional<formation::CrowdWheels> wheels = {};  ///< as the crowd had them
  /// m: of the disc that holds the body, on wheels about the axle; 0 where the file does not say.
  double body_radius = 0.0;
};

/// A solid body that a recording keeps, as it stood at the start.
struct CrowdBodyRecord {
  geometry::ConvexShape shape;  ///< m
  bool moves = false;           ///< whether it moves; against a moving body promises hold for kept robots alone
  std::string id = {};          ///< of the obstacle, or moving obstacle; empty in files of earlier versions
};

/// An obstacle that is no body.
struct CrowdObstacleRecord {
  std::string id;           ///< as in the scenario
  std::uint32_t edges = 0;  ///< how many
};

struct CrowdRow;

/// What stands before the rows.
struct CrowdRecordingHead {
  std::string scenario;                  ///< its name
  double time_step = 0.0;                ///< s
  double position_step = 0.0;            ///< m, q
  std::uint32_t every = 1;               ///< steps from row to row; the last row may follow sooner
  std::vector<CrowdKindRecord> kinds;    ///< by number, as in the crowd
  std::vector<std::uint16_t> kind_of;    ///< of each robot
  std::vector<geometry::Segment> edges;  ///< of obstacles
  /// The obstacle of each edge, in order; empty in files of earlier versions.
  std::vector<CrowdObstacleRecord> obstacles;
  std::vector<CrowdBodyRecord> bodies;  ///< those that the crowd had at the start
  std::vector<std::string> ids;         ///< of each robot; empty in files of earlier versions
  double tracking = 0.0;                ///< m, >= 0: no point of a body is farther from where rows have it
  /// Where each robot on wheels headed at first, as `half_heading_of` has it; (1, 0) of the others. Empty where no kind
  /// has wheels. Where every step is a row, later headings follow from this and from places (crowd/wheels.h).
  std::vector<geometry::Vec2> half_headings;

  /// A robot's id; "#1" and so on where there are none. REQUIRES: a robot of the recording.
  std::string name_of(std::size_t robot) const;
  /// A body's id; "body 1" and so on where it has none. REQUIRES: a body of the recording.
  std::string body_name(std::size_t body) const;
  /// m, where it is. Exact.
  geometry::Vec2 place(const CrowdRow& row, std::size_t robot) const;
  /// m, how far a body has come. Exact.
  geometry::Vec2 displacement(const CrowdRow& row, std::size_t body) const;
};

/// The robots at a time, in the order of the scenario.
struct CrowdRow {
  std::uint32_t step = 0;  ///< time steps from the start
  /// Positions, in lattice steps.
  std::vector<std::int32_t> x, y;  ///< lattice steps
  /// Lattice steps that each body has come from where it stood at the start.
  std::vector<std::int64_t> body_x, body_y;  ///< lattice steps
  std::vector<std::uint8_t> kept;  ///< 1: provably kept all its half-planes in every step since the row before
};

/// Takes a run whose robots and bodies stay the same; the file appears as a whole at `finish`. With
/// `Unfinished::stays` what was written outlasts an interrupted run, and one that goes on from a snapshot
/// (formation/crowd_run.h) goes on writing behind the rows that the snapshot knows of: the file is the same.
class CrowdRecorder : public formation::RunSink {
 public:
  /// The robots of the crowd have the ids of the scenario's, if there are as many and no two are the same; else none.
  /// Throws DataError (E_FILE_UNWRITABLE), as the others do. REQUIRES: every >= 1.
  CrowdRecorder(const std::filesystem::path& path, const formation::Scenario& scenario, std::uint32_t every,
                Unfinished unfinished = Unfinished::goes);
  /// Takes the start, then writes a row where one is due. REQUIRES: the state of a crowd.
  void add_state(const formation::RunState& now) override;
  /// Waits until the rows so far are on the disk.
  void save(std::ostream& to) override;
  /// Throws DataError (E_FORMAT_SYNTAX) where the unfinished file has fewer rows than that, or another head.
  void restore(const formation::RunState& now, std::istream& from) override;
  /// Writes the last row, if it is due, and publishes the file.
  void finish();
  /// How much was written so far.
  std::uint64_t bytes() const { return bytes_; }

 private:
  std::string head_of(const formation::Crowd& crowd);
  void name_bodies();
  void put(const std::string& bytes);
  void take(const formation::RunState& now);
  void write_row();

  AtomicFile file_;
  CrowdRecordingHead head_;         ///< without ids
  std::size_t robots_ = 0;          ///< of the scenario
  std::string ids_;                 ///< as they stand in the file
  std::vector<double> body_radii_;  ///< m, of the robots of the scenario
  bool ids_differ_ = true;          ///< all of them
  CrowdRow row_, last_;             ///< the next one, and the one before it
  std::vector<formation::ObstacleId> body_ids_;
  std::vector<std::string> moving_names_, disc_names_;  ///< of the scenario's bodies, in its order
  std::vector<geometry::Vec2> body_start_;
  std::vector<std::uint8_t> kept_;
  std::uint64_t bytes_ = 0, rows_ = 0;
  std::uint64_t sum_ = 0;  ///< of all blocks
  std::uint64_t head_sum_ = 0;
  bool is_due_ = false;
};

/// Reads a recording row by row, in constant memory.
class CrowdRecordingReader {
 public:
  /// Throws DataError: E_FILE_MISSING, E_FORMAT_SYNTAX with the byte.
  explicit CrowdRecordingReader(const std::filesystem::path& path);
  ~CrowdRecordingReader();

  /// What stands before the rows. Valid as long as the reader.
  const CrowdRecordingHead& head() const;
  /// False at the end. Throws DataError where a row was changed.
  bool next(CrowdRow& row);
  /// After the last row: the file has no proper end.
  bool is_cut_off() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// What was written as a table.
struct CrowdTable {
  std::size_t rows = 0;  ///< of the recording
  bool cut_off = false;  ///< the recording was: these are the rows before
};

/// "step,time,robot,x,y,kept,id", one line per robot and row; `robot` counts from 0, and `id` is left out where the
/// recording has none.
CrowdTable write_crowd_csv(const std::filesystem::path& from, AtomicFile& to);

/// The scene as other recordings have it, without what is not recorded: goals, motions of bodies, rows. Edges of one
/// obstacle that follow one another are a wall, in parts of at most 32; an ellipse is the polygon of 48 corners round
/// it.
RecordingFile scene_of(const CrowdRecordingHead& head);

/// Whether a file is one by its name, FILE.evr.
bool is_crowd_recording(const std::filesystem::path& path);

/// Whether these are the first bytes of a recording of a crowd.
bool begins_crowd_recording(std::string_view bytes);

}  // namespace exactvo::datasets
