// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Which files a batch reads, and what tells each from any other: the SHA-256 of its content, and of what it cannot be
/// read without (the picture of a ROS map, the tables beside a Shapefile).

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace exactvo::datasets::batch {

struct Input {
  std::string name;  ///< as the user named it, or the folder's name and what is below it
  std::filesystem::path path;
  std::string sha256;  ///< empty where it can't be read
  std::uint64_t size = 0;
};

/// Files as named, folders walked in order of names. Hidden files and folders, what belongs to another file (the tables
/// of a Shapefile, the pictures of ROS maps) and whatever is below `out` are no inputs. Each file once. Throws
/// DataError (E_FILE_MISSING) for a path that is not there.
std::vector<Input> list_inputs(const std::vector<std::filesystem::path>& paths, const std::filesystem::path& out);

}  // namespace exactvo::datasets::batch
