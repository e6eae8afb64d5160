// SPDX-License-Identifier: GPL-3.0-or-later
// Which pairs the second level of a crowd looks at, against every pair in whole numbers, and lemma (6) of near_pairs.h.
#include "crowd/near_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "crowd/pair_row.h"
#include "lp/sets/target.h"
#include "support/seeded_random.h"

namespace exactvo::formation::crowd {
namespace {

using test::SeededRandom;

/// Robots at any scale, many in contact or all but in contact, with wishes as long as their kind allows.
class Cluster {
 public:
  explicit Cluster(SeededRandom& random) {
    const int scale = random.integer(0, 3);
    const double radius = std::ldexp(random.uniform(1.0, 2.0), 7 + 5 * scale);
    const double longest = std::min(std::ldexp(random.uniform(0.1, 2.0), random.integer(6, 21)), 8.0 * radius);
    const int number_of_kinds = random.integer(1, 3);
    for (int k = 0; k < number_of_kinds; ++k) {
      StepsOfKind kind;
      kind.radius = static_cast<std::int64_t>(radius * random.uniform(0.5, 1.0)) + 9;
      longest_.push_back(longest * random.uniform(0.2, 1.0));
      kinds.push_back(kind);
    }
    const double widest = radius + 9.0;
    for (std::size_t k = 0; k < kinds.size(); ++k)
      kinds[k].reach = static_cast<double>(kinds[k].radius) + widest + kLongerWay * (longest_[k] + longest) +
                       2.0 * (kWayMargin + 1.0);
    add_robots(random, radius, random.integer(2, 40));
  }

  std::vector<StepsOfKind> kinds;
  Robots robots;

 private:
  void add_robots(SeededRandom& random, double radius, int count) {
    std::set<std::pair<std::int32_t, std::int32_t>> taken;
    const double side = radius * random.uniform(1.5, 4.0) * std::sqrt(static_cast<double>(count));
    for (int i = 0; i < count; ++i) {
      auto x = static_cast<std::int32_t>(side * random.uniform(0.0, 1.0)),
           y = static_cast<std::int32_t>(side * random.uniform(0.0, 1.0));
      const auto kind = static_cast<KindId>(random.integer(0, static_cast<int>(kinds.size()) - 1));
      if (i > 0 && random.integer(0, 2) == 0) {  // beside another, in contact or a few steps from it
        const std::size_t other = robots.size() - 1;
        const double angle = random.uniform(0.0, 6.2831853),
                     far = static_cast<double>(kinds[kind].radius + kinds[robots.kind(other)].radius +
                                               random.integer(-12, 4));
        x = robots.x[other] + static_cast<std::int32_t>(far * std::cos(angle));
        y = robots.y[other] + static_cast<std::int32_t>(far * std::sin(angle));
      }
      if (taken.insert({x, y}).second) robots.append(x, y, static_cast<std::int32_t>(robots.size()), kind);
    }
    Tasks tasks(1);
    robots.set_strip(std::max(4.0, radius * random.uniform(0.5, 4.0)));
    robots.sort(tasks);
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const double most = longest_[robots.kind(i)] * std::sqrt(random.uniform(0.0, 1.0)),
                   angle = random.uniform(0.0, 6.2831853);
      robots.wish_mx[i] = static_cast<std::int32_t>(most * std::cos(angle));
      robots.wish_my[i] = static_cast<std::int32_t>(most * std::sin(angle));
    }
  }

