// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/run_recorder.h"

#include <utility>

#include "exactvo/formation/stability.h"

namespace exactvo::tools {

using datasets::RecordingFile;
using formation::LyapunovRow;
using formation::Step;

namespace {

/// What figures show of a row.
Step without_half_planes(const Step& row) {
  Step shown;
  shown.time = row.time;
  shown.leader_position = row.leader_position;
  shown.leader_velocity = row.leader_velocity;
  shown.robots.reserve(row.robots.size());
  for (const formation::RobotStep& r : row.robots) {
    formation::RobotStep& robot = shown.robots.emplace_back();
    robot.position = r.position;
    robot.velocity = r.velocity;
    robot.wheels = r.wheels;
  }
  return shown;
}

}  // namespace

void ShownRows::add(const Step& row, const LyapunovRow* lyapunov) {
  if (last_is_extra_) {
    rows_.pop_back();
    if (!lyapunov_.empty()) lyapunov_.pop_back();
  }
  if ((rows_.size() + 1) * row.robots.size() > kMostStates && rows_.size() > 2) thin();
  rows_.push_back(without_half_planes(row));
  if (lyapunov) lyapunov_.push_back(*lyapunov);
  last_is_extra_ = count_ % every_ != 0;
  ++count_;
}

void ShownRows::thin() {
  keep_every_second(rows_);
  keep_every_second(lyapunov_);
  every_ *= 2;
}

void ShownRows::move_to(RecordingFile& file) {
  file.recording.steps = std::move(rows_);
  file.lyapunov = std::move(lyapunov_);
}

struct RunRecorder::Files {
  /// The recording alone, into that file.
  Files(std::shared_ptr<datasets::AtomicFile> recorded, const RecordingFile& about)
      : recording(std::move(recorded), about) {}
  Files(const std::filesystem::path& folder, const RecordingFile& about)
      : recording(folder / "recording.jsonl", about) {
    trajectory.emplace(folder / "trajectory.csv", about.scenario);
    if (tracks_choices(about.scenario)) lyapunov.emplace(folder / "lyapunov.csv");
  }

  datasets::RecordingWriter recording;
  std::optional<datasets::TrajectoryWriter> trajectory;
  std::optional<datasets::LyapunovWriter> lyapunov;
};

RunRecorder::RunRecorder(RecordingFile about, RunOutput output) : about_(std::move(about)), output_(std::move(output)) {
  if (output_.page) packer_.emplace(output_.page_limits);
}

void RunRecorder::begin(const formation::Recording& run) {
  if (output_.warnings) output_.warnings(run.warnings);
  about_.recording = run;
  if (!output_.folder.empty()) {
    files_ = std::make_shared<Files>(output_.folder, about_);
  } else if (output_.recording) {
    files_ = std::make_shared<Files>(std::move(output_.recording), about_);
  }
  evaluator_.emplace(about_.scenario, about_.recording,
                     [this](const Step& row, const LyapunovRow* lyapunov) { take(row, lyapunov); });
}

void RunRecorder::add_row(Step row) {
  evaluator_->add(std::make_shared<const Step>(std::move(row)));
  goal_bodies_of_last_ = std::exchange(goal_bodies_of_next_, {});
  plans_of_last_ = std::exchange(plans_of_next_, {});
}

void RunRecorder::take(const Step& row, const LyapunovRow* lyapunov) {
  if (output_.figures) shown_.add(row, lyapunov);
  if (packer_) packer_->add(row);
  if (!files_) return;
  for (const formation::GoalBodies& of_goal : goal_bodies_of_last_) files_->recording.add(of_goal, bodies_);
  for (const formation::JointPlan& plan : plans_of_last_) files_->recording.add(plan);
  files_->recording.add(row, bodies_, lyapunov);
  if (files_->trajectory) files_->trajectory->add(row);
  if (files_->lyapunov && lyapunov) files_->lyapunov->add(*lyapunov);
}

std::string RunRecorder::packed(const RecordingFile& file, const std::string& metrics_json) const {
  return packer_ ? packer_->finish(file, metrics_json) : std::string();
}

formation::Metrics RunRecorder::finish(formation::Recording run, RecordingFile& file) {
  formation::Evaluation found = evaluator_->finish(run);
  file = std::move(about_);
  file.recording = std::move(run);
  shown_.move_to(file);
  file.stuck = std::move(found.stuck);
  file.collisions = found.metrics.collisions;
  file.outcome = found.metrics.outcome;
  if (files_) {
    // A folder of files is published as a whole, with their names (StagedFolder).
    const auto durability = output_.folder.empty() ? datasets::Durability::name : datasets::Durability::content;
    files_->recording.finish(file, durability);
    if (files_->trajectory) files_->trajectory->finish(durability);
    if (files_->lyapunov) files_->lyapunov->finish(durability);
    files_.reset();
  }
  return std::move(found.metrics);
}

}  // namespace exactvo::tools
