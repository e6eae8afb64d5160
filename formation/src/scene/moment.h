// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "exactvo/formation/scenario.h"

namespace exactvo::formation::detail {

/// s: 1 s with the default horizons, and in proportion to the least one otherwise. Stalls, rests and pauses are
/// measured in it: a scene with all its times scaled runs as before, whatever its robots' speeds.
inline double moment(const Horizons& horizons) {
  return horizons.least / Horizons{}.least;
}

}  // namespace exactvo::formation::detail
