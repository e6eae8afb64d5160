// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Scenes of the arena, in suites: the same questions that others have published answers to.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::bench {

/// When a run counts as a success, besides that no robot touches another or an obstacle.
enum class Success {
  all_arrive,    ///< within 20 times the bound and 100 s; ended before where none comes nearer for 4 times and 60 s
  nobody_stands  ///< at the end no robot has been slower than 0.02 m/s for 5 s, away from its last goal
};

struct Scene {
  std::string suite, name;
  std::uint64_t seed = 1;  ///< of those with random places
  Success success = Success::all_arrive;
  std::function<formation::Scenario()> make;
};

/// `quick` takes a minute, `full` at most half an hour on two cores.
enum class Extent { quick, full };

struct SuiteInfo {
  std::string name;
  std::string shows;  ///< in a sentence
};
const std::vector<SuiteInfo>& suites();
std::vector<std::string> suite_names();

/// Which draws of each random scene.
struct Draws {
  std::optional<std::uint64_t> count = {};  ///< the suite's own number unless given
  std::uint64_t first = 1;                  ///< seed
};

/// REQUIRES: one of `suite_names`.
std::vector<Scene> scenes_of(const std::string& suite, Extent extent, const Draws& draws);

}  // namespace exactvo::bench
