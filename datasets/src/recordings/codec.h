// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Shapes, bodies, half-planes and decisions as JSON, both ways: what lines of recordings are made of.

#include "exactvo/formation/recording.h"
#include "json/json_cursor.h"

namespace exactvo::datasets {

/// {"disc": ...}, {"segment": ...}, {"polygon": ...} or {"ellipse": ...}.
void append_convex(JsonWriter& json, const geometry::ConvexShape& shape);
geometry::ConvexShape to_convex(const JsonCursor& at);

/// Of a robot or moving obstacle the shape is left out: its place changes, and rows have it.
void append_body(JsonWriter& json, std::size_t number, const vo::Body& body);
vo::Body to_body(const JsonCursor& at);

/// One robot's part of a row. What is empty or as usual is left out.
void append_robot(JsonWriter& json, const formation::RobotStep& robot);
/// Half-planes come back without what is not theirs alone: source, shape, position, radius and velocity.
formation::RobotStep to_robot(const JsonCursor& at);

}  // namespace exactvo::datasets
