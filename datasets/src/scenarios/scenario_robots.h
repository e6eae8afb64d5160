// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The member `robots` of a scenario: robots one by one, by generators and from tables.

#include <filesystem>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "json/json_text.h"

namespace exactvo::datasets {

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

/// `list` has been held against the schema. Tables are looked up in `base_dir`; `file` is the scenario's name in
/// messages. Throws DataError: a table that is missing or wrong, a box without room.
RobotList read_robots(const Json& list, const std::vector<formation::SceneObstacle>& obstacles, const std::string& file,
                      const std::filesystem::path& base_dir);

}  // namespace exactvo::datasets
