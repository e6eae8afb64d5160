// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Bytes as text of 64 characters.

#include <string>

namespace exactvo::tools {

/// RFC 4648.
std::string base64(const std::string& bytes);

}  // namespace exactvo::tools
