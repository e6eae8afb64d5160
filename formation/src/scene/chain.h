// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A footprint that turns, beside obstacles. The reference point p drives at u and brakes within p + [0, tau] u, and
/// the heading turns from e towards u, by less than a half turn and never back (differential.h). A disc at d behind p
/// is then within {p + s u - d e' : s in [0, tau], e' between e and u / |u|}, however fast the heading turns.
///
/// Suffix lemma: after a step at u the same set for lambda u is a part of it: p + T u + [0, tau] lambda u is a part of
/// the way, and the new heading lies between e and u / |u|. So what is clear for u stays clear while the robot brakes.

#include "exactvo/formation/scenario.h"
#include "scene/free_space.h"

namespace exactvo::formation::detail {

/// m: room that discs of a chain keep beside their radius, so that an audit can prove them clear.
inline constexpr double kRoomOfLinks = 2e-4;

/// Whether every disc of the chain but the first, which half-planes are about, keeps `kRoomOfLinks` from what stands,
/// wherever a robot at p = `at` may come that drives at `u` and then brakes. Rounded, by far less than that room. True
/// without a chain.
bool links_are_clear(const FreeSpace& space, const DifferentialDrive& drive, Vec2 at, Vec2 heading, Vec2 u,
                     double braking_time);

}  // namespace exactvo::formation::detail