  std::vector<double> longest_;
};

using Pairs = std::set<std::pair<std::int32_t, std::int32_t>>;

struct Found {
  Pairs pairs;  ///< of robots with one that (6) leaves open, all of them, by robot and other
  std::vector<bool> meets, hindered;
  std::size_t overlapping = 0;
};

/// As the search leaves them, in packs of `together`, or unknown.
NearLists lists_of(const Cluster& c, bool listed, std::size_t together) {
  NearLists lists;
  auto others = std::make_unique<Candidates>();
  others->count = c.robots.size();
  for (std::size_t j = 0; j < c.robots.size(); ++j) others->robot[j] = static_cast<std::int32_t>(j);
  constexpr float kNear = 0.25F, kMeeting = 1.0F;
  for (std::size_t begin = 0; begin < c.robots.size(); begin += together) {
    const std::size_t size = std::min(together, c.robots.size() - begin);
    auto ranked = std::make_unique<Ranked>();
    for (auto& row : ranked->key) std::fill(row, row + kPack, kMeeting);
    float meeting[kPack] = {};
    std::int32_t most[kPack] = {};
    for (std::size_t lane = 0; lane < size; ++lane) {
      const std::size_t i = begin + lane;
      meeting[lane] = listed ? kMeeting : 0.0F;
      most[lane] = kMostNeighbours;
      std::size_t rank = 0;
      for (std::size_t j = c.robots.size(); j-- > 0;) {
        const double far = std::hypot(c.robots.x[i] - c.robots.x[j], c.robots.y[i] - c.robots.y[j]);
        if (j == i || far > c.kinds[c.robots.kind(i)].reach || rank + 1 == kMostRanks) continue;
        ranked->key[++rank][lane] = float_of((bits_of(kNear) & ~kIndexBits) | static_cast<std::int32_t>(j));
      }
    }
    lists.add(begin, size, *others, *ranked, meeting, most, listed ? 0U : (1U << size) - 1U);
  }
  return lists;
}

void take_pairs(const NearPairs& near, std::size_t robots, Pairs& to) {
  for (std::size_t i = 0; i < robots; ++i)
    near.for_pairs_of(i, [&](std::size_t pair, bool is_a, std::int32_t other) {
      EXPECT_EQ(is_a ? near.pairs.a[pair] : near.pairs.b[pair], static_cast<std::int32_t>(i));
      EXPECT_TRUE(to.emplace(static_cast<std::int32_t>(i), other).second) << "twice";
    });
}

Found find(Cluster& c, bool listed, bool first_round, std::size_t together = kPack) {
  NearLists lists = lists_of(c, listed, together);
  std::fill(c.robots.next_kept.begin(), c.robots.next_kept.end(), std::uint8_t{0});
  NearPairs near;
  near.find(c.robots, c.kinds, 0, c.robots.size(), lists);
  Found found;
  found.overlapping = near.overlapping;
  for (std::size_t i = 0; i < c.robots.size(); ++i) {
    bool any = false;
    near.for_pairs_of(i, [&](std::size_t, bool, std::int32_t) { any = true; });
    found.hindered.push_back(any);
    found.meets.push_back((c.robots.next_kept[i] & Robots::kHasMet) != 0);
    if (any) near.state[i] = NearPairs::kCut, near.cut.push_back(static_cast<std::int32_t>(i));
    c.robots.safe_mx[i] = c.robots.wish_mx[i] + any;
    c.robots.safe_my[i] = c.robots.wish_my[i];
  }
  if (first_round)
    near.add_clear(c.robots, c.kinds, lists);
  else
    near.find_again(c.robots, c.kinds, 0, c.robots.size(), lists);
  take_pairs(near, c.robots.size(), found.pairs);
  return found;
}

enum class Pair { far, near, overlapping };

Pair judged(const Cluster& c, std::size_t i, std::size_t j) {
  const Robots& r = c.robots;
  const std::int64_t dx = std::int64_t{r.x[i]} - r.x[j], dy = std::int64_t{r.y[i]} - r.y[j];
  const std::int64_t radii = c.kinds[r.kind(i)].radius + c.kinds[r.kind(j)].radius;
  const std::int64_t reach = radii + longest_way(r.wish_mx[i], r.wish_my[i]) + longest_way(r.wish_mx[j], r.wish_my[j]);
  if (dx * dx + dy * dy >= reach * reach) return Pair::far;
  const std::int64_t apart = radii - kRoundedContact;
  return dx * dx + dy * dy >= apart * apart ? Pair::near : Pair::overlapping;
}

/// Whether the rows of a pair at rest allow both wishes.
bool allows_both(const Cluster& c, std::size_t i, std::size_t j) {
  const Robots& r = c.robots;
  PairTable table;
  table.radii[table.add(i, j)] = static_cast<double>(c.kinds[r.kind(i)].radius + c.kinds[r.kind(j)].radius);
  make_pair_rows({r.x.data(), r.y.data(), r.wish_mx.data(), r.wish_my.data(), nullptr, nullptr}, table, 0);
  return table.row(0, true).allows({r.wish_mx[i], r.wish_my[i]}) &&
         table.row(0, false).allows({r.wish_mx[j], r.wish_my[j]});
}

TEST(NearPairs, Lemma6_WishesOfRobotsThatAreNotHinderedSatisfyAllTheirRows) {
  SeededRandom random(test::seed_of_run(61));
  std::size_t near = 0, clear = 0, hindered = 0, overlapping = 0;
  for (int k = 0; k < 3000; ++k) {
    Cluster c(random);
    const Found found = find(c, k % 2 == 0, true);
    std::size_t overlap = 0;
    for (std::size_t i = 0; i < c.robots.size(); ++i) {
      Pairs expected;
      bool overlaps = false;
      for (std::size_t j = 0; j < c.robots.size(); ++j) {
        const Pair pair = i == j ? Pair::far : judged(c, i, j);
        overlaps |= pair == Pair::overlapping;
        if (pair != Pair::near) continue;
        ++near;
        expected.emplace(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j));
        if (!found.hindered[i]) {
          ASSERT_TRUE(allows_both(c, i, j)) << k << ' ' << i << ' ' << j;
          ++clear;
        }
      }
      ASSERT_EQ(found.meets[i], !expected.empty()) << k << ' ' << i;
      overlap += overlaps;
      if (!found.hindered[i]) continue;
      ++hindered;
      Pairs got;
      for (const auto& pair : found.pairs)
        if (pair.first == static_cast<std::int32_t>(i)) got.insert(pair);
      ASSERT_EQ(got, expected) << k << ' ' << i;
    }
    ASSERT_EQ(found.overlapping, overlap) << k;
    overlapping += overlap;
  }
  EXPECT_GT(near, 50000U);
  EXPECT_GT(clear, 5000U);
  EXPECT_GT(hindered, 20000U);
  EXPECT_GT(overlapping, 1000U);
}

