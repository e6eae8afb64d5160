// SPDX-License-Identifier: GPL-3.0-or-later
// Files made to hurt: headers that claim 2^31 of something, nesting 10^5 deep, entities that expand, paths that lead
// out of a map's folder. Each is refused with a code, in seconds, within 20 times its size plus 200 MB.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>

#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "support/forged_crowd.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

constexpr double kPatience = 10.0;  // s
constexpr std::size_t kDeep = 100'000;

/// MB; the largest that this process ever was.
double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t k = 0; k < times; ++k) all += text;
  return all;
}

struct HostileFile {
  const char* name;  ///< of the case
  const char* file;
  const char* format;  ///< empty: told by content
  std::string text;
  std::optional<DataCode> code;  ///< none: read without a refusal of the file
};

void PrintTo(const HostileFile& hostile, std::ostream* out) {
  *out << hostile.name;
}

/// A picture of one pixel whose comment claims 1.5 GB.
const std::string kPngWithAHugeChunk(
    "\x89PNG\r\n\x1a\n"
    "\0\0\0\x0dIHDR\0\0\0\1\0\0\0\1\x08\0\0\0\0\x3a\x7e\x9b\x55"
    "\x58\xfc\0\x1dtEXtComment\0x",
    8 + 25 + 17);

class Hostile : public ::testing::TestWithParam<HostileFile> {};

TEST_P(Hostile, IsRefusedWithACodeInTimeAndSpace) {
  const HostileFile& hostile = GetParam();
  const std::filesystem::path folder = std::filesystem::temp_directory_path() /
                                       ("exactvo_hostile_" + std::string(hostile.name) + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / hostile.file, std::ios::binary) << hostile.text;
  std::ofstream(folder / "big.pgm", std::ios::binary) << "P5 2147483647 2147483647 255\nxx";
  std::ofstream(folder / "deep.pgm", std::ios::binary) << "P2 99999 99999 255\n0 0 0";
  std::ofstream(folder / "big.png", std::ios::binary) << kPngWithAHugeChunk;
  const double before = peak_memory();
  const auto start = std::chrono::steady_clock::now();
  std::optional<DataCode> code;
  try {
    ReadOptions options;
    options.format = hostile.format;
    options.keep_going = true;
    options.repair = true;
    const ObstacleFile file = read_obstacles(folder / hostile.file, options);
    if (!file.rejected.empty()) code = file.rejected.front().code();
  } catch (const DataError& error) {
    code = error.code();
  }
  std::filesystem::remove_all(folder);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), kPatience);
  EXPECT_LT(peak_memory() - before, 20.0 * static_cast<double>(hostile.text.size()) / 1048576.0 + 200.0);
  ASSERT_EQ(code.has_value(), hostile.code.has_value()) << (code ? code_name(*code) : "nothing was refused");
  if (code) {
    EXPECT_STREQ(code_name(*code), code_name(*hostile.code));
  }
}

const std::string kEntities =
    "<?xml version=\"1.0\"?><!DOCTYPE x [<!ENTITY a \"1111111111\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;\">"
    "<!ENTITY file SYSTEM \"file:///etc/passwd\">]>";

const std::string kShell = "POLYGON ((0 0, 10 0, 10 10, 0 10, 0 0)";
constexpr const char* kHole = ", (1 1, 1 3, 3 3, 3 1, 1 1)";

/// Each a little smaller than the one before.
std::string nested_holes(int count) {
  std::string all;
  for (int k = 0; k < count; ++k) {
    const std::string low = std::to_string(1.0 + 1e-6 * k);
    all += ", (" + low + " " + low + ", " + low + " 3, 3 3, 3 " + low + ", " + low + " " + low + ")";
  }
  return all;
}

/// side x side triangular holes, side by side.
std::string many_holes(int side) {
  std::string all;
  for (int k = 0; k < side * side; ++k) {
    const std::string x = std::to_string(1 + 2 * (k % side));
    const std::string y = std::to_string(1 + 2 * (k / side));
    all += ", (" + x + " " + y + ", " + x + " " + y + ".5, " + x + ".5 " + y + ", " + x + " " + y + ")";
  }
  return all;
}

