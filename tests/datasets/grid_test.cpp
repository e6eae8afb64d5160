// SPDX-License-Identifier: GPL-3.0-or-later
// Grids become polygons that are the union of their occupied cells: neither more nor less.
#include <cmath>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/distance.h"
#include "refusal.h"
#include "support/seeded_random.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using exactvo::test::SeededRandom;
using geometry::Polygon;
using geometry::Vec2;

double area_of(const geometry::Ring& ring) {
  double doubled = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) doubled += cross(ring[i], ring[(i + 1) % ring.size()]);
  return doubled / 2;
}

double area_of(const Polygon& polygon) {
  double area = area_of(polygon.outer);
  for (const geometry::Ring& hole : polygon.holes) area += area_of(hole);
  return area;
}

double area_of(const ObstacleFile& file) {
  double area = 0.0;
  for (const formation::SceneObstacle& o : file.obstacles) area += area_of(std::get<Polygon>(o.shape));
  return area;
}

bool covers(const ObstacleFile& file, Vec2 p) {
  for (const formation::SceneObstacle& o : file.obstacles) {
    if (geometry::contains(std::get<Polygon>(o.shape), p)) return true;
  }
  return false;
}

std::string map_text(const std::vector<std::string>& rows) {
  std::string text =
      "type octile\nheight " + std::to_string(rows.size()) + "\nwidth " + std::to_string(rows[0].size()) + "\nmap\n";
  for (const std::string& row : rows) text += row + "\n";
  return text;
}

class GridTest : public TemporaryFolder {
 protected:
  ObstacleFile read(const std::vector<std::string>& rows, const ReadOptions& options = {}) const {
    return read_obstacles(put("a.map", map_text(rows)), options);
  }
  DataError refused(const std::string& text) const {
    return refusal_of([&] { read_obstacles(put("bad.map", text)); });
  }
};

TEST_F(GridTest, RowZeroIsOnTopAndCellsAreSquares) {
  const ObstacleFile file = read({"@..", "...", "..."});
  ASSERT_EQ(file.obstacles.size(), 1u);
  EXPECT_EQ(std::get<Polygon>(file.obstacles[0].shape).outer, (geometry::Ring{{0, 2}, {1, 2}, {1, 3}, {0, 3}}));
  EXPECT_EQ(file.format, "movingai-map");
  EXPECT_EQ(file.counts.done, 1u);
}

TEST_F(GridTest, CellSizeIsTheCallers) {
  ReadOptions options;
  options.cell_size = 0.25;
  const ObstacleFile file = read({"@@", "@@"}, options);
  EXPECT_EQ(area_of(file), 0.25);
  ASSERT_TRUE(file.coverage.has_value());
  EXPECT_EQ(static_cast<double>(file.coverage->occupied) * file.coverage->cell_area, 0.25);
}

TEST_F(GridTest, ARingThatMeetsItselfAtACornerIsCutInTwo) {
  const ObstacleFile file = read({"@@@@", "@..@", "@.@@", "@@.."});  // the hole touches the outside at (2, 1)
  ASSERT_EQ(file.obstacles.size(), 1u);
  EXPECT_TRUE(file.rejected.empty());
  EXPECT_EQ(std::get<Polygon>(file.obstacles[0].shape).holes.size(), 1u);
  EXPECT_EQ(area_of(file), 11.0);
}

TEST_F(GridTest, CellsThatTouchAtACornerAreTwoObstacles) {
  EXPECT_EQ(read({"@.", ".@"}).obstacles.size(), 2u);
}

TEST_F(GridTest, PolygonsAreTheUnionOfTheCells) {
  SeededRandom random(exactvo::test::seed_of_run(19));
  for (int round = 0; round < 150; ++round) {
    const int width = random.integer(1, 12);
    const int height = random.integer(1, 12);
    const double density = random.uniform(0.1, 0.95);
    std::vector<std::string> rows(static_cast<std::size_t>(height), std::string(static_cast<std::size_t>(width), '.'));
    double occupied = 0.0;
    for (std::string& row : rows) {
      for (char& cell : row) {
        if (random.uniform(0, 1) < density) cell = '@', occupied += 1.0;
      }
    }
    const ObstacleFile file = read(rows);
    EXPECT_EQ(area_of(file), occupied);
    EXPECT_EQ(file.counts.repaired + file.counts.rejected, 0u);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const bool blocked = rows[static_cast<std::size_t>(height - 1 - y)][static_cast<std::size_t>(x)] == '@';
        ASSERT_EQ(covers(file, {x + 0.5, y + 0.5}), blocked) << map_text(rows) << x << " " << y;
      }
    }
  }
}

