// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/generators.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "exactvo/datasets/obstacle_write.h"
#include "exactvo/geometry/validity.h"

namespace exactvo::datasets::test {
namespace {

using formation::SceneObstacle;
using geometry::Polygon;
using geometry::Vec2;

std::vector<SceneObstacle> items(const std::string& kind, std::uint64_t count, std::uint64_t seed) {
  std::vector<SceneObstacle> all;
  for (std::uint64_t k = 0; k < count; ++k) {
    for (SceneObstacle& o : generated_item(kind, k, seed)) all.push_back(std::move(o));
  }
  return all;
}

/// FNV-1a over the text, whose digits are the doubles' own.
std::uint64_t hash_of(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

class Generator : public ::testing::TestWithParam<std::string> {};

TEST_P(Generator, TheSameSeedGivesTheSameBitsEverywhere) {
  // 100 items of seed 7, recorded. The fields are left out: random_fields_test has theirs.
  static const std::map<std::string, std::uint64_t> kGolden{
      {"polygon", 0x195f126d11322faaULL}, {"star", 0x8866840d5b4a677eULL}, {"wall", 0x1d219736d366098aULL},
      {"needle", 0x7a579a3adfadf185ULL},  {"maze", 0xf079a0656c793861ULL}, {"block", 0x14cc3bed821a5ca0ULL},
      {"floor", 0x23a58dca58ec15e4ULL}};
  const auto golden = kGolden.find(GetParam());
  const std::uint64_t hash = hash_of(to_wkt(items(GetParam(), 100, 7)));
  if (golden == kGolden.end()) {
    EXPECT_EQ(GetParam().rfind("field-", 0), 0u);
    return;
  }
  EXPECT_EQ(hash, golden->second) << GetParam() << " 0x" << std::hex << hash;
}

TEST_P(Generator, Property1_ItemsDependOnNothingElse) {
  const std::string late = to_wkt(generated_item(GetParam(), 41, 3));
  items(GetParam(), 5, 3);
  EXPECT_EQ(to_wkt(generated_item(GetParam(), 41, 3)), late);
  EXPECT_NE(to_wkt(generated_item(GetParam(), 41, 4)), late);
  EXPECT_NE(to_wkt(generated_item(GetParam(), 42, 3)), late);
}

TEST_P(Generator, Property2_EveryObstacleIsValid) {
  std::size_t polygons = 0, walls = 0;
  for (const SceneObstacle& o : items(GetParam(), 300, 11)) {
    if (const auto* line = std::get_if<geometry::Polyline>(&o.shape)) {
      ++walls;
      EXPECT_TRUE(geometry::normalize_polyline(line->points).problems.empty()) << o.id;
      continue;
    }
    ++polygons;
    const auto& polygon = std::get<Polygon>(o.shape);
    std::vector<geometry::Ring> rings{polygon.outer};
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
    for (const geometry::RingProblem& p : geometry::normalize(rings).problems)
      EXPECT_EQ(p.code, geometry::RingProblemCode::unclosed) << o.id;
  }
  EXPECT_GE(polygons + walls, 300u);
}

struct Box {
  Vec2 low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
  bool meets(const Box& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y;
  }
};

TEST_P(Generator, Property3_ItemsKeepToTheirSquares) {
  std::vector<Box> boxes;
  for (std::uint64_t k = 0; k < 64; ++k) {
    Box& box = boxes.emplace_back();
    for (const SceneObstacle& o : generated_item(GetParam(), k, 5)) {
      for (const Vec2 p : vertices_of(o.shape)) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
      }
    }
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(boxes[i].meets(boxes[j])) << i << " " << j;
  }
}

TEST_P(Generator, FarItemsAreAsGood) {
  const auto item = generated_item(GetParam(), 9'999'999, 5);
  EXPECT_FALSE(item.empty());
  for (const SceneObstacle& o : item) {
    if (const auto* polygon = std::get_if<Polygon>(&o.shape)) {
      EXPECT_TRUE(geometry::is_simple(polygon->outer)) << o.id;
    } else {
      EXPECT_TRUE(geometry::normalize_polyline(std::get<geometry::Polyline>(o.shape).points).problems.empty()) << o.id;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Generator, ::testing::ValuesIn(generator_kind_names()), [](const auto& each) {
  std::string name = each.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Generators, AnUnknownKindIsTheCallersMistake) {
  EXPECT_THROW(generated_item("dragon", 0, 1), std::logic_error);
}

}  // namespace
}  // namespace exactvo::datasets::test
