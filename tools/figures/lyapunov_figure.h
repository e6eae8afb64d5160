// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Both Lyapunov functions along a run, term by term (formation/lyapunov.h).

#include <string>
#include <vector>

#include "exactvo/datasets/recording_file.h"
#include "figures/figure.h"

namespace exactvo::tools {

/// `lyapunov`: the paper's (18) and its derivative above, the function that holds and its derivative below.
/// REQUIRES: a formation's run with its rows of `lyapunov`.
Figure lyapunov_figure(const datasets::RecordingFile& run);

/// A row a row, units in the column names.
std::string lyapunov_csv(const std::vector<formation::LyapunovRow>& rows);

}  // namespace exactvo::tools
