// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What turning_motions.h and turning_pairs.h require of motions and bodies. Both throw `std::logic_error`.

#include "exactvo/geometry/turning_motions.h"

namespace exactvo::geometry::turned {

/// Finite numbers, times that do not fall.
void require_drive(const TurningMotion& m);

/// The parts, each with the corners of its hull counter-clockwise. REQUIRES: each has an interior.
RigidBody hulls_of(const RigidBody& body);

}  // namespace exactvo::geometry::turned
