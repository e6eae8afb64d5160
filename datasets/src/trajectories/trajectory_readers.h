// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The readers of trajectories: how each knows its own, and how it hands rows on.

#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "exactvo/datasets/trajectory_file.h"

namespace exactvo::datasets {

/// Bytes: no row of a trajectory is longer.
inline constexpr std::size_t kLongestRow = std::size_t{1} << 16;

/// Where readers put rows: gives agents numbers, checks times and places.
class TrajectorySink {
 public:
  TrajectorySink(const TrajectoryOptions& options, const std::function<void(const TrajectoryRow&)>& take,
                 TrajectoryFile& file)
      : options_(options), take_(take), file_(file) {}

  TrajectoryFile& file() { return file_; }
  /// The number of an agent, made when it first comes up.
  std::size_t agent(std::string_view id);
  /// `at` in the file's unit of length; `time` in s. REQUIRES: a number of `agent`.
  void row(std::size_t agent, double time, geometry::Vec2 at, std::uint64_t line,
           double heading = std::numeric_limits<double>::quiet_NaN(),
           geometry::Vec2 velocity = TrajectoryRow().velocity);
  double scale() const { return options_.scale; }  ///< m
  const TrajectoryOptions& options() const { return options_; }
  /// Behind the last row: notes on all of them.
  void finish();
  /// All rows are of one agent, since the table does not say whose they are. Notes it.
  void has_no_ids();
  /// s, of a frame. Notes once where no frame rate is known. `of_file`: frames a second as the file says, 0 if not.
  double time_of_frame(double frame, double of_file);
  [[noreturn]] void refuse(DataCode code, std::uint64_t line, const std::string& found,
                           const std::string& expected) const;
  /// A field as a finite number.
  double number(std::string_view field, const char* what, std::uint64_t line) const;

 private:
  struct Last {
    double time;
    geometry::Vec2 at;
    std::uint64_t line;
    double heading;
    geometry::Vec2 velocity;
  };
  const TrajectoryOptions& options_;
  const std::function<void(const TrajectoryRow&)>& take_;
  TrajectoryFile& file_;
  std::unordered_map<std::string, std::size_t> numbers_;
  std::string id_;  ///< to look up without allocating each time
  std::vector<Last> last_;
  std::uint64_t headings_ = 0, large_headings_ = 0;  ///< rows with one, and with one beyond a whole turn
  bool rate_noted_ = false, counts_frames_ = false, has_ids_ = true;
};

struct TrajectoryFormat {
  const char* name;
  bool (*matches)(std::string_view beginning);  ///< of the first bytes of a file
  void (*read)(const std::filesystem::path& path, TrajectorySink& out);
};

/// In order of preference: the surest marks first.
const std::vector<TrajectoryFormat>& trajectory_readers();

// trajectory_tables.cpp
bool looks_like_trajectory_csv(std::string_view beginning);
/// What a file is to have that begins with other names of columns; empty of a file that does not begin with names.
std::string what_a_header_lacks(std::string_view beginning);
void read_trajectory_csv(const std::filesystem::path& path, TrajectorySink& out);
bool looks_like_jupedsim_text(std::string_view beginning);
void read_jupedsim_text(const std::filesystem::path& path, TrajectorySink& out);
bool looks_like_obsmat(std::string_view beginning);
void read_obsmat(const std::filesystem::path& path, TrajectorySink& out);
bool looks_like_four_columns(std::string_view beginning);
void read_four_columns(const std::filesystem::path& path, TrajectorySink& out);

// trajectory_polynomials.cpp
bool looks_like_polynomials(std::string_view beginning);
void read_polynomials(const std::filesystem::path& path, TrajectorySink& out);
bool looks_like_curves(std::string_view beginning);
void read_curves(const std::filesystem::path& path, TrajectorySink& out);

// trajectory_plans.cpp
bool looks_like_mapf_yaml(std::string_view beginning);
void read_mapf_yaml(const std::filesystem::path& path, TrajectorySink& out);
bool looks_like_mapf_paths(std::string_view beginning);
void read_mapf_paths(const std::filesystem::path& path, TrajectorySink& out);

// trajectory_databases.cpp
bool looks_like_sqlite(std::string_view beginning);
void read_jupedsim_sqlite(const std::filesystem::path& path, TrajectorySink& out);

// trajectory_trees.cpp
bool looks_like_trajnet(std::string_view beginning);
void read_trajnet(const std::filesystem::path& path, TrajectorySink& out);
bool looks_like_sumo_fcd(std::string_view beginning);
void read_sumo_fcd(const std::filesystem::path& path, TrajectorySink& out);
bool looks_like_recording(std::string_view beginning);
void read_recorded_trajectories(const std::filesystem::path& path, TrajectorySink& out);
void read_crowd_trajectories(const std::filesystem::path& path, TrajectorySink& out);

}  // namespace exactvo::datasets
