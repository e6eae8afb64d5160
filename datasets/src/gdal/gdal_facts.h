// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace exactvo::datasets {

/// The release that this was built with, "3.6.2", or "none". Known without loading GDAL.
std::string gdal_release();

}  // namespace exactvo::datasets
