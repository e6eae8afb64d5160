// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the options of `exactvo vo` ask.

#include <CLI/CLI.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/vo/family.h"
#include "support/given_obstacle.h"
#include "verbs/obstacles/obstacle_files.h"

namespace exactvo::tools {

using geometry::Vec2;

/// The options as they were typed.
struct VoFlags {
  std::vector<std::string> obstacles;
  std::vector<std::string> obstacle_velocities;
  std::string enclose = "none";
  std::string pieces;
  ReadingFlags reading;  ///< of obstacles that are files
  std::string position, velocity, goal, robot;
  std::string velocities;  ///< a file, or "-"
  std::optional<double> radius;
  std::string time_horizon;
  double alpha = 1.0;
  std::vector<std::string> variants;
  bool exact_legs = false;
  bool free = false;
  std::optional<double> max_speed;
  bool json = false;
  std::string figure;
};

void declare_options(CLI::App& app, VoFlags& flags);

/// What stands for an obstacle in the answer.
enum class Taken {
  itself,             ///< it is convex
  convex_pieces,      ///< whose union it is
  convex_hull,        ///< of an obstacle that is not convex, because --pieces hull asks for it
  smallest_ellipse,   ///< round it
  trap_free_ellipse,  ///< round it
};

/// One obstacle as it was given, and what of it the encounters are with.
struct AskedObstacle {
  GivenObstacle given;
  Taken taken = Taken::itself;
  std::size_t first_encounter = 0;
  std::size_t encounters = 1;
};

/// The same as values, checked. `encounters` are with convex shapes: one an obstacle, or one a piece of it. Without
/// --free and --velocities there is exactly one obstacle.
struct VoQuestion {
  std::vector<AskedObstacle> obstacles;
  std::vector<vo::Encounter> encounters;
  std::vector<vo::Variant> variants;
  double alpha = 1.0;
  bool exact_legs = false;
  bool free = false;
  double max_speed = 0.0;  ///< m/s, of --free
  Vec2 velocity;           ///< (0, 0) where many are asked for by --velocities
};

/// The obstacle, and which of its encounters.
struct Place {
  std::size_t obstacle = 0;
  std::size_t cone = 0;
};
Place place_of(const VoQuestion& question, std::size_t encounter);

/// Throws UsageError with the option that is wrong, DataError for a file.
VoQuestion question_of(const VoFlags& flags);

}  // namespace exactvo::tools
