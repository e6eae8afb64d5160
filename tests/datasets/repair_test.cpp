// SPDX-License-Identifier: GPL-3.0-or-later
// Repairs: what is held to the rule by another road (repair_oracle.h).
#include "exactvo/datasets/repair.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/even_odd.h"
#include "repair_oracle.h"
#include "shared_data.h"
#include "support/seeded_random.h"

namespace exactvo::datasets::test {
namespace {

// --- Shapes by hand ---

TEST(Repair, BowTieBecomesTwoTriangles) {
  const Repair r = repaired_and_checked({{{0, 0}, {2, 2}, {2, 0}, {0, 2}}}, "bow tie");
  ASSERT_EQ(r.polygons.size(), 2u);
  EXPECT_TRUE(r.recombined);
  EXPECT_EQ(r.polygons[0].outer, (Ring{{0, 0}, {1, 1}, {0, 2}}));
  EXPECT_EQ(r.polygons[1].outer, (Ring{{1, 1}, {2, 0}, {2, 2}}));
  EXPECT_EQ(r.after.area, 2.0);
}

TEST(Repair, SpikesAndEdgesWalkedTwiceVanish) {
  const Repair spike = repaired_and_checked({{{0, 0}, {4, 0}, {4, 4}, {7, 7}, {4, 4}, {0, 4}}}, "spike");
  ASSERT_EQ(spike.polygons.size(), 1u);
  EXPECT_EQ(spike.polygons[0].outer, (Ring{{0, 0}, {4, 0}, {4, 4}, {0, 4}}));
  const Repair slit = repaired_and_checked({{{0, 0}, {2, 0}, {2, 2}, {2, 0}, {4, 0}, {4, 4}, {0, 4}}}, "slit");
  ASSERT_EQ(slit.polygons.size(), 1u);
  EXPECT_EQ(slit.after.area, 16.0);
}

TEST(Repair, ARingThatPassesThroughItsOwnVertexIsCutThere) {
  // The seam of a polygon whose hole is tied to its shell by a bridge.
  const Repair r =
      repaired_and_checked({{{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 3}, {2, 4}, {4, 3}, {2, 2}, {0, 3}}}, "seam");
  ASSERT_EQ(r.polygons.size(), 1u);
  ASSERT_EQ(r.polygons[0].holes.size(), 1u);
  EXPECT_EQ(r.after.area, 32.0);
}

TEST(Repair, NestedRingsAlternate) {
  const auto square = [](double half) { return Ring{{-half, -half}, {half, -half}, {half, half}, {-half, half}}; };
  const Repair r = repaired_and_checked({square(4), square(3), square(2), square(1)}, "nested");
  ASSERT_EQ(r.polygons.size(), 2u);
  EXPECT_EQ(r.after.area, 64.0 - 36.0 + 16.0 - 4.0);
}

TEST(Repair, AHoleOutsideIsSolidAndOneThatCrossesIsCut) {
  const Repair outside = repaired_and_checked({{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, {{4, 0}, {5, 0}, {5, 1}}}, "outside");
  EXPECT_EQ(outside.polygons.size(), 2u);
  const Repair across =
      repaired_and_checked({{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{2, 1}, {6, 1}, {6, 3}, {2, 3}}}, "across");
  EXPECT_EQ(across.after.area, 16.0 - 4.0 + 4.0);
}

TEST(Repair, HolesThatEncloseNothingAreDropped) {
  const Repair r = repaired_and_checked(
      {{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{1, 1}}, {{1, 2}, {2, 2}, {3, 2}}, {{2, 3}, {3, 3}}}, "dots");
  ASSERT_EQ(r.polygons.size(), 1u);
  EXPECT_TRUE(r.polygons[0].holes.empty());
  EXPECT_FALSE(r.recombined);
}

TEST(EvenOdd, AHoleThatTouchesTwiceCutsThePolygonInTwo) {
  const geometry::EvenOddRegion region =
      geometry::even_odd_region({{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{2, 0}, {3, 2}, {2, 4}, {1, 2}}});
  ASSERT_EQ(region.polygons.size(), 2u);
  EXPECT_TRUE(region.polygons[0].holes.empty());
  EXPECT_EQ(region.polygons[0].outer, (Ring{{0, 0}, {2, 0}, {1, 2}, {2, 4}, {0, 4}}));
}

TEST(Repair, WhatHasNoRuleIsNamed) {
  const double nan = std::nan("");
  const auto refusal = [](const Rings& rings) { return repair(rings).refused.value_or(DataCode::scenario); };
  EXPECT_EQ(refusal({{{0, 0}, {1, nan}, {1, 1}}}), DataCode::not_finite);
  EXPECT_EQ(refusal({{{0, 0}, {4, 0}, {4, 4}}, {{1, 0}, {HUGE_VAL, 0}, {1, 1}}}), DataCode::not_finite);
  EXPECT_EQ(refusal({{}}), DataCode::too_few_points);
  EXPECT_EQ(refusal({{{0, 0}, {1, 0}, {0, 0}}}), DataCode::too_few_points);
  EXPECT_EQ(refusal({{{0, 0}, {1, 0}, {2, 0}}}), DataCode::zero_area);
  EXPECT_EQ(refusal({{{0, 0}, {1, 0}, {1, 1}, {1, 0}}}), DataCode::zero_area);  // an L, there and back
  EXPECT_EQ(refusal({{{0, 0}, {1, 0}, {1, 1}}, {{0, 0}, {1, 0}, {1, 1}}}), DataCode::zero_area);
}

TEST(Repair, CrossingsTooFarOutForFiltersAreRefused) {
  EXPECT_EQ(repair({{{2.2e292, 0}, {-2, 5}, {1, 7}, {3, -4}}}).refused, DataCode::out_of_range);
  const double far = 0x1p99;
  repaired_and_checked({{{far, 0}, {-far, 5}, {-far, 0}, {far, 5}}}, "at the bound");
  EXPECT_TRUE(repair({{{2.2e292, 0}, {5, 5}, {0, 0}}}).ok());  // nothing to cut
}

TEST(Repair, TooManyCrossingsAreRefusedBeforeTheyAreCut) {
  Ring comb;  // a weave of 2 x 600 long edges: 360,000 crossings
  for (int i = 0; i < 600; ++i) comb.push_back({1.0 * i, i % 2 == 0 ? 0.0 : 1000.0});
  for (int i = 0; i < 600; ++i) comb.push_back({i % 2 == 0 ? 0.0 : 1000.0, 1.0 * i});
  EXPECT_EQ(repair({comb}).refused, DataCode::size);
}

// --- Properties over random rings ---

Ring random_ring(exactvo::test::SeededRandom& random, int most, int lattice) {
  Ring ring;
  for (int k = random.integer(3, most); k > 0; --k) {
    if (lattice > 0) {
      ring.push_back({1.0 * random.integer(0, lattice), 1.0 * random.integer(0, lattice)});
    } else {
      ring.push_back(random.in_box(10.0));
    }
  }
  return ring;
}

TEST(RepairProperty, LatticeRingsWithEveryDegeneracy) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(71));
  int repaired = 0;
  for (int k = 0; k < 600; ++k) {
    Rings rings;
    for (int n = random.integer(1, 4); n > 0; --n) rings.push_back(random_ring(random, 9, 5));
    const Repair r = repair(rings);
    if (!r.ok()) {
      const bool is_named = r.refused == DataCode::zero_area || r.refused == DataCode::too_few_points;
      EXPECT_TRUE(is_named) << code_name(*r.refused);
      continue;
    }
    ++repaired;
    expect_properties(r, std::to_string(k));
    expect_area_of_the_rule(rings, r);
  }
  EXPECT_GT(repaired, 450);
}

TEST(RepairProperty, RandomDoublesWithRoundedCrossings) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(73));
  for (int k = 0; k < 120; ++k) {
    Rings rings;
    for (int n = random.integer(1, 3); n > 0; --n) rings.push_back(random_ring(random, 14, 0));
    repaired_and_checked(rings, std::to_string(k));
  }
}

