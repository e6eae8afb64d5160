// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Many problems at once, one a SIMD lane (Highway picks the widest target at run time: SSE4, AVX2, AVX-512, NEON).
///
/// The same search as `solve`: the most violated line enters, the optimum of the working set of a few lines
/// follows. Lanes never mix and no operation is fused, so in double every target and every number of threads gives the
/// same bits. Rounded inward like `solve`; a verdict is heuristic in the last digits. Lanes that the lockstep search
/// cannot settle (too many rounds, contradicting hard lines, speeds whose squares leave the range of T: below 2^-200 or
/// above 2^250 m/s, of float 2^-25 and 2^30) go to `solve`. Float answers from there are moved inward once
/// more, by up to three steps of float, and are `no_interior` where that does not do.

#include <cstddef>
#include <cstdint>

#include "exactvo/vo/lp/solution.h"

namespace exactvo::lp {

/// Structure of arrays in blocks of `block` problems: line k of problem i stands at
///   [(i / block) * block * lines + k * block + i % block],
/// so that neighbours share a register. Blocks of 16 or 32 keep a problem's lines in few pages and are fastest; one
/// block for all (block >= count) is the plain structure of arrays, whose lines should not lie a power of two apart.
/// Arrays that begin at a multiple of 64 bytes are read at full width, others at about half of it.
/// Nothing is copied. Problems with fewer lines are padded with lines that always hold: normal (1, 0), offset -1e30.
template <class T>
struct BatchProblems {
  std::size_t count = 0;               ///< problems
  std::size_t lines = 0;               ///< lines each, padding included
  std::size_t block = 0;               ///< a multiple of 16, or at least `count`
  const T* normal_x = nullptr;         ///< with normal_y
  const T* normal_y = nullptr;         ///< | |normal| - 1 | <= 2^-10: the slack is reckoned for that
  const T* offset = nullptr;           ///< m/s
  const T* preferred_x = nullptr;      ///< with preferred_y
  const T* preferred_y = nullptr;      ///< m/s, [i]
  const T* disc = nullptr;             ///< m/s, [i], finite, > 0
  const std::int32_t* hard = nullptr;  ///< [i]: the number of hard lines, which come first; null: none
};

/// Index of nothing in `active`.
inline constexpr std::int32_t kNoLine = -1;

/// Where answers are written, arrays of the caller's.
template <class T>
struct BatchAnswers {
  T* velocity_x = nullptr;         ///< m/s, [i]
  T* velocity_y = nullptr;         ///< m/s, [i]
  T* violation = nullptr;          ///< m/s, [i], as Solution::violation, up to 8 u disc
  std::uint8_t* status = nullptr;  ///< [i], a Status
  std::int32_t* active = nullptr;  ///< [3 * stride], line indices or kNoLine; may be null
  std::size_t stride = 0;          ///< between the three rows of `active`, at least `count`
  /// [i], double only, may be null. Where given, every lane is proven in the same pass (inequalities (1), (2) and (4)
  /// of certificate.h, rounding errors included); lanes that are not proven go to `solve_certified`. 1: proven, 0: see
  /// Proven.
  std::uint8_t* proven = nullptr;
};

/// How many problems left the lockstep search.
struct BatchCounts {
  std::size_t scalar = 0;  ///< problems that the lockstep search handed to `solve`
  std::size_t exact = 0;   ///< those among them that needed exact arithmetic; only with `proven`
};

/// Solves problems first .. last - 1 on the caller's thread. T is double or float. REQUIRES: finite numbers as
/// described.
template <class T>
BatchCounts solve_batch(const BatchProblems<T>& problems, const BatchAnswers<T>& answers, std::size_t first,
                        std::size_t last);

/// All problems, on oneTBB's threads. The same bits as on one.
template <class T>
BatchCounts solve_batch_parallel(const BatchProblems<T>& problems, const BatchAnswers<T>& answers);

/// The name of the target that runs ("AVX3", "AVX2", "SSE4", ...).
const char* batch_target();

}  // namespace exactvo::lp
