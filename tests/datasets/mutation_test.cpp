// SPDX-License-Identifier: GPL-3.0-or-later
// Readers meet damaged files: whatever the damage, what comes out is obstacles or a DataError, and the books balance.
#include <algorithm>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "support/seeded_random.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using exactvo::test::SeededRandom;

struct Sample {
  const char* format;
  const char* name;
  std::string text;
};

void PrintTo(const Sample& sample, std::ostream* out) {
  *out << sample.format;
}

/// Bytes changed, dropped, doubled or swapped for what readers stumble over; or the end cut off.
std::string damaged(std::string text, SeededRandom& random) {
  static const std::vector<std::string> kStumbling{
      "",   "-1", "1e999", "nan", "0",  "4294967296", "9223372036854775808", "(",   ")", "[", "]",
      "\"", "<",  ">",     ",",   "\n", "\t",         std::string(1, '\0'),  "\xff"};
  for (int k = random.integer(1, 4); k > 0; --k) {
    const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size())));
    const auto length = static_cast<std::size_t>(random.integer(0, 6));
    const std::string& put =
        kStumbling[static_cast<std::size_t>(random.integer(0, static_cast<int>(kStumbling.size()) - 1))];
    switch (random.integer(0, 3)) {
      case 0:
        text = text.substr(0, at);
        break;
      case 1:
        text.insert(at, text.substr(at, 8 * length));
        break;
      default:
        text.replace(at, std::min(length, text.size() - at), put);
    }
  }
  return text;
}

class DamagedFiles : public ::testing::TestWithParam<Sample> {};

