// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Random numbers for tests: the same on every machine, seed logged by `seed_of_run`.

#include <cstdint>

#include "exactvo/geometry/vec2.h"

namespace exactvo::test {

/// Counter-based (SplitMix64): number k of stream `seed` is the same everywhere.
class SeededRandom {
 public:
  explicit SeededRandom(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  double uniform(double low, double high);
  int integer(int low, int high);  ///< both ends included
  geometry::Vec2 in_box(double half_width);
  geometry::Vec2 direction();  ///< |n| = 1 up to rounding

 private:
  std::uint64_t state_;
};

/// EXACTVO_TEST_SEED from the environment, or `fallback`; printed, so that a failure can be run again.
std::uint64_t seed_of_run(std::uint64_t fallback);

}  // namespace exactvo::test
