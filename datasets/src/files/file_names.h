// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <system_error>

namespace exactvo::datasets {

/// Whether the path leads to a regular file; false where that cannot be found out.
inline bool is_regular(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

/// One name for each file; where links can't be followed, the path as it stands.
inline std::filesystem::path name_of_file(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
  return error ? path : canonical;
}

}  // namespace exactvo::datasets
