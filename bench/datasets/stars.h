// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Generated obstacles: stars of 3 to 16 corners with coordinates in whole millimetres, the same on every machine but
/// for the last digits of cosines.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::bench {

/// Number `k` of the set.
geometry::Polygon star(std::uint64_t k);

/// Those from 0 to `count` that are valid; rounding to millimetres makes a few cross themselves.
std::vector<geometry::Polygon> stars(std::size_t count);

/// All from 0 to `count` as WKT, one a line; memory does not grow with their number.
void write_stars(const std::filesystem::path& path, std::size_t count);

}  // namespace exactvo::bench
