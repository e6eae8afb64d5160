// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Proofs that a moving body stays clear, and their check in rationals by code of its own.
///
/// A certificate divides time into pieces. For each piece, and for each pair of convex parts, it names a direction n
/// such that the moving part stays on n's side of the other part by a margin. The difference of the reference points is
/// a polynomial; its component along n lies within its Bernstein coefficients, so finitely many comparisons prove a
/// piece:
///
///     least coefficient of n.(a(t) - b(t))  >=  max over corners v of n.v + (reach + margin) |n|
///
/// Exact: `proves_clear` accepts only what is true. A body that only touches has no certificate.

#include <cstddef>
#include <optional>
#include <vector>

#include "exactvo/geometry/motions.h"

namespace exactvo::geometry {

/// One pair of convex parts over one piece of time.
struct Separation {
  std::size_t part = 0;   ///< of the moving body
  std::size_t other = 0;  ///< part of the other body, or edge of the obstacle (in the order of `edges_of`)
  double from = 0.0;      ///< s
  double to = 0.0;        ///< s
  Vec2 direction;         ///< from the other to the moving part, of any length but 0
  double margin = 0.0;    ///< m, >= 0: they stay at least this far apart along the direction
};

/// A proof that a moving body stays clear.
struct MotionCertificate {
  /// Sorted by `part`, then by `other`, then by time. The separations of each pair of parts cover, without a gap, the
  /// time that the two motions have in common; empty if they have none.
  std::vector<Separation> separations;
};

/// A proof that the two stay clear; none if they touch or overlap, or if they are so near to touching that 2^40 pieces
/// of time are not enough. REQUIRES: as `encounter`.
std::optional<MotionCertificate> certify(const Motion& a, const RigidBody& body_a, const Motion& b,
                                         const RigidBody& body_b);
/// The same against an obstacle.
std::optional<MotionCertificate> certify(const Motion& a, const RigidBody& body_a, const Obstacle& obstacle);

/// Whether the certificate proves that the two stay clear. Exact, in rationals. REQUIRES: as `encounter`.
bool proves_clear(const MotionCertificate& certificate, const Motion& a, const RigidBody& body_a, const Motion& b,
                  const RigidBody& body_b);
/// The same against an obstacle; that a part does not begin inside a polygon is decided by the even-odd rule.
bool proves_clear(const MotionCertificate& certificate, const Motion& a, const RigidBody& body_a,
                  const Obstacle& obstacle);

}  // namespace exactvo::geometry
