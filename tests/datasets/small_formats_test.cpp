// SPDX-License-Identifier: GPL-3.0-or-later
// The formats without a library: lasers, points, rings, and the XML of crowd simulators.
#include <algorithm>
#include <cmath>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/distance.h"
#include "refusal.h"
#include "support/seeded_random.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using geometry::Polygon;
using geometry::Polyline;
using geometry::Vec2;

class SmallFormats : public TemporaryFolder {
 protected:
  ObstacleFile read(const std::string& name, const std::string& text, const ReadOptions& options = {}) const {
    return read_obstacles(put(name, text), options);
  }
  DataError refused(const std::string& name, const std::string& text) const {
    return refusal_of([&] { read(name, text); });
  }
};

bool covers(const ObstacleFile& file, Vec2 p) {
  for (const formation::SceneObstacle& o : file.obstacles) {
    if (geometry::contains(std::get<Polygon>(o.shape), p)) return true;
  }
  return false;
}

TEST_F(SmallFormats, EveryPointLiesInACellAndEveryCellHoldsAPoint) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(23));
  std::string text = "x, y\n";
  std::vector<Vec2> points;
  for (int k = 0; k < 300; ++k) {
    // A third of them on corners of cells, where rounding decides.
    const Vec2 p =
        k % 3 == 0 ? Vec2{0.05 * random.integer(-40, 40), 0.05 * random.integer(-40, 40)} : random.in_box(2.0);
    points.push_back(p);
    char line[80];
    std::snprintf(line, sizeof line, "%.17g , %.17g\r\n", p.x, p.y);
    text += line;
  }
  ReadOptions options;
  options.format = "points-csv";
  const ObstacleFile file = read("p.csv", text, options);
  for (const Vec2 p : points) EXPECT_TRUE(covers(file, p)) << p.x << " " << p.y;
  EXPECT_EQ(file.coverage->cell_area, 0.05 * 0.05);
  // No cell is covered without a point in it.
  std::size_t covered = 0;
  for (int column = -42; column < 42; ++column) {
    for (int row = -42; row < 42; ++row) {
      const Vec2 middle{0.05 * (column + 0.5), 0.05 * (row + 0.5)};
      if (!covers(file, middle)) continue;
      ++covered;
      const auto in_the_cell = [&](Vec2 p) {
        return std::max(std::fabs(p.x - middle.x), std::fabs(p.y - middle.y)) < 0.025 + 1e-12;
      };
      EXPECT_TRUE(std::any_of(points.begin(), points.end(), in_the_cell)) << middle.x << " " << middle.y;
    }
  }
  EXPECT_EQ(covered, file.coverage->occupied);
}

TEST_F(SmallFormats, PointsAreKnownByTheirFirstLineAndBadOnesNamed) {
  EXPECT_EQ(read("p.csv", "0.5 , 1\n-2,3e0\n").format, "points-csv");
  expect_refusal(refused("p.csv", "1,2\n1,x\n"), DataCode::number, "line 2");
  expect_refusal(refused("p.csv", "1,2\n1,2,3\n"), DataCode::wrong_count, "line 2");
  expect_refusal(refused("p.csv", "1,2\n1,inf\n"), DataCode::not_finite, "line 2");
  EXPECT_EQ(refused("p.csv", "1,2\n1e6,1e6\n").code(), DataCode::size);
  EXPECT_EQ(refused("p.csv", "1,2\n1e300,0\n").code(), DataCode::size);
}

TEST_F(SmallFormats, CarmenBeamsRunFromRightToLeft) {
  const std::string log =
      "# CARMEN Logfile\nPARAM robot 1\nFLASER 3 1.0 2.0 81.83 10 20 0 0 0 0 1.5 host 1.5\nODOM 1 2 3\n";
  const ObstacleFile file = read("a.log", log);
  EXPECT_EQ(file.format, "carmen-log");
  EXPECT_EQ(file.coverage->occupied, 2u) << "81.83 is no return";
  EXPECT_TRUE(covers(file, {10.01, 19.01}) || covers(file, {10.01, 18.99}) || covers(file, {9.99, 19.01}));
  EXPECT_TRUE(covers(file, {12.0, 20.0}));
  const std::string none = "FLASER 2 50 32.767 0 0 0 0 0 0\n";
  EXPECT_TRUE(read("b.log", none).obstacles.empty());
  expect_refusal(refused("c.log", "FLASER 180 1 2 3\n"), DataCode::wrong_count, "line 1");
  expect_refusal(refused("c.log", "FLASER -1 1 2 3\n"), DataCode::wrong_count, "line 1");
  expect_refusal(refused("c.log", "FLASER 1 one 2 3 4\n"), DataCode::number, "line 1");
}

