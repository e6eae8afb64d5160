// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A run as the page of `exactvo view` reads it: a JSON head and columns of numbers, deflated.
///
///     "EXVIEW01" | length of the head (uint32) | head (JSON) | zeros to a multiple of 8 | columns
///
/// little endian, in zlib's format, so that a browser inflates it by itself and notices bytes that are missing or
/// changed. The head names each column with its type, its number of entries and how it is coded; page/columns.js reads
/// them. Positions and velocities of all rows are rounded (to 2^-13 m, 2^-13 m/s or coarser in a wide scene), which is
/// what a picture shows. Decisions (velocities, half-planes, multipliers) are the recording's doubles, bit for bit, so
/// that the page can check their proofs.
///
/// Long runs are thinned: of rows and of decisions every second, fourth and so on is kept, and always the last one. The
/// head says which.
///
/// See also: page.h puts it into a page; support/run_recorder.h fills one while a run is made.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/datasets/recording_file.h"

namespace exactvo::tools {

class PackedColumns;

/// What a page holds at most. A state is one robot in one row.
struct PackedRunLimits {
  std::size_t states = 1U << 20;            ///< positions and velocities
  std::size_t decision_numbers = 1U << 20;  ///< doubles of decisions: about twenty a robot and six a half-plane
  std::size_t routed_robots = 50;           ///< beyond this many robots, no routes
  std::size_t routed_vertices = 2000;       ///< the same, of obstacles: planning again must cost little
  bool has_scenario = false;  ///< whether the whole scenario is in it, for a page that asks to compute with it
};

/// The first, the third and so on.
template <class Value>
void keep_every_second(std::vector<Value>& all) {
  for (std::size_t k = 1; 2 * k < all.size(); ++k) all[k] = std::move(all[2 * k]);
  all.resize((all.size() + 1) / 2);
}

/// Takes rows as they are made, in memory bounded by its limits.
class RunPacker {
 public:
  explicit RunPacker(PackedRunLimits limits = {}) : limits_(limits) {}

  /// In the order of time. Shapes of half-planes are not kept: their bodies have them.
  void add(const formation::Step& row);

  /// The same for a row whose robots have a place, a velocity, a mode and a status, and no decisions.
  void add_positions(const formation::Step& row);

  /// Takes everything of `about` but the rows. `metrics_json` as datasets::metrics_json writes it; empty where there is
  /// none. `bodies`, one for each robot or none: more members of the robots in the head. "there" is a list of times,
  /// from and until, s, at which the robot is there; "outline" a list of rings [x, y, ...] round its place, m, for a
  /// disc.
  std::string finish(const datasets::RecordingFile& about, const std::string& metrics_json,
                     const std::vector<nlohmann::ordered_json>& bodies = {}) const;

 private:
  struct State {
    double x = 0.0, y = 0.0, vx = 0.0, vy = 0.0;
    double heading = 0.0;  ///< of a robot on wheels, radians
    std::uint8_t mode = 0, status = 0;
    std::int8_t side = 0;
  };
  struct Row {
    double time = 0.0;
    geometry::Vec2 leader;
    std::vector<State> states;
    std::vector<formation::MovedObstacle> moving;
  };

  nlohmann::ordered_json add_rows(std::size_t robots, PackedColumns& columns) const;
  std::vector<formation::Step> decided() const;
  void note_events(const formation::Step& row);
  void add_event(double time, std::size_t robot, const char* kind, const std::string& text);
  void keep_row(const formation::Step& row);
  void keep_decisions(const formation::Step& row);

  PackedRunLimits limits_;
  std::size_t count_ = 0;    ///< rows so far
  bool has_wheels_ = false;  ///< some robot
  std::vector<Row> rows_;
  std::size_t every_row_ = 1;
  bool last_row_is_extra_ = false;
  std::vector<formation::Step> decisions_;
  std::size_t every_decision_ = 1, decision_numbers_ = 0;
  std::vector<formation::Mode> modes_;  ///< of the row before, by robot, as the next
  std::vector<bool> is_relaxed_;
  nlohmann::ordered_json events_ = nlohmann::ordered_json::array();
  std::size_t events_left_out_ = 0;
};

/// The whole of a recording that was read.
std::string packed_run(const datasets::RecordingFile& file, const std::string& metrics_json,
                       PackedRunLimits limits = {});

struct PackedCrowd {
  std::string scenario;     ///< its name
  std::string packed;       ///< RunPacker::finish
  bool is_cut_off = false;  ///< after its last whole row, which the page says too
};

/// A recording of a crowd (datasets/crowd_recording.h) as a packed run: positions and which robots kept their
/// half-planes, without goals and decisions, which such recordings do not have. Read row by row, in memory bounded by
/// the limits. `metrics_json`: of the run, as datasets::metrics_json writes it; empty where there is none. Throws
/// datasets::DataError.
PackedCrowd packed_crowd(const std::filesystem::path& path, const PackedRunLimits& limits = {},
                         const std::string& metrics_json = "");

/// What the head of a packed run says of a recording beside its rows: the scene, the method, the bodies, the joint
/// plans and the routes. Routes are planned again as the run did; null where it had none, or where that would take
/// long.
nlohmann::ordered_json packed_head(const datasets::RecordingFile& about, const PackedRunLimits& limits);

/// Without what differs between equal runs, so that their pages do not. Null where `text` is no JSON.
nlohmann::ordered_json shown_metrics(const std::string& text);

}  // namespace exactvo::tools