/// A ring round `many_holes` with a vertex a metre.
std::string long_shell(int side) {
  std::string all = "POLYGON ((0 0";
  for (int k = 1; k <= 2 * side; ++k) all += ", " + std::to_string(k) + " " + (k % 2 == 0 ? "0" : "-0.5");
  for (int k = 1; k <= 2 * side; ++k) all += ", " + std::to_string(2 * side + k % 2) + " " + std::to_string(k);
  for (int k = 1; k <= 2 * side; ++k)
    all += ", " + std::to_string(2 * side - k) + " " + std::to_string(2 * side + k % 2);
  for (int k = 1; k <= 2 * side; ++k) all += ", " + std::to_string(-(k % 2)) + " " + std::to_string(2 * side - k);
  return all + ")";
}

std::vector<HostileFile> hostile_files() {
  std::vector<HostileFile> files{
      {"EqualHoles", "a.wkt", "", kShell + repeated(kHole, 1600) + ")\n", DataCode::size},
      {"ManyEqualHoles", "a.wkt", "", kShell + repeated(kHole, 40'000) + ")\n", DataCode::size},
      {"NestedHoles", "a.wkt", "", kShell + nested_holes(1600) + ")\n", DataCode::size},
      {"ManyHoles", "a.wkt", "", long_shell(150) + many_holes(150) + ")\n", std::nullopt},
      {"EmptyHoles", "a.wkt", "", kShell + repeated(", (1 1, 1 1, 1 1)", 40'000) + ")\n", std::nullopt},
      {"OnePointRepeatedInWkt", "a.wkt", "", "LINESTRING (2 2" + repeated(",1 1", 1'000'000) + ")\n", std::nullopt},
      {"OnePointRepeatedInSumo", "a.poly.xml", "",
       "<additional><poly id='a' shape='" + repeated("1,1 ", 1'000'000) + "'/></additional>", DataCode::too_few_points},
      {"EveryPointTwiceInSumo", "a.poly.xml", "",
       "<additional><poly id='a' shape='" + repeated("1,1 1,1 2,1 2,1 2,2 2,2 ", 150'000) + "'/></additional>",
       std::nullopt},
      {"OnePointRepeatedInRings", "a.json", "rings-json", "[[[1,1]" + repeated(",[1,1]", 500'000) + "]]",
       DataCode::too_few_points},
      {"ZeroBytesBehindXml", "a.poly.xml", "", "<additional></additional>" + std::string(100'000, '\0'),
       DataCode::format_syntax},
      {"MapHeader", "a.map", "movingai-map", "type octile\nheight 2147483648\nwidth 2147483648\nmap\n..\n",
       DataCode::size},
      {"MapHeaderBeyond64Bits", "a.map", "", "type octile\nheight 99999999999999999999\nwidth 2\nmap\n..\n",
       DataCode::number},
      {"PgmHeader", "a.yaml", "", "image: big.pgm\nresolution: 1\norigin: [0, 0, 0]\n", DataCode::size},
      {"PngChunkBeyondTheFile", "a.yaml", "", "image: big.png\nresolution: 1\norigin: [0, 0, 0]\n", DataCode::size},
      {"PgmShortOfItsHeader", "a.yaml", "", "image: deep.pgm\nresolution: 1\norigin: [0, 0, 0]\n", DataCode::size},
      {"PathOutOfTheMap", "a.yaml", "", "image: ../../x\nresolution: 1\norigin: [0, 0, 0]\n", DataCode::path_escape},
      {"AbsolutePath", "a.yaml", "", "image: /etc/passwd\nresolution: 1\norigin: [0, 0, 0]\n", DataCode::path_escape},
      {"PathThroughTheMap", "a.yaml", "", "image: sub/../../x.pgm\nresolution: 1\norigin: [0, 0, 0]\n",
       DataCode::path_escape},
      {"CarmenCount", "a.log", "carmen-log", "FLASER 2147483648 1 2 3\n", DataCode::wrong_count},
      {"PslgCount", "a.txt", "", "2147483648 1\n0 0\n", DataCode::size},
      {"PslgIndex", "a.txt", "", "2 1\n0 0\n1 1\n0 2147483648\n", DataCode::out_of_range},
      {"LineCount", "a.line", "", "2147483648\n0 0\n", DataCode::size},
      {"FarPoints", "a.csv", "points-csv", "0,0\n1e9,1e9\n", DataCode::size},
      {"WktNesting", "a.wkt", "", repeated("GEOMETRYCOLLECTION (", kDeep), DataCode::nesting},
      {"WktBrackets", "a.wkt", "", "POLYGON " + repeated("(", kDeep), DataCode::number},
      {"JsonNesting", "a.json", "rings-json", repeated("[", kDeep) + repeated("]", kDeep), DataCode::nesting},
      {"YamlNesting", "a.yaml", "ros-map", "image: " + repeated("[", kDeep), DataCode::format_syntax},
      {"XmlNesting", "a.xml", "menge-xml",
       "<Experiment>" + repeated("<a>", kDeep) + repeated("</a>", kDeep) + "</Experiment>", std::nullopt},
      {"MengeEntities", "a.xml", "", kEntities + "<Experiment><ObstacleSet/></Experiment>", DataCode::format_syntax},
      {"SumoEntities", "a.poly.xml", "", kEntities + "<additional><poly id=\"&file;\"/></additional>",
       DataCode::format_syntax},
      {"JuPedSimEntities", "a.xml", "jupedsim-xml", kEntities + "<geometry/>", DataCode::format_syntax},
      {"BarnEntities", "a.world", "barn-world", kEntities + "<sdf/>", DataCode::format_syntax},
      {"JtsEntities", "a.xml", "jts-xml", kEntities + "<run/>", DataCode::format_syntax},
      {"GraphmlEntities", "a.graphml", "graphml", kEntities + "<graphml/>", DataCode::format_syntax},
      {"OpenTrajEntities", "a.xml", "opentraj-xml", kEntities + "<Trial/>", DataCode::format_syntax},
      {"ManyModels", "a.world", "barn-world",
       "<sdf><world>" + repeated("<model name='m'>\n</model>", 40'000) + "</world></sdf>", std::nullopt},
      {"ManyBadPolygons", "a.poly.xml", "",
       "<shapes>" + repeated("<poly id='p' shape='0,0 x,1'/>\n", 20'000) + "</shapes>", DataCode::number},
  };
  if (built_with_gdal()) {
    files.push_back({"OnePointRepeatedInGeoJson", "a.geojson", "",
                     "{\"type\":\"Polygon\",\"coordinates\":[[[1,1]" + repeated(",[1,1]", 300'000) + "]]}",
                     DataCode::too_few_points});
    files.push_back(
        {"GeoJsonNesting", "a.geojson", "",
         "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":null,\"geometry\":" +
             repeated("{\"type\":\"GeometryCollection\",\"geometries\":[", kDeep),
         DataCode::nesting});
    const std::string point = "{\"type\": \"Point\", \"coordinates\": [1, 2]}\n";
    files.push_back({"SequenceNesting", "a.ndjson", "",
                     point + repeated("{\"type\":\"GeometryCollection\",\"geometries\":[", kDeep), DataCode::nesting});
    files.push_back(
        {"SequenceDepth", "a.ndjson", "",
         point + "{\"type\": \"LineString\", \"coordinates\": " + repeated("[", kDeep) + repeated("]", kDeep) + "}\n",
         DataCode::nesting});
    files.push_back({"SequenceLine", "a.ndjson", "", point + repeated("x", 20 * kDeep), DataCode::json_syntax});
    files.push_back({"GmlEntities", "a.gml", "", kEntities + "<a>&b;&file;</a>", DataCode::format_syntax});
    files.push_back({"KmlEntities", "a.kml", "", kEntities + "<kml><Document><name>&b;&file;</name></Document></kml>",
                     DataCode::format_syntax});
  }
  return files;
}

INSTANTIATE_TEST_SUITE_P(Files, Hostile, ::testing::ValuesIn(hostile_files()),
                         [](const auto& each) { return std::string(each.param.name); });

using SparseFiles = TemporaryFolder;

/// 4 GB that take no room on the disk: what is read whole is refused by its size, before memory is asked for.
TEST_F(SparseFiles, AreRefusedInEveryFormat) {
  for (const std::string& format : readable_formats()) {
    const auto path = put("sparse.poly.xml", "<additional>");
    std::filesystem::resize_file(path, std::uint64_t{4} << 30);
    ReadOptions options;
    options.format = format;
    const double before = peak_memory();
    try {
      read_obstacles(path, options);
      ADD_FAILURE() << format << " took it";
    } catch (const DataError& error) {
      // GDAL's own refusal has the code of libraries; of our readers it would hide what is wrong.
      EXPECT_EQ(error.code() == DataCode::library, format == "gdal") << format << ": " << error.what();
    }
    EXPECT_LT(peak_memory() - before, 200.0) << format;
  }
}

TEST_F(SparseFiles, AreRefusedAsScenariosRecordingsAndProblems) {
  const auto path = put("sparse.json", "{");
  std::filesystem::resize_file(path, std::uint64_t{4} << 30);
  try {
    load_scenario(path);
    FAIL() << "nothing was refused";
  } catch (const DataError& error) {
    EXPECT_EQ(error.code(), DataCode::size);
  }
}

/// What is not listed is counted.
TEST(Findings, BeyondTheMostThatAreListedAreCounted) {
  ReadOptions options;
  options.keep_going = true;
  const std::size_t repeats = kMostFindings + 1234;
  const ObstacleFile file = parse_wkt("LINESTRING (2 2, 1 1" + repeated(",1 1", repeats) + ")\n", "t.wkt", options);
  EXPECT_EQ(file.counts.repaired, 1u);
  EXPECT_EQ(file.findings.size(), kMostFindings);
  ASSERT_EQ(file.unlisted.count(DataCode::repeated_vertex), 1u);
  EXPECT_EQ(file.unlisted.at(DataCode::repeated_vertex), repeats - kMostFindings);
}

using HostileScenarios = TemporaryFolder;

TEST_F(HostileScenarios, AScenarioNestedTooDeeplyIsRefused) {
  const auto path = put("a.json", "{\"name\": " + repeated("[", kDeep));
  try {
    load_scenario(path);
    FAIL() << "nothing was refused";
  } catch (const DataError& error) {
    EXPECT_EQ(error.code(), DataCode::nesting);
  }
}

using HostileCrowds = TemporaryFolder;

/// Numbers of heads and rows that no arithmetic in doubles bears; those at the limit are audited.
TEST_F(HostileCrowds, NumbersBeyondTheLimitAreRefused) {
  using exactvo::test::ForgedCrowd;
  constexpr double kHuge = 1e308, kLimit = 0x1p100;
  const auto with = [](const std::function<void(ForgedCrowd&)>& change) {
    ForgedCrowd crowd;
    crowd.kind_of = {0, 0};
    for (const std::uint32_t step : {0U, 2U}) crowd.rows.push_back({step, {{0, 0}, {4096, 1}}, {}});
    change(crowd);
    for (ForgedCrowd::Row& row : crowd.rows) row.bodies.resize(crowd.bodies.size(), {0, 0});
    return crowd;
  };
  const auto all = [&](double v) {
    return std::vector<ForgedCrowd>{with([&](ForgedCrowd& c) { c.time_step = v / 2; }),
                                    with([&](ForgedCrowd& c) { c.position_step = v * 0x1p-30; }),
                                    with([&](ForgedCrowd& c) {
                                      c.kinds = {{v, 1.0}};
                                    }),
                                    with([&](ForgedCrowd& c) {
                                      c.kinds = {{0.3, v}};
                                    }),
                                    with([&](ForgedCrowd& c) {
                                      c.kinds = {{v, v}}, c.time_step = v / 2, c.position_step = v * 0x1p-30;
                                    }),
                                    with([&](ForgedCrowd& c) {
                                      c.edges = {{v, 0, -v, 0}};
                                    }),
                                    with([&](ForgedCrowd& c) {
                                      c.edges = {{v, 0, v, 1}};
                                    }),
                                    with([&](ForgedCrowd& c) {
                                      c.bodies = {{false, 0, {v, 0, v}}};
                                    }),
                                    with([&](ForgedCrowd& c) {
                                      c.bodies = {{true, 0, {v, 0, v}}};
                                    }),
                                    with([&](ForgedCrowd& c) {
                                      c.bodies = {{false, 3, {0, v, v, -v, v}}};
                                    })};
  };
  std::size_t refused = 0, audited = 0;
  for (const double v : {kHuge, std::nextafter(kLimit, kHuge)})
    for (const ForgedCrowd& crowd : all(v)) {
      try {
        audit_recording(put("huge.evr", bytes_of(crowd)));
        ADD_FAILURE() << v << " was taken";
      } catch (const DataError& error) {
        EXPECT_STREQ(code_name(error.code()), "E_RANGE") << error.what();
        EXPECT_NE(error.place(), "");
        ++refused;
      }
    }
  for (const ForgedCrowd& crowd : all(kLimit)) audited += audit_recording(put("large.evr", bytes_of(crowd))).rows;
  EXPECT_EQ(refused, 20U);
  EXPECT_EQ(audited, 20U);
}

}  // namespace
}  // namespace exactvo::datasets::test
