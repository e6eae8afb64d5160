// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Scenes for free_arrangement.h as plain data: made by class, written to the corpus and read back.

#include <string>
#include <vector>

#include "exactvo/vo/family.h"
#include "support/corpus.h"
#include "support/seeded_random.h"

namespace exactvo::test {

struct SceneCone {
  geometry::ConvexShape shape;        ///< m, seen from the robot; no ellipse
  double radius = 0.0;                ///< m, of the robot; ignored where it is a polygon
  std::vector<geometry::Vec2> robot;  ///< a convex polygon; empty: a disc
  double time_horizon = 1.0;          ///< s, may be infinite
  geometry::Vec2 apex;                ///< m/s
};

struct FreeScene {
  double max_speed = 1.0;  ///< m/s
  std::vector<SceneCone> cones;
};

vo::ShiftedCone cone_of(const SceneCone& cone);
std::vector<vo::ShiftedCone> cones_of(const FreeScene& scene);

/// "free_scene ...", lossless; without a newline.
std::string corpus_line(const FreeScene& scene);
/// Throws std::runtime_error for another kind or a wrong count.
FreeScene free_scene_of(const CorpusCase& corpus_case);

/// The ways in which curves of a scene can touch, coincide or meet.
enum class SceneClass {
  generic,           ///< every kind of shape and robot, nothing special
  walls,             ///< radius 0, a polygon and two walls, some moving
  lattice,           ///< small integers throughout
  tangent_fronts,    ///< fronts that touch from outside or from inside, also three in a point
  shared_legs,       ///< obstacles of one homothety, so that legs coincide
  apex_on_boundary,  ///< apices on the legs, fronts or apices of other cones
  walls_in_line,     ///< walls and points that the robot sees end on: cones without area
  parallel_legs,     ///< one shape, several velocities
  concurrent,        ///< legs of many cones through one point
  speed_circle,      ///< fronts, legs and apices that touch the circle of the speed
  polygonal_robots,  ///< on integers
  nudged,            ///< one of the others, its numbers moved by a few ulps
};
inline constexpr int kSceneClasses = 12;
const char* name(SceneClass scene_class);

/// No cone overlaps the robot; at most five cones.
FreeScene random_scene(SeededRandom& random, SceneClass scene_class);

}  // namespace exactvo::test
