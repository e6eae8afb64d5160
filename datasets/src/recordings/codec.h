// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// As JSON, both ways: shapes, bodies, half-planes and decisions, which lines of recordings are made of; and what a
/// recording says beside its rows: the Lyapunov functions term by term, who collided, and why robots stopped.

#include "exactvo/datasets/recording_file.h"
#include "json/json_text.h"

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

/// The member `lyapunov` of a row; `time` is the row's.
void append_lyapunov(JsonWriter& json, const formation::LyapunovRow& row);
formation::LyapunovRow to_lyapunov(const JsonCursor& at, double time);

/// The member `collisions` of metrics and of a recording's header.
void append_collisions(JsonWriter& json, const std::vector<formation::Collision>& all);
std::vector<formation::Collision> to_collisions(const JsonCursor& at);

/// The member `stuck` of the header.
void append_stuck(JsonWriter& json, const RecordingFile& file);
void read_stuck(const JsonCursor& at, RecordingFile& file);

}  // namespace exactvo::datasets
