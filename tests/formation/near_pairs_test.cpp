// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of robots looked up by place, against all pairs.
#include "scene/near_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "support/seeded_random.h"

namespace exactvo::formation::detail {
namespace {

using geometry::Vec2;
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

Pairs visited(const std::vector<Vec2>& places, double reach) {
  Pairs all;
  for_each_near_pair(places, reach, [&](std::size_t i, std::size_t j) { all.emplace_back(i, j); });
  return all;
}

void expect_no_pair_missing(const std::vector<Vec2>& places, double reach) {
  const Pairs found = visited(places, reach);
  Pairs near;
  for (const auto& [i, j] : found)
    if (norm(places[i] - places[j]) <= reach) near.emplace_back(i, j);
  Pairs expected;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = i + 1; j < places.size(); ++j)
      if (norm(places[i] - places[j]) <= reach) expected.emplace_back(i, j);
  EXPECT_EQ(near, expected) << places.size() << " places, reach " << reach;
  for (std::size_t k = 1; k < found.size(); ++k) ASSERT_LT(found[k - 1], found[k]) << "each once, in order";
}

TEST(NearPairs, NoneIsMissingAndTheyComeInOrder) {
  test::SeededRandom random(test::seed_of_run(19));
  for (int k = 0; k < 60; ++k) {
    const auto count = static_cast<std::size_t>(random.integer(0, 300));
    const double size = std::pow(10.0, random.uniform(-2.0, 6.0)), origin = std::pow(10.0, random.uniform(0.0, 8.0));
    std::vector<Vec2> places;
    for (std::size_t i = 0; i < count; ++i) {
      const bool coincides = !places.empty() && random.integer(0, 9) == 0;
      const double height = k % 5 == 0 ? 0.0 : size;  // on a line
      places.push_back(coincides ? places.back()
                                 : Vec2{origin + random.uniform(0.0, size), random.uniform(0.0, height)});
    }
    for (const double share : {0.0, 0.01, 0.1, 1.0, 10.0}) expect_no_pair_missing(places, share * size);
    // Exactly as far as another is.
    if (count > 1) expect_no_pair_missing(places, norm(places.front() - places.back()));
  }
}

TEST(NearPairs, OfALatticeWhoseNeighboursAreExactlyThatFar) {
  std::vector<Vec2> places;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) places.push_back({0.1 * x, 0.1 * y});
  expect_no_pair_missing(places, 0.1);
  expect_no_pair_missing(places, 0.2);
}

TEST(NearPairs, FewOfACrowdAreLookedAt) {
  test::SeededRandom random(test::seed_of_run(20));
  std::vector<Vec2> places;
  for (int i = 0; i < 3000; ++i) places.push_back({random.uniform(0.0, 300.0), random.uniform(0.0, 300.0)});
  EXPECT_LT(visited(places, 3.0).size(), 3000u * 10u);
}

TEST(NearPairs, PlacesOrAReachThatIsNotFiniteHaveAllPairs) {
  const double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();
  std::vector<Vec2> places;
  for (int i = 0; i < 100; ++i) places.push_back({1.0 * i, 0.0});
  EXPECT_EQ(visited(places, kInfinity).size(), 4950u);
  for (const double odd : {kNaN, kInfinity}) {
    places[7].x = odd;
    EXPECT_EQ(visited(places, 1.0).size(), 4950u);
  }
}

TEST(NearPairs, NoneIsMissingAmongMovingPlacesThatAreLookedUpNowAndThen) {
  test::SeededRandom random(test::seed_of_run(21));
  constexpr double kReach = 3.0, kRoom = 1.0;
  for (const int count : {10, 200}) {
    std::vector<Vec2> places;
    for (int i = 0; i < count; ++i) places.push_back({random.uniform(0.0, 30.0), random.uniform(0.0, 30.0)});
    NearPairsOfMoving pairs;
    std::size_t near = 0;
    for (int step = 0; step < 100; ++step) {
      const double reach = kReach * (1.0 + 0.1 * (step % 7));
      Pairs found, expected;
      pairs.for_each(places, reach, kRoom, [&](std::size_t i, std::size_t j) {
        if (norm(places[i] - places[j]) <= reach) found.emplace_back(i, j);
      });
      for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t j = i + 1; j < places.size(); ++j)
          if (norm(places[i] - places[j]) <= reach) expected.emplace_back(i, j);
      ASSERT_EQ(found, expected) << count << " places, step " << step;
      near += expected.size();
      const double farthest = step % 10 == 9 ? 5.0 : 0.1;
      for (Vec2& p : places) p = p + farthest * random.in_box(1.0);
      if (step == 50) places.pop_back();
    }
    EXPECT_GT(near, 100u);
  }
}

}  // namespace
}  // namespace exactvo::formation::detail