TEST(RepairProperty, FarFromTheOriginCrossingsRoundCoarsely) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(79));
  for (int k = 0; k < 120; ++k) {
    Ring ring = random_ring(random, 12, 0);
    // An ulp here is 2^-10 to 2^-2 m beside rings of 20 m.
    const double far = std::ldexp(1.0, random.integer(43, 51));
    for (Vec2& p : ring) p = p + Vec2{far, -far};
    const Repair r = repair({ring});
    expect_properties(r, std::to_string(k));
    EXPECT_LT(r.moved, 16 * std::ldexp(far, -52)) << k;
  }
}

TEST(RepairProperty, NeedlesAndNearlyParallelEdges) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(83));
  for (int k = 0; k < 150; ++k) {
    Ring ring;
    for (int n = random.integer(4, 9); n > 0; --n)
      ring.push_back({random.uniform(0, 100), random.uniform(0, 1) * std::ldexp(1.0, -random.integer(0, 50))});
    repaired_and_checked({ring}, std::to_string(k));
  }
}

TEST(RepairProperty, PointsLieInsideAsTheRuleSays) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(89));
  for (int k = 0; k < 60; ++k) {
    Rings rings{random_ring(random, 10, 0), random_ring(random, 6, 0)};
    const Repair r = repair(rings);
    ASSERT_TRUE(r.ok());
    for (int n = 0; n < 40; ++n) {
      const Vec2 p = random.in_box(10.0);
      EXPECT_EQ(encloses(rings_of(r.polygons), p), encloses(rings, p)) << k;
    }
  }
}

