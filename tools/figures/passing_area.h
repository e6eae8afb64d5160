// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where robots of a run that did not all arrive are proven to have no room to pass each other (formation/passing.h),
/// for pictures: proven again from the scenario.

#include <vector>

#include "exactvo/datasets/recording_file.h"
#include "figures/outlines.h"

namespace exactvo::tools {

/// Rectangles, m, that cover the places of a robot of the first pair; empty where all arrived or nothing is proven.
std::vector<Points> passing_area(const datasets::RecordingFile& run);

}  // namespace exactvo::tools
