// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the inequalities (1)-(4) of certificate.h leave open, enclosed without integers of any length: in doubles,
/// which rejects most of what proves nothing, then in 106 bits, which settles nearly all. Certified: the value lies
/// within the bounds. Shares nothing with `check`, which multiplies out in rationals.

#include <array>
#include <cstddef>
#include <optional>

#include "exactvo/vo/lp/problem.h"
#include "lp/proof/duality.h"

namespace exactvo::lp {

/// At most three constraints, sides of the box or the disc, and a multiplier each.
struct Multipliers {
  std::array<Binding, 3> binding{};
  std::array<double, 3> value{};  ///< finite, 0 or more
  std::size_t count = 0;
  void add(Binding b, double multiplier = 0.0) {
    binding[count] = b;
    value[count++] = multiplier;
  }
};

struct Bounds {
  double low, high;
};

enum class Digits { of_double, twice };

/// What an answer claims: its velocity, and for `Scope` other than all_must_hold its violation.
struct Claim {
  Vec2 velocity;           ///< m/s
  double violation = 0.0;  ///< m/s
};

/// The least gap with which `m` proves the claim by (2), (3) or (4), as scope and objective are. Nothing where rounding
/// cannot tell: a number that is neither 0 nor within [2^-150, 2^150], a speed bound that is infinite where the sum of
/// normals does not vanish for certain, or a sum of giving multipliers that may be 0.
/// REQUIRES: constraints that exist and may be used in `scope`.
std::optional<Bounds> rounded_gap(const Problem& problem, const Multipliers& m, Scope scope, const Claim& claim,
                                  Digits digits);

/// C - sigma(w) of (1): `m` contradicts where that is positive. Nothing where rounding cannot tell, as above.
std::optional<Bounds> rounded_surplus(const Problem& problem, const Multipliers& m, Scope scope);

}  // namespace exactvo::lp
