// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Names of files: what they lead to, and how they end.

#include <cctype>
#include <filesystem>
#include <string>
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

/// Changes ASCII letters only.
inline std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Its extension in lower case, with its dot.
inline std::string lower_extension(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

/// For names of files on their way that no other process takes, be it of this machine or another on the same disk:
/// process numbers repeat from machine to machine. 16 hexadecimal digits from the system's source of randomness, other
/// ones at each call. Goes into names of temporary files only, never into a result.
std::string unique_word();

}  // namespace exactvo::datasets
