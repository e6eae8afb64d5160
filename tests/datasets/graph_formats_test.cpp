// SPDX-License-Identifier: GPL-3.0-or-later
// Formats of other people's tests: suites of JTS, polygons as graphs, OMPL's scenes, OpenTraj's walls.
#include <gtest/gtest.h>

#include "exactvo/datasets/obstacle_file.h"
#include "refusal.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using geometry::Polygon;
using geometry::Polyline;
using geometry::Ring;
using GraphFormats = TemporaryFolder;

ReadOptions going_on() {
  ReadOptions options;
  options.keep_going = true;
  return options;
}

TEST_F(GraphFormats, ArgumentsOfJtsCasesAreRead) {
  const auto path =
      put("t.xml",
          "<run>\n<case><desc>x</desc>\n<a>\n POLYGON((0 0, 4 0, 4 4, 0 0)) </a><b>LINESTRING(0 0, 1 1)</b>"
          "<test><op>POLYGON((9 9, 8 9, 8 8, 9 9))</op></test></case>\n<case><a>0101000000</a></case></run>");
  const ObstacleFile file = read_obstacles(path, going_on());
  EXPECT_EQ(file.format, "jts-xml");
  ASSERT_EQ(file.obstacles.size(), 2u);
  EXPECT_EQ(file.obstacles[0].id, "0a");
  EXPECT_EQ(file.obstacles[1].id, "0b");
  ASSERT_EQ(file.rejected.size(), 1u);  // a point without its coordinates
  EXPECT_EQ(file.rejected[0].code(), DataCode::format_syntax);
  EXPECT_EQ(file.rejected[0].place().substr(0, 6), "line 5");
}

TEST_F(GraphFormats, HexadecimalWkbOfEitherByteOrderAndWithHeights) {
  const std::string little = "0102000000020000000000000000000000000000000000F03F00000000000000400000000000000840";
  const std::string big = "000000000200000002000000000000000000000000000000003FF00000000000003FF0000000000000";
  // PostGIS's flag for Z. Below: a multipolygon that claims 2^32 - 1 parts.
  const std::string heights =
      "01020000800200000000000000000000000000000000000000000000000000F03F000000000000F03F000000000000F03F000000000000F0"
      "3F";
  const auto path = put("w.xml", "<run><case><a>\n  " + little + "\n</a><b>" + big + "</b></case><case><a>" + heights +
                                     "</a><b>0106000000FFFFFFFF</b></case>\n<case><a>POLYGON((</a></case></run>");
  const ObstacleFile file = read_obstacles(path, going_on());
  ASSERT_EQ(file.obstacles.size(), 3u);
  const auto points = [&](std::size_t k) { return std::get<Polyline>(file.obstacles[k].shape).points; };
  EXPECT_EQ(points(0), (std::vector<geometry::Vec2>{{0, 1}, {2, 3}}));
  EXPECT_EQ(points(1), (std::vector<geometry::Vec2>{{0, 0}, {1, 1}}));
  EXPECT_EQ(points(2), (std::vector<geometry::Vec2>{{0, 0}, {1, 1}}));
  ASSERT_EQ(file.rejected.size(), 2u);
  EXPECT_EQ(file.rejected[0].code(), DataCode::size);
  EXPECT_EQ(file.rejected[1].place().substr(0, 6), "line 4");  // of the file, not of the text in it
}

TEST_F(GraphFormats, GraphMlRingsAreOnePolygonWithTheLargestOutside) {
  std::string text = "<graphml><graph>";
  const double xy[][2] = {{1, 1}, {2, 1}, {2, 2}, {0, 0}, {4, 0}, {4, 4}, {0, 4}};
  for (int k = 0; k < 7; ++k)
    text += "<node id='" + std::to_string(k) + "'><data key='x'>" + std::to_string(xy[k][0]) + "</data><data key='y'>" +
            std::to_string(xy[k][1]) + "</data></node>";
  for (const auto& [a, b] : {std::pair{0, 1}, {2, 1}, {0, 2}, {3, 4}, {5, 4}, {5, 6}, {6, 3}})
    text += "<edge source='" + std::to_string(a) + "' target='" + std::to_string(b) + "'/>";
  const ObstacleFile file = read_obstacles(put("g.graphml", text + "</graph></graphml>"), going_on());
  ASSERT_EQ(file.obstacles.size(), 1u);
  const auto& polygon = std::get<Polygon>(file.obstacles[0].shape);
  EXPECT_EQ(polygon.outer.size(), 4u);
  ASSERT_EQ(polygon.holes.size(), 1u);
  EXPECT_EQ(polygon.holes[0].size(), 3u);
}

TEST_F(GraphFormats, GraphMlNamesWhatItMisses) {
  const auto no_y = put("a.graphml", "<graphml><graph><node id='0'><data key='x'>1</data></node></graph></graphml>");
  EXPECT_EQ(refusal_of([&] { read_obstacles(no_y); }).code(), DataCode::key_missing);
  const auto no_node = put("b.graphml", "<graphml><graph><edge source='0' target='1'/></graph></graphml>");
  EXPECT_EQ(refusal_of([&] { read_obstacles(no_node); }).code(), DataCode::not_an_option);
}

