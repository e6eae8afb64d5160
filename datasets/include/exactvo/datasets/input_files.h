// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Which files are read when one is named: what no output may replace, and what an input's digest depends on.
///
/// A file that cannot be understood names no others, and none of these functions throws for it: reading it as an input
/// says what is wrong. What is no regular file, a pipe for instance, is not opened.

#include <filesystem>
#include <string>
#include <vector>

namespace exactvo::datasets {

/// The files that belong to `path` and are no input of their own, as far as they are there: the picture of a ROS map,
/// the tables beside a Shapefile or a MapInfo file. `format` as in `ReadOptions::format`, empty if it is to be found
/// out.
std::vector<std::filesystem::path> sidecar_files(const std::filesystem::path& path, const std::string& format = {});

/// Everything that is read with the file, each once: `path` itself first, its sidecar files, and of a scenario the
/// obstacle files that it names, with theirs.
std::vector<std::filesystem::path> files_read_with(const std::filesystem::path& path, const std::string& format = {});

}  // namespace exactvo::datasets
