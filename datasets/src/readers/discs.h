// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Round obstacles of files, as polygons that contain them.

#include "exactvo/geometry/shapes.h"

namespace exactvo::datasets {

/// 16 corners round the disc, tan(pi/16) / (pi/16) = 1.013 times its area; closed. The disc lies inside.
geometry::Ring polygon_round(geometry::Vec2 center, double radius);

}  // namespace exactvo::datasets
