// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Recordings as a forger sees them: lines of JSON, any of which can be edited, with a seal that is made anew.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "exactvo/datasets/recording_file.h"
#include "support/seeded_random.h"

namespace exactvo::datasets::test {

using Lines = std::vector<nlohmann::json>;

/// A short run, its scenario, and its recording.
struct ShortRun {
  std::string name;
  formation::Scenario scenario;
  Lines lines;
};

/// Kinematic robots and formations of every integrator, by half-planes of enclosures and of edges, with and without
/// moving obstacles, boxes and discs as speed bounds, choices that are relaxed, recordings with and without what is
/// far away. A few rows each.
std::vector<ShortRun> short_runs();

/// What was done to which field.
struct Edit {
  std::string field;  ///< "row.robots.chosen": the place without its numbers
  std::string how;    ///< "an ulp up"
  std::string place;  ///< with its numbers, and what stood there before and after
};

/// Makes one edit: it changes a random number, word, list, member or line, or it adapts the rest of the file to the
/// change. It corrects the count in the last line.
Edit edit(Lines& lines, exactvo::test::SeededRandom& random);

/// The file that the lines make, sealed.
std::string sealed(const Lines& lines);

}  // namespace exactvo::datasets::test
