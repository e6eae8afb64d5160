// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Metrics of a run as JSON, SI units, keys in a fixed order; a value that does not apply is null.

#include <string>
#include <vector>

#include "exactvo/datasets/run_info.h"
#include "exactvo/formation/metrics.h"

namespace exactvo::datasets {

/// One object, indented, with a newline at its end. `wall_time` and `provenance.written_at` are its only values that
/// differ between equal runs.
std::string metrics_json(const RunInfo& info, const formation::Metrics& metrics);

/// An array of such objects, as summary.json holds.
std::string summary_json(const std::vector<std::string>& metrics_objects);

}  // namespace exactvo::datasets
