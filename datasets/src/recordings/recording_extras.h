// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a recording says beside its rows: the Lyapunov functions term by term, who collided, and why robots stopped.

#include "exactvo/datasets/recording_file.h"
#include "json/json_cursor.h"

namespace exactvo::datasets {

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
