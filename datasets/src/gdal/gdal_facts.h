// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace exactvo::datasets {

/// "3.6.2", or "none" in a build without GDAL.
std::string gdal_release();

}  // namespace exactvo::datasets
