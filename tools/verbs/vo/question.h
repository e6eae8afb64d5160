// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the options of `exactvo vo` ask.

#include <CLI/CLI.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "exactvo/vo/family.h"
#include "verbs/obstacles/obstacle_files.h"

namespace exactvo::tools {

using geometry::Vec2;

// --- An obstacle as an option gives it: WKT, the name of a file, or the numbers of a disc or an ellipse, which no
// obstacle format has ---

/// A polygon or a wall; or a disc or an ellipse, convex as it stands.
using GivenObstacle = std::variant<geometry::Obstacle, geometry::ConvexShape>;

/// Whether `text` is the name of a file or a folder; one too long for a name is not.
bool is_there(const std::string& text);

/// The obstacles in `text`, at least one: a file with some; WKT; `DISC(x y, r)`; `ELLIPSE(cx cy, l11 l21 l22)`, the set
/// c + L w with |w| <= 1 and L = [l11 0; l21 l22], exactly as given; `ELLIPSE(cx cy, a b, degrees)`, semi-axes and the
/// angle of the first, rounded to such an L. A file is read as `reading` says; degrees that became metres are reported.
/// Throws UsageError that names `option`, DataError for a file or bad WKT.
std::vector<GivenObstacle> obstacles_in(const std::string& option, const std::string& text,
                                        const datasets::ReadOptions& reading = {});

// --- All options ---

/// The options as they were typed.
struct VoFlags {
  std::vector<std::string> obstacles;
  std::vector<std::string> obstacle_velocities;
  std::string enclose = "none";
  std::string pieces;
  ReadingFlags reading;  ///< of obstacles that are files
  std::string position, velocity, goal, robot;
  std::optional<double> radius;
  std::string time_horizon;
  double responsibility = 1.0;
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
/// --free there is exactly one obstacle.
struct VoQuestion {
  std::vector<AskedObstacle> obstacles;
  std::vector<vo::Encounter> encounters;
  double responsibility = 1.0;
  bool exact_legs = false;
  bool free = false;
  double max_speed = 0.0;  ///< m/s, of --free
  Vec2 velocity;
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
