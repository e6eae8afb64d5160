// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Both Lyapunov functions along a run, term by term (formation/lyapunov.h).

#include <string>

#include "exactvo/datasets/recording_file.h"
#include "figures/figure.h"

namespace exactvo::tools {

/// `lyapunov`: the paper's (18) and its derivative above, the function that holds and its derivative below.
/// REQUIRES: a formation's run with its rows of `lyapunov`.
Figure lyapunov_figure(const datasets::RecordingFile& run);

/// The same as a table: its head, with units in the column names, and the line of one row.
std::string lyapunov_csv_head();
std::string lyapunov_csv_line(const formation::LyapunovRow& row);

}  // namespace exactvo::tools
