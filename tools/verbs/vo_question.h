// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the options of `exactvo vo` ask.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "exactvo/vo/family.h"

namespace exactvo::tools {

using geometry::Vec2;

/// The options as they were typed.
struct VoFlags {
  std::vector<std::string> obstacles;
  std::vector<std::string> obstacle_velocities;
  std::string enclose = "none";
  std::string position, velocity, goal, robot;
  double radius = 0.0;
  std::string time_horizon;
  double alpha = 1.0;
  std::vector<std::string> variants;
  bool free = false;
  double max_speed = 0.0;
  bool json = false;
  std::string figure;
};

void declare_options(CLI::App& app, VoFlags& flags);

/// The same as values, checked. `encounters` has one entry an obstacle; without --free there is exactly one.
struct VoQuestion {
  std::vector<vo::Encounter> encounters;
  std::vector<vo::Variant> variants;
  double alpha = 1.0;
  bool free = false;
  double max_speed = 0.0;  ///< m/s, of --free
  Vec2 velocity;
};

/// Throws UsageError with the option that is wrong, DataError for a file.
VoQuestion question_of(const VoFlags& flags);

}  // namespace exactvo::tools
