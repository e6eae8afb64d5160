// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where the lines of a problem stand in the arrays of a batch.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "exactvo/vo/lp/batch.h"

namespace exactvo::lp {

/// The widest register holds so many numbers (float, 512 bits); blocks are multiples of it, so no pack crosses one.
inline constexpr std::size_t kMostLanes = 16;

template <class T>
std::size_t first_line_of(const BatchProblems<T>& in, std::size_t i) {
  return i / in.block * in.block * in.lines + i % in.block;
}

/// Rounds after which a lane is left to the scalar solver; recorded problems need at most a dozen.
inline constexpr int kMostLockstepRounds = 40;

/// Where a thread keeps its unfinished problems: kept between calls.
template <class T>
T* conveyor_memory(std::size_t numbers) {
  thread_local std::vector<T> memory;
  if (memory.size() < numbers) memory.resize(numbers);
  return memory.data();
}

}  // namespace exactvo::lp
