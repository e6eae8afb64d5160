// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A run on its way to its files: every row is measured and written as it is made and then forgotten, but for those
/// that figures show.
///
/// See also: run.h runs a scenario into one.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "explorer/packed_run.h"

namespace exactvo::tools {

/// Rows for figures: all of a short run, of a long one every second, fourth and so on, and always the last one. Without
/// half-planes, which no figure of a run shows.
class ShownRows {
 public:
  /// Counts the states of all robots together.
  static constexpr std::size_t kMostStates = 200'000;

  void add(const formation::Step& row, const formation::LyapunovRow* lyapunov);
  void move_to(datasets::RecordingFile& file);

 private:
  void thin();

  std::vector<formation::Step> rows_;
  std::vector<formation::LyapunovRow> lyapunov_;  ///< of the same rows, of a formation
  std::size_t count_ = 0;                         ///< rows so far
  std::size_t every_ = 1;
  bool last_is_extra_ = false;  ///< the last one is kept only until the next comes
};

struct RunOutput {
  std::filesystem::path folder = {};               ///< must exist; nothing is written where it is empty
  bool figures = true;                             ///< whether any will be drawn; without them no row is kept for them
  std::function<void(double)> progress = nullptr;  ///< gets the simulated time, s
  /// Gets, before the first row, what can be said before the run (formation::warnings_before).
  std::function<void(const std::vector<std::string>&)> warnings = nullptr;
  bool page = false;                                          ///< whether a page will be made (explorer/page.h)
  PackedRunLimits page_limits = {};                           ///< of what it holds
  std::shared_ptr<datasets::AtomicFile> recording = nullptr;  ///< without a folder: takes the recording
};

class RunRecorder : public formation::RunSink {
 public:
  /// `about`: what is known before the run.
  RunRecorder(datasets::RecordingFile about, RunOutput output);

  void begin(const formation::Recording& run) override;
  void add_body(const vo::Body& body) override { bodies_.push_back(body); }
  void add_goal_bodies(const formation::GoalBodies& of_goal) override { goal_bodies_of_next_.push_back(of_goal); }
  void add_plan(const formation::JointPlan& plan) override { plans_of_next_.push_back(plan); }
  void add_row(formation::Step row) override;

  /// `run` is what the simulation returned. Afterwards recording.jsonl, trajectory.csv and, of a formation,
  /// lyapunov.csv stand in the folder, and `file` has the whole but for the rows that no figure shows.
  formation::Metrics finish(formation::Recording run, datasets::RecordingFile& file);

  /// The run for a page (explorer/page.h); empty where none was asked for. REQUIRES: `file` is what `finish` gave.
  std::string packed(const datasets::RecordingFile& file, const std::string& metrics_json) const;

 private:
  struct Files;
  void take(const formation::Step& row, const formation::LyapunovRow* lyapunov);

  datasets::RecordingFile about_;
  RunOutput output_;
  std::shared_ptr<Files> files_;
  std::optional<formation::Evaluator> evaluator_;
  ShownRows shown_;
  std::optional<RunPacker> packer_;
  std::vector<vo::Body> bodies_;
  /// A row is written when the next one comes, and what came before it stands before it in the file.
  std::vector<formation::GoalBodies> goal_bodies_of_last_, goal_bodies_of_next_;
  std::vector<formation::JointPlan> plans_of_last_, plans_of_next_;
};

}  // namespace exactvo::tools
