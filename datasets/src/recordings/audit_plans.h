// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Point (8) of an audit: joint plans begin where their robots were, and no move of one runs into an obstacle or into
/// another robot of the plan.

#include <vector>

#include "recordings/audit_scene.h"
#include "recordings/audit_tally.h"

namespace exactvo::datasets {

/// Distances of a plan are rounded when it is made: a move may come nearer than radii allow by this share of them. (Of
/// a way a billionth of the square, of a place that is taken for one that is there a billionth of the diameter.)
inline constexpr double kPlanRounding = 1e-8;

/// REQUIRES: plans as read_recording gives them.
void audit_plans(const RecordingFile& file, const std::vector<RationalObstacle>& obstacles, AuditTally& tally);

}  // namespace exactvo::datasets
