// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Certificates of routes with one thing changed: a point, a name, a digit, a flag, the question. Most are wrong then;
/// some are still true, such as a chain of which two points in a row have been made one.

#include <string>
#include <vector>

#include "exactvo/geometry/route_certificate.h"
#include "route_fields.h"

namespace exactvo::test {

struct Certificate {
  geometry::RouteQuestion question;
  geometry::RouteAnswer answer;
};

struct Mutant {
  Certificate certificate;
  std::string change;  ///< what was changed, in two words
};

/// Another certificate than the one given, from one change that is drawn.
Mutant mutated(const std::vector<Obstacle>& obstacles, const Certificate& original, SeededRandom& random);

/// Everything in it in one line, numbers as hex floats.
std::string to_string(const Certificate& certificate);

}  // namespace exactvo::test
