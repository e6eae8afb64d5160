// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ogr_geometry.h>

#include <functional>
#include <string>
#include <vector>

#include "readers/raw_geometry.h"

namespace exactvo::datasets {

/// The lines and polygons inside a geometry of any kind, in order, and a word about what else is there.
struct Visitor {
  std::function<void(RawKind, std::vector<geometry::Ring>)> shape;
  std::function<void(const std::string&)> other;
};

void visit(const OGRGeometry& geometry, const Visitor& visitor, int depth = 0);

}  // namespace exactvo::datasets
