// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The results of a run as text, however it was made.

#include <string>

#include "exactvo/datasets/run_info.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/scenario.h"

namespace exactvo::tools {

/// Its first line says what was run and how it ended. Of many robots those that did not arrive are named first, and
/// few.
std::string run_summary(const datasets::RunInfo& info, const formation::Scenario& scenario,
                        const formation::Metrics& metrics);

}  // namespace exactvo::tools
