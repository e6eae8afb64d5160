// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Lines of tables as fields, and fields as numbers.

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace exactvo::tools {

/// Without the blanks round it.
std::string_view trimmed(std::string_view text);

/// Line `number` of a file without the byte order mark that may stand before the first one.
std::string_view without_mark(std::string_view line, std::size_t number);

/// Between commas, or between blanks where there is no comma; blanks round a field are taken off.
std::vector<std::string_view> fields_of(std::string_view line);

/// The whole field as a double, which may be infinite or NaN where it says so; nothing where it is no number.
std::optional<double> number_in(std::string_view field);

}  // namespace exactvo::tools
