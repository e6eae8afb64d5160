// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the head of a packed run (packed_run.h) says of a recording beside its rows: the scene, the method, the bodies,
/// the joint plans and the routes, as JSON.

#include <nlohmann/json.hpp>
#include <string>

#include "exactvo/datasets/recording_file.h"
#include "explorer/packed_run.h"

namespace exactvo::tools {

/// Routes are planned again as the run did; null where it had none, or where that would take long.
nlohmann::ordered_json packed_head(const datasets::RecordingFile& about, const PackedRunLimits& limits);

/// Without what differs between equal runs, so that their pages do not. Null where `text` is no JSON.
nlohmann::ordered_json shown_metrics(const std::string& text);

}  // namespace exactvo::tools
