// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// An obstacle as an option of the command line gives it: WKT, the name of a file, or the numbers of a disc or an
/// ellipse, which no obstacle format has.

#include <string>
#include <variant>
#include <vector>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::tools {

/// A polygon or a wall; or a disc or an ellipse, convex as it stands.
using GivenObstacle = std::variant<geometry::Obstacle, geometry::ConvexShape>;

/// m: coordinates and lengths go up to here, so that their squares and those of their sums stay far within doubles.
inline constexpr double kLargestGiven = datasets::kLargestCoordinate;

/// Whether `text` is the name of a file or a folder; one too long for a name is not.
bool is_there(const std::string& text);

/// The obstacles in `text`, at least one: a file with some; WKT; `DISC(x y, r)`; `ELLIPSE(cx cy, l11 l21 l22)`, the set
/// c + L w with |w| <= 1 and L = [l11 0; l21 l22], exactly as given; `ELLIPSE(cx cy, a b, degrees)`, semi-axes and the
/// angle of the first, rounded to such an L. A file is read as `reading` says; degrees that became metres are said.
/// Throws UsageError that names `option`, DataError for a file or bad WKT.
std::vector<GivenObstacle> obstacles_in(const std::string& option, const std::string& text,
                                        const datasets::ReadOptions& reading = {});

}  // namespace exactvo::tools
