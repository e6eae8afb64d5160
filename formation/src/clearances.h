// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Swept clearances of a recording: every robot against obstacles, moving obstacles and the other robots, over each
/// step as it was driven. Certified lower bounds, all roundings taken off.

#include <optional>
#include <vector>

#include "exactvo/formation/metrics.h"

namespace exactvo::formation::detail {

struct Clearances {
  std::vector<std::optional<double>> to_obstacles;  ///< m, per robot; moving ones included
  std::optional<double> between_robots;             ///< m
  std::vector<Collision> collisions;                ///< in the order of their beginnings
};

Clearances swept_clearances(const Scenario& scenario, const Recording& recording);

}  // namespace exactvo::formation::detail
