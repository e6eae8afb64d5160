// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What is done with MPI, as one table of functions on whole numbers and bytes: a program either links them or loads
/// them when it runs in ranks (modules/loader.cpp). A failure in one rank ends all of them, as a scheduler expects.

#include <cstddef>

namespace exactvo::datasets {

struct RankLibrary {
  /// Joins the other ranks; `leave` before the process ends.
  void (*join)();
  void (*leave)();
  int (*rank)();
  int (*size)();
  /// From the first rank to all.
  long (*broadcast)(long value);
  /// Each value becomes the least that any rank gives.
  void (*least_of_each)(long* values, int count);
  /// Rank r has filled the bytes from ends[r - 1] (of rank 0: 0) to ends[r]; then all have all.
  void (*share)(char* bytes, const std::size_t* ends);
  /// The same, but only the first rank has all. The others give their own bytes alone, and it puts them together.
  void (*gather)(char* bytes, const std::size_t* ends);
  /// From the first rank to all.
  void (*broadcast_bytes)(char* bytes, std::size_t count);
};

/// Throws DataError (E_FORMAT_UNAVAILABLE) where a program loads it and cannot.
const RankLibrary& rank_library();

}  // namespace exactvo::datasets
