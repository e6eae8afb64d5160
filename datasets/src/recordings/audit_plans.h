// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Point (8) of an audit: joint plans begin where their robots were, and no move of one runs into an obstacle or into
/// another robot of the plan.

#include <vector>

#include "recordings/audit_rows.h"
#include "recordings/audit_scene.h"
#include "recordings/audit_tally.h"

namespace exactvo::datasets {

/// A move may come nearer than radii allow by this share of them, since plans are rounded: squared distances are
/// compared to within a share of 1e-9, and a place within 1e-9 diameters of a known one counts as that one.
inline constexpr double kPlanRounding = 1e-8;

/// REQUIRES: plans as read_recording gives them, and `places` of all rows.
void audit_plans(const RecordingFile& file, const std::vector<RationalObstacle>& obstacles, const PlacesInRows& places,
                 AuditTally& tally);

}  // namespace exactvo::datasets
