// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Pieces of an obstacle's record (obstacle_record.h) for whatever writes one.

#include "exactvo/geometry/obstacle_shapes.h"
#include "json/json_text.h"
#include "scenarios/scenario_json.h"

namespace exactvo::datasets {

void append_measurements(JsonWriter& json, const geometry::ObstacleShapes& shapes);
void append_verdicts(JsonWriter& json, const geometry::ObstacleShapes& shapes);

}  // namespace exactvo::datasets
