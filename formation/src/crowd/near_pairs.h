// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The robots that one could meet within the step, given what all wish, and whether all wishes near it are surely
/// allowed. Exact: eight or sixteen others at a time are judged in float with bounds of its rounding, and what these
/// leave open is judged in whole numbers.
///
/// With the names of pair_row.h, at u = 0 and N = 2^20 D / |D| rounded to whole numbers, both wishes satisfy their rows
/// if N.D - bar >= max(0, -N.w_a) + max(0, N.w_b). A component of N is off by 1/2, and bar <= R |N| + 4. So, with
/// S = |D| + R + |w_a| + |w_b|,
///  (6) both do if |D| - R - max(0, -D.w_a) / |D| - max(0, D.w_b) / |D| >= 2^-20 (0.708 S + 4).
/// Times |D|, every term is off by at most 5 roundings of float, 2^-24 each, and their differences by 3: by 2^-21 S |D|
/// in all. The test asks for 2^-18 S |D| + |D|.

#include <cstdint>
#include <vector>

#include "crowd/robots.h"

namespace exactvo::formation::crowd {

/// What the search looks up of each kind, lattice steps.
struct StepsOfKind {
  std::int64_t radius = 0;     ///< rounded up
  double reach = 0.0;          ///< farther than this no robot can be met within the step
  double squared_speed = 0.0;  ///< (max_speed dt / q)^2, rounded down
};

/// Of all kinds.
struct StepTable {
  std::vector<StepsOfKind> kinds;
  std::vector<float> radius;  ///< rounded

  void clear() { kinds.clear(), radius.clear(); }
  void add(const StepsOfKind& kind) {
    kinds.push_back(kind);
    radius.push_back(static_cast<float>(kind.radius));
  }
};

/// What it finds for some robots.
struct NearPairs {
  static constexpr std::uint8_t kMeets = 1,  ///< a robot could be met
      kHindered = 2,                         ///< and then not all wishes are surely allowed
      kOverlaps = 4;                         ///< another overlaps it by more than kRoundedContact

  Array<std::int32_t> other;        ///< who could be met, robot by robot; none of robots that are not hindered
  std::vector<std::size_t> end;     ///< of each robot, in `other`
  std::vector<std::uint8_t> state;  ///< of each robot
};

/// Lattice steps by which two robots in contact may overlap, as places and radii were rounded: they keep their
/// distance. Two that overlap by more have come from elsewhere, and the first level leads them apart.
inline constexpr std::int64_t kRoundedContact = 8;

/// At least as far as a robot with this wish can get in the step, lattice steps.
std::int64_t longest_way(std::int32_t wish_x, std::int32_t wish_y);

/// For each robot of `asked`. `from_rest`: whether (6) counts; else all that could meet another are hindered.
void find_near_pairs(const Robots& robots, const StepTable& table, const std::vector<std::int32_t>& asked,
                     bool from_rest, NearPairs& out);

}  // namespace exactvo::formation::crowd
