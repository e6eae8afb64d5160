// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/validity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>

#include "exactvo/geometry/pi.h"
#include "geometry/random_shapes.h"
#include "geometry/rational_oracle.h"

namespace exactvo::geometry {
namespace {

using test::SeededRandom;

const Ring kSquare = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};

std::string codes(const std::vector<RingProblem>& problems) {
  std::string out;
  for (const RingProblem& p : problems) {
    out += std::string(code_name(p.code)) + "@" + std::to_string(p.ring) + "/" + std::to_string(p.vertex);
    out += p.repaired ? " repaired;" : ";";
  }
  return out;
}

std::string codes_of(const std::vector<Ring>& rings) {
  return codes(normalize(rings).problems);
}

Ring closed(Ring ring) {
  ring.push_back(ring.front());
  return ring;
}

TEST(Normalize, AValidClosedSquareHasNoProblem) {
  const auto result = normalize({closed(kSquare)});
  EXPECT_TRUE(result.ok());
  EXPECT_TRUE(result.problems.empty());
  EXPECT_EQ(result.polygon.outer, kSquare);
}

TEST(Normalize, MendsClosureDuplicatesAndWinding) {
  EXPECT_EQ(codes_of({kSquare}), "E_UNCLOSED@0/3 repaired;");
  EXPECT_EQ(codes_of({{{0, 0}, {4, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {0, 0}}}),
            "E_REPEATED_VERTEX@0/2 repaired;E_REPEATED_VERTEX@0/6 repaired;");
  const auto turned = normalize({{{0, 0}, {0, 4}, {4, 4}, {4, 0}, {0, 0}}});
  EXPECT_EQ(codes(turned.problems), "E_CLOCKWISE@0/0 repaired;");
  EXPECT_EQ(turned.polygon.outer, kSquare);
  const auto hole = normalize({closed(kSquare), {{1, 1}, {2, 1}, {2, 2}, {1, 1}}});
  EXPECT_EQ(codes(hole.problems), "E_CLOCKWISE@1/0 repaired;");
  EXPECT_EQ(hole.polygon.holes[0], (Ring{{1, 1}, {2, 2}, {2, 1}}));
}

TEST(Normalize, ReportsWhatHasNoOneRightAnswer) {
  const double nan = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(codes_of({{{0, 0}, {nan, 1}, {2, infinity}, {0, 0}}}), "E_NOT_FINITE@0/1;E_NOT_FINITE@0/2;");
  EXPECT_EQ(codes_of({{}}), "E_TOO_FEW_POINTS@0/0;");
  EXPECT_EQ(codes_of({{{1, 1}, {2, 2}, {1, 1}}}), "E_TOO_FEW_POINTS@0/0;");
  EXPECT_EQ(codes_of({{{0, 0}, {1, 1}, {2, 2}, {0, 0}}}), "E_ZERO_AREA@0/0;");
  EXPECT_EQ(codes_of({{{0, 0}, {4, 4}, {4, 0}, {0, 4}, {0, 0}}}), "E_SELF_INTERSECTION@0/0;");
  // A spike: out to (6, 0) and back.
  EXPECT_EQ(codes_of({{{0, 0}, {4, 0}, {6, 0}, {4, 0}, {4, 4}, {0, 0}}}).substr(0, 19), "E_SELF_INTERSECTION");
  // A ring that touches itself in the vertex (2, 2).
  EXPECT_EQ(codes_of({{{0, 0}, {2, 2}, {4, 0}, {4, 4}, {2, 2}, {0, 4}, {0, 0}}}).substr(0, 19), "E_SELF_INTERSECTION");
  EXPECT_THROW(normalize({}), std::logic_error);
}

TEST(Normalize, PlacesHoles) {
  const Ring shell = closed(kSquare);
  EXPECT_EQ(codes_of({shell, {{1, 1}, {1, 2}, {2, 2}, {1, 1}}}), "");
  EXPECT_EQ(codes_of({shell, {{0, 2}, {2, 4}, {4, 2}, {2, 0}, {0, 2}}}), "");  // touches in four points
  EXPECT_EQ(codes_of({shell, {{6, 6}, {6, 7}, {7, 7}, {6, 6}}}), "E_HOLE_OUTSIDE@1/0;");
  EXPECT_EQ(codes_of({shell, {{4, 1}, {5, 2}, {5, 1}, {4, 1}}}), "E_HOLE_OUTSIDE@1/0;");  // touches from outside
  EXPECT_NE(codes_of({shell, {{0, 0}, {0, 4}, {4, 4}, {4, 0}, {0, 0}}}).find("E_HOLE_OUTSIDE"), std::string::npos);
  EXPECT_NE(codes_of({shell, {{3, 3}, {3, 5}, {5, 5}, {3, 3}}}).find("E_HOLE_OUTSIDE@1"), std::string::npos);
  // A hole that leaves through a vertex of the shell.
  EXPECT_NE(codes_of({shell, {{3, 3}, {3, 4.5}, {5, 5}, {3, 3}}}).find("E_HOLE_OUTSIDE@1"), std::string::npos);
  const Ring big = {{1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
  EXPECT_EQ(codes_of({shell, big, {{1.5, 1.5}, {2, 2}, {2, 1.5}, {1.5, 1.5}}}), "E_HOLE_OUTSIDE@2/0;");
  EXPECT_NE(codes_of({shell, big, big}).find("E_HOLE_OUTSIDE@2"), std::string::npos);
}

TEST(Normalize, EveryCodeHasItsName) {
  for (int i = 0; i <= static_cast<int>(RingProblemCode::hole_outside); ++i) {
    EXPECT_EQ(std::string(code_name(static_cast<RingProblemCode>(i))).substr(0, 2), "E_");
  }
}

TEST(NormalizePolyline, MendsAndReports) {
  const auto wall = normalize_polyline({{0, 0}, {0, 0}, {1, 1}, {0, 1}, {1, 0}});
  EXPECT_TRUE(wall.ok());  // it may cross itself
  EXPECT_EQ(wall.polyline.points.size(), 4U);
  EXPECT_EQ(codes(wall.problems), "E_REPEATED_VERTEX@0/1 repaired;");
  EXPECT_EQ(codes(normalize_polyline({{1, 2}, {1, 2}}).problems),
            "E_TOO_FEW_POINTS@0/0;E_REPEATED_VERTEX@0/1 repaired;");
  EXPECT_FALSE(normalize_polyline({}).ok());
  EXPECT_FALSE(normalize_polyline({{0, 0}, {std::nan(""), 0}}).ok());
}

std::vector<Segment> edges(const Ring& ring) {
  return edges_of(Polygon{ring, {}});
}

// Every pair of edges, in rationals.
bool oracle_is_simple(const Ring& ring) {
  const auto e = edges(ring);
  const std::size_t n = e.size();
  if (n < 3) return false;
  for (std::size_t i = 0; i < n; ++i) {
    if (e[i].a == e[i].b) return false;
    for (std::size_t j = 0; j < i; ++j) {
      const bool neighbours = i - j == 1 || i - j + 1 == n;
      if (neighbours ? test::segments_overlap(e[i], e[j]) : test::segments_meet(e[i], e[j])) return false;
      if (n == 3 && test::segments_overlap(e[i], e[j])) return false;
    }
  }
  return true;
}

TEST(IsSimple, AgreesWithEveryPairOnAGrid) {
  SeededRandom random(test::seed_of_run(51));
  int simple = 0;
  for (int i = 0; i < 60000; ++i) {
    const Ring ring = test::grid_points(random, random.integer(1, 8), 4);
    const bool expected = oracle_is_simple(ring);
    ASSERT_EQ(is_simple(ring), expected) << to_string(ring);
    if (!expected) continue;
    ++simple;
    ASSERT_EQ(static_cast<int>(winding(ring)), static_cast<int>(CGAL::sign(test::doubled_area(ring))))
        << to_string(ring);
  }
  EXPECT_GT(simple, 1000);
}

TEST(IsSimple, AgreesWithEveryPairWhereVerticesNearlyTouchEdges) {
  SeededRandom random(test::seed_of_run(52));
  for (int i = 0; i < 5000; ++i) {
    Ring ring = test::placed(test::star_ring(random, random.integer(4, 12)), random.uniform(-3, 3), 1.0, 1.0,
                             random.in_box(i % 2 == 0 ? 0.0 : 1e6));
    // A vertex goes to within an ulp of a random edge.
    const auto n = static_cast<int>(ring.size());
    const auto at = static_cast<std::size_t>(random.integer(0, n - 1));
    const Segment e = edges(ring)[static_cast<std::size_t>(random.integer(0, n - 1))];
    ring[at] = e.a + random.uniform(0, 1) * (e.b - e.a);
    ASSERT_EQ(is_simple(ring), oracle_is_simple(ring)) << to_string(ring);
  }
}

// Whether the rational point lies strictly inside the ring (it is not on it).
bool strictly_inside(const Ring& ring, const test::RationalPoint& p) {
  bool odd = false;
  for (const Segment& e : edges(ring)) {
    const auto a = test::rational(e.a), b = test::rational(e.b);
    if ((a.y <= p.y) == (b.y <= p.y)) continue;
    const test::Rational x = a.x + (p.y - a.y) * (b.x - a.x) / (b.y - a.y);
    if (x > p.x) odd = !odd;
  }
  return odd;
}

// The middles of the pieces into which the other rings' touches cut this ring's edges.
std::vector<test::RationalPoint> piece_middles(const Ring& ring, const Ring& other) {
  std::vector<test::RationalPoint> middles;
  for (const Segment& e : edges(ring)) {
    std::vector<Vec2> cuts = {e.a, e.b};
    for (const Vec2 v : other) {
      if (test::on_segment(e, v)) cuts.push_back(v);
    }
    std::sort(cuts.begin(), cuts.end(), [&](Vec2 p, Vec2 q) {
      return dot(p - e.a, e.b - e.a) < dot(q - e.a, e.b - e.a);  // exact on a small grid
    });
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      const auto p = test::rational(cuts[i - 1]), q = test::rational(cuts[i]);
      if (cuts[i - 1] != cuts[i]) middles.push_back({(p.x + q.x) / 2, (p.y + q.y) / 2});
    }
  }
  return middles;
}

bool edges_cross_or_overlap(const Ring& a, const Ring& b) {
  for (const Segment& s : edges(a)) {
    for (const Segment& t : edges(b)) {
      if (test::segments_overlap(s, t)) return true;
      const bool touches =
          test::on_segment(s, t.a) || test::on_segment(s, t.b) || test::on_segment(t, s.a) || test::on_segment(t, s.b);
      if (!touches && test::segments_meet(s, t)) return true;
    }
  }
  return false;
}

bool lies_wholly(const Ring& ring, const Ring& other, bool inside) {
  const auto middles = piece_middles(ring, other);
  return std::all_of(middles.begin(), middles.end(),
                     [&](const test::RationalPoint& p) { return strictly_inside(other, p) == inside; });
}

bool oracle_holes_fit(const std::vector<Ring>& rings) {
  for (std::size_t i = 0; i < rings.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (edges_cross_or_overlap(rings[i], rings[j])) return false;
      if (!lies_wholly(rings[i], rings[j], j == 0)) return false;
      if (j > 0 && !lies_wholly(rings[j], rings[i], false)) return false;
    }
  }
  return true;
}

Ring random_simple_ring(SeededRandom& random, int size) {
  for (;;) {
    Ring ring = test::grid_points(random, random.integer(3, 6), size);
    if (is_simple(ring)) return ring;
  }
}

TEST(Normalize, HolePlacementAgreesWithRationalsOnAGrid) {
  SeededRandom random(test::seed_of_run(53));
  int fitting = 0;
  for (int i = 0; i < 30000; ++i) {
    std::vector<Ring> rings = {random.integer(0, 1) == 0 ? Ring{{0, 0}, {5, 0}, {5, 5}, {0, 5}}
                                                         : random_simple_ring(random, 5)};
    for (int k = random.integer(1, 2); k > 0; --k) rings.push_back(random_simple_ring(random, 5));
    const bool expected = oracle_holes_fit(rings);
    fitting += expected ? 1 : 0;
    std::string text;
    for (const Ring& r : rings) text += to_string(r) + "\n";
    ASSERT_EQ(normalize(rings).ok(), expected) << text << codes_of(rings);
  }
  EXPECT_GT(fitting, 1000);
}

Ring rotated_start(Ring ring, int by) {
  std::rotate(ring.begin(), ring.begin() + by % static_cast<int>(ring.size()), ring.end());
  return ring;
}

// Properties 1 to 3 of `normalize`.
TEST(Normalize, Properties1To3) {
  SeededRandom random(test::seed_of_run(54));
  int valid = 0, with_hole = 0;
  for (int i = 0; i < 20000; ++i) {
    std::vector<Ring> rings = {test::grid_points(random, random.integer(3, 7), 5)};
    if (random.integer(0, 1) == 1) rings.push_back(test::grid_points(random, random.integer(3, 5), 5));
    const auto result = normalize(rings);
    std::vector<Ring> moved = rings;
    for (Ring& r : moved) {
      r = rotated_start(r, random.integer(0, 6));
      if (random.integer(0, 1) == 1) std::reverse(r.begin(), r.end());
    }
    // A ring that starts on a repeated vertex is closed by chance, which changes nothing.
    ASSERT_EQ(normalize(moved).ok(), result.ok()) << to_string(rings[0]) << "\n" << codes(result.problems);
    if (!result.ok()) continue;
    std::vector<Ring> again = {closed(result.polygon.outer)};
    for (const Ring& hole : result.polygon.holes) again.push_back(closed(hole));
    const auto second = normalize(again);
    ASSERT_TRUE(second.problems.empty()) << codes(second.problems);
    ASSERT_EQ(second.polygon.outer, result.polygon.outer);
    ASSERT_EQ(second.polygon.holes, result.polygon.holes);
    ++valid;
    with_hole += !result.polygon.holes.empty();
  }
  EXPECT_GT(valid, 1000);
  EXPECT_GT(with_hole, 0);
}

Ring gear(int n, Vec2 center, double radius) {
  Ring ring;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * kPi * i / n;
    ring.push_back(center + (radius * (1 + 0.1 * (i % 2))) * Vec2{std::cos(angle), std::sin(angle)});
  }
  return ring;
}

// The height of the outer ring is beyond the doubles, and a vertex at its top was sought in a slab that is not there.
TEST(Normalize, AHoleInARingAsHighAsAllDoubles) {
  for (const double far : {1.0, 1.5e308}) {
    Ring outer;
    for (int k = 0; k < 100; ++k) outer.push_back({1.0 * k, -far});
    outer.push_back({99.0, far});
    outer.push_back({0.0, far});
    const Ring hole{{10.0, 0.0}, {10.0, 0.5}, {11.0, 0.5}, {11.0, 0.0}}, beside{{-2, 0}, {-2, 0.5}, {-1, 0.5}, {-1, 0}};
    EXPECT_TRUE(normalize({outer, hole}).ok()) << far;
    EXPECT_FALSE(normalize({outer, beside}).ok()) << far;
  }
}

TEST(Normalize, AHoleInARingThatIsNearlyFlat) {
  const auto is_ok = [](double height) {
    Ring outer;
    for (int k = 0; k < 100; ++k) outer.push_back({1.0 * k, 0.0});
    outer.push_back({99.0, height});
    outer.push_back({0.0, height});
    return normalize({outer, {{10.0, 0.0}, {11.0, 0.0}, {11.0, height}, {10.0, height}}}).ok();
  };
  for (const double height : {5e-324, 1e-323, 2e-308}) EXPECT_EQ(is_ok(height), is_ok(1.0)) << height;
}

double seconds_to_normalize(const std::vector<Ring>& rings) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(normalize(rings).ok());
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The sizes met in public data: a ring of 39,000 vertices, a polygon of 1443 holes. Here they take about 0.1 s; the
// bound only rules out a quadratic method.
TEST(Normalize, LargeRingsInTime) {
  EXPECT_LT(seconds_to_normalize({gear(39000, {2e7, -2e7}, 1e4)}), 20.0);
  std::vector<Ring> sieve = {gear(4000, {0, 0}, 100.0)};
  for (int i = 0; i < 1443; ++i) sieve.push_back(gear(12, {3.0 * (i % 38) - 57, 3.0 * (i / 38) - 57}, 1.0));
  EXPECT_LT(seconds_to_normalize(sieve), 20.0);
  // Needles side by side: the boxes of any two edges meet, so that pairs of boxes would be quadratic.
  Ring comb;
  for (int i = 0; i < 10000; ++i) {
    comb.push_back({1.0 * i, 0.5 * i});
    comb.push_back({i + 5000.5, 0.5 * i + 40000});
  }
  comb.push_back({1e5, -10});
  comb.push_back({-10, -10});
  EXPECT_LT(seconds_to_normalize({comb}), 20.0);
}

}  // namespace
}  // namespace exactvo::geometry
