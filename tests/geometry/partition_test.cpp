// SPDX-License-Identifier: GPL-3.0-or-later
// Convex pieces of rings that are hard to split, judged in plain rationals; and the corpus that they come from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pieces.h"
#include "exactvo/geometry/validity.h"
#include "geometry/random_shapes.h"
#include "geometry/rational_oracle.h"
#include "support/corpus.h"

namespace exactvo::geometry {
namespace {

using test::SeededRandom;

constexpr PartitionMethod kEveryMethod[] = {PartitionMethod::automatic, PartitionMethod::greene,
                                            PartitionMethod::approximate, PartitionMethod::triangles};

bool is_convex(const std::vector<Vec2>& v) {
  for (std::size_t k = 0; k < v.size(); ++k) {
    if (test::turn(v[k], v[(k + 1) % v.size()], v[(k + 2) % v.size()]) < 0) return false;
  }
  return v.size() >= 3;
}

// Every piece is convex and counter-clockwise, and the areas add up to the ring's, exactly.
void expect_partition(const Ring& ring, PartitionMethod method) {
  SCOPED_TRACE("method " + std::to_string(static_cast<int>(method)) + "\n" + test::corpus_line(ring));
  test::Rational sum = 0;
  for (const ConvexPolygon& piece : convex_pieces(ring, method)) {
    ASSERT_TRUE(is_convex(piece.vertices)) << to_string(ConvexShape{piece});
    ASSERT_TRUE(is_valid(piece));
    sum += test::doubled_area(piece.vertices);
  }
  ASSERT_TRUE(sum == test::doubled_area(ring));
}

TEST(ConvexCover, OfAConvexObstacleIsOneShape) {
  const Obstacle square = Polygon{{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}, {}};
  EXPECT_TRUE(is_convex(square));
  ASSERT_EQ(convex_cover(square).size(), 1u);
  EXPECT_EQ(std::get<ConvexPolygon>(convex_cover(square)[0]).vertices.size(), 4u);
  const Obstacle straight = Polyline{{{0, 0}, {3, 3}, {1, 1}}};
  EXPECT_TRUE(is_convex(straight));
  EXPECT_EQ(std::get<Segment>(convex_cover(straight).at(0)).b, (Vec2{3, 3}));
}

TEST(ConvexCover, OfAnotherObstacleIsThatObstacleExactly) {
  const Obstacle court = Polygon{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{{2, 2}, {2, 8}, {8, 8}, {8, 2}}}};
  EXPECT_FALSE(is_convex(court));
  test::Rational sum = 0;
  for (const ConvexShape& piece : convex_cover(court)) {
    ASSERT_TRUE(is_valid(piece));
    sum += test::doubled_area(std::get<ConvexPolygon>(piece).vertices);
  }
  EXPECT_TRUE(sum == 2 * (100 - 36));
  const Obstacle corner = Polyline{{{0, 0}, {2, 0}, {4, 0}, {4, 4}}};
  EXPECT_FALSE(is_convex(corner));
  const auto edges = convex_cover(corner);
  ASSERT_EQ(edges.size(), 2u);
  EXPECT_EQ(std::get<Segment>(edges[0]).b, (Vec2{4, 0}));
}

TEST(ConvexPieces, EveryRingOfTheCorpus) {
  const std::vector<test::CorpusCase> cases = test::read_corpus("geometry/convex_pieces.txt");
  ASSERT_FALSE(cases.empty());
  for (const test::CorpusCase& one : cases) {
    for (const PartitionMethod method : kEveryMethod) expect_partition(test::ring_of(one), method);
  }
}

TEST(ConvexPieces, LargeStarsByEveryMethod) {
  SeededRandom random(test::seed_of_run(35));
  for (int i = 0; i < 60; ++i) {
    const Ring ring = test::star_ring(random, random.integer(33, 300), 0.05);
    ASSERT_TRUE(is_simple(ring)) << test::corpus_line(ring);
    for (const PartitionMethod method : kEveryMethod) expect_partition(ring, method);
  }
}

// A staircase down one side of a comb: collinear vertices, cocircular corners, every angle a right one.
Ring staircase(int steps) {
  Ring ring{{0, 0}};
  for (int i = 0; i < steps; ++i) {
    ring.push_back({i + 1.0, static_cast<double>(i)});
    ring.push_back({i + 1.0, i + 1.0});
  }
  ring.push_back({0, static_cast<double>(steps)});
  for (int i = steps - 1; i > 0; --i) ring.push_back({0, static_cast<double>(i)});
  return ring;
}

TEST(ConvexPieces, StaircasesByEveryMethod) {
  for (const int steps : {2, 20, 100}) {
    const Ring ring = staircase(steps);
    ASSERT_TRUE(is_simple(ring) && winding(ring) == Sign::positive);
    for (const PartitionMethod method : kEveryMethod) expect_partition(ring, method);
  }
}

// Hertel and Mehlhorn: at most four times the least number; a convex ring stays whole.
TEST(ConvexPieces, TrianglesAreMerged) {
  SeededRandom random(test::seed_of_run(36));
  for (int i = 0; i < 100; ++i) {
    const Ring ring = test::star_ring(random, random.integer(4, 24));
    const std::size_t least = convex_pieces(ring, PartitionMethod::optimal).size();
    ASSERT_LE(convex_pieces(ring, PartitionMethod::triangles).size(), 4 * least) << test::corpus_line(ring);
    const Ring hull = convex_hull(ring).vertices;
    ASSERT_EQ(convex_pieces(hull, PartitionMethod::triangles).size(), 1U) << test::corpus_line(hull);
  }
}

TEST(ConvexPieces, MessagesShowAFewVertices) {
  Ring ring;
  for (int i = 0; i < 1000; ++i) ring.push_back({static_cast<double>(i), i % 2 == 0 ? 1.0 : -1.0});
  try {
    convex_pieces(ring);
    FAIL() << "a zigzag is no simple ring";
  } catch (const std::logic_error& error) {
    EXPECT_LT(std::string(error.what()).size(), 400U) << error.what();
    EXPECT_NE(std::string(error.what()).find("1000 points"), std::string::npos) << error.what();
  }
}

TEST(Corpus, ALineReadsBackBitForBit) {
  const Ring ring = {{0.1, -0.0}, {1e-310, 1.0 / 3.0}, {-1e300, 2.0}};
  const auto cases = test::parse_corpus("# why\n\n" + test::corpus_line(ring) + "\n", "text");
  ASSERT_EQ(cases.size(), 1U);
  const Ring back = test::ring_of(cases.front());
  EXPECT_EQ(back, ring);
  EXPECT_TRUE(std::signbit(back[0].y));
}

TEST(Corpus, RefusesWhatItCannotRead) {
  EXPECT_THROW(test::parse_corpus("ring 1 0x1p+0 two\n", "text"), std::runtime_error);
  EXPECT_THROW(test::ring_of({"ring", {3, 0, 0}}), std::runtime_error);
  EXPECT_THROW(test::ring_of({"disc", {1, 0, 0}}), std::runtime_error);
  EXPECT_THROW(test::read_corpus("geometry/no_such_file.txt"), std::runtime_error);
}

/// What needs no partition is not asked of CGAL; the piece is the one that it would give.
TEST(ConvexPieces, AConvexRingIsItsOwnPieceAsTheOptimalPartitionHasIt) {
  SeededRandom random(17);
  std::size_t judged = 0;
  for (int k = 0; k < 600; ++k) {
    std::vector<Vec2> points;
    for (int i = random.integer(3, 30); i > 0; --i) {
      const double angle = random.uniform(0.0, 6.28);
      const Vec2 on_ellipse{3.0 * std::cos(angle), 2.0 * std::sin(angle)};
      const Vec2 on_grid{0.1 * random.integer(0, 9), 0.1 * random.integer(0, 9)};
      points.push_back(k % 2 == 0 ? on_ellipse : on_grid);
    }
    std::vector<Vec2> ring = convex_hull(points).vertices;
    if (ring.size() < 3) continue;
    std::rotate(ring.begin(), ring.begin() + random.integer(0, static_cast<int>(ring.size()) - 1), ring.end());
    const std::vector<ConvexPolygon> pieces = convex_pieces(ring);
    const std::vector<ConvexPolygon> by_cgal = convex_pieces(ring, PartitionMethod::optimal);
    ASSERT_EQ(pieces.size(), 1u) << test::corpus_line(ring);
    ASSERT_EQ(by_cgal.size(), 1u) << test::corpus_line(ring);
    EXPECT_EQ(pieces[0].vertices, ring) << test::corpus_line(ring);
    EXPECT_EQ(by_cgal[0].vertices, ring) << test::corpus_line(ring);
    ++judged;
  }
  EXPECT_GT(judged, 400u);
}

/// A vertex in the middle of a side is left to the partition.
TEST(ConvexPieces, AStraightVertexIsLeftToThePartition) {
  const Ring ring{{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {0.0, 1.0}};
  const std::vector<ConvexPolygon> pieces = convex_pieces(ring),
                                   by_cgal = convex_pieces(ring, PartitionMethod::optimal);
  ASSERT_EQ(pieces.size(), by_cgal.size());
  for (std::size_t k = 0; k < pieces.size(); ++k) EXPECT_EQ(pieces[k].vertices, by_cgal[k].vertices);
}

}  // namespace
}  // namespace exactvo::geometry