/// A comb of two corners a tooth, rows of teeth on rows of cells: one component, and above it a cell of its own.
std::vector<std::string> combs(std::size_t side) {
  std::string teeth;
  for (std::size_t x = 0; x < side; ++x) teeth += x % 2 == 0 ? '@' : '.';
  const std::string free = std::string(side, '.');
  std::vector<std::string> rows{std::string(side - 1, '.') + "@", free};
  while (rows.size() < side) {
    rows.push_back(teeth);
    rows.push_back(std::string(side, '@'));
    rows.push_back("@" + std::string(side - 1, '.'));
  }
  return rows;
}

TEST_F(GridTest, AComponentOfTooManyCornersIsRejectedAlone) {
  const std::vector<std::string> rows = combs(640);
  EXPECT_EQ(refusal_of([&] { read(rows); }).code(), DataCode::size);
  ReadOptions options;
  options.keep_going = true;
  const ObstacleFile file = read(rows, options);
  EXPECT_EQ(file.obstacles.size(), 1u);
  ASSERT_EQ(file.rejected.size(), 1u);
  EXPECT_EQ(file.rejected[0].code(), DataCode::size);
  EXPECT_EQ(read(combs(64)).obstacles.size(), 2u);
}

TEST_F(GridTest, OddMapsAreRead) {
  EXPECT_EQ(area_of(read_obstacles(put("a.map", "height 1\nwidth 3\nmap\n@T."))), 2.0)
      << "no type line, no last newline";
  EXPECT_EQ(area_of(read_obstacles(put("b.map", "type octile\r\nheight 1\r\nwidth 2\r\nmap\r\nW.\r\n\r\n"))), 1.0);
  const ObstacleFile odd = read_obstacles(put("c.map", map_text({"stgE", "GSOW"})));
  EXPECT_EQ(area_of(odd), 2.0);
  EXPECT_EQ(odd.notes.size(), 4u);
  EXPECT_TRUE(read({"...", "..."}).obstacles.empty());
}

TEST_F(GridTest, BadMapsAreNamed) {
  expect_refusal(refused("type octile\nheight 2\nwidth 2\nmap\n..\n.\n"), DataCode::wrong_count, "line 6");
  expect_refusal(refused("type octile\nheight 3\nwidth 2\nmap\n..\n..\n"), DataCode::wrong_count, "line 6");
  expect_refusal(refused("type octile\nheight 1\nwidth 2\nmap\n.x\n"), DataCode::format_syntax, "line 5");
  expect_refusal(refused("type octile\nheight 2147483648\nwidth 2\nmap\n.."), DataCode::size, "line 2");
  expect_refusal(refused("type octile\nheight 4000\nwidth 4000\nmap\n.."), DataCode::size, "line 4");
  expect_refusal(refused("type octile\nheight two\nwidth 2\nmap\n.."), DataCode::number, "line 2");
  expect_refusal(refused("type octile\nwidth 2\nmap\n.."), DataCode::format_syntax, "line 3");
}

std::string pgm(const std::string& pixels) {
  return "P5\n# a comment\n3 2\n255\n" + pixels;
}

class RosMapTest : public GridTest {
 protected:
  ObstacleFile read_map(const std::string& extra, const std::string& image = "m.pgm",
                        const ReadOptions& options = {}) const {
    return read_obstacles(put("m.yaml", "image: " + image + "\nresolution: 0.5\norigin: [1, 2, 0]\n" + extra), options);
  }
};

// Pixels: occupied, unknown at 0.196, free / grey, free, free.
const std::string kPixels{'\x00', '\xcd', '\xfe', '\x80', '\xff', '\xff'};

