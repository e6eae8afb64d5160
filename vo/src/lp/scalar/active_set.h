// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The active-set searches of the scalar double solver: in each round the line that is violated most enters, of equal
/// ones the first. Heuristic at the last digit: their verdicts are proven elsewhere (certificate.h). Every search ends
/// after kMostRounds at the latest, whatever the numbers.

#include "lp/problem/region.h"

namespace exactvo::lp {

/// A search visits one basis a round and the objective grows with each; random and recorded problems need at most a
/// dozen rounds, tangents of a circle about log m.
inline constexpr int kMostRounds = 1000;

struct Found {
  bool feasible = false;
  Vec2 velocity;
  Basis basis;  ///< of the optimum, or a witness of the contradiction
};

/// The optimum of `objective` over the lines (hard and soft alike) and the disc of `region`. REQUIRES: for a linear
/// objective a finite disc, or lines that leave only speeds up to `region.speed`.
/// `priced`, where given, gets the velocities at which the most violated line was looked for.
Found best_velocity(const Region& region, Objective objective, Vec2 preferred, std::vector<Vec2>* priced = nullptr);

/// The velocity that keeps the hard lines and the disc and violates the soft ones least. `feasible` is false where the
/// hard lines left nothing.
/// A region without a disc is copied into `with_disc`, which gets one.
Found least_violation(const Region& region, Region& with_disc);

}  // namespace exactvo::lp
