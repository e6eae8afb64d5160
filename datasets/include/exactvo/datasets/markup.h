// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Text within XML and HTML, for everything that writes either.

#include <string>
#include <string_view>

namespace exactvo::datasets {

/// What shows as `text` between tags and between double quotes. XML 1.0 has no control characters but tab and line
/// ends; each other one becomes a question mark.
std::string escaped_markup(std::string_view text);

}  // namespace exactvo::datasets
