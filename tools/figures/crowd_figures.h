// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The figures of a recording of a crowd: maps of what the whole crowd did, and a sample of its robots.
///
/// Neighbours: crowd_course.h has the numbers; run_figures.h draws runs of few robots.

#include <vector>

#include "figures/crowd_course.h"
#include "figures/figure.h"

namespace exactvo::tools {

/// `density` (robots a square metre, on average over the run), `flow` (how many pass a metre in a second, with arrows),
/// `speed` (of those who were there), `speeds` (over time) and `paths` (of some robots).
std::vector<Figure> crowd_figures(const CrowdCourse& course);

}  // namespace exactvo::tools
