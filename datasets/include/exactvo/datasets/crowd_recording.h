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
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/data_error.h"
#include "exactvo/formation/crowd.h"
#include "exactvo/formation/run_sink.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::datasets {

/// What a recording keeps of a kind of robots.
struct CrowdKindRecord {
  double radius = 0.0;     ///< m
  double max_speed = 0.0;  ///< m/s
};

/// A solid body that a recording keeps, as it stood at the start.
struct CrowdBodyRecord {
  geometry::ConvexShape shape;  ///< m
  bool moves = false;           ///< what is promised of one that moves is promised of kept robots
};

/// What stands before the rows.
struct CrowdRecordingHead {
  std::string scenario;                  ///< its name
  double time_step = 0.0;                ///< s
  double position_step = 0.0;            ///< m, q
  std::uint32_t every = 1;               ///< steps from row to row; the last row may follow sooner
  std::vector<CrowdKindRecord> kinds;    ///< by number, as in the crowd
  std::vector<std::uint16_t> kind_of;    ///< of each robot
  std::vector<geometry::Segment> edges;  ///< of obstacles
  std::vector<CrowdBodyRecord> bodies;   ///< those that the crowd had at the start
  std::vector<std::string> ids;          ///< of each robot; empty in files of earlier versions

  /// A robot's id; "#1" and so on where there are none. REQUIRES: a robot of the recording.
  std::string name_of(std::size_t robot) const;
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
  void put(const std::string& bytes);
  void take(const formation::RunState& now);
  void write_row();

  AtomicFile file_;
  CrowdRecordingHead head_;  ///< without ids
  std::size_t robots_ = 0;   ///< of the scenario
  std::string ids_;          ///< as they stand in the file
  bool ids_differ_ = true;   ///< all of them
  CrowdRow row_, last_;      ///< the next one, and the one before it
  std::vector<formation::ObstacleId> body_ids_;
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

/// The most findings that the audit of one recording lists.
inline constexpr std::size_t kMostCrowdFindings = 20;

/// What an audit found. Everything is exact. To touch is to be nearer than the radii and a rounding error
/// (formation/crowd.h).
struct CrowdAuditReport {
  std::size_t rows = 0;                 ///< of the file
  std::size_t robots = 0;               ///< of the file
  std::size_t motions = 0;              ///< of robots from row to row that were looked at
  std::size_t too_fast = 0;             ///< longer than the speed limit allows
  std::size_t pairs = 0;                ///< that were near enough to meet
  std::size_t pairs_met = 0;            ///< of these: that overlap on the way (of consecutive steps) or at its end
  std::size_t pairs_overlapping = 0;    ///< of these: that overlap already at the row before
  std::size_t near_edges = 0;           ///< robots and edges near enough to ask, that did not touch at the row before
  std::size_t edges_met = 0;            ///< of these: that overlap on the way or at its end
  std::size_t touching_edges = 0;       ///< robots and edges that touched: a robot must not come nearer
  std::size_t edges_neared = 0;         ///< of these: that come nearer, by more than rounding
  std::size_t touching_edges_open = 0;  ///< whose centre is on the edge up to rounding: nothing is promised
  std::size_t near_bodies = 0;          ///< robots and bodies near enough to ask, that did not touch at the row before
  std::size_t bodies_met = 0;           ///< of these, if the body is at rest or the robot kept: that overlap
  std::size_t bodies_open = 0;          ///< of these: the body moves and the robot is not kept, nothing is promised
  std::size_t touching_bodies = 0;    ///< that touched: apart at the end from one that moves, not nearer to one at rest
  std::size_t bodies_not_parted = 0;  ///< of these: that overlap, or came nearer
  bool cut_off = false;               ///< the file has no proper end
  std::vector<std::string> findings;  ///< the first few of what is wrong, in words
  /// Nothing is wrong with what was judged.
  bool clean() const {
    return too_fast + pairs_met + pairs_overlapping + edges_met + edges_neared + bodies_met + bodies_not_parted == 0;
  }
};

/// The counts of a report under their names, in its order.
inline constexpr std::pair<const char*, std::size_t CrowdAuditReport::*> kCrowdAuditCounts[] = {
    {"rows", &CrowdAuditReport::rows},
    {"robots", &CrowdAuditReport::robots},
    {"motions", &CrowdAuditReport::motions},
    {"too_fast", &CrowdAuditReport::too_fast},
    {"pairs", &CrowdAuditReport::pairs},
    {"pairs_met", &CrowdAuditReport::pairs_met},
    {"pairs_overlapping", &CrowdAuditReport::pairs_overlapping},
    {"near_edges", &CrowdAuditReport::near_edges},
    {"edges_met", &CrowdAuditReport::edges_met},
    {"touching_edges", &CrowdAuditReport::touching_edges},
    {"edges_neared", &CrowdAuditReport::edges_neared},
    {"touching_edges_open", &CrowdAuditReport::touching_edges_open},
    {"near_bodies", &CrowdAuditReport::near_bodies},
    {"bodies_met", &CrowdAuditReport::bodies_met},
    {"bodies_open", &CrowdAuditReport::bodies_open},
    {"touching_bodies", &CrowdAuditReport::touching_bodies},
    {"bodies_not_parted", &CrowdAuditReport::bodies_not_parted}};

/// Counts added up, findings joined.
void add(CrowdAuditReport& sum, const CrowdAuditReport& other);

/// Judges positions and motions from the file alone, in exact predicates. Of rows of consecutive steps the straight
/// motion is judged, of others its ends. `sample`: about so many motions, spread evenly over robots and rows; 0: all.
CrowdAuditReport audit_crowd_recording(const std::filesystem::path& path, std::size_t sample = 0);

/// What was written as a table.
struct CrowdTable {
  std::size_t rows = 0;  ///< of the recording
  bool cut_off = false;  ///< the recording was: these are the rows before
};

/// "step,time,robot,x,y,kept,id", one line per robot and row; `robot` counts from 0, and `id` is left out where the
/// recording has none.
CrowdTable write_crowd_csv(const std::filesystem::path& from, AtomicFile& to);

/// Whether these are the first bytes of a recording of a crowd.
bool begins_crowd_recording(std::string_view bytes);

}  // namespace exactvo::datasets
