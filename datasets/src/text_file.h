// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Whole files as text, and where in a text a byte stands.

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace exactvo::datasets {

/// The bytes of a regular file. Throws DataError (missing, unreadable, a directory).
std::string read_text_file(const std::filesystem::path& path);

/// The first `count` bytes, or all.
std::string read_beginning(const std::filesystem::path& path, std::size_t count);

/// "line 3, column 7", both from 1; columns count bytes.
std::string line_and_column(std::string_view text, std::size_t byte);

/// At most `length` printable characters from `byte` on, in quotes, for messages; in words if there are none.
std::string excerpt(std::string_view text, std::size_t byte, std::size_t length = 20);

}  // namespace exactvo::datasets
