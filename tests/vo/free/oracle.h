// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What is free, found in another way than free_arrangement.h finds it, sharing nothing with it but the scene.
///
/// The faces of F: every front's circles and edges, both legs and the circle of the speed as *whole* circles and lines
/// (which part of a curve bounds something is asked of samples, not of the construction), with a line through each
/// circle's centre so that all is connected; their common points in 664 bits; round each point the curves sorted by
/// where they leave a circle of radius 2^-150 (tangent ones part there without a rule for ties); both sides of each
/// stretch sampled 2^-200 beside its middle; sides that share a sector, a free stretch or a free point united. Numbers
/// of a scene are doubles of moderate size: what is algebraic of them and not 0 is far above the 2^-300 that is asked
/// for, what is 0 comes out below 2^-380. Between the two `Ambiguous` is thrown.
///
/// Membership: in rationals, by the distance of the swept segment from the hull of the points.

#include <stdexcept>
#include <string>
#include <vector>

#include "vo/free/scene.h"

namespace exactvo::test {

struct Ambiguous : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A component of F. The numbers are brackets no wider than an ulp or two.
struct OracleFace {
  double area_low = 0.0, area_high = 0.0;
  double perimeter = 0.0;
};

/// The components, largest first. REQUIRES: no cone overlaps the robot.
std::vector<OracleFace> free_faces(const FreeScene& scene);

/// Whether |v| <= max_speed and v lies in no cone. In rationals. REQUIRES: no cone overlaps the robot.
bool is_free(const FreeScene& scene, geometry::Vec2 v);

/// What is wrong with FreeArrangement's answer to the scene; empty where nothing is. `random` places the samples.
std::string difference_from_oracle(const FreeScene& scene, SeededRandom& random);

}  // namespace exactvo::test