TEST(RepairProperty, Property3_ValidPolygonsComeBackBitForBit) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(97));
  int judged = 0;
  for (int k = 0; k < 200; ++k) {
    Ring star;  // star-shaped about the origin: simple
    const int n = random.integer(3, 30);
    for (int i = 0; i < n; ++i) {
      const double angle = 6.28318 * i / n;
      star.push_back(random.uniform(1.0, 5.0) * Vec2{std::cos(angle), std::sin(angle)});
    }
    if (!geometry::is_simple(star)) continue;
    const Repair r = repair({star});
    ASSERT_EQ(r.polygons.size(), 1u);
    EXPECT_EQ(r.polygons[0].outer, star);
    Ring turned(star.rbegin(), star.rend());
    const Repair back = repair({turned});
    EXPECT_FALSE(back.recombined);
    ASSERT_EQ(back.polygons.size(), 1u);
    EXPECT_TRUE(std::is_permutation(star.begin(), star.end(), back.polygons[0].outer.begin()));
    EXPECT_EQ(geometry::winding(back.polygons[0].outer), geometry::Sign::positive);
    ++judged;
  }
  EXPECT_GT(judged, 180);
}

TEST(EvenOdd, Property4_OrderWindingAndStartDoNotMatter) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(101));
  for (int k = 0; k < 100; ++k) {
    Rings rings{random_ring(random, 9, k % 2 == 0 ? 6 : 0), random_ring(random, 9, 6)};
    const geometry::EvenOddRegion one = geometry::even_odd_region(rings);
    std::rotate(rings[0].begin(), rings[0].begin() + 1, rings[0].end());
    std::reverse(rings[1].begin(), rings[1].end());
    std::swap(rings[0], rings[1]);
    const geometry::EvenOddRegion other = geometry::even_odd_region(rings);
    ASSERT_EQ(one.polygons.size(), other.polygons.size()) << k;
    for (std::size_t i = 0; i < one.polygons.size(); ++i) EXPECT_TRUE(same(one.polygons[i], other.polygons[i])) << k;
  }
}

// --- The public files ---

TEST(RepairShared, EveryInvalidPolygonIsRepairedOrNamed) {
  EXACTVO_NEEDS_SHARED_DATA();
  std::vector<std::string> folders{"wkt-georust", "wkt-jts", "wkt-osm", "wkt-rvo2",
                                   "earcut-json", "jts-xml", "geos-xml"};
  if (built_with_gdal()) {
    for (const char* more : {"geojson-nasty", "geojson-naturalearth", "geojson-osm", "geojson-polyclip"})
      folders.push_back(more);
  }
  ReadOptions options;
  options.keep_going = true;
  options.repair = true;
  options.units = Units::metres;  // files that span the earth have no plane in metres; rings cross all the same
  std::size_t recombined = 0;
  std::size_t unrepaired = 0;
  for (const ManifestRow& row : manifest_of(folders)) {
    SCOPED_TRACE(row.path);
    const ObstacleFile file = read_obstacles(shared_data() / row.path, options);
    for (const DataError& error : file.rejected) {
      const bool has_no_rule = error.code() == DataCode::too_few_points || error.code() == DataCode::zero_area ||
                               error.code() == DataCode::not_finite;
      EXPECT_TRUE(has_no_rule) << error.what();
      ++unrepaired;
    }
    std::size_t parts = 0;
    for (const RepairRecord& r : file.repairs) {
      parts += r.after.polygons;
      if (!r.recombined || r.refused) continue;
      ++recombined;
      if (r.before.vertices > 150) continue;  // the oracle looks at every pair of edges
      Repair as_record;
      as_record.moved = r.moved;
      EXPECT_NEAR(r.after.area, even_odd_area(r.given),
                  area_tolerance(r.given, as_record) + r.moved * perimeter(r.given))
          << r.place;
    }
    EXPECT_GE(file.obstacles.size(), parts);
    for (const formation::SceneObstacle& o : file.obstacles) {
      const auto* polygon = std::get_if<Polygon>(&o.shape);
      if (polygon == nullptr) continue;
      for (const geometry::RingProblem& p : geometry::normalize(rings_of(*polygon)).problems)
        EXPECT_EQ(p.code, geometry::RingProblemCode::unclosed) << o.id;
    }
  }
  std::printf("%zu polygons cut and recombined, %zu shapes that nothing can be made of\n", recombined, unrepaired);
  EXPECT_GE(recombined, built_with_gdal() ? 122u : 80u);
  EXPECT_LE(unrepaired, 26u);
}

TEST(RepairShared, TheSeamOfLandBecomesAPolygonWithAHole) {
  EXACTVO_NEEDS_SHARED_DATA();
  if (!built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  ReadOptions options;
  options.keep_going = true;
  options.repair = true;
  options.units = Units::metres;
  const ObstacleFile file = read_obstacles(shared_data() / "geojson-naturalearth/ne_110m_land.geojson", options);
  EXPECT_EQ(file.counts.rejected, 0u);
  EXPECT_EQ(file.obstacles.size(), 127u);
  const auto is_cut = [](const RepairRecord& r) { return r.recombined; };
  EXPECT_EQ(std::count_if(file.repairs.begin(), file.repairs.end(), is_cut), 1);
}

}  // namespace
}  // namespace exactvo::datasets::test
