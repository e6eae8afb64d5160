// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Distances in metres. Those that are doubles are rounded to nearest, to neither side; `rounding_of_distance` bounds
/// by how much. Questions (does it meet, where does it lie) are exact.

#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::geometry {

/// The point of the segment nearest to x.
Vec2 nearest_point(const Segment& s, Vec2 x);
/// From x to that point, m.
double distance(const Segment& s, Vec2 x);

/// Whether the closed segments have a point in common. Exact.
bool intersect(const Segment& s, const Segment& t);

/// 0 where the segments meet (decided exactly).
double distance(const Segment& s, const Segment& t);

/// From x to the obstacle's edges; negative (minus the depth) inside a polygon.
double signed_distance(const Obstacle& obstacle, Vec2 x);

/// The least signed distance from the points of the motion `path` (a straight step) to the obstacle: swept, not
/// sampled. Inside a polygon at either end it is the smaller of the ends' signed distances; a step across an edge gives
/// <= 0.
double swept_distance(const Obstacle& obstacle, const Segment& path);

/// The least distance between two points that move straight and uniformly over the same time.
double swept_distance(const Segment& path_a, const Segment& path_b);

/// By how much any distance of this header may be off, up or down, where no coordinate of its arguments is larger in
/// magnitude than `largest_coordinate` (m, finite, >= 0): subtracted from a computed distance it leaves a certified
/// lower bound. It is 2^-46 of the coordinate: a tenth of a nanometre 10 km out. The derivation stands in distance.cpp.
double rounding_of_distance(double largest_coordinate);

/// Where x lies by the even-odd rule over all rings. Exact.
Place locate(const Polygon& polygon, Vec2 x);

/// Whether x lies in the polygon; the boundary counts as inside. Exact.
bool contains(const Polygon& polygon, Vec2 x);

}  // namespace exactvo::geometry
