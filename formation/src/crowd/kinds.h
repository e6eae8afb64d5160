// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the engine looks up, most of it by kind, in its own arithmetic and rounded to the safe side.

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "exactvo/formation/crowd.h"

namespace exactvo::formation::crowd {

/// What a search for neighbours looks up, of every kind.
struct ReachTable {
  std::vector<float> none;     ///< squared lattice steps, without the bits of a number: keys from here on do not count
  std::vector<float> reach;    ///< squared lattice steps, rounded up: beyond it no robot can be met in the step
  std::vector<float> meeting;  ///< squared lattice steps, rounded up: as far as the second level looks (near_pairs.h)
  std::vector<double> window;  ///< lattice steps, how far a search goes at most
  std::vector<std::int32_t> whole_window;  ///< the same, down to a whole number, 2^30 at most
  std::vector<int> neighbours;
  int most_neighbours = 1;
  double nearby = 0.0;  ///< lattice steps, how far a search goes at least

  bool is_mixed() const { return none.size() > 1; }
};

template <class T>
struct KindTable : ReachTable {
  std::vector<T> radius;           ///< m, rounded up
  std::vector<T> inverse_horizon;  ///< 1/s
  std::vector<T> least_offset;     ///< m/s, below it an offset never binds
  std::vector<T> disc;             ///< m/s, less what rounding to the lattice adds
  std::vector<T> allowed;          ///< m/s, what may be missing of a line with its lattice slack, as computed in T
  T lattice_slack = 0;             ///< m/s, in every offset
  double spare = 0.0;  ///< m/s, how much of it the rounding to the lattice may use up; the rest covers underflow
  double velocity_step = 0.0;  ///< m/s, q / dt
  T position_step = 0;         ///< m
  T inverse_step = 0;          ///< dt / q
  T inverse_time = 0;          ///< 1/s, 1 / dt
  bool certified = true;       ///< offsets are rounded up

  /// m/s: what a motion of one lattice step is taken for.
  T unit() const { return static_cast<T>(velocity_step); }
};

template <class T>
KindTable<T> kind_table(const CrowdOptions& options, const std::vector<CrowdKind>& kinds);

/// Lattice steps: farther than this from a robot of the kind no other is in a pair that could meet, by
/// `longest_way` of near_pairs.h. `largest`: m, radius of any kind; `fastest`: m/s.
double reach_of_pairs(const CrowdKind& kind, const CrowdOptions& options, double largest, double fastest);

/// The least T that is at least `value`.
template <class T>
T rounded_up(double value) {
  const T rounded = static_cast<T>(value);
  return static_cast<double>(rounded) < value ? std::nextafter(rounded, std::numeric_limits<T>::infinity()) : rounded;
}

/// The bits of a squared distance that order neighbours.
float without_number(float squared);

}  // namespace exactvo::formation::crowd
