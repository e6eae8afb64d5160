// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the units of the crowd engine hand to each other: tables of candidates, ranked neighbours, half-planes.

#include <boost/align/aligned_allocator.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace exactvo::formation::crowd {

/// Robots that share a list of candidates, next to each other in the sorted order. The same on every target.
inline constexpr std::size_t kPack = 16;
/// Problems that go to the linear program together: it keeps six registers of sixteen floats under way.
inline constexpr std::size_t kGroupPacks = 6, kSlots = kGroupPacks * kPack;
/// A candidate's number rides in the low bits of its squared distance.
inline constexpr std::size_t kMostCandidates = 256;
inline constexpr std::int32_t kIndexBits = 0xFF;
/// A robot's kind rides in the low bits of its tag.
inline constexpr std::int32_t kKindBits = 0x3FFF;
inline constexpr int kMostNeighbours = 15, kMostRanks = kMostNeighbours + 1;
/// Edges and bodies at rest that a robot of a pack has half-planes against; a robot with more is decided alone.
inline constexpr std::size_t kMostEdges = 12;
/// The same for bodies that move.
inline constexpr std::size_t kMostMoving = 4;
/// Arrays of robots end with this many entries of no robot, so that whole registers may be read.
inline constexpr std::size_t kPadding = 64;
/// Coordinates stay below it, so that differences fit 32 bits.
inline constexpr std::int32_t kLatticeEnd = 1 << 30;
/// Lattice steps that a robot or a body makes in a time step at most.
inline constexpr double kLongestMotion = 0x1p22;
/// Half the diagonal of a square with side 1, sqrt(1/2) rounded up: what rounding to the lattice adds in both
/// coordinates.
inline constexpr double kHalfDiagonal = 0.7072;
/// An offset that always holds.
inline constexpr double kNever = -1e30;

/// m: the finest lattice that reaches as far as `reach` (m), and on which `way` (m, the longest in a time step) is at
/// most kLongestMotion steps.
inline double lattice_for(double reach, double way) {
  double step = 0x1p-18;
  while (step < 1.0 && (reach >= kLatticeEnd * step || way > kLongestMotion * step)) step *= 2.0;
  return step;
}

/// Begins with a line of the cache.
template <class A>
using Array = std::vector<A, boost::alignment::aligned_allocator<A, 64>>;

/// Robots of some stretches of the sorted order, side by side, in that order.
struct Candidates {
  static constexpr std::size_t kRoom = kMostCandidates + kPadding;
  alignas(64) std::int32_t x[kRoom], y[kRoom], mx[kRoom], my[kRoom], kind[kRoom];
  std::int32_t robot[kRoom];  ///< its place in the sorted order
  std::size_t count = 0;
};

inline std::int32_t bits_of(float value) {
  std::int32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

inline float float_of(std::int32_t bits) {
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// key[r][lane]: the r-th smallest of a lane, a squared distance (lattice steps) whose low bits hold the candidate's
/// number; `none` of the lane where there are fewer.
struct Ranked {
  alignas(64) float key[kMostRanks][kPack];
};

/// What the robots of a pack ask of a search, by lane. Lanes without a robot want no neighbour: their `none` is 0.
struct LaneLimits {
  alignas(64) float none[kPack];           ///< squared lattice steps: keys from here on do not count
  alignas(64) float reach[kPack];          ///< squared lattice steps: a nearer robot can be met within the step
  alignas(64) std::int32_t wanted[kPack];  ///< neighbours at most
  alignas(64) std::int32_t window[kPack];  ///< lattice steps: the hint of a robot with fewer neighbours
  alignas(64) std::int32_t kind[kPack];
};

/// What a search has found, by lane.
struct LaneFinds {
  alignas(64) std::int32_t have[kPack];  ///< neighbours
  alignas(
      64) std::int32_t hint[kPack];  ///< lattice steps, distance of the last neighbour; the window if there are fewer
  int most = 0;                      ///< neighbours of any lane
  int neighbours = 0;                ///< of all lanes
  std::uint32_t unseen = 0;          ///< bit `lane`: the last neighbour is farther than `seen`, or is missing
  std::uint32_t crowded = 0;         ///< has as many as it wants, and could meet all of them within the step
};

/// Up to kPack robots whose half-planes are made, rank by rank. The robots' own arrays are read to kPack.
struct LineQuery {
  const Candidates* others = nullptr;
  const Ranked* ranked = nullptr;
  const float* none = nullptr;  ///< by lane: keys from here on are no neighbours
  int first_rank = 1, end_rank = 1;
  const std::int32_t *x = nullptr, *y = nullptr, *mx = nullptr, *my = nullptr;
  const std::int32_t* kind = nullptr;
};

/// Where half-planes go: that of rank r (counted from first_rank) and lane l stands at [r * stride + l].
template <class T>
struct LineRows {
  T *x = nullptr, *y = nullptr, *c = nullptr;
  std::size_t stride = 0;
};

/// Bit `lane`: a neighbour of the lane touches it; stands in the very place of it.
struct LineFlags {
  std::uint32_t touching = 0, coincident = 0;
};

}  // namespace exactvo::formation::crowd
