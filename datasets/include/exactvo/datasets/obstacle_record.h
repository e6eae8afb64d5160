// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What was made of one obstacle (geometry/obstacle_shapes.h) as JSON: one object on one line, doubles in the shortest
/// digits that read back to the same value, nothing that depends on time or machine.
///
/// Shapes: points are [x, y] in metres; a segment is [[x, y], [x, y]]; a piece is a list of points (two for a wall's);
/// an ellipse is {"center": [x, y], "l11", "l21", "l22"}: { center + L w : |w| <= 1 }. Infinity is the text "inf".
/// Verdicts are true, or the reason why not as a text.

#include <string>

#include "exactvo/geometry/obstacle_shapes.h"

namespace exactvo::datasets {

/// The obstacle's identity, written before its shapes.
struct RecordHead {
  std::string file;     ///< as the user named it; empty: left out
  std::string id;       ///< the obstacle's own; empty: left out
  std::string outcome;  ///< "done", "repaired", "rejected"; empty: left out
};

/// The whole record: measurements, verdicts, problems and, with `geometry`, every shape. No newline at the end.
std::string to_json(const RecordHead& head, const geometry::ObstacleShapes& shapes, bool geometry = true);

}  // namespace exactvo::datasets
