// SPDX-License-Identifier: GPL-3.0-or-later
// Enclosures are the recorded bits, which were recorded when the search asked every candidate in full: what it rules
// out by a glance at two points changes no ellipse. Record anew only for a change that is meant to change them.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "exactvo/datasets/provenance.h"
#include "exactvo/geometry/enclosure.h"
#include "support/c_library.h"
#include "support/seeded_random.h"

namespace exactvo::geometry {
namespace {

using test::append_bits;
using test::SeededRandom;

void append(std::string& bytes, const ConvexShape& shape) {
  if (const auto* e = std::get_if<Ellipse>(&shape))
    for (const double x : {e->center.x, e->center.y, e->l11, e->l21, e->l22}) append_bits(bytes, x);
  if (const auto* polygon = std::get_if<ConvexPolygon>(&shape))
    for (const Vec2 v : polygon->vertices)
      for (const double x : {v.x, v.y}) append_bits(bytes, x);
}

std::string digest(const std::string& bytes) {
  return datasets::sha256_of(bytes).substr(0, 16);
}

/// Walls, blobs and needles, with ends near and far: every grade comes up, and fits that fail.
TEST(FitTrapFree, GivesTheRecordedBits) {
  if (!test::c_library_is_the_recorded_one()) GTEST_SKIP() << "another C library rounds otherwise";
  SeededRandom random(2026);
  std::string bytes;
  int grades[4] = {};
  for (int k = 0; k < 400; ++k) {
    const Vec2 middle = random.in_box(k % 5 == 0 ? 1e3 : 5.0);
    const Vec2 along = random.direction();
    const double length = random.uniform(0.0, 4.0), height = k % 4 == 0 ? 0.0 : random.uniform(0.0, 2.0);
    std::vector<Vec2> points;
    for (int i = 0; i < 1 + k % 40; ++i) {
      const Vec2 p = random.in_box(1.0);
      points.push_back(middle + p.x * length * along + p.y * height * perp(along));
    }
    const double to_start = random.uniform(0.5, 8.0), to_goal = random.uniform(0.5, 8.0);
    const Vec2 start = middle + to_start * random.direction();
    const Vec2 goal = middle + to_goal * random.direction();
    EnclosureOptions options;
    if (k % 7 == 0) options.margin = options.least_margin = 0.0;
    const auto fitted = fit_trap_free(points, k % 6 == 0 ? 0.0 : random.uniform(0.05, 0.6), start, goal, options);
    append_bits(bytes, fitted ? static_cast<double>(fitted->grade) : -1.0);
    if (fitted) append(bytes, fitted->ellipse);
    ++grades[fitted ? static_cast<int>(fitted->grade) : 3];
  }
  for (const int count : grades) EXPECT_GT(count, 5);
  EXPECT_EQ(digest(bytes), "11eef9e06d7b9fb9");
}

/// Forests of posts and walls, whose enclosures merge again and again.
TEST(Enclose, GivesTheRecordedBits) {
  if (!test::c_library_is_the_recorded_one()) GTEST_SKIP() << "another C library rounds otherwise";
  SeededRandom random(2027);
  std::string bytes;
  std::size_t merged = 0;
  for (int k = 0; k < 6; ++k) {
    std::vector<ObstacleParts> obstacles;
    for (int i = 0; i < 40; ++i) {
      const Vec2 at = random.in_box(8.0);
      if (i % 3 == 0) {
        obstacles.push_back(parts_of(Polyline{{at, at + random.in_box(1.0), at + random.in_box(1.0)}}));
      } else {
        const double r = random.uniform(0.05, 0.5);
        obstacles.push_back(parts_of(Polygon{{at, at + Vec2{r, 0}, at + Vec2{r, r}, at + Vec2{0, r}}, {}}));
      }
    }
    const Vec2 start{-12.0, random.uniform(-6.0, 6.0)}, goal{12.0, random.uniform(-6.0, 6.0)};
    for (const Enclosure& e : enclose(obstacles, 0.2, start, goal)) {
      append_bits(bytes, static_cast<double>(e.grade));
      for (const std::size_t o : e.obstacles) append_bits(bytes, static_cast<double>(o));
      append(bytes, e.shape);
      merged += e.obstacles.size() > 2;
    }
  }
  EXPECT_GT(merged, 3u);
  EXPECT_EQ(digest(bytes), "53bd90c011ca1e54");
}

}  // namespace
}  // namespace exactvo::geometry
