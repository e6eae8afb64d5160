// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The inequalities (1)-(4) of certificate.h, evaluated exactly, for the writer and the checker of certificates. Knows
/// no solver.

#include <vector>

#include "exactvo/vo/lp/certificate.h"
#include "lp/proof/exact_points.h"

namespace exactvo::lp {

/// What a sum of constraints says: w.v >= offset.
struct Combination {
  bool well_formed = false;
  ExactVector normal{0, 0};
  Exact offset = 0;
  Exact giving = 0;  ///< sum of the multipliers of the constraints that may give
  Exact disc = 0;    ///< nu
};

/// Which constraints of a problem may be used, and which of those may give.
enum class Scope {
  all_must_hold,  ///< optimal
  soft_may_give,  ///< relaxed
  hard_may_give   ///< infeasible: soft ones are not to be used at all
};
Scope scope_of(Status status);

/// Whether it names a constraint, a finite side of the box or a finite disc, and not a soft one where soft ones are
/// out.
bool can_be_used(const Problem& problem, Binding binding, Scope scope);

/// Whether it may be violated. REQUIRES: it can be used.
bool may_give(const Problem& problem, Binding binding, Scope scope);

Combination combine(const Problem& problem, const std::vector<Term>& terms, Scope scope);

/// The half-plane of a constraint or of a side of the box.
HalfPlane half_plane_at(const Problem& problem, Binding binding);

/// Whether sigma(w) < limit (strict) or sigma(w) <= limit.
bool reaches_less(const SpeedBound& bound, const ExactVector& w, const Exact& limit, bool strict);

/// (1)
bool contradicts(const Problem& problem, const Combination& sum);
/// (2): no velocity that keeps the rest violates those that may give by less than `violation - gap`.
bool bounds_violation(const Problem& problem, const Combination& sum, double violation, double gap);
/// (3) or (4), as the objective is.
bool bounds_objective(const Problem& problem, const Combination& sum, Vec2 velocity, double gap);

}  // namespace exactvo::lp
