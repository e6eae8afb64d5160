// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Recordings as JSON Lines (format 2): each line an object with one member that says what it is. First the `header`
/// (what was run, the whole scenario, provenance); then, in the order in which they came up, every `body` (a convex
/// shape with a number and the obstacles that it stands for) before the first line that names it, every `goal_bodies`
/// (the enclosures of a robot for a goal), every joint `plan` and one `row` per step; last the `end` (how the run went,
/// and the digest of all before it). Each fact is stored once, before the first line that needs it: a run of any length
/// can be written in constant memory while it is computed. A file without an end was cut off and is refused; so is one
/// of format 1.
///
/// Enough stands there to prove half-planes again without the program that wrote them: each has its body, clearance
/// and horizon, and its row says where robots and moving obstacles were. The end's `sha256` shows what was altered
/// since.
///
/// Property (1): read_recording gives back every double bit for bit. Numbers are the shortest that do so; the
/// non-finite ones, which JSON has no word for, are the strings "nan", "inf" and "-inf".

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/run_info.h"
#include "exactvo/formation/lyapunov.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/recording.h"
#include "exactvo/formation/stuck.h"

namespace exactvo::datasets {

/// What `format_version` says. Another one is refused (E_RANGE).
inline constexpr int kRecordingFormat = 2;

/// A recording with what a reader needs to know of its run.
struct RecordingFile {
  RunInfo info;                                       ///< what was run, and by what
  formation::Scenario scenario;                       ///< the whole scenario
  formation::Recording recording;                     ///< the run
  std::vector<formation::LyapunovRow> lyapunov = {};  ///< one for every row of a formation; else empty
  std::vector<formation::StuckReport> stuck = {};     ///< robots that stopped elsewhere; binding bodies by name only
  std::vector<formation::Collision> collisions = {};  ///< as the metrics have them
  /// As the metrics have it, with collisions and detours; empty: as `recording.outcome`, which has neither.
  std::string outcome = {};
};

/// A recording that is written as the run is made, in constant memory. Whole or not at all (atomic_file.h): nothing
/// stands there before `finish`. Into a pipe it is written while it is made; one that is cut off lacks its last line
/// (E_CUT_OFF where it is read). Throws DataError where it can't be written.
class RecordingWriter {
 public:
  /// Reads from `about` only what is known before a run: the scenario, the info, and from the recording `motion`,
  /// `time_step`, `tracking_gain`, `relative_frame`, `controller_options`, `offsets` and `all_half_planes`.
  RecordingWriter(const std::filesystem::path& path, const RecordingFile& about);
  /// Into a pipe that was opened before, for instance.
  RecordingWriter(std::shared_ptr<AtomicFile> out, const RecordingFile& about);
  ~RecordingWriter();
  /// `bodies` are the run's so far.
  void add(const formation::GoalBodies& of_goal, const std::vector<vo::Body>& bodies);
  /// Adds a joint plan. REQUIRES: before the row in which it was made, after the rows before that.
  void add(const formation::JointPlan& plan);
  /// Adds a row. `lyapunov`: its row of the functions, null without a formation.
  void add(const formation::Step& row, const std::vector<vo::Body>& bodies,
           const formation::LyapunovRow* lyapunov = nullptr);
  /// Reads the rest from `about`: outcome, warnings, robots that were stuck, the time it took.
  void finish(const RecordingFile& about, Durability durability = Durability::name);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Whole or not at all (atomic_file.h). Throws DataError where it can't be written.
void write_recording(const std::filesystem::path& path, const RecordingFile& file);

/// Throws DataError naming the line and, within it, the JSON pointer.
RecordingFile read_recording(const std::filesystem::path& path);
/// Takes a row, with its values of a formation (else null). `so_far` has what the file says before it.
using TakeRow = std::function<void(const RecordingFile& so_far, formation::Step row, const formation::LyapunovRow*)>;
/// The same row by row, in order: rows go to `take`, and the file that is returned has none. Memory does not grow
/// with the run.
RecordingFile read_recording(const std::filesystem::path& path, const TakeRow& take);
/// The same from the file's text; `file_name` is used in messages.
RecordingFile parse_recording(const std::string& text, const std::string& file_name);

/// The table of a run as it is made, one row per robot and step: time, robot, state, preferred and chosen velocity,
/// status, mode, side; with a formation also the leader's state. Units stand in the column names. Whole or not at all,
/// as RecordingWriter.
class TrajectoryWriter {
 public:
  /// Throws DataError where it can't be written.
  TrajectoryWriter(const std::filesystem::path& path, const formation::Scenario& scenario);
  ~TrajectoryWriter();
  /// Adds the rows of one step.
  void add(const formation::Step& row);
  /// Publishes the file. Nothing stands there before.
  void finish(Durability durability = Durability::name);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The table of a formation's Lyapunov functions as the run is made, term by term, one row per step. Units stand in the
/// column names; a derivative that does not exist is an empty cell. Whole or not at all, as RecordingWriter.
class LyapunovWriter {
 public:
  /// Throws DataError where it can't be written.
  explicit LyapunovWriter(const std::filesystem::path& path);
  ~LyapunovWriter();
  /// Adds the row of one step.
  void add(const formation::LyapunovRow& row);
  /// Publishes the file. Nothing stands there before.
  void finish(Durability durability = Durability::name);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace exactvo::datasets
