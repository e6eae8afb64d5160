// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The proof of a half-plane as a value: written, read and checked by code that shares nothing with the construction
/// but the plain types. The check is done in rationals (GMP), without any filter: microseconds, not nanoseconds.
///
/// What is claimed: { v : normal.v >= offset } is disjoint from the interior of
/// { w + u : t w in S, 0 < t <= time_horizon }, S = (shape - position) (+) D(0, radius), u = shape_velocity; which
/// holds iff h_S(normal) <= 0 and h_S(normal) <= time_horizon (offset - normal.u) (docs/guide/velocity-obstacles.md).
///
/// Properties (tests quote the numbers):
///  (1) read_certificate(write_certificate(c)) == c, bit for bit;
///  (2) check(c) is `valid` for every c of `certify`;
///  (3) a certificate of which any number was changed, by an ulp or more, is not valid: a change of the half-plane or
///  of
///      what it touches shows in the margin, any other in the digest. (The digest guards against accidents, not against
///      a forger that computes it anew; the margin guards against both.)

#include <cstdint>
#include <optional>
#include <string>

#include "exactvo/geometry/half_plane.h"
#include "exactvo/geometry/shapes.h"

namespace exactvo::vo {

/// What is claimed of a half-plane, with all that the claim depends on.
struct HalfPlaneClaim {
  geometry::ConvexShape shape;     ///< m
  geometry::Vec2 position;         ///< m, of the robot
  double radius = 0.0;             ///< m, >= 0, of the robot
  double time_horizon = 0.0;       ///< s, > 0, may be infinite
  geometry::Vec2 shape_velocity;   ///< m/s
  geometry::HalfPlane half_plane;  ///< claimed to be disjoint from the interior of the velocity obstacle
};

/// A claim with the numbers that show it to be true and unchanged.
struct Certificate {
  HalfPlaneClaim claim;      ///< what is proven
  double margin = 0.0;       ///< m: the largest double <= min(0, time_horizon (offset - normal.u)) - h_S(normal); >= 0
  std::uint64_t digest = 0;  ///< FNV-1a of the bits of every other number
};

/// Whether the claim is true. Exact, in rationals. REQUIRES: nothing; a claim with a NaN, another infinity, a negative
/// radius or a horizon that is not positive is not true.
bool is_true(const HalfPlaneClaim& claim);

/// Nothing where the claim is not true.
std::optional<Certificate> certify(const HalfPlaneClaim& claim);

/// What a check came to.
enum class Verdict {
  valid,        ///< the claim is true, and nothing was changed
  malformed,    ///< a NaN, an infinity, a negative length, no vertices, a zero normal
  altered,      ///< the digest does not fit
  wrong_margin  ///< the margin is not the one of these numbers, or is negative: the claim is not true
};
/// Checks in rationals, from the certificate alone. Exact.
Verdict check(const Certificate& certificate);
/// "valid", "malformed", "altered", "wrong margin".
const char* name(Verdict verdict);

/// One line of words and hex floats, without a newline.
std::string write_certificate(const Certificate& certificate);
/// Nothing where the text is not exactly one certificate.
std::optional<Certificate> read_certificate(const std::string& text);
/// A shape as it stands in a certificate (`geometry::to_string`). Nothing where the text is not exactly one.
std::optional<geometry::ConvexShape> read_shape(const std::string& text);

}  // namespace exactvo::vo