TEST_F(SmallFormats, CsmNullsAndInvalidReadingsAreNoHits) {
  const std::string scan = R"({"nrays": 4, "theta": [0, 1, 2, 3], "readings": [1, null, 2, 3], "valid": [1, 1, 0, 1],
    "estimate": [null, null, null], "odometry": [5, 5, 0]})";
  const ObstacleFile file = read("a.log", scan + "\n" + scan);
  EXPECT_EQ(file.format, "csm-log");
  EXPECT_EQ(file.coverage->occupied, 2u);
  EXPECT_TRUE(covers(file, {6.0, 5.0}));
  EXPECT_EQ(refused("b.log", scan + scan.substr(0, 40)).code(), DataCode::json_syntax);
  EXPECT_EQ(refused("b.log", "{\"nrays\": 1, \"readings\": [1]}").code(), DataCode::key_missing);
}

TEST_F(SmallFormats, RingsAreOnePolygon) {
  const ObstacleFile file = read("a.json", "[[[0,0],[10,0],[10,10],[0,10]],[[1,1],[2,1],[2,2],[1,2]]]");
  EXPECT_EQ(file.format, "rings-json");
  EXPECT_EQ(std::get<Polygon>(file.obstacles.at(0).shape).holes.size(), 1u);
  EXPECT_EQ(file.counts.repaired, 1u) << "unclosed, and the hole's winding";
  EXPECT_EQ(refused("b.json", "[[[0,0],[1,0],[1]]]").code(), DataCode::wrong_count);
  EXPECT_EQ(refused("b.json", "[[[0,0],[1,\"0\"],[1,1]]]").code(), DataCode::wrong_type);
  EXPECT_EQ(refused("b.json", "[ [\n[0,0").code(), DataCode::json_syntax);
}

TEST_F(SmallFormats, MengeObstaclesAreClosedOrNot) {
  const std::string begin = "<?xml version=\"1.0\"?>\n<!-- a > b -->\n<Experiment><ObstacleSet type=\"explicit\">";
  const std::string vertices =
      R"(<Vertex p_x="0" p_y="0"/><Vertex p_x="1" p_y="0"/><Vertex p_x="1" p_y="1"/></Obstacle>)";
  const ObstacleFile file = read("a.xml", begin + "<Obstacle closed=\"1\">" + vertices + "<Obstacle closed=\"0\">" +
                                              vertices + "</ObstacleSet></Experiment>");
  EXPECT_EQ(file.format, "menge-xml");
  ASSERT_EQ(file.obstacles.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<Polygon>(file.obstacles[0].shape));
  EXPECT_TRUE(std::holds_alternative<Polyline>(file.obstacles[1].shape));
  const DataError error =
      refused("b.xml", begin + "\n<Obstacle><Vertex p_x=\"0\"/></Obstacle></ObstacleSet></Experiment>");
  expect_refusal(error, DataCode::key_missing, "line 4, column 12");
  EXPECT_EQ(refused("c.xml", begin).code(), DataCode::format_syntax);
}

TEST_F(SmallFormats, ClockwiseObstaclesOfMengeAreRooms) {
  const std::string text =
      R"(<Experiment><ObstacleSet><Obstacle closed="1"><Vertex p_x="0" p_y="0"/><Vertex p_x="0" p_y="9"/>)"
      R"(<Vertex p_x="9" p_y="9"/><Vertex p_x="9" p_y="0"/></Obstacle></ObstacleSet></Experiment>)";
  const ObstacleFile file = read("a.xml", text);
  ASSERT_EQ(file.obstacles.size(), 1u);
  const auto& wall = std::get<Polyline>(file.obstacles[0].shape).points;
  EXPECT_EQ(wall.size(), 5u);
  EXPECT_EQ(wall.front(), wall.back());
  EXPECT_TRUE(file.findings.empty());
  EXPECT_EQ(file.notes.back().text.rfind("1 clockwise obstacle read as walls round rooms", 0), 0u);
}

TEST_F(SmallFormats, AWalkableAreaAsPlainWktIsHintedAt) {
  const std::string area = "POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0), (1 1, 1 2, 2 2, 1 1))";
  const ObstacleFile alone = read("a.wkt", area + "\n");
  ASSERT_EQ(alone.notes.size(), 1u);
  EXPECT_NE(alone.notes[0].text.find("jupedsim-wkt"), std::string::npos);
  EXPECT_TRUE(read("b.wkt", area + "\n" + area + "\n").notes.empty());
  EXPECT_TRUE(read("c.wkt", "POLYGON ((0 0, 9 0, 9 9, 0 0))\n").notes.empty());
  ReadOptions options;
  options.format = "jupedsim-wkt";
  EXPECT_TRUE(read_obstacles(folder_ / "a.wkt", options).notes.empty());
}

