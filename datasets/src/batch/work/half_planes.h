// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The velocity obstacles of a batch's robot: one half-plane for each of its positions.

#include "exactvo/datasets/batch.h"
#include "json/json_text.h"

namespace exactvo::datasets::batch {

/// The member "half_planes": for each position the half-plane of the obstacle's hull nearest to the robot's velocity;
/// where the robot stands within the hull, of each convex piece instead. "certified" says that the pair of doubles
/// excludes the velocity obstacle (predicate A, exact). In bare contact it is the half-plane away from the nearest
/// point, where that can be proven; null stands where the robot overlaps the shape, and within a few ulps of contact
/// where nothing could be proven. Returns how many are null.
std::uint64_t append_half_planes(JsonWriter& json, const geometry::ObstacleShapes& shapes, const BatchRobot& robot);

}  // namespace exactvo::datasets::batch
