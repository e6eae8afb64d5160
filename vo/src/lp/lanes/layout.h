// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where the lines of a problem stand in the arrays of a batch.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "exactvo/vo/lp/batch.h"

namespace exactvo::lp {

/// The widest register holds this many numbers (float, 512 bits); blocks are multiples of it, so no pack crosses one.
inline constexpr std::size_t kMostLanes = 16;

template <class T>
std::size_t first_line_of(const BatchProblems<T>& in, std::size_t i) {
  return i / in.block * in.block * in.lines + i % in.block;
}

/// What the searches allow for rounding, in units of u V: lines are moved inward by the slack. A vertex of unit normals
/// misses its lines by up to 2.1 u V where measured; with a bound of (1 + 2) u for the dot product on either side and
/// the division of the intersection, 16 u V covers every well-conditioned one, and half of that again normals that are
/// not quite of unit length. What is left over of a violation after a step is noise up to 8 u V, which leaves 16 u V of
/// the slack; the disc shrinks by as much.
inline constexpr double kSlackUnits = 24.0, kNoiseUnits = 8.0, kDiscUnits = 8.0;

/// A velocity whose |v|^2 is within this share of the disc's is said to lie on it: kWidestGap (certificate.h).
inline constexpr double kOnDisc = 0x1p-40;

/// The range in which squares of speeds, and products of two such squares, are ordinary numbers of T with all their
/// digits. Lanes whose disc or preferred velocity leaves it go to `solve`.
template <class T>
inline constexpr T kLeastSquare = static_cast<T>(sizeof(T) == 8 ? 0x1p-400 : 0x1p-50);
template <class T>
inline constexpr T kMostSquare = static_cast<T>(sizeof(T) == 8 ? 0x1p500 : 0x1p60);

/// Added to a slope of two lines: lost in all but 0, for which it stands. Far below u, far above the least number.
template <class T>
inline constexpr T kParallel = static_cast<T>(sizeof(T) == 8 ? 1e-300 : 1e-36);

/// The number of a line stands in this many last digits of its violation; 2^16 of them leave it 36.
inline constexpr std::size_t kMostNumbered = std::size_t{1} << 16U;

/// A violation as the search of one problem compares it with another, the later line first among equals.
inline double without_last_digits(double violation) {
  std::uint64_t digits = 0;
  std::memcpy(&digits, &violation, sizeof digits);
  digits &= ~std::uint64_t{kMostNumbered - 1};
  std::memcpy(&violation, &digits, sizeof digits);
  return violation;
}

/// Rounds after which a lane is left to `solve`; recorded problems need at most a dozen.
inline constexpr int kMostLockstepRounds = 40;

/// Where a thread keeps its unfinished problems: kept between calls.
template <class T>
T* conveyor_memory(std::size_t numbers) {
  thread_local std::vector<T> memory;
  if (memory.size() < numbers) memory.resize(numbers);
  return memory.data();
}

}  // namespace exactvo::lp
