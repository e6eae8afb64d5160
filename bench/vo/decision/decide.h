// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One decision, two ways. The obstacles stand still, so each half-plane is the robot's own to keep (responsibility 1).

#include "decision/scenes.h"

namespace exactvo::bench {

/// Certified half-planes and a velocity that was seen to keep each of them exactly: it lies in no velocity obstacle's
/// interior. Where none is found that does, the robot stops: standing still it meets nothing that stands still.
geometry::Vec2 proven_velocity(const Scene& scene);

/// Plain doubles throughout: plain half-planes and the textbook incremental linear program (de Berg et al., chapter 4),
/// no slack, no look at the answer.
geometry::Vec2 plain_velocity(const Scene& scene);

}  // namespace exactvo::bench
