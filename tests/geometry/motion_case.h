// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Bodies in motion for tests: random and constructed cases, and their lines in the corpus.

#include <optional>
#include <string>
#include <vector>

#include "exactvo/geometry/motions.h"
#include "support/corpus.h"
#include "support/seeded_random.h"

namespace exactvo::test {

/// A body in motion against another, or against an obstacle.
struct MotionCase {
  geometry::Motion a;
  geometry::RigidBody body_a;
  std::optional<geometry::Motion> b;
  geometry::RigidBody body_b;
  std::optional<geometry::Obstacle> obstacle;
  /// What the construction says, if it says something.
  std::optional<geometry::Encounter> known;
};

geometry::Encounter encounter(const MotionCase& c);
geometry::MotionVerdict examine(const MotionCase& c);

/// `motion_pair MOTION BODY MOTION BODY` or `motion_obstacle MOTION BODY OBSTACLE`. MOTION is `-1 t x y t x y` or
/// `basis start end n x y ...`; BODY is `parts`, then of each part `radius n x y ...`; OBSTACLE is `0 n x y ...` for a
/// wall, `rings`, then of each ring `n x y ...`, for a polygon.
std::string corpus_line(const MotionCase& c);
/// Throws std::runtime_error for another kind or wrong counts.
MotionCase motion_case_of(const CorpusCase& line);

enum class MotionKind { discs, disc_and_edges, curved_discs, curved_edges, bodies };
inline constexpr MotionKind kMotionKinds[] = {MotionKind::discs, MotionKind::disc_and_edges, MotionKind::curved_discs,
                                              MotionKind::curved_edges, MotionKind::bodies};
const char* name_of(MotionKind kind);

/// Random and constructed cases in turn: near misses, exact contact in passing and at the ends, needles, coordinates of
/// 1e6 m, parallel and equal motions, no motion, no duration, spans that share one moment or none.
MotionCase random_motion_case(SeededRandom& random, MotionKind kind);

}  // namespace exactvo::test
