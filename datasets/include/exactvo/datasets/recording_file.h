// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Recordings as JSON Lines: a header (what was run, the whole scenario, the enclosures, provenance), then a row a
/// step. Enough stands in a row to prove its half-planes again without the program that wrote it: beside each
/// half-plane its convex shape, the robot's position and radius, the horizon and the shape's velocity.
///
/// The header's `rows_sha256` is the digest of all that follows it: audit.h finds by it what was altered since.
///
/// Property (1): read_recording gives back every double bit for bit. Numbers are the shortest that do so; the
/// non-finite ones, which JSON has no word for, are the strings "nan", "inf" and "-inf".

#include <filesystem>
#include <string>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/run_info.h"
#include "exactvo/formation/lyapunov.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/recording.h"
#include "exactvo/formation/stuck.h"

namespace exactvo::datasets {

struct RecordingFile {
  RunInfo info;
  formation::Scenario scenario;
  std::vector<std::vector<geometry::ConvexShape>> enclosures;  ///< per robot; empty where the method has none
  formation::Recording recording;
  std::vector<formation::LyapunovRow> lyapunov = {};  ///< a row for every row, of a formation; else empty
  std::vector<formation::StuckReport> stuck = {};     ///< who stopped elsewhere; of what binds, the names only
  std::vector<formation::Collision> collisions = {};  ///< as the metrics have them
};

/// Whole or not at all (atomic_file.h). Throws DataError where it can't be written.
void write_recording(const std::filesystem::path& path, const RecordingFile& file);

/// Throws DataError naming the line and, within it, the JSON pointer.
RecordingFile read_recording(const std::filesystem::path& path);

/// One row a robot and step: time, robot, state, preferred and chosen velocity, status, mode, side; with a formation
/// also the leader's state. Units stand in the column names. Same atomicity.
void write_trajectory_csv(const std::filesystem::path& path, const RecordingFile& file);

}  // namespace exactvo::datasets
