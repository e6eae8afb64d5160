// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The pairs that could meet within the step, given what all robots wish, and whether the wishes of a pair are surely
/// allowed. Exact: pairs are judged one per SIMD lane, in float with bounds of its rounding, and what
/// these leave open is judged in whole numbers.
///
/// The search of the first level has listed the robots near each robot. Where its list may not have all that could be
/// met, the robots in the window round a robot are looked at one by one. All that is judged of a pair is the same for
/// both its robots, so one of them makes its rows, if both belong to the range.
///
/// With the names of pair_row.h, at u = 0 and N = 2^20 D / |D| rounded to whole numbers, both wishes satisfy their rows
/// if N.D - bar >= max(0, -N.w_a) + max(0, N.w_b). A component of N is off by 1/2, and bar <= R |N| + 4. So, with
/// S = |D| + R + |w_a| + |w_b|,
///  (6) both do if |D| - R - max(0, -D.w_a) / |D| - max(0, D.w_b) / |D| >= 2^-20 (0.708 S + 4).
/// Times |D|, every term is off by at most 5 roundings of float, 2^-24 each, and their differences by 3: by 2^-21 S |D|
/// in all. The test asks for 2^-18 S |D| + |D|.

#include <cstdint>
#include <vector>

#include "crowd/pair_row.h"
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

/// Lattice steps by which a motion may be longer than the wish: what rounding to the lattice adds, and some.
inline constexpr std::int32_t kRoundingRoom = 4;

/// The robots near each robot of a range, as far as StepsOfKind::reach of its kind, pack by pack.
class NearLists {
 public:
  /// Robots that stand one after the other, a lane each. Row k holds of each lane one of the robots near it.
  struct Lanes {
    std::int32_t begin = 0;
    std::uint32_t first_row = 0;
    std::uint16_t unknown = 0;  ///< bit `lane`: may have others
    std::uint8_t size = 0, rows = 0;
  };

  std::vector<Lanes> packs;
  std::vector<std::int16_t> away;   ///< by row and lane: the place of the other less its own; 0: none
  std::vector<std::uint16_t> near;  ///< by row, bit `lane`: could be met; the first round writes it

  void clear() { packs.clear(), rows_ = 0; }
  /// The next robots. `meeting`, by lane, squared lattice steps: robots that are nearer are near; `most`, by lane: how
  /// many neighbours were sought. A lane with this many near robots is unknown, as are the lanes of `unknown`.
  void add(std::size_t begin, std::size_t size, const Candidates& others, const Ranked& ranked, const float* meeting,
           const std::int32_t* most, std::uint32_t unknown);
  std::size_t rows() const { return rows_; }
  std::size_t bytes() const {
    return away.capacity() * sizeof(std::int16_t) + near.capacity() * sizeof(std::uint16_t) +
           packs.capacity() * sizeof(Lanes);
  }

 private:
  std::size_t rows_ = 0;
};

/// The pairs of a range whose rows are needed, each once. One object per thread.
class NearPairs {
 public:
  static constexpr std::uint8_t kCut = 1,  ///< one of its rows may not allow its wish
      kStays = 2,                          ///< one of its pairs has no row
      kAsked = 4;                          ///< its pairs are looked for

  PairTable pairs;
  std::vector<std::uint8_t> state;  ///< by robot of the range
  std::vector<std::int32_t> cut;    ///< those with kCut
  std::size_t overlapping = 0;      ///< robots that another overlaps by more than kRoundedContact

  /// Finds the pairs of robots `first` to `last`, whose lists are given, that (6) leaves open. Marks in
  /// Robots::next_kept which could meet another.
  void find(Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t first, std::size_t last,
            NearLists& lists);
  /// All pairs of robots whose safe motion is not what they wish.
  void find_again(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t first, std::size_t last,
                  const NearLists& lists);
  /// REQUIRES: pairs with rows. Marks the robots that are cut short and those that stay.
  void judge_rows();
  /// After `find`: the other pairs of those that are cut.
  void add_clear(const Robots& robots, const std::vector<StepsOfKind>& kinds, const NearLists& lists);

  /// `what(pair, is_a, other)` for the pairs of a robot.
  template <class Do>
  void for_pairs_of(std::size_t robot, const Do& what) const {
    for (std::int32_t e = last_of_[robot - first_]; e >= 0; e = pairs.before[static_cast<std::size_t>(e)]) {
      const auto pair = static_cast<std::size_t>(e) / 2;
      const bool is_a = e % 2 == 0;
      what(pair, is_a, is_a ? pairs.b[pair] : pairs.a[pair]);
    }
  }

 private:
  void make_radii();
  void start(const std::vector<StepsOfKind>& kinds, std::size_t first, std::size_t last, bool is_first);
  void take_pack(Robots& robots, const std::vector<StepsOfKind>& kinds, const NearLists::Lanes& pack, NearLists& lists);
  void look_round(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t robot);
  bool add_of_unknown(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t robot);
  void add(const Robots& robots, const std::vector<StepsOfKind>& kinds, std::size_t robot, std::size_t other,
           bool of_both);
  void cut_short(std::size_t robot, std::uint8_t how);
  bool is_asked(std::size_t robot) const { return is_ours(robot) && (state[robot - first_] & kAsked) != 0; }
  bool is_ours(std::size_t robot) const { return robot >= first_ && robot < last_; }
  std::uint8_t& state_of(std::size_t robot) { return state[robot - first_]; }

  std::size_t first_ = 0, last_ = 0;
  std::size_t with_radii_ = 0;                                            ///< places of `pairs` that hold both_radii_
  bool is_first_ = true;                                                  ///< all are asked
  double both_radii_ = 0.0;                                               ///< R, where there is one kind
  std::vector<std::int32_t> last_of_;                                     ///< of each robot its last entry; -1: none
  std::vector<std::uint16_t> clear_, doubtful_;                           ///< by row of the lists
  std::vector<std::uint16_t> asked_;                                      ///< by pack of the lists
  Array<std::int32_t> refusing_;                                          ///< pairs
  Array<std::int32_t> round_;                                             ///< robots round one
  std::vector<std::uint16_t> round_near_, round_clear_, round_doubtful_;  ///< of these, by sixteen
};

}  // namespace exactvo::formation::crowd
