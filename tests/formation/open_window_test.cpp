// SPDX-License-Identifier: GPL-3.0-or-later
// What a window of squares says to be open, against a search square by square; and that robots in the open, which are
// not looked at more closely, change nothing of what is proven of others.
#include "preflight/open_window.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "exactvo/formation/passing.h"
#include "exactvo/geometry/distance.h"
#include "liveness_scenes.h"
#include "support/seeded_random.h"

namespace exactvo::formation::detail {
namespace {

using geometry::Segment;
using geometry::Vec2;
constexpr int kColumns = OpenWindow::kColumns, kRows = OpenWindow::kRows;

struct Field {
  std::vector<Segment> edges;
  double reach = 0.0, side = 1.0;
  std::int32_t x = 0, y = 0;

  OpenWindow window() const {
    OpenWindow w(x, y, side);
    for (const Segment& e : edges) w.take_away(e, reach);
    return w;
  }
  double distance_to(int column, int row) const {
    const Vec2 low{side * (x + column), side * (y + row)}, high = low + Vec2{side, side};
    double least = HUGE_VAL;
    for (const Segment& e : edges)
      for (const Segment& s : {Segment{low, {high.x, low.y}}, Segment{{high.x, low.y}, high},
                               Segment{high, {low.x, high.y}}, Segment{{low.x, high.y}, low}})
        least = std::min(least, geometry::distance(e, s));
    return least;
  }
  /// How many squares of the window hang together with one: of those that no edge is within the distance of.
  std::size_t count_round(int column, int row, double least_distance) const {
    std::vector<char> seen(std::size_t{kColumns} * kRows);
    std::vector<std::pair<int, int>> open{{column, row}};
    seen[static_cast<std::size_t>(row * kColumns + column)] = 1;
    std::size_t count = 0;
    while (!open.empty()) {
      const auto [i, j] = open.back();
      open.pop_back();
      ++count;
      for (int di = -1; di <= 1; ++di)
        for (int dj = -1; dj <= 1; ++dj) {
          const int a = i + di, b = j + dj;
          if (a < 0 || b < 0 || a >= kColumns || b >= kRows) continue;
          char& known = seen[static_cast<std::size_t>(b * kColumns + a)];
          if (known || distance_to(a, b) <= least_distance) continue;
          known = 1;
          open.emplace_back(a, b);
        }
    }
    return count;
  }
};

Field random_field(test::SeededRandom& random) {
  Field f;
  f.side = std::exp2(random.integer(-6, 6));
  f.x = random.integer(-1000000, 1000000);
  f.y = random.integer(-1000000, 1000000);
  f.reach = f.side * random.uniform(0.0, 8.0);
  const auto place = [&] {
    return f.side * Vec2{f.x + random.uniform(-0.5, 1.5) * kColumns, f.y + random.uniform(-0.5, 1.5) * kRows};
  };
  const int edges = random.integer(0, 12);
  for (int k = 0; k < edges; ++k) {
    const Vec2 a = place();
    Vec2 b = place();
    if (k % 4 == 0) b.x = a.x;
    if (k % 4 == 1) b.y = a.y;
    if (k % 4 == 2) b = a + 10.0 * f.side * random.direction();
    f.edges.push_back({a, b});
  }
  return f;
}

TEST(OpenWindow, CountsNoSquareThatAnEdgeComesNearTo) {
  test::SeededRandom random(test::seed_of_run(63));
  int said = 0;
  for (int k = 0; k < 40; ++k) {
    const Field f = random_field(random);
    const int column = random.integer(0, kColumns - 1), row = random.integer(0, kRows - 1);
    const std::size_t most = f.count_round(column, row, f.reach);
    // Two squares more than asked for are left out where rounding and the steps of a slanting edge would ask for less.
    const std::size_t least = f.count_round(column, row, f.reach + 8.0 * f.side);
    EXPECT_FALSE(f.window().has_more_than(most, column, row)) << "case " << k;
    if (least > 0) {
      EXPECT_TRUE(f.window().has_more_than(least - 1, column, row)) << "case " << k;
    }
    said += least > 100;
  }
  EXPECT_GT(said, 10) << "cases with room";
}

TEST(OpenWindow, WithoutEdgesAllIsOpen) {
  const OpenWindow window(-32, -128, 0.25);
  const std::size_t all = std::size_t{kColumns} * kRows;
  EXPECT_TRUE(window.has_more_than(all - 1, 32, 128));
  EXPECT_FALSE(window.has_more_than(all, 0, 0));
}

/// With many in the open every look counts, and robots are gone through as if none was spared.
TEST(OpenWindow, OthersInTheOpenChangeNoProof) {
  for (const int others : {0, 1, 4, 20}) {
    Scenario s;
    test_scenes::add_box(s, 4.0, 0.75);
    test_scenes::add_robot(s, {-3, 0}, {3, 0});
    for (int k = 0; k < others; ++k) test_scenes::add_robot(s, {100.0 * (k + 1), 0}, {100.0 * (k + 1), 5});
    test_scenes::add_robot(s, {3, 0}, {-3, 0});
    const std::vector<NoPassing> proofs = robots_without_passing(s);
    ASSERT_EQ(proofs.size(), 1u) << others;
    EXPECT_EQ(proofs[0].first, 0u);
    EXPECT_EQ(proofs[0].second, static_cast<std::size_t>(others) + 1);
  }
}

}  // namespace
}  // namespace exactvo::formation::detail
