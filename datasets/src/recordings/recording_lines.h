// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Recordings line by line, from a file, a pipe or a text.

#include <functional>
#include <string>
#include <string_view>

#include "exactvo/datasets/recording_file.h"

namespace exactvo::datasets {

/// Gives the next line without its \n, valid until the next call; false at the end.
using NextLine = std::function<bool(std::string_view& line)>;

/// `read_recording` of these lines into `run`, which is empty: rows go to `take`. `name` is used in messages.
void read_recording_lines(const NextLine& next_line, const std::string& name, const TakeRow& take, RecordingFile& run);

}  // namespace exactvo::datasets
