// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What repairs are held to. The oracle knows nothing of arrangements: it slices the rings into horizontal slabs at
/// every vertex and every crossing, in rationals, and counts.

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/datasets/repair.h"
#include "exactvo/geometry/even_odd.h"

namespace exactvo::datasets::test {

using geometry::Polygon;
using geometry::Ring;
using geometry::Vec2;
using Rational = mpq_class;
using Rings = std::vector<Ring>;

struct RationalEdge {
  Rational ax, ay, bx, by;  ///< ay < by: from below to above
  Rational x_at(const Rational& y) const { return ax + (bx - ax) * (y - ay) / (by - ay); }
};

inline std::vector<RationalEdge> sloping_edges(const Rings& rings) {
  std::vector<RationalEdge> edges;
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      Vec2 a = ring[i], b = ring[(i + 1) % ring.size()];
      if (a.y == b.y) continue;
      if (a.y > b.y) std::swap(a, b);
      edges.push_back({a.x, a.y, b.x, b.y});
    }
  }
  return edges;
}

/// The heights at which the order of the edges may change.
inline std::set<Rational> event_heights(const std::vector<RationalEdge>& edges) {
  std::set<Rational> heights;
  for (const RationalEdge& e : edges) heights.insert({e.ay, e.by});
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const RationalEdge &e = edges[i], &f = edges[j];
      const Rational slope_e = (e.bx - e.ax) / (e.by - e.ay), slope_f = (f.bx - f.ax) / (f.by - f.ay);
      if (slope_e == slope_f) continue;
      const Rational y = (f.ax - e.ax + slope_e * e.ay - slope_f * f.ay) / (slope_e - slope_f);
      if (y > e.ay && y < e.by && y > f.ay && y < f.by) heights.insert(y);
    }
  }
  return heights;
}

/// Twice the area between consecutive pairs of edges in one slab: trapezia.
inline Rational doubled_area_of_slab(const std::vector<RationalEdge>& edges, const Rational& low,
                                     const Rational& high) {
  std::vector<std::pair<Rational, Rational>> crossings;  // x in the middle, sum of x below and above
  const Rational middle = (low + high) / 2;
  for (const RationalEdge& e : edges) {
    if (e.ay <= low && e.by >= high) crossings.emplace_back(e.x_at(middle), e.x_at(low) + e.x_at(high));
  }
  std::sort(crossings.begin(), crossings.end());
  Rational sum = 0;
  for (std::size_t k = 0; k + 1 < crossings.size(); k += 2) sum += crossings[k + 1].second - crossings[k].second;
  return sum * (high - low);
}

/// The area enclosed an odd number of times, exactly, then rounded.
inline double even_odd_area(const Rings& rings) {
  const std::vector<RationalEdge> edges = sloping_edges(rings);
  const std::set<Rational> heights = event_heights(edges);
  Rational doubled = 0;
  if (heights.empty()) return 0.0;
  for (auto low = heights.begin(), high = std::next(low); high != heights.end(); ++low, ++high)
    doubled += doubled_area_of_slab(edges, *low, *high);
  return Rational(doubled / 2).get_d();
}

/// Whether an odd number of edges lie to the right of a point that is on none.
inline bool encloses(const Rings& rings, Vec2 p) {
  bool inside = false;
  const Rational px = p.x, py = p.y;
  for (const RationalEdge& e : sloping_edges(rings)) {
    if (e.ay <= py && py < e.by && e.x_at(py) > px) inside = !inside;
  }
  return inside;
}

inline Rings rings_of(const std::vector<Polygon>& polygons) {
  Rings rings;
  for (const Polygon& polygon : polygons) {
    rings.push_back(polygon.outer);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return rings;
}

inline Rings rings_of(const Polygon& polygon) {
  return rings_of(std::vector<Polygon>{polygon});
}

inline bool same(const Polygon& a, const Polygon& b) {
  return a.outer == b.outer && a.holes == b.holes;
}

inline double perimeter(const Rings& rings) {
  double sum = 0.0;
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) sum += norm(ring[(i + 1) % ring.size()] - ring[i]);
  }
  return sum;
}

inline double total_area(const std::vector<Polygon>& polygons) {
  double sum = 0.0;
  for (const Polygon& polygon : polygons) sum += area(polygon);
  return sum;
}

/// Each vertex moved by no more than `moved`: the area between is at most that times the perimeters, and a little for
/// the doubles that areas are summed in.
inline double area_tolerance(const Rings& before, const Repair& repair) {
  double largest = 1e-300;
  for (const Ring& ring : before) {
    for (const Vec2 p : ring) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  }
  constexpr double kSumsInDoubles = 1e-12;
  return repair.moved * (perimeter(before) + perimeter(rings_of(repair.polygons))) + kSumsInDoubles * largest * largest;
}

inline void expect_properties(const Repair& repaired, const std::string& what) {
  SCOPED_TRACE(what);
  ASSERT_TRUE(repaired.ok()) << code_name(*repaired.refused);
  for (const Polygon& polygon : repaired.polygons) {
    // (1) valid, and (2) not touched again.
    const geometry::NormalizedPolygon normal = geometry::normalize(rings_of(polygon));
    for (const geometry::RingProblem& p : normal.problems) EXPECT_EQ(p.code, geometry::RingProblemCode::unclosed);
    const Repair again = repair(rings_of(polygon));
    ASSERT_EQ(again.polygons.size(), 1u);
    EXPECT_TRUE(same(again.polygons[0], polygon));
    EXPECT_FALSE(again.recombined);
  }
  if (repaired.recombined) {
    // (1) insides disjoint, (2): the rings of all of them are a fixed point.
    const geometry::EvenOddRegion again = geometry::even_odd_region(rings_of(repaired.polygons));
    ASSERT_EQ(again.polygons.size(), repaired.polygons.size());
    for (std::size_t k = 0; k < again.polygons.size(); ++k)
      EXPECT_TRUE(same(again.polygons[k], repaired.polygons[k])) << k;
    EXPECT_EQ(again.moved, 0.0);
  }
}

inline void expect_area_of_the_rule(const Rings& rings, const Repair& repaired) {
  EXPECT_NEAR(total_area(repaired.polygons), even_odd_area(rings), area_tolerance(rings, repaired));
}

inline Repair repaired_and_checked(const Rings& rings, const std::string& what) {
  Repair result = repair(rings);
  expect_properties(result, what);
  expect_area_of_the_rule(rings, result);
  return result;
}

}  // namespace exactvo::datasets::test
