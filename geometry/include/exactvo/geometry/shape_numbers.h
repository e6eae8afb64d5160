// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Convex shapes as plain numbers, for files and snapshots. Lossless.

#include <cstddef>
#include <optional>
#include <vector>

#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// The numbers of a shape, in the order of its fields, m. Its kind is its place in ConvexShape (`shape.index()`).
std::vector<double> numbers_of(const ConvexShape& shape);

/// The shape of these numbers, valid or not; none if no shape of the kind has this many.
std::optional<ConvexShape> shape_of(std::size_t kind, const std::vector<double>& numbers);

}  // namespace exactvo::geometry
