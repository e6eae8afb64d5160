// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "exactvo/formation/scenario.h"
#include "json/json_text.h"

namespace exactvo::datasets {

/// The scenario as one JSON value, where a writer stands: recordings carry it in their header.
void append_scenario(JsonWriter& json, const formation::Scenario& scenario);

void append_points(JsonWriter& json, const std::vector<geometry::Vec2>& points);

}  // namespace exactvo::datasets
