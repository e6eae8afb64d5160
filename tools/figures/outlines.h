// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the figures share: colours, and shapes as rings of points, for drawing only:
/// sampled finely enough for the eye, certified for nothing.

#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "exactvo/geometry/box.h"
#include "exactvo/geometry/half_plane.h"
#include "exactvo/geometry/motions.h"
#include "exactvo/geometry/shapes.h"
#include "exactvo/geometry/support.h"
#include "exactvo/geometry/twist.h"
#include "exactvo/geometry/vec2.h"

namespace exactvo::tools {

using geometry::Box;
using geometry::Vec2;

/// Colours that colour-blind readers can tell apart (Okabe and Ito, 2008; the yellow, too pale on white, left out).
inline const char* series_colour(std::size_t i) {
  static constexpr std::array<const char*, 7> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                          "#E69F00", "#56B4E9", "#555555"};
  return kColours[i % kColours.size()];
}

/// With series_colour: 28 line styles before one comes again. Empty for a solid line.
inline const char* series_dash(std::size_t i) {
  static constexpr std::array<const char*, 4> kDashes = {"", " dt (12,4)", " dt (3,3)", " dt (12,3,3,3)"};
  return kDashes[i / 7 % kDashes.size()];
}

/// How many colours, and how many line styles, there are.
inline constexpr std::size_t kColours = 7, kStyles = 28;

inline constexpr const char* kCollisionColour = "#e00000";
inline constexpr const char* kHitColour = "#a05a00";        ///< a robot that stood and was hit
inline constexpr const char* kSeparatorColour = "#b2182b";  ///< what separates a goal out of reach
inline constexpr const char* kRouteColour = "#0072B2";
inline constexpr const char* kGoalColour = "#CC79A7";
inline constexpr const char* kObstacleFill = "#c9ccd2";
inline constexpr const char* kObstacleLine = "#3f444d";

using Points = std::vector<Vec2>;

/// The boundary of a convex shape, counter-clockwise, first point not repeated.
Points outline(const geometry::ConvexShape& shape);

/// The boundary of a convex part of a body at a pose, grown by `grown` m.
Points hull_outline(const geometry::RoundedPolygon& part, const geometry::Pose& pose = {}, double grown = 0.0);

/// The boundary of S scaled by 1/tau: the points of the velocity plane that reach S at exactly time tau.
Points scaled_outline(const geometry::GrownShape& s, double tau);

/// One closed path: the outer ring with each hole tied to it by a bridge walked there and back, which no filling shows.
/// What lies in a hole is not painted over.
Points tied_together(const geometry::Polygon& polygon);

/// The corners of the box, counter-clockwise.
Points corners(const Box& box);

/// What of a convex ring lies in the half-plane (Sutherland and Hodgman); empty where nothing does.
Points clipped(const Points& convex_ring, const geometry::HalfPlane& keep);

/// What of any ring lies in the box. The pieces of a ring that is not convex stay joined by stretches along the box's
/// sides: right for filling, wrong for an outline.
Points clipped_to(const Points& ring, const Box& keep);

/// The stretch of a segment that lies in the box; empty where none does.
Points segment_within(const Box& box, Vec2 a, Vec2 b);

/// The stretch of a half-plane's boundary that lies in the box; empty where none does.
Points boundary_within(const Box& box, const geometry::HalfPlane& half_plane);

/// The stretch of a line between two points that half-planes keep, up to 1e-9; empty where none does, or of no line.
Points stretch_within(const std::vector<geometry::HalfPlane>& all, const Points& line);

/// Strokes from a boundary into its forbidden side, aslant, `gap` apart; `normal` points into the allowed side.
std::vector<Points> hatching(const Points& boundary, Vec2 normal, double gap);

/// The two directions at which the support of S changes sign: outward normals of the legs, of length 1, the left one
/// seen from the origin first. Nothing where the origin lies in S, so that there is no cone.
std::optional<std::pair<Vec2, Vec2>> leg_normals(const geometry::GrownShape& s);

/// The truncated velocity obstacle { v : t (v - shift) in S, 0 < t <= tau } within a box: the box cut by
/// n.(v - shift) <= h_S(n)/tau for many n with h_S(n) <= 0. Empty where the origin lies in S or nothing is in view.
Points velocity_obstacle_in(const Box& box, const geometry::GrownShape& s, double tau, Vec2 shift);

// --- Curves without the points that make no difference to the eye: long runs of many robots have hundreds of thousands
// of points a figure, which gnuplot reads and writes once for each format ---

/// A figure of fewer points has all of them: its data file is read by people too.
inline constexpr std::size_t kMostWholePoints = 20'000;

/// px of the SVG: how far a thinned curve may lie from a point that it leaves out.
inline constexpr double kThinning = 0.1;

/// Which points of a curve are drawn, ascending: the first, the last, and so many that every point lies within
/// kThinning of the stretch that stands for it (Douglas and Peucker 1973). `curve` in px, all finite.
std::vector<std::size_t> drawn_points(const Points& curve);

/// All of them: 0, ..., count - 1.
std::vector<std::size_t> all_points(std::size_t count);

}  // namespace exactvo::tools
