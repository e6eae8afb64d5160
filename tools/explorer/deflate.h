// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Bytes as they travel inside a page.

#include <string>
#include <string_view>

namespace exactvo::tools {

/// In zlib's format (RFC 1950), which ends in a checksum.
std::string deflated(std::string_view bytes);

}  // namespace exactvo::tools