TEST_F(SmallFormats, EntitiesAreRefused) {
  const std::string text =
      "<?xml version=\"1.0\"?>\n<!DOCTYPE x [<!ENTITY a SYSTEM \"file:///etc/passwd\">]>\n"
      "<shapes><poly id=\"1\" shape=\"&a;\"/></shapes>";
  ReadOptions options;
  options.format = "sumo-poly";
  EXPECT_EQ(refusal_of([&] { read("a.xml", text, options); }).code(), DataCode::format_syntax);
}

TEST_F(SmallFormats, SumoShapesAndOnesThatAreNone) {
  const std::string text =
      "<?xml version=\"1.0\" encoding=\"iso-8859-1\"?>\n<shapes>\n"
      "<poly id=\"a\" shape=\"0,0 1,0 1,1 0,0\"/><poly id=\"b\" fill=\"1\" shape=\"0,0,5 1,0,5 1,1,5\"/>"
      "<poly id=\"c\" shape=\"0,0 1,0\"/><poi id=\"d\" x=\"0\" y=\"0\"/></shapes>";
  const ObstacleFile file = read("a.poly.xml", text);
  ASSERT_EQ(file.obstacles.size(), 3u);
  EXPECT_EQ(file.obstacles[0].id, "a");
  EXPECT_TRUE(std::holds_alternative<Polyline>(file.obstacles[2].shape));
  EXPECT_EQ(file.counts.passed_over, 1u);
  EXPECT_EQ(refused("b.poly.xml", "<shapes><poly id=\"a\" geo=\"1\" shape=\"13,52 13,53\"/></shapes>").code(),
            DataCode::projection);
  EXPECT_EQ(refused("b.poly.xml", "<shapes><poly id=\"a\" shape=\"0,0 1 2\"/></shapes>").code(), DataCode::wrong_count);
  ReadOptions on;
  on.keep_going = true;
  EXPECT_EQ(
      read("c.poly.xml", "<shapes><poly id=\"a\" shape=\"x,0 1,1\"/><poly id=\"b\" shape=\"0,0 1,1\"/></shapes>", on)
          .counts.rejected,
      1u);
}

TEST_F(SmallFormats, JuPedSimWallsAndObstacles) {
  const std::string ring =
      R"(<vertex px="0" py="0"/><vertex px="4" py="0"/><vertex px="4" py="4"/><vertex px="0" py="0"/>)";
  const ObstacleFile file = read("a.xml", "<geometry><rooms><room><subroom><polygon caption=\"wall\">" + ring +
                                              "</polygon><obstacle><polygon>" + ring +
                                              "</polygon></obstacle></subroom></room></rooms></geometry>");
  EXPECT_EQ(file.format, "jupedsim-xml");
  ASSERT_EQ(file.obstacles.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<Polyline>(file.obstacles[0].shape)) << "the room's shell is a wall";
  EXPECT_TRUE(std::holds_alternative<Polygon>(file.obstacles[1].shape));
}

TEST_F(SmallFormats, JuPedSimWktIsWalkableInside) {
  ReadOptions options;
  options.format = "jupedsim-wkt";
  const ObstacleFile file = read("a.wkt", "POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0), (1 1, 1 2, 2 2, 1 1))", options);
  ASSERT_EQ(file.obstacles.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<Polyline>(file.obstacles[0].shape));
  EXPECT_TRUE(std::holds_alternative<Polygon>(file.obstacles[1].shape));
  EXPECT_EQ(file.counts.done, 2u);
}

TEST_F(SmallFormats, BarnCylindersAreContainedAndCountedOnce) {
  const std::string model =
      "<model name=\"c\"><pose>3 -4 0 0 0 0</pose><link><collision><geometry><cylinder><radius>0.075"
      "</radius></cylinder></geometry></collision></link></model>";
  const ObstacleFile file = read("a.world", "<sdf version='1.6'><world name='w'>" + model +
                                                "<model name=\"plane\"/><state>" + model + "</state></world></sdf>");
  EXPECT_EQ(file.format, "barn-world");
  ASSERT_EQ(file.obstacles.size(), 1u);
  EXPECT_EQ(file.counts.passed_over, 1u);
  for (int k = 0; k < 360; ++k) {
    const double angle = k * 0.0174532925199;
    EXPECT_TRUE(covers(file, {3 + 0.075 * std::cos(angle), -4 + 0.075 * std::sin(angle)})) << k;
  }
}

}  // namespace
}  // namespace exactvo::datasets::test
