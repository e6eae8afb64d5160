// SPDX-License-Identifier: GPL-3.0-or-later
// Which pairs the second level of a crowd looks at, against every pair in whole numbers, and lemma (6) of near_pairs.h.
#include "crowd/near_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

struct Found {
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  std::vector<std::uint8_t> state;
};

/// From lists of all robots, or from the windows round them.
Found find(const Cluster& c, bool listed, bool first_round) {
  NearLists lists;
  lists.clear(c.robots.size());
  std::vector<AskedRobot> asked;
  std::size_t list = 0;
  for (std::size_t i = 0; i < c.robots.size(); ++i) {
    std::vector<std::int32_t> others;
    for (std::size_t j = c.robots.size(); j-- > 0;)
      if (j != i &&
          std::hypot(c.robots.x[i] - c.robots.x[j], c.robots.y[i] - c.robots.y[j]) <= c.kinds[c.robots.kind(i)].reach)
        others.push_back(static_cast<std::int32_t>(j));
    asked.push_back({i, list});
    if (listed && others.size() <= kMostNeighbours) {
      lists.add(i, others.data(), others.size());
      list += others.size();
    } else {
      lists.add_unknown();
    }
  }
  NearPairs out;
  find_near_pairs(c.robots, c.kinds, 0, asked, true, lists, out);
  if (!first_round) {
    std::vector<AskedRobot> again;
    for (std::size_t k = 0; k < asked.size(); ++k)
      if (out.state[k] & NearPairs::kHindered) again.push_back(asked[k]);
    find_near_pairs(c.robots, c.kinds, 0, again, false, lists, out);
  }
  Found found;
  for (std::size_t k = 0; k < out.pairs(); ++k) found.pairs.emplace_back(out.robot[k], out.other[k]);
  found.state = out.state;
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
  PairInStep p;
  p.dx = std::int64_t{r.x[i]} - r.x[j], p.dy = std::int64_t{r.y[i]} - r.y[j];
  p.radius = c.kinds[r.kind(i)].radius + c.kinds[r.kind(j)].radius;
  p.wish_a = {r.wish_mx[i], r.wish_my[i]}, p.wish_b = {r.wish_mx[j], r.wish_my[j]};
  PairTable table;
  table.lay_out(2, true);
  table.put(0, p, true);
  table.put(1, p, false);
  make_pair_rows(table);
  return table.row(0).allows(p.wish_a) && table.row(1).allows(p.wish_b);
}

TEST(NearPairs, Lemma6_WishesOfRobotsThatAreNotHinderedSatisfyAllTheirRows) {
  SeededRandom random(test::seed_of_run(61));
  std::size_t near = 0, clear = 0, hindered = 0, overlapping = 0;
  for (int k = 0; k < 3000; ++k) {
    const Cluster c(random);
    const Found found = find(c, k % 2 == 0, true);
    for (std::size_t i = 0; i < c.robots.size(); ++i) {
      const std::uint8_t state = found.state[i];
      std::vector<std::pair<std::int32_t, std::int32_t>> expected;
      bool overlaps = false;
      for (std::size_t j = 0; j < c.robots.size(); ++j) {
        const Pair pair = i == j ? Pair::far : judged(c, i, j);
        overlaps |= pair == Pair::overlapping;
        if (pair != Pair::near) continue;
        ++near;
        expected.emplace_back(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j));
        if ((state & NearPairs::kHindered) == 0) {
          ASSERT_TRUE(allows_both(c, i, j)) << k << ' ' << i << ' ' << j;
          ++clear;
        }
      }
      ASSERT_EQ((state & NearPairs::kMeets) != 0, !expected.empty()) << k << ' ' << i;
      ASSERT_EQ((state & NearPairs::kOverlaps) != 0, overlaps) << k << ' ' << i;
      overlapping += overlaps;
      if ((state & NearPairs::kHindered) == 0) continue;
      ++hindered;
      decltype(expected) got;
      for (const auto& pair : found.pairs)
        if (pair.first == static_cast<std::int32_t>(i)) got.push_back(pair);
      ASSERT_EQ(got, expected) << k << ' ' << i;
    }
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
    const Cluster c(random);
    const Found first = find(c, true, true);
    for (const char* target : {"", "AVX3", "AVX2", "SSE4", "SSE2"}) {
      if (!lp::limit_batch_target(target)) continue;  // not on this machine
      targets += k == 0;
      for (const bool listed : {true, false}) {
        ASSERT_EQ(find(c, listed, true).pairs, first.pairs) << k << ' ' << target;
        ASSERT_EQ(find(c, listed, true).state, first.state) << k << ' ' << target;
        ASSERT_EQ(find(c, listed, false).pairs, first.pairs) << k << ' ' << target;
      }
    }
    lp::limit_batch_target("");
    pairs += first.pairs.size();
  }
  EXPECT_GT(pairs, 5000U);
  EXPECT_GT(targets, 2U);
}

}  // namespace
}  // namespace exactvo::formation::crowd
