// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Values of a scenario out of JSON that has been held against the schema: types and required keys are as they should
/// be.

#include <filesystem>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "scenarios/scenario_json.h"

namespace exactvo::datasets {

/// m; the schema's bound of coordinates.
inline constexpr double kFarthest = 1e9;

/// The member `formation`, of these robots. Throws DataError for what the schema cannot say: an unknown robot's id, a
/// speed profile of the wrong length. `file` is used in messages.
formation::FormationSpec to_formation(const Json& object, const std::vector<formation::Robot>& robots,
                                      const std::string& file);

/// A leader that is to go `to` a place: its route among the scenario's obstacles, and its profile along it. Throws
/// DataError for the speeds of legs, which nobody knows before. `object` is the member `leader`.
void plan_leader_of(const Json& object, formation::Scenario& scenario, const std::string& file);

/// A member `profile` of something that follows `path`; `pointer` is its place, for messages.
std::vector<formation::SpeedKnot> to_profile(const Json& object, const std::vector<geometry::Vec2>& path,
                                             const std::string& file, const std::string& pointer);

// scenario_robots.cpp: robots one by one, by generators and from tables

/// Where in the text a robot comes from.
struct RobotOrigin {
  std::size_t entry = 0;
  bool is_one_of_many = false;
};

struct RobotList {
  std::vector<formation::Robot> robots;
  std::vector<RobotOrigin> origins;           ///< of each robot
  std::vector<std::filesystem::path> tables;  ///< files that were read
};

/// `list`, or one of its entries alone, has been held against the schema. Tables are looked up in `base_dir`; `file` is
/// the scenario's name in messages. Of `scenario` it takes obstacles, the time step and the tracking error, which radii
/// take in. Throws DataError: a table that is missing or wrong, a box without room.
RobotList read_robots(const Json& list, const formation::Scenario& scenario, const std::string& file,
                      const std::filesystem::path& base_dir);

}  // namespace exactvo::datasets