TEST_F(GraphFormats, EdgesThatSayNothingAboutInsideAreWalls) {
  // A square with a crack: a chain from each fork to the next.
  const auto path = put("s.txt", "5 5\n0 0\n4 0\n4 4\n0 4\n2 2\n0 1\n1 2\n2 3\n3 0\n2 4\n");
  const ObstacleFile file = read_obstacles(path, going_on());
  EXPECT_EQ(file.format, "pslg");
  ASSERT_EQ(file.obstacles.size(), 2u);
  EXPECT_EQ(std::get<Polyline>(file.obstacles[0].shape).points,
            (std::vector<geometry::Vec2>{{4, 4}, {4, 0}, {0, 0}, {0, 4}, {4, 4}}));
  EXPECT_EQ(std::get<Polyline>(file.obstacles[1].shape).points, (std::vector<geometry::Vec2>{{4, 4}, {2, 2}}));
}

TEST_F(GraphFormats, PointsWithoutEdgesArePassedOver) {
  EXPECT_EQ(read_obstacles(put("p.txt", "2 0\n0 0\n1 1\n")).counts.passed_over, 1u);
}

TEST_F(GraphFormats, CountedRings) {
  const ObstacleFile file = read_obstacles(put("p.line", "5\n0 0\n4 0\n4 4\n0 4\n0 0\n4\n1 1\n2 1\n2 2\n1 1\n"));
  ASSERT_EQ(file.obstacles.size(), 1u);
  EXPECT_EQ(std::get<Polygon>(file.obstacles[0].shape).holes.size(), 1u);
  EXPECT_EQ(refusal_of([&] { read_obstacles(put("q.line", "3\n0 0\n4 0\n")); }).code(), DataCode::format_syntax);
}

TEST_F(GraphFormats, OmplCirclesStandAsPolygonsRoundThem) {
  const ObstacleFile file = read_obstacles(put("c.txt", "units: meter\n\tx\ty\tr\n1\t27\t15\t5\n2\t1\t1\t0.5\n"));
  ASSERT_EQ(file.obstacles.size(), 2u);
  for (const geometry::Vec2 p : std::get<Polygon>(file.obstacles[0].shape).outer)
    EXPECT_GE(norm(p - geometry::Vec2{27, 15}), 5.0);
  EXPECT_EQ(refusal_of([&] { read_obstacles(put("d.txt", "units: meter\nx y r\n1 2 3 -1\n")); }).code(),
            DataCode::out_of_range);
}

TEST_F(GraphFormats, OmplGridsHaveTheirFirstRowOnTop) {
  const ObstacleFile file =
      read_obstacles(put("e.txt", "discretization(cells): 3 2\nstart(cells): 0 0\nenvironment:\n1 0 0\n0 0 0\n"));
  ASSERT_EQ(file.obstacles.size(), 1u);
  EXPECT_EQ(std::get<Polygon>(file.obstacles[0].shape).outer, (Ring{{0, 1}, {1, 1}, {1, 2}, {0, 2}}));
  EXPECT_EQ(
      refusal_of([&] { read_obstacles(put("f.txt", "discretization(cells): 3 2\nenvironment:\n1 0\n0\n")); }).code(),
      DataCode::wrong_count);
}

TEST_F(GraphFormats, AScenarioGivesItsObstaclesWithThoseOfItsFiles) {
  put("more.wkt", "POLYGON ((0 9, 4 9, 4 8, 0 9))\n");
  const auto path =
      put("s.json", R"({"name": "s", "robots": [{"id": "R", "position": [0, 0], "goal": [9, 0]}],)"
                    R"( "obstacles": [{"id": "w", "polyline": [[3, 3], [5, 3]]}, {"file": "more.wkt"}]})");
  const ObstacleFile file = read_obstacles(path);
  EXPECT_EQ(file.format, "scenario");
  ASSERT_EQ(file.obstacles.size(), 2u);
  EXPECT_EQ(file.obstacles[0].id, "w");
  EXPECT_TRUE(std::holds_alternative<Polygon>(file.obstacles[1].shape));
}

TEST_F(GraphFormats, OpenTrajLinesAreWalls) {
  const auto path = put("m.xml",
                        "<Trial><obstacles><obstacle><TrialObstacle><Lines><Line x1='0' y1='1' x2='2' y2='3'/></Lines>"
                        "</TrialObstacle></obstacle></obstacles></Trial>");
  const ObstacleFile file = read_obstacles(path);
  ASSERT_EQ(file.obstacles.size(), 1u);
  EXPECT_EQ(std::get<Polyline>(file.obstacles[0].shape).points, (std::vector<geometry::Vec2>{{0, 1}, {2, 3}}));
}

}  // namespace
}  // namespace exactvo::datasets::test
