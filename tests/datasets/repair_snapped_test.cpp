// SPDX-License-Identifier: GPL-3.0-or-later
// Repairs where plain rounding keeps making new crossings, so that snap rounding must end it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "exactvo/geometry/distance.h"
#include "repair_oracle.h"
#include "support/seeded_random.h"

namespace exactvo::datasets::test {
namespace {

/// At 2^52 m every double is a whole number, and the pixels of snap rounding are two units wide.
constexpr double kFarOut = 0x1p52;
constexpr double kPixel = 2.0;

/// x in whole numbers, y in any doubles: crossings round to one side a thousand times as far as to the other.
Ring far_out_ring(exactvo::test::SeededRandom& random, int most, double width) {
  Ring ring;
  for (int k = random.integer(4, most); k > 0; --k)
    ring.push_back({kFarOut + std::floor(random.uniform(0.0, width)), random.uniform(0.0, width)});
  return ring;
}

/// Whether two of the edges cross at a height where x is no whole number, so no double.
bool has_a_crossing_between_doubles(const Ring& ring) {
  const std::vector<RationalEdge> edges = sloping_edges({ring});
  for (const Rational& y : event_heights(edges)) {
    std::map<Rational, int> edges_at;
    for (const RationalEdge& e : edges) {
      if (e.ay < y && y < e.by) ++edges_at[e.x_at(y)];
    }
    for (const auto& [x, count] : edges_at) {
      if (count > 1 && x.get_den() != 1) return true;
    }
  }
  return false;
}

void expect_vertices_at_middles_of_pixels(const Repair& repaired) {
  for (const Ring& ring : rings_of(repaired.polygons)) {
    for (const Vec2 p : ring) EXPECT_TRUE(std::fmod(p.x, kPixel) == 0.0 && std::fmod(p.y, kPixel) == 0.0);
  }
}

double distance_to(const Ring& ring, Vec2 p) {
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < ring.size(); ++i)
    least = std::min(least, geometry::distance(geometry::Segment{ring[i], ring[(i + 1) % ring.size()]}, p));
  return least;
}

bool was_snapped(const Ring& ring) {
  return geometry::even_odd_region({ring}).rounds > geometry::kPlainRounds;
}

TEST(RepairSnapped, AStarWhoseCrossingsKeepCrossing) {
  const Ring star{{0x1.000000000000ap+52, 0x1.e9de4bcc319eep+2},
                  {0x1.0000000000004p+52, 0x1.77aaf2f5e5865p+1},
                  {0x1.0000000000008p+52, 0x1.fc5d3218d3b3cp+2},
                  {0x1.0000000000002p+52, 0x1.91ab76965122cp+1},
                  {0x1.000000000000bp+52, 0x1.5d55e4e6dda82p+2}};
  ASSERT_TRUE(has_a_crossing_between_doubles(star));
  ASSERT_TRUE(was_snapped(star));
  const Repair r = repaired_and_checked({star}, "star");
  expect_vertices_at_middles_of_pixels(r);
  EXPECT_FALSE(r.polygons.empty());
}

TEST(RepairSnapped, Properties1To4HoldAfterSnapRounding) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(103));
  int snapped = 0;
  int probed = 0;
  for (int k = 0; k < 100; ++k) {
    const Ring ring = far_out_ring(random, 24, k % 2 == 0 ? 12.0 : 30.0);
    if (!has_a_crossing_between_doubles(ring) || !was_snapped(ring)) continue;
    ++snapped;
    const Repair r = repaired_and_checked({ring}, std::to_string(k));
    expect_vertices_at_middles_of_pixels(r);
    EXPECT_LE(r.moved, geometry::kPlainRounds * 1.5 + kPixel) << k;  // a whole number and a little each, then a pixel
    for (int n = 0; n < 100; ++n) {
      const Vec2 p{kFarOut + std::floor(random.uniform(0.0, 30.0)), random.uniform(0.0, 30.0)};
      if (distance_to(ring, p) <= r.moved) continue;
      ++probed;
      EXPECT_EQ(encloses(rings_of(r.polygons), p), encloses({ring}, p)) << k;
    }
  }
  std::printf("%d rings snapped, %d points asked\n", snapped, probed);
  EXPECT_GT(snapped, 8);
  EXPECT_GT(probed, 100);
}

}  // namespace
}  // namespace exactvo::datasets::test
