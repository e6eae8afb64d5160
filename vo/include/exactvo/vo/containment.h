// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The proof that an ellipse contains points, as a value: what makes a half-plane of the ellipse one of everything that
/// the points are the hull of. Written, read and checked by code that shares nothing with what found the ellipse, in
/// rationals (GMP), as certificate.h does for half-planes.
///
/// What is claimed: |L^-1 (x - c)|^2 <= 1 for every point x, L = [l11 0; l21 l22] not singular.
///
/// Properties (tests quote the numbers):
///  (1) read_containment(write_containment(c)) == c, bit for bit;
///  (2) check(c) is `valid` for every c of `certify_containment`;
///  (3) a certificate of which any number was changed is not valid, unless margin and digest are made anew.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/vo/certificate.h"

namespace exactvo::vo {

/// That an ellipse contains points, with the numbers that show it.
struct Containment {
  geometry::Ellipse ellipse;           ///< m
  std::vector<geometry::Vec2> points;  ///< m, at least one
  double margin = 0.0;                 ///< the largest double <= 1 - max |L^-1 (x - c)|^2; >= 0
  std::uint64_t digest = 0;            ///< FNV-1a: of c, L, the number of points, the points, the margin
};

/// Nothing where a point is not contained, no point is given, a number is not finite or L is singular. Exact.
std::optional<Containment> certify_containment(const geometry::Ellipse& ellipse, std::vector<geometry::Vec2> points);

/// Checks in rationals, from the certificate alone. Exact.
Verdict check(const Containment& certificate);

/// "containment-certificate 1 ellipse cx cy l11 l21 l22 points k x1 y1 ... margin m digest d", hex floats.
std::string write_containment(const Containment& certificate);
/// Nothing where the text is not exactly one.
std::optional<Containment> read_containment(const std::string& text);

}  // namespace exactvo::vo
