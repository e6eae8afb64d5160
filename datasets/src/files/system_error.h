// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the operating system says about a file, as a DataError.

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets {

/// `error` is an errno value.
inline DataError cannot_write(const std::filesystem::path& path, int error) {
  return {DataCode::file_unwritable, path.string(), "", std::generic_category().message(error),
          "a path that can be written"};
}

inline DataError cannot_read(const std::filesystem::path& path, int error) {
  const bool missing = error == ENOENT || error == ENOTDIR;
  return {missing ? DataCode::file_missing : DataCode::file_unreadable, path.string(), "",
          missing ? "no such file" : std::generic_category().message(error),
          missing && path == "-" ? "a file that can be read; standard input is read as /dev/stdin"
                                 : "a file that can be read"};
}

}  // namespace exactvo::datasets