TEST_F(RosMapTest, TheLowerLeftPixelLiesAtTheOrigin) {
  put("m.pgm", pgm(kPixels));
  const ObstacleFile file = read_map("negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  ASSERT_EQ(file.obstacles.size(), 1u);
  EXPECT_EQ(std::get<Polygon>(file.obstacles[0].shape).outer.front(), (Vec2{1.0, 2.5}));
  EXPECT_EQ(file.notes.front().text, "2 unknown cells taken as free (option unknown: free or blocked)");
}

TEST_F(RosMapTest, AnOriginThatIsNoListOfNumbersIsNamed) {
  put("m.pgm", pgm(kPixels));
  const auto found = [&](const std::string& origin) {
    return refusal_of([&] { read_obstacles(put("m.yaml", "image: m.pgm\nresolution: 0.5\norigin: " + origin + "\n")); })
        .found();
  };
  EXPECT_EQ(found("[0.0, 0.0, -nan]"), "\"-nan\" as number 3 of a list");
  EXPECT_EQ(found("[[1, 2], 0, 0]"), "a list as number 1 of a list");
  EXPECT_EQ(found("[0, ~, 0]"), "nothing as number 2 of a list");
  EXPECT_EQ(found("{x: 1}"), "keys");
  EXPECT_EQ(found("here"), "\"here\"");
}

TEST_F(RosMapTest, GreyTwoHundredAndFiveIsFreeAtAQuarter) {
  put("m.pgm", pgm(kPixels));
  EXPECT_EQ(read_map("free_thresh: 0.25\n").notes.front().text,
            "1 unknown cell taken as free (option unknown: free or blocked)");
}

TEST_F(RosMapTest, UnknownCellsAreFreeOrBlockedAsAsked) {
  put("m.pgm", pgm(kPixels));
  ReadOptions options;
  options.unknown = UnknownCells::blocked;
  const double cell = 0.5 * 0.5;
  for (const char* negated : {"", "negate: 0\n"}) {
    const ObstacleFile free = read_map(negated), blocked = read_map(negated, "m.pgm", options);
    EXPECT_EQ(free.coverage->occupied, 1u);
    EXPECT_EQ(blocked.coverage->occupied, 3u) << "0, 205 and 128";
    EXPECT_DOUBLE_EQ(area_of(blocked), 3 * cell);
    EXPECT_EQ(blocked.notes.front().text, "2 unknown cells taken as blocked (option unknown: free or blocked)");
  }
  // In mode raw what is above 100 is unknown.
  put("r.pgm", "P2 3 2 255 0 100 101 60 65 66");
  EXPECT_EQ(read_map("mode: raw\noccupied_thresh: 0.65\n", "r.pgm", options).coverage->occupied, 3u);
  // Nothing is unknown: nothing changes.
  put("k.pgm", pgm(std::string(6, '\xff')));
  EXPECT_TRUE(read_map("", "k.pgm", options).obstacles.empty());
}

TEST_F(RosMapTest, NegatedTwinsAgree) {
  put("m.pgm", pgm(kPixels));
  std::string negative = kPixels;
  for (char& c : negative) c = static_cast<char>(255 - static_cast<unsigned char>(c));
  put("n.pgm", pgm(negative));
  EXPECT_EQ(area_of(read_map("negate: 0\n")), area_of(read_map("negate: 1\n", "n.pgm")));
}

TEST_F(RosMapTest, ThresholdsAreStrict) {
  put("m.pgm", pgm(std::string(6, '\x66')));  // 102: (255 - 102) / 255 = 0.6 exactly
  EXPECT_EQ(read_map("occupied_thresh: 0.6\n").coverage->occupied, 0u);
  EXPECT_EQ(read_map("occupied_thresh: 0.599\n").coverage->occupied, 6u);
}

TEST_F(RosMapTest, PlainPgmAndRawModeAndYaw) {
  put("m.pgm", "P2 3 2 255 0 100 101 60 65 66");
  const ObstacleFile raw = read_map("mode: raw\noccupied_thresh: 0.65\n");
  EXPECT_EQ(raw.coverage->occupied, 2u) << "100 and 66 per cent";
  put("y.yaml", "image: m.pgm\nresolution: 1\norigin: [5, 5, 1.5707963267948966]\nnegate: 0\n");
  const ObstacleFile turned = read_obstacles(folder_ / "y.yaml");
  for (const formation::SceneObstacle& o : turned.obstacles) {
    for (const Vec2 p : geometry::vertices_of(o.shape)) {
      EXPECT_TRUE(p.x > 2.99 && p.x < 5.01 && p.y > 4.99 && p.y < 8.01) << p.x << " " << p.y;
    }
  }
}

TEST_F(RosMapTest, BadMapsAreNamed) {
  put("m.pgm", pgm(kPixels));
  const auto code = [&](const std::string& yaml) {
    return refusal_of([&] { read_obstacles(put("bad.yaml", yaml)); }).code();
  };
  const std::string rest = "resolution: 0.5\norigin: [1, 2, 0]\n";
  EXPECT_EQ(code("image: none.pgm\n" + rest), DataCode::image);
  EXPECT_EQ(code("image: ../../etc/passwd\n" + rest), DataCode::path_escape);
  EXPECT_EQ(code("image: /etc/passwd\n" + rest), DataCode::path_escape);
  EXPECT_EQ(code("image: m.pgm\norigin: [1, 2, 0]\n"), DataCode::key_missing);
  EXPECT_EQ(code("image: m.pgm\nresolution: 0\norigin: [1, 2, 0]\n"), DataCode::out_of_range);
  EXPECT_EQ(code("image: m.pgm\nresolution: .nan\norigin: [1, 2, 0]\n"), DataCode::number);
  EXPECT_EQ(code("image: m.pgm\nresolution: 1\norigin: [1, 2]\n"), DataCode::wrong_count);
  EXPECT_EQ(code("image: m.pgm\nresolution: x\norigin: [1, 2, 3]\n"), DataCode::wrong_type);
  EXPECT_EQ(code("image: m.pgm\nmode: best\n" + rest), DataCode::not_an_option);
  EXPECT_EQ(code("image: m.pgm\n\tx: [\n"), DataCode::format_syntax);
}

TEST_F(RosMapTest, ThresholdsThatWouldLoseTheWallsAreRefused) {
  put("m.pgm", pgm(kPixels));
  struct Refused {
    const char* lines;
    const char* place;
    const char* found;
    const char* expected;
  };
  const char* const kShare = "a number from 0 to 1";
  const Refused refused[] = {
      {"occupied_thresh: 65\n", "line 4, key occupied_thresh", "65", kShare},
      {"negate: 0\nfree_thresh: 19.6\n", "line 5, key free_thresh", "19.6", kShare},
      {"occupied_thresh: -0.1\n", "line 4, key occupied_thresh", "-0.1", kShare},
      {"occupied_thresh: .nan\n", "line 4, key occupied_thresh", ".nan", kShare},
      {"mode: raw\nfree_thresh: .inf\n", "line 5, key free_thresh", ".inf", kShare},
      {"free_thresh: 0.66\n", "line 4, key free_thresh", "0.66", "at most occupied_thresh, 0.65 where it is left out"},
      {"occupied_thresh: 0.2\nfree_thresh: 0.65\n", "line 5, key free_thresh", "0.65", "at most occupied_thresh, 0.2"}};
  for (const Refused& r : refused) {
    const DataError error = refusal_of([&] { read_map(r.lines); });
    expect_refusal(error, DataCode::out_of_range, r.place);
    EXPECT_EQ(error.found(), r.found) << r.lines;
    EXPECT_EQ(error.expected(), r.expected) << r.lines;
  }
}

TEST_F(RosMapTest, ThresholdsAtTheEndsAndOneLeftOutAreTaken) {
  put("m.pgm", pgm(kPixels));
  EXPECT_EQ(read_map("occupied_thresh: 1\nfree_thresh: 0\n").coverage->occupied, 0u) << "comparisons are strict";
  EXPECT_EQ(read_map("occupied_thresh: 0\nfree_thresh: 0\n").coverage->occupied, 4u) << "all but 255";
  EXPECT_EQ(read_map("occupied_thresh: 0.1\n").coverage->occupied, 3u) << "free_thresh, left out, is no higher";
}

TEST_F(RosMapTest, HostilePicturesAreNamed) {
  const auto code = [&](const std::string& picture) {
    put("m.pgm", picture);
    return refusal_of([&] { read_map("negate: 0\n"); }).code();
  };
  EXPECT_EQ(code("P5 2147483648 2147483648 255\n"), DataCode::size);
  EXPECT_EQ(code("P5 9999999999 1 255\nx"), DataCode::size);
  EXPECT_EQ(code("P5 3 2 255\nabc"), DataCode::size);
  EXPECT_EQ(code("P5 0 2 255\n"), DataCode::size);
  EXPECT_EQ(code("P5 3 2 0\nabcdef"), DataCode::image);
  EXPECT_EQ(code("P2 1 2 255\n 1 x"), DataCode::image);
  EXPECT_EQ(code("P5 # nothing more"), DataCode::image);
}

}  // namespace
}  // namespace exactvo::datasets::test
