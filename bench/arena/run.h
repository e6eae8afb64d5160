// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One run of the arena: a scene by a method, and its line of CSV.

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "suites.h"

namespace exactvo::bench {

struct ArenaMethod {
  std::string name;
  std::string program = {};  ///< of a peer (peer.h); empty for our own
};

/// `plan`: the defaults of `simulate`. `bias`: without joint plans. `orca`: van den Berg et al. 2011 along the same
/// routes, with relaxing instead of repair.
std::vector<std::string> own_methods();

struct RunResult {
  std::string suite, scene;
  std::uint64_t seed = 0;
  std::string method;
  std::size_t robots = 0, arrived = 0;
  bool success = false;
  std::size_t collisions = 0;  ///< in continuous time, with robots and obstacles
  std::size_t relaxed = 0;     ///< decisions; 0 of a peer, which reports none
  double makespan = 0.0;       ///< s, of the last arrival; where some do not arrive, to the end of the run
  double bound = 0.0;          ///< s, of the longest straight way at full speed
  double path = 0.0;           ///< of all robots, over their straight ways
  double cpu_per_step = 0.0;   ///< us of processor time per robot and step
  std::size_t plans = 0;
};

/// s, processor time of this thread.
double processor_seconds();

/// Rows are measured as they are made and not kept: memory does not grow with the run, but for a peer's output. Empty
/// where `stop` became true meanwhile. Throws std::runtime_error where a peer fails.
std::optional<RunResult> run_scene(const Scene& scene, const ArenaMethod& method, const std::atomic<bool>& stop);

std::string csv_header();
std::string csv_line(const RunResult& result);
/// Throws std::runtime_error for a line that `csv_line` did not write.
RunResult parsed(const std::string& line);

}  // namespace exactvo::bench