TEST(NearPairs, ListsAndWindowsGiveTheSamePairsInBothRoundsOnEveryTarget) {
  SeededRandom random(test::seed_of_run(62));
  std::size_t pairs = 0, targets = 0;
  for (int k = 0; k < 500; ++k) {
    Cluster c(random);
    const Found first = find(c, true, true);
    for (const char* target : {"", "AVX3", "AVX2", "SSE4", "SSE2"}) {
      if (!lp::limit_batch_target(target)) continue;  // not on this machine
      targets += k == 0;
      for (const bool listed : {true, false}) {
        const Found again = find(c, listed, true, 1 + static_cast<std::size_t>(k) % kPack);
        ASSERT_EQ(again.pairs, first.pairs) << k << ' ' << target;
        ASSERT_EQ(again.meets, first.meets) << k << ' ' << target;
        ASSERT_EQ(again.overlapping, first.overlapping) << k << ' ' << target;
        ASSERT_EQ(find(c, listed, false).pairs, first.pairs) << k << ' ' << target;
      }
    }
    lp::limit_batch_target("");
    pairs += first.pairs.size();
  }
  EXPECT_GT(pairs, 5000U);
  EXPECT_GT(targets, 2U);
}

/// Each of two ranges makes the rows of pairs that reach across.
TEST(NearPairs, ARangeHasThePairsOfItsRobotsWithThoseOfOthers) {
  SeededRandom random(test::seed_of_run(63));
  std::size_t across = 0;
  for (int k = 0; k < 500; ++k) {
    Cluster c(random);
    const Found whole = find(c, true, true);
    const std::size_t half = c.robots.size() / 2;
    Pairs both;
    for (const bool second : {false, true}) {
      const std::size_t first = second ? half : 0, last = second ? c.robots.size() : half;
      NearLists all = lists_of(c, true, 1), lists = all;
      lists.packs = {all.packs.begin() + static_cast<std::ptrdiff_t>(first),
                     all.packs.begin() + static_cast<std::ptrdiff_t>(last)};
      NearPairs near;
      near.find(c.robots, c.kinds, first, last, lists);
      for (std::size_t i = first; i < last; ++i)
        if (whole.hindered[i])
          near.state[i - first] = NearPairs::kCut, near.cut.push_back(static_cast<std::int32_t>(i));
      near.add_clear(c.robots, c.kinds, lists);
      for (std::size_t i = first; i < last; ++i)
        near.for_pairs_of(i, [&](std::size_t, bool, std::int32_t other) {
          both.emplace(static_cast<std::int32_t>(i), other);
          across += (static_cast<std::size_t>(other) < first || static_cast<std::size_t>(other) >= last);
        });
    }
    ASSERT_EQ(both, whole.pairs) << k;
  }
  EXPECT_GT(across, 2000U);
}

}  // namespace
}  // namespace exactvo::formation::crowd
