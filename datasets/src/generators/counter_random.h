// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Random numbers by counting (SplitMix64; Steele, Lea and Flood, 2014): draw n of a key is a function of the two, the
/// same on every machine. No standard distributions, whose results the standard leaves open.

#include <algorithm>
#include <cstdint>

namespace exactvo::datasets {

inline constexpr std::uint64_t kRandomStride = 0x9e3779b97f4a7c15ULL;

/// SplitMix64's output function: a bijection that mixes every bit.
inline std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// The key of item k of a stream of a seed.
inline std::uint64_t random_key(std::uint64_t stream, std::uint64_t k, std::uint64_t seed) {
  return mixed(mixed(seed + stream * kRandomStride) + k * kRandomStride);
}

class CounterRandom {
 public:
  explicit CounterRandom(std::uint64_t key) : key_(key) {}

  double uniform(double low, double high) {
    constexpr double kScale = 0x1p-53;
    return low + (high - low) * static_cast<double>(bits() >> 11) * kScale;
  }
  /// Both ends included.
  int integer(int low, int high) { return std::min(high, low + static_cast<int>(uniform(0.0, high - low + 1))); }
  bool coin() { return (bits() >> 63) != 0; }

 private:
  std::uint64_t bits() { return mixed(key_ + (++count_) * kRandomStride); }

  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

}  // namespace exactvo::datasets
