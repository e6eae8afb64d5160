// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/seeded_random.h"

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string>

namespace exactvo::test {

std::uint64_t SeededRandom::bits() {
  state_ += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

double SeededRandom::uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
}

int SeededRandom::integer(int low, int high) {
  return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1));
}

geometry::Vec2 SeededRandom::in_box(double half_width) {
  const double x = uniform(-half_width, half_width);
  return {x, uniform(-half_width, half_width)};
}

geometry::Vec2 SeededRandom::direction() {
  const double angle = uniform(-3.14159265358979, 3.14159265358979);
  return {std::cos(angle), std::sin(angle)};
}

std::uint64_t seed_of_run(std::uint64_t fallback) {
  const char* text = std::getenv("EXACTVO_TEST_SEED");
  const std::uint64_t seed = text ? std::stoull(text) : fallback;
  std::cout << "seed " << seed << " (set EXACTVO_TEST_SEED to change)\n";
  return seed;
}

}  // namespace exactvo::test
