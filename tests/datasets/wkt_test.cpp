// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "exactvo/datasets/obstacle_file.h"
#include "refusal.h"

namespace exactvo::datasets::test {
namespace {

using geometry::Polygon;
using geometry::Polyline;
using geometry::Vec2;

ObstacleFile parse(const std::string& text) {
  return parse_wkt(text, "t.wkt");
}

ObstacleFile parse_on(const std::string& text) {
  ReadOptions options;
  options.keep_going = true;
  return parse_wkt(text, "t.wkt", options);
}

DataError refused(const std::string& text) {
  return refusal_of([&] { parse(text); });
}

TEST(Wkt, ReadsLinesAndPolygonsWithHoles) {
  const ObstacleFile file = parse(
      "LINESTRING (0 0, 1 2, 3 4)\n"
      "POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0), (1 1, 1 2, 2 2, 1 1))");
  ASSERT_EQ(file.obstacles.size(), 2u);
  EXPECT_EQ(std::get<Polyline>(file.obstacles[0].shape).points, (std::vector<Vec2>{{0, 0}, {1, 2}, {3, 4}}));
  const auto& polygon = std::get<Polygon>(file.obstacles[1].shape);
  EXPECT_EQ(polygon.outer, (std::vector<Vec2>{{0, 0}, {9, 0}, {9, 9}, {0, 9}}));
  EXPECT_EQ(polygon.holes.size(), 1u);
  EXPECT_EQ(file.counts.done, 2u);
  EXPECT_TRUE(file.notes.empty());
}

TEST(Wkt, EveryKindAndSpelling) {
  const ObstacleFile file = parse(
      "\xef\xbb\xbfSRID=0;polygon z((0 0 1,1 0 1,1 1 1,0 0 1));\n\n"
      "MultiPolygon M (((0 0 5, 1 0 5, 1 1 5, 0 0 5)), ((2 2 5, 3 2 5, 3 3 5, 2 2 5)))\n"
      "MULTILINESTRINGZM((0 0 1 2, 1 1 1 2),(2 2 1 2, 3 3 1 2))\n"
      "LINEARRING(0 0,1 0,\n  1 1,0 0)\n"
      "TRIANGLE((0 0,+1e0 0,1 .5,0 0))\n"
      "GEOMETRYCOLLECTION(POINT(1 1),GEOMETRYCOLLECTION(LINESTRING(0 0,1 1),POLYGON EMPTY))");
  EXPECT_EQ(file.obstacles.size(), 1u + 2u + 2u + 1u + 1u + 1u);
  EXPECT_EQ(file.obstacles[2].id, "2.2");
  EXPECT_EQ(file.counts.passed_over, 2u) << "the point and the empty polygon";
  EXPECT_EQ(file.counts.read, 10u);
}

TEST(Wkt, PointsAndEmptiesArePassedOverWithANote) {
  const ObstacleFile file = parse(
      "POINT (1 2)\nMULTIPOINT ((1 2), (3 4))\nMULTIPOINT (1 2, 3 4)\nPOINT EMPTY\n"
      "POLYGON Z EMPTY\nGEOMETRYCOLLECTION EMPTY\nMULTIPOLYGON (EMPTY)");
  EXPECT_TRUE(file.obstacles.empty());
  EXPECT_EQ(file.notes.size(), 7u);
  EXPECT_EQ(file.counts.passed_over, 7u);
  EXPECT_EQ(file.notes[0].place, "line 1, column 1");
  EXPECT_FALSE(file.notes[0].code.has_value());
}

TEST(Wkt, RepairsAreNoted) {
  const ObstacleFile file = parse("POLYGON ((0 0, 0 1, 1 1, 1 1, 1 0))\nLINESTRING (0 0, 0 0, 1 1)");
  EXPECT_EQ(file.counts.repaired, 2u);
  std::vector<DataCode> codes;
  for (const DataNote& note : file.notes) codes.push_back(note.code.value());
  EXPECT_EQ(std::count(codes.begin(), codes.end(), DataCode::unclosed), 1);
  EXPECT_EQ(std::count(codes.begin(), codes.end(), DataCode::clockwise), 1);
  EXPECT_EQ(std::count(codes.begin(), codes.end(), DataCode::repeated_vertex), 2);
}

TEST(Wkt, WhatCannotBeReadIsPlaced) {
  expect_refusal(refused("CIRCLE (0 0)"), DataCode::format_syntax, "line 1, column 1");
  expect_refusal(refused("POLYGON 0 0"), DataCode::format_syntax, "line 1, column 9");
  expect_refusal(refused("POLYGON ((0 0,\n 1 x, 1 1, 0 0))"), DataCode::number, "line 2, column 4");
  expect_refusal(refused("LINESTRING (0 0, 1"), DataCode::number, "line 1, column 19");
  expect_refusal(refused("LINESTRING (0 0, 1 2 3 4 5)"), DataCode::format_syntax, "line 1, column 26");
  expect_refusal(refused("LINESTRING (0 0, 1 2"), DataCode::format_syntax, "line 1, column 21");
  expect_refusal(refused("LINESTRING (0 0, nan 2)"), DataCode::not_finite, "line 1, column 1, ring 0, vertex 1");
  expect_refusal(refused("POLYGON ((0 0, 1e999 0, 1 1))"), DataCode::not_finite, "line 1, column 1, ring 0, vertex 1");
  expect_refusal(refused("LINESTRING (1 1, 1 1)"), DataCode::too_few_points, "line 1, column 1, ring 0, vertex 0");
  expect_refusal(refused("POLYGON ((0 0, 2 2, 2 0, 0 2, 0 0))"), DataCode::self_intersection,
                 "line 1, column 1, ring 0, vertex 0");
}

TEST(Wkt, CoordinatesGoToTheFarthestAndNoFarther) {
  // 2^100 in decimal, and the double above it.
  EXPECT_EQ(parse("LINESTRING (1267650600228229401496703205376 0, 0 -1267650600228229401496703205376)").counts.done,
            1u);
  expect_refusal(refused("LINESTRING (0 0, 1267650600228229682971679916032 0)"), DataCode::out_of_range,
                 "line 1, column 1, ring 0, vertex 1");
  expect_refusal(refused("POLYGON ((0 0, 1 0, 1 1), (0 0, 0 0, 0 -1e200))"), DataCode::out_of_range,
                 "line 1, column 1, ring 1, vertex 2");
}

TEST(Wkt, AnUnderflowIsNoInfinity) {
  const ObstacleFile file = parse("LINESTRING (0 1e-999, 1 1)");
  EXPECT_EQ(std::get<Polyline>(file.obstacles.at(0).shape).points[0], (Vec2{0, 0}));
}

TEST(Wkt, OneBadGeometryDoesNotStopTheRest) {
  const ObstacleFile file = parse_on(
      "LINESTRING (0 0, 1 1)\n"
      "FOO BAR\n"
      "POLYGON ((0 0, 1 1\n"
      "LINESTRING (0 0, 2 2)\n"
      "POLYGON ((0 0, 2 2, 2 0, 0 2, 0 0))\n"
      "LINESTRING (0 0, 3 3)\n");
  EXPECT_EQ(file.obstacles.size(), 3u);
  ASSERT_EQ(file.rejected.size(), 3u);
  EXPECT_EQ(file.rejected[0].code(), DataCode::format_syntax);
  EXPECT_EQ(file.rejected[2].code(), DataCode::self_intersection);
  EXPECT_EQ(file.counts.read, 6u);
  EXPECT_EQ(file.counts.rejected, 3u);
  EXPECT_EQ(file.counts.done, 3u);
}

TEST(Wkt, EndlessNestingIsRefused) {
  std::string text;
  for (int k = 0; k < 100000; ++k) text += "GEOMETRYCOLLECTION(";
  EXPECT_EQ(refused(text).code(), DataCode::nesting);
}

TEST(Wkt, DegreesNeedAFormatThatKnowsThem) {
  ReadOptions options;
  options.units = Units::degrees;
  EXPECT_EQ(refusal_of([&] { parse_wkt("POINT EMPTY", "t.wkt", options); }).code(), DataCode::projection);
}

}  // namespace
}  // namespace exactvo::datasets::test
