// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where the lines of a problem stand in the arrays of a batch.

#include <cstddef>
#include <vector>

#include "exactvo/vo/lp/batch.h"

namespace exactvo::lp {

/// The widest register holds so many numbers (float, 512 bits); blocks are multiples of it, so no pack crosses one.
inline constexpr std::size_t kMostLanes = 16;

template <class T>
std::size_t first_line_of(const BatchProblems<T>& in, std::size_t i) {
  return i / in.block * in.block * in.lines + i % in.block;
}

/// What the searches allow for rounding, in units of u V: lines are moved inward by the slack, 16 u V for any vertex of
/// unit normals (region.h) and half of that again for normals that are not quite of unit length; what is left over of a
/// violation after a step is noise up to 8 u V, which leaves 16 u V of the slack; the disc shrinks by as much.
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