TEST_P(DamagedFiles, GiveObstaclesOrADataError) {
  const Sample& sample = GetParam();
  const std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                       ("exactvo_damaged_" + std::string(sample.format) + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "m.pgm", std::ios::binary) << "P5 2 2 255\n" << std::string("\x00\xff\x00\xff", 4);
  SeededRandom random(exactvo::test::seed_of_run(31));
  ReadOptions options;
  options.keep_going = true;
  options.format = sample.format;
  const auto read = [&](const std::string& text) {
    std::ofstream(folder / sample.name, std::ios::binary | std::ios::trunc) << text;
    return read_obstacles(folder / sample.name, options);
  };
  EXPECT_NO_THROW(read(sample.text));
  int refused = 0, accepted = 0;
  for (int k = 0; k < 400; ++k) {
    const std::string text = damaged(sample.text, random);
    try {
      const ReadCounts n = read(text).counts;
      ASSERT_EQ(n.read, n.done + n.repaired + n.passed_over + n.rejected) << text;
      ++(n.rejected > 0 ? refused : accepted);
    } catch (const DataError& error) {
      ASSERT_FALSE(error.found().empty()) << text;
      ++refused;
    } catch (const std::exception& error) {
      FAIL() << error.what() << "\n" << text;
    }
  }
  std::filesystem::remove_all(folder);
  EXPECT_GT(refused, 100);
  EXPECT_GT(accepted, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Readers, DamagedFiles,
    ::testing::Values(
        Sample{"wkt", "a.wkt",
               "POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0), (1 1, 1 2, 2 2, 1 1))\nGEOMETRYCOLLECTION (POINT Z (1 2 3))\n"},
        Sample{"jupedsim-wkt", "a.wkt", "POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0), (1 1, 1 2, 2 2, 1 1))"},
        Sample{"movingai-map", "a.map", "type octile\nheight 3\nwidth 4\nmap\n.@@.\n@..T\n.WW.\n"},
        Sample{"ros-map", "a.yaml",
               "image: m.pgm\nresolution: 0.05\norigin: [-1, 2, 0.5]\nnegate: 0\noccupied_thresh: 0.65\n"},
        Sample{"carmen-log", "a.log", "PARAM x\nFLASER 3 1.0 2.0 81.83 0 0 0.5 0 0 0 1 h 1\n"},
        Sample{"csm-log", "a.log",
               R"({"nrays": 2, "theta": [0, 1], "readings": [1, null], "valid": [1, 0], "odometry": [0, 0, 1]})"},
        Sample{"points-csv", "a.csv", "x,y\n0.5,1\n-2,3\n"},
        Sample{"rings-json", "a.json", "[[[0,0],[9,0],[9,9],[0,9]],[[1,1],[2,1],[2,2]]]"},
        Sample{"jts-xml", "a.xml",
               "<run><case><a>POLYGON((0 0, 4 0, 4 4, 0 0))</a><b>0102000000020000000000000000000000000000000000F03F"
               "00000000000000400000000000000840</b></case></run>"},
        Sample{"graphml", "a.graphml",
               "<graphml><graph><node id='0'><data key='x'>0</data><data key='y'>0</data></node><node id='1'>"
               "<data key='x'>1</data><data key='y'>0</data></node><edge source='0' target='1'/></graph></graphml>"},
        Sample{"counted-rings", "a.line", "4\n0 0\n4 0\n4 4\n0 0\n"},
        Sample{"pslg", "a.txt", "4 3\n0 0\n4 0\n4 4\n2 2\n0 1\n1 2\n2 0\n"},
        Sample{"ompl-circles", "a.txt", "units: meter\n x y r\n1 27 15 5\n2 1 1 0.5\n"},
        Sample{"ompl-grid", "a.txt", "discretization(cells): 3 2\nenvironment:\n1 0 0\n0 0 1\n"},
        Sample{"opentraj-xml", "a.xml",
               "<Trial><obstacles><obstacle><TrialObstacle><Lines><Line x1='0' y1='1' x2='2' y2='3'/></Lines>"
               "</TrialObstacle></obstacle></obstacles></Trial>"},
        Sample{"scenario", "a.json",
               R"({"name": "s", "robots": [{"id": "R", "position": [0, 0], "goal": [9, 0]}],)"
               R"( "obstacles": [{"id": "w", "polyline": [[3, 3], [5, 3]]}]})"},
        Sample{"menge-xml", "a.xml",
               R"(<Experiment><ObstacleSet><Obstacle closed="1"><Vertex p_x="0" p_y="0"/><Vertex p_x="1" p_y="0"/>)"
               R"(<Vertex p_x="1" p_y="1"/></Obstacle></ObstacleSet></Experiment>)"},
        Sample{"sumo-poly", "a.xml", R"(<shapes><poly id="a" shape="0,0 1,0 1,1 0,0"/><poi id="b"/></shapes>)"},
        Sample{"jupedsim-xml", "a.xml",
               R"(<geometry><rooms><room><subroom><polygon><vertex px="0" py="0"/><vertex px="1" py="0"/></polygon>)"
               R"(</subroom></room></rooms></geometry>)"},
        Sample{"barn-world", "a.world",
               "<sdf><world><model name='c'><pose>1 2 0 0 0 0</pose><link><collision><geometry><cylinder><radius>0.1"
               "</radius></cylinder></geometry></collision></link></model></world></sdf>"}),
    [](const auto& each) {
      std::string name = each.param.format;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

TEST(DamagedScenarios, AreRefusedByName) {
  SeededRandom random(exactvo::test::seed_of_run(37));
  std::ifstream file(std::filesystem::path(EXACTVO_SOURCE_DIR) / "datasets/data/paper/B3.json");
  std::ostringstream good;
  good << file.rdbuf();
  int refused = 0;
  for (int k = 0; k < 1000; ++k) {
    const std::string text = damaged(good.str(), random);
    try {
      parse_scenario(text, "damaged.json", {});
    } catch (const DataError& error) {
      ASSERT_FALSE(error.expected().empty()) << text;
      ++refused;
    } catch (const std::exception& error) {
      FAIL() << error.what() << "\n" << text;
    }
  }
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace exactvo::datasets::test
