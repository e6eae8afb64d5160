// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The least clearance of a question in plain doubles: a guess, which exact questions then confirm.

#include "motions/question.h"

namespace exactvo::geometry::motions {

struct Nearest {
  double clearance = 0.0;  ///< m, rounded; no less than -reach
  double time = 0.0;       ///< s
  Vec2 place;              ///< m
  double size = 0.0;       ///< m, of the lengths whose rounding counts
  double reach = 0.0;      ///< m, the largest reach, rounded up: no clearance is below its negative
};

/// REQUIRES: `over` is a part of the question's window.
Nearest nearest_of(const Question& q, Window over);

}  // namespace exactvo::geometry::motions
