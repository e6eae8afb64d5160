// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Bodies that drive and turn against an oracle of 50 digits, which looks at every moment at which a gap can change its
/// sign, and between any two of them: random and constructed cases.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "exactvo/geometry/turning_motions.h"
#include "geometry/motion_judge.h"
#include "support/seeded_random.h"

namespace exactvo::test {

/// A body on a twist, and what stands there.
struct TurningCase {
  geometry::TurningMotion motion;
  geometry::RigidBody body;
  geometry::RoundedPolygon piece;
};

/// The hull of this many points in a box of this half side.
std::vector<geometry::Vec2> random_hull(SeededRandom& random, int least, int most, double size);

/// All numbers, losslessly.
std::string line_of(const TurningCase& c);

enum class TurningKind { twists, drives, turning_polygons, full_turns };
inline constexpr TurningKind kTurningKinds[] = {TurningKind::twists, TurningKind::drives, TurningKind::turning_polygons,
                                                TurningKind::full_turns};
const char* name_of(TurningKind kind);

/// Random and constructed cases in turn: exact contact in passing, or an ulp beside it, needles, coordinates of 1e6 m,
/// circles as wide as the earth, whole turns to an ulp.
TurningCase random_turning_case(SeededRandom& random, TurningKind kind);

/// The verdict, beside a wall, a polygon or a body; with `proof_too` the certificate as well (`clearances` counts
/// them).
void judge_turning(const TurningCase& c, MotionCampaign& campaign, bool proof_too);
MotionCampaign judge_turnings(TurningKind kind, std::size_t count, std::uint64_t seed, std::size_t proof_of_each);

}  // namespace exactvo::test
