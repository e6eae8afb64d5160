// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The pairs that could meet within the step, given what all robots wish, and whether the wishes of a pair are surely
/// allowed. Exact: pairs are judged one per SIMD lane, in float with bounds of its rounding, and what
/// these leave open is judged in whole numbers.
///
/// The search of the first level has listed the robots near each robot. Where its list may not have all that could be
/// met, the robots in the window round a robot are looked at one by one.
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

/// What the second level looks up of each kind, lattice steps.
struct StepsOfKind {
  std::int64_t radius = 0;     ///< rounded up
  double reach = 0.0;          ///< farther than this no robot is in a pair that could meet
  double squared_speed = 0.0;  ///< (max_speed dt / q)^2, rounded down
};

/// Lattice steps by which two robots in contact may overlap, as places and radii were rounded: they keep their
/// distance. Two that overlap by more have come from elsewhere, and the first level leads them apart.
inline constexpr std::int64_t kRoundedContact = 8;

/// At least as far as a robot with this wish can get in the step, lattice steps: at most kLongerWay times the wish and
/// kWayMargin. No root.
std::int64_t longest_way(std::int32_t wish_x, std::int32_t wish_y);
inline constexpr double kLongerWay = 1.125, kWayMargin = 6.0;

/// The robots near each robot of a range, as far as StepsOfKind::reach of its kind: the places of the others less its
/// own. The first round of the second level leaves of each list of a hindered robot those that could be met, and then
/// 0.
class NearLists {
 public:
  static constexpr std::uint8_t kUnknown = 255;

  std::vector<std::int16_t> away;   ///< robot by robot; readable to kPack beyond each
  std::vector<std::uint8_t> count;  ///< of each robot, or kUnknown: it may have others

  /// Empties the lists; from now on they are of `robots` robots.
  void clear(std::size_t robots) {
    if (count.size() < robots) count.resize(robots);
    listed_ = used_ = 0;
  }
  /// Of the next robot, kMostNeighbours at most. `others`: their places.
  void add(std::size_t robot, const std::int32_t* others, std::size_t others_count) {
    if (away.size() < used_ + 2 * kPack) away.resize(2 * away.size() + 2 * kPack);
    std::int16_t* const to = away.data() + used_;
    for (std::size_t k = 0; k < others_count; ++k) {
      const std::int32_t by = others[k] - static_cast<std::int32_t>(robot);
      to[k] = static_cast<std::int16_t>(by);
      if (to[k] != by) return add_unknown();
    }
    used_ += others_count;
    count[listed_++] = static_cast<std::uint8_t>(others_count);
  }
  void add_unknown() { count[listed_++] = kUnknown; }
  std::size_t bytes() const { return away.capacity() * sizeof(std::int16_t) + count.capacity(); }

 private:
  std::size_t listed_ = 0, used_ = 0;
};

/// A robot, and where its list begins.
struct AskedRobot {
  std::size_t robot, list;
};

/// What is found for some robots.
struct NearPairs {
  static constexpr std::uint8_t kMeets = 1,  ///< a robot could be met
      kHindered = 2,                         ///< and then not all wishes are surely allowed
      kOverlaps = 4;                         ///< another overlaps it by more than kRoundedContact

  /// Pairs that could meet, of hindered robots, one robot after the other; robots up to a multiple of kPack.
  Array<std::int32_t> robot, other;
  std::vector<std::size_t> end;     ///< of each robot's pairs
  std::vector<std::uint8_t> state;  ///< of each robot

  // Pairs that are judged, robot by robot; arrays have room for kPack more.
  Array<std::int32_t> judged_other, own_x, own_y, own_wish_x, own_wish_y;
  Array<float> contact;                             ///< R, where there are several kinds
  std::vector<std::size_t> judged_end;              ///< of each robot's
  std::vector<std::uint8_t> near, clear, doubtful;  ///< a bit each

  std::size_t pairs() const { return end.empty() ? 0 : end.back(); }
};

/// For each robot of `asked`, whose lists are in `lists`; the first robot there is `begin`. Pairs of a robot ascend by
/// the other's place. `first_round`: (6) counts, and lists are cut. REQUIRES: in the second, robots that were hindered
/// in the first.
void find_near_pairs(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t begin,
                     const std::vector<AskedRobot>& asked, bool first_round, NearLists& lists, NearPairs& out);

}  // namespace exactvo::formation::crowd
