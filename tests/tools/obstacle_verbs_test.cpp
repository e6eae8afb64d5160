// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs for obstacle files as a user meets them: validate, repair, convert, batch, segment.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <thread>

#include "exactvo/datasets/obstacle_file.h"
#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kGood = "POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0))\n";
constexpr const char* kClockwise = "POLYGON ((0 0, 0 4, 4 4, 4 0, 0 0))\n";
constexpr const char* kBowTie = "POLYGON ((10 0, 12 2, 12 0, 10 2, 10 0))\n";
constexpr const char* kHopeless = "POLYGON ((0 0, 1 0, 0 0))\n";

TEST(Validate, StatusSaysWhetherEverythingCanBeUsed) {
  const Workplace here;
  here.write("good.wkt", kGood);
  here.write("turned.wkt", kClockwise);
  here.write("bad.wkt", std::string(kGood) + kBowTie);
  EXPECT_EQ(here.run("validate good.wkt").status, 0);
  EXPECT_EQ(here.run("validate turned.wkt").status, 0);
  EXPECT_EQ(here.run("validate --strict turned.wkt").status, 1);
  EXPECT_EQ(here.run("validate good.wkt bad.wkt").status, 1);
  EXPECT_EQ(here.run("validate good.wkt nowhere.wkt bad.wkt").status, 2);
}

TEST(Validate, NamesFileFeatureRingVertexCodeAndCoordinates) {
  const Workplace here;
  here.write("bad.wkt", std::string(kGood) + kBowTie);
  const Outcome text = here.run("validate bad.wkt");
  EXPECT_THAT(text.out, AllOf(HasSubstr("bad.wkt: line 2, column 1, ring 0, vertex "), HasSubstr("(11, 1)"),
                              HasSubstr("a ring that crosses or touches itself [E_SELF_INTERSECTION]")));
  const Outcome outcome = here.run("validate bad.wkt --json");
  const json report = json::parse(outcome.out);
  EXPECT_FALSE(report.at("valid"));
  const json& file = report.at("files").at(0);
  EXPECT_EQ(file.at("file"), "bad.wkt");
  EXPECT_EQ(file.at("verdict"), "invalid");
  EXPECT_EQ(file.at("counts").at("rejected"), 1);
  const json& problem = file.at("problems").at(0);
  EXPECT_EQ(problem.at("code"), "E_SELF_INTERSECTION");
  EXPECT_EQ(problem.at("feature"), "line 2, column 1");
  EXPECT_EQ(problem.at("ring"), 0);
  EXPECT_EQ(problem.at("x"), 11.0);
  EXPECT_EQ(problem.at("y"), 1.0);
  EXPECT_FALSE(problem.at("repaired"));
  EXPECT_EQ(problem.at("found"), "a ring that crosses or touches itself");
}

TEST(ObstacleVerbs, MistypedWordsAreAnsweredWithTheNearest) {
  const Workplace here;
  here.write("a.wkt", kGood);
  const std::pair<const char*, const char*> cases[] = {{"validat a.wkt", "'validate'"},
                                                       {"validate a.wkt --format wktt", "'wkt'"},
                                                       {"validate a.wkt --units meters", "'metres'"},
                                                       {"repair a.wkt --out b.wkt --to geojsn", "'geojson'"},
                                                       {"convert a.wkt b.wkt --from movingai-mapp", "'movingai-map'"},
                                                       {"convert a.wkt b.wkt --too wkt", "'--to'"},
                                                       {"generate maz --out b.wkt", "'maze'"},
                                                       {"segment a.wkt --figur b.svg", "'--figure'"}};
  for (const auto& [arguments, nearest] : cases) {
    const Outcome outcome = here.run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(std::string("did you mean ") + nearest)) << arguments;
    EXPECT_THAT(outcome.out, IsEmpty()) << arguments;
  }
  EXPECT_FALSE(here.has("b.wkt"));
}

TEST(Repair, WritesWhatIsRepairedAndNamesWhatIsNot) {
  const Workplace here;
  here.write("bad.wkt", std::string(kGood) + kBowTie + kHopeless);
  const Outcome outcome = here.run("repair bad.wkt --out repaired.wkt --figure repaired.svg --json");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  const json file = json::parse(outcome.out).at("files").at(0);
  EXPECT_EQ(file.at("counts").at("repaired"), 1);
  EXPECT_EQ(file.at("counts").at("rejected"), 1);
  const json& bow_tie = file.at("repairs").at(0);
  EXPECT_EQ(bow_tie.at("codes"), json::array({"E_SELF_INTERSECTION"}));
  EXPECT_EQ(bow_tie.at("before").at("area"), 0.0);
  EXPECT_EQ(bow_tie.at("after").at("area"), 2.0);
  EXPECT_EQ(bow_tie.at("after").at("polygons"), 2);
  EXPECT_EQ(file.at("repairs").at(1).at("refused"), "E_TOO_FEW_POINTS");
  EXPECT_TRUE(here.has("repaired.dat"));
  EXPECT_TRUE(here.has("repaired.gp"));
  const Outcome again = here.run("validate --strict repaired.wkt");
  EXPECT_EQ(again.status, 0) << again.out;
  EXPECT_THAT(again.err, HasSubstr("3 valid"));
}

TEST(Repair, AWallOfTheSameIdDoesNotStopTheFigure) {
  const Workplace here;
  here.write("twice.geojson", R"({"type":"FeatureCollection","features":[
    {"type":"Feature","id":"A","properties":{"id":"A"},"geometry":{"type":"LineString","coordinates":[[0,0],[1,5]]}},
    {"type":"Feature","id":"A","properties":{"id":"A"},"geometry":{"type":"Polygon",
     "coordinates":[[[10,0],[12,2],[12,0],[10,2],[10,0]]]}}]})");
  const Outcome outcome = here.run("repair twice.geojson --units metres --out repaired.wkt --figure repaired.svg");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(here.has("repaired.dat"));
}

/// The colour of a pixel by what gnuplot drew there is not ours to test: what is filled, and in which order, is.
TEST(Repair, AnIslandInAHoleIsFilledWithNothingPaintedOverIt) {
  const Workplace here;
  here.write("island.wkt",
             "POLYGON((0 0, 400000 0, 400000 400000, 0 400000, 0 0), (50000 50000, 350000 50000, 350000 350000, 50000 "
             "350000, 50000 50000), (100000 100000, 200000 200000, 200000 100000, 100000 200000, 100000 100000))\n");
  const Outcome outcome = here.run("repair island.wkt --out repaired.wkt --figure repaired.svg");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string script = here.read("repaired.gp");
  EXPECT_THAT(script, HasSubstr("title '(b) after: 3 polygons'"));
  std::size_t fillings = 0;
  for (std::size_t at = 0; (at = script.find("filledcurves", at)) != std::string::npos; ++at) ++fillings;
  EXPECT_EQ(fillings, 3u);
  EXPECT_THAT(script, Not(HasSubstr("fc rgb 'white'")));
  EXPECT_THAT(script, HasSubstr("set xtics 100000\n")) << "445000 m in 330 px, a label takes 60";
}

TEST(Repair, FiguresFarFromTheOriginCountFromAPointNearby) {
  const Workplace here;
  here.write("far.wkt", "POLYGON((500010 5500000, 500012 5500002, 500012 5500000, 500010 5500002, 500010 5500000))\n");
  ASSERT_EQ(here.run("repair far.wkt --out repaired.wkt --figure repaired.svg").status, 0);
  EXPECT_THAT(here.read("repaired.gp"), AllOf(HasSubstr("after: 2 polygons - (500010, 5500000)'"), HasSubstr("x0 = "),
                                              HasSubstr("set xtics 0.5\n")));
}

TEST(Repair, SeveralFilesBecomeOneAndAnUnreadableOneNone) {
  const Workplace here;
  here.write("a.wkt", kGood);
  here.write("b.wkt", kBowTie);
  EXPECT_EQ(here.run("repair a.wkt b.wkt --out all.csv").status, 0);
  EXPECT_THAT(here.read("all.csv"), AllOf(HasSubstr("\"a/1\""), HasSubstr("\"b/1\""), HasSubstr("\"b/1-2\"")));
  EXPECT_EQ(here.run("repair a.wkt nowhere.wkt --out none.wkt").status, 2);
  EXPECT_FALSE(here.has("none.wkt"));
}

TEST(Repair, FilesOfOneNameKeepTheirObstaclesApart) {
  const Workplace here;
  here.write("a.wkt", kGood);
  here.write("a.txt", kGood);
  EXPECT_EQ(here.run("repair a.wkt a.txt --format wkt --out all.csv").status, 0);
  EXPECT_THAT(here.read("all.csv"), AllOf(HasSubstr("\"a/1\""), HasSubstr("\"a-2/1\"")));
}

std::string geojson_at(int longitude) {
  const std::string x = std::to_string(longitude);
  return R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[)" + x + ",50],[" + x +
         ".001,50],[" + x + ".001,50.001],[" + x + ",50]]]}}\n";
}

TEST(Repair, FilesOfDegreesAreNotPutOnOneHeap) {
  const Workplace here;
  here.write("here.geojson", geojson_at(7));
  here.write("there.geojson", geojson_at(8));
  const Outcome both = here.run("repair here.geojson there.geojson --out all.csv");
  EXPECT_EQ(both.status, 2);
  EXPECT_FALSE(here.has("all.csv"));
  if (!datasets::built_with_gdal()) return;
  EXPECT_THAT(both.err, AllOf(HasSubstr("here.geojson (round 7.0"), HasSubstr("there.geojson (round 8.0")));
  const Outcome one = here.run("repair here.geojson --out one.csv --json");
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_NEAR(json::parse(one.out).at("files").at(0).at("origin").at("longitude").get<double>(), 7.0005, 1e-3);
}

constexpr const char* kFourByThree = R"({"type":"Polygon","coordinates":[[[0,0],[4,0],[4,3],[0,3],[0,0]]]})";

/// By RFC 7946 a 4 x 3 rectangle without units is in degrees, which is hardly meant: a message says so.
TEST(ObstacleVerbs, AMessageSaysThatDegreesBecameMetres) {
  const Workplace here;
  here.write("unit.geojson", kFourByThree);
  here.write("unit.json", R"({"name": "unit", "robots": [{"id": "R", "position": [2, 1], "goal": [9, 9]}],
    "obstacles": [{"file": "unit.geojson"}]})");
  const std::string vo = "vo --obstacle unit.geojson --position 5,5 --velocity 1,0 --radius 0.5 --time-horizon 2";
  for (const std::string& arguments :
       {std::string("validate unit.geojson"), std::string("segment unit.geojson"),
        std::string("repair unit.geojson --out u.wkt"), std::string("convert unit.geojson u.wkt"), vo,
        std::string("simulate unit.json")})
    EXPECT_THAT(here.run(arguments).err, HasSubstr("projected from degrees to metres")) << arguments;
  for (const std::string& arguments : {std::string("validate unit.geojson --units metres"), vo + " --units metres"})
    EXPECT_THAT(here.run(arguments).err, testing::Not(HasSubstr("degrees"))) << arguments;
  EXPECT_THAT(here.run(vo + " --units metres").out, HasSubstr("nearest boundary"));
}

TEST(ObstacleVerbs, NotesOnWholeFilesAreReported) {
  const Workplace here;
  here.write("table.csv", "id,WKT\n1,\"POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0))\"\n");
  for (const std::string arguments : {"validate table.csv", "segment table.csv", "repair table.csv --out u.wkt",
                                      "convert table.csv v.wkt", "batch table.csv --out out --write measurements"})
    EXPECT_THAT(here.run(arguments).err, HasSubstr("table.csv: taken as metres: names no reference system"))
        << arguments;
  here.write("m.pgm", "P2 2 1 255\n0 205\n");
  here.write("m.yaml", "image: m.pgm\nresolution: 1\norigin: [0, 0, 0]\n");
  EXPECT_THAT(here.run("validate m.yaml").err, HasSubstr("m.yaml: 1 unknown cell taken as free"));
}

TEST(ObstacleVerbs, UnknownCellsAreBlockedWhereAsked) {
  const Workplace here;
  here.write("m.pgm", "P2 3 1 255\n255 205 255\n");  // free, unknown, free
  here.write("m.yaml", "image: m.pgm\nresolution: 1\norigin: [0, 0, 0]\n");
  EXPECT_THAT(here.run("validate m.yaml --unknown blocked").err, HasSubstr("m.yaml: 1 unknown cell taken as blocked"));
  const std::string route = "route m.yaml --from 0.5,0.5 --to 1.5,0.5 --radius 0.1";
  EXPECT_EQ(here.run(route).status, 0);
  const Outcome blocked = here.run(route + " --unknown blocked");
  EXPECT_EQ(blocked.status, 1);
  EXPECT_THAT(blocked.out, HasSubstr("inside"));
  EXPECT_THAT(here.run("convert m.yaml - --unknown blocked").out, HasSubstr("POLYGON"));
  EXPECT_THAT(here.run("batch m.yaml --out out --write measurements --unknown blocked").err,
              HasSubstr("taken as blocked"));
  EXPECT_THAT(here.run(route + " --unknown blokced").err, HasSubstr("did you mean 'blocked'?"));
}

TEST(ObstacleVerbs, DistortionIsInJson) {
  const Workplace here;
  here.write("unit.geojson", kFourByThree);
  const json file = json::parse(here.run("validate unit.geojson --json").out).at("files").at(0);
  EXPECT_NEAR(file.at("distortion").at("length").get<double>(), 3.2e-4, 1e-5);
  EXPECT_TRUE(file.at("distortion").at("certified").get<bool>());
  here.write("a.wkt", kGood);
  EXPECT_TRUE(json::parse(here.run("validate a.wkt --json").out).at("files").at(0).at("distortion").is_null());
}

TEST(Segment, TheSizeOfItsOutputIsPrintedBefore) {
  const Workplace here;
  EXPECT_EQ(here.run("generate star --seed 3 --count 20 --out stars.wkt").status, 0);
  for (const std::string out : {"shapes.geojson", "shapes.jsonl"}) {
    const Outcome outcome = here.run("segment stars.wkt --out " + out + (out == "shapes.geojson" ? " --metres" : ""));
    const std::size_t about = outcome.err.find(": about ");
    ASSERT_NE(about, std::string::npos) << outcome.err;
    EXPECT_LT(about, outcome.err.find("wrote " + out));
    std::istringstream words(outcome.err.substr(about + 8));
    double said = 0.0;
    std::string unit;
    words >> said >> unit;
    said *= unit == "MB" ? 1e6 : unit == "kB" ? 1e3 : 1.0;
    const auto written = static_cast<double>(here.read(out).size());
    EXPECT_GT(said, written / 2) << outcome.err;
    EXPECT_LT(said, written * 2) << outcome.err << written;
  }
}

TEST(Batch, WhereTheResultsLieDoesNotShowInThem) {
  const Workplace here;
  here.write("a.wkt", kGood);
  EXPECT_EQ(here.run("batch a.wkt --write measurements -oone").status, 0);
  EXPECT_EQ(here.run("batch a.wkt --write measurements --out two -j1").status, 0);
  EXPECT_EQ(here.read("one/measurements.jsonl"), here.read("two/measurements.jsonl"));
}

TEST(Batch, RejectedFilesAreNamedAndNoSuccess) {
  const Workplace here;
  std::filesystem::create_directory(here.path() / "maps");
  here.write("maps/good.wkt", kGood);
  for (int k = 10; k < 35; ++k) here.write("maps/bad" + std::to_string(k) + ".wkt", "POLYGON ((0 0");
  const Outcome some = here.run("batch maps --out out --write measurements");
  EXPECT_EQ(some.status, 1) << some.err;
  EXPECT_THAT(some.err, AllOf(HasSubstr("rejected: maps/bad10.wkt: E_"), HasSubstr("rejected: maps/bad29.wkt"),
                              testing::Not(HasSubstr("bad30.wkt")), HasSubstr("and 5 more, see out/summary.json")));
  const Outcome again = here.run("batch maps --out out --write measurements");
  EXPECT_THAT(again.err, HasSubstr("note: replaced the earlier batch in out"));
  EXPECT_THAT(here.run("batch nowhere --out out").err,
              AllOf(HasSubstr("E_FILE_MISSING"), testing::Not(HasSubstr("replace"))));
  EXPECT_THAT(here.run("batch maps --out out --write measurements --resume").err,
              HasSubstr("rejected: maps/bad10.wkt"));
  EXPECT_EQ(here.run("batch maps/bad10.wkt --out none --write measurements").status, 1);
  here.write("half.wkt", std::string(kGood) + kBowTie);
  EXPECT_EQ(here.run("batch half.wkt --out half --write measurements").status, 1);
  EXPECT_EQ(here.run("batch half.wkt --out mended --write measurements --repair").status, 0);
  std::filesystem::create_directory(here.path() / "empty");
  const Outcome nothing = here.run("batch empty --out zero --write measurements");
  EXPECT_EQ(nothing.status, 2);
  EXPECT_THAT(nothing.err, AllOf(HasSubstr("no file to read"), HasSubstr("E_FILE_MISSING")));
  EXPECT_FALSE(std::filesystem::exists(here.path() / "zero"));
}

TEST(Batch, AnotherProcessJoinsWithResume) {
  const Workplace here;
  here.write("a.wkt", kGood);
  std::filesystem::create_directories(here.path() / "out/.parts");
  here.write("out/.parts/run.json", "{}");  // as a process at work has it
  const Outcome refused = here.run("batch a.wkt --out out --write measurements");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("E_OTHER_RUN"), HasSubstr("--resume"), HasSubstr("join")));
  const auto joining = [&] {
    return std::system(("cd '" + here.path().string() +
                        "' && " EXACTVO_PROGRAM
                        " batch a.wkt --out both --write measurements --resume > /dev/null 2>&1")
                           .c_str());
  };
  std::future<int> other = std::async(std::launch::async, joining);
  EXPECT_EQ(joining(), 0);
  EXPECT_EQ(other.get(), 0);
  EXPECT_TRUE(here.has("both/summary.json"));
}

TEST(Batch, NumbersOutOfRangeAreReportedInWords) {
  const Workplace here;
  here.write("good.wkt", kGood);
  for (const char* option : {"--radius -1", "--tolerance -1", "--cell-size nan", "--time-horizon 0",
                             "--time-horizon 7e-31", "--time-horizon 2e30", "--time-horizon inf", "--radius 2e30"}) {
    const Outcome outcome = here.run(std::string("batch good.wkt --out out ") + option);
    EXPECT_EQ(outcome.status, 2) << option;
    EXPECT_THAT(outcome.err, HasSubstr("expected a ")) << option;
    EXPECT_LT(outcome.err.size(), 120u) << outcome.err;
  }
}

/// Beside the square the robot touches it, which leaves the velocities away from it.
TEST(Batch, HalfPlanesThatAreNullAreCountedAndReported) {
  const Workplace here;
  here.write("a.wkt", "POLYGON((0 0, 1 0, 1 1, 0 1, 0 0))\n");
  const std::string robot = " --write measurements --out out --time-horizon 2 --radius 1 --position ";
  const std::pair<const char*, int> cases[] = {
      {"5,5", 0}, {"2,0.5", 0}, {"1.5,0.5", 1}, {"0.5,0.5 --position 1.5,0.5 --position 5,5", 2}};
  for (const auto& [positions, nulls] : cases) {
    const Outcome outcome = here.run("batch a.wkt" + robot + positions);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(json::parse(here.read("out/summary.json")).at("no_half_plane"), nulls) << positions;
    std::istringstream figures(here.read("out/measurements.jsonl"));
    std::string line;
    std::getline(figures, line);  // provenance
    std::getline(figures, line);
    const json record = json::parse(line);
    int found = 0;
    for (const json& at : record.at("half_planes"))
      for (const json& half_plane : at.at("half_planes")) found += half_plane.is_null() ? 1 : 0;
    EXPECT_EQ(found, nulls) << line;
    const std::string note = "note: " + std::to_string(nulls) + " of the half-planes in out/measurements.jsonl";
    if (nulls > 0) {
      EXPECT_THAT(outcome.err, HasSubstr(note));
    } else {
      EXPECT_THAT(outcome.err, Not(HasSubstr("half-planes")));
    }
  }
  EXPECT_THAT(here.run("batch a.wkt" + robot + cases[3].first + " --resume").err, HasSubstr("note: 2 of"))
      << "told again";
}

TEST(Batch, AShardThatIsThroughFirstSaysSo) {
  const Workplace here;
  here.write("a.wkt", kGood);
  here.write("b.wkt", kGood);
  const Outcome first = here.run("batch a.wkt b.wkt --write measurements --out out --shard 1/2");
  EXPECT_EQ(first.status, 0);
  EXPECT_THAT(first.err, HasSubstr("shard 1/2 is complete"));
  EXPECT_FALSE(here.has("out/summary.json"));
  EXPECT_EQ(here.run("batch a.wkt b.wkt --write measurements --out out --shard 2/2").status, 0);
  EXPECT_TRUE(here.has("out/summary.json"));
}

/// Held as by a process that puts parts together: others wait for it.
class HeldLock {
 public:
  explicit HeldLock(std::filesystem::path path)
      : path_(std::move(path)), descriptor_(::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
    EXPECT_EQ(::flock(descriptor_, LOCK_EX), 0);
  }
  ~HeldLock() { ::close(descriptor_); }
  HeldLock(const HeldLock&) = delete;
  HeldLock& operator=(const HeldLock&) = delete;

  /// The processes that wait for it, once there are this many, a minute at most.
  std::vector<pid_t> awaited_by(std::size_t processes) const {
    std::vector<pid_t> waiting;
    for (int looks = 0; looks < 6000; ++looks, std::this_thread::sleep_for(std::chrono::milliseconds(10))) {
      waiting = others_with_it_open();
      if (waiting.size() >= processes) break;
    }
    return waiting;
  }

 private:
  std::vector<pid_t> others_with_it_open() const {
    std::vector<pid_t> found;
    std::error_code gone;
    for (const auto& process : std::filesystem::directory_iterator("/proc")) {
      const pid_t pid = std::atoi(process.path().filename().c_str());
      // A shell's child holds what this process has open until it becomes the program.
      if (pid <= 0 || std::filesystem::read_symlink(process.path() / "exe", gone) != program_) continue;
      std::filesystem::directory_iterator files(process.path() / "fd", gone);
      if (gone) continue;
      for (; files != std::filesystem::directory_iterator(); files.increment(gone))
        if (std::filesystem::read_symlink(files->path(), gone) == path_) found.push_back(pid);
    }
    return found;
  }

  std::filesystem::path path_;
  int descriptor_;
  std::filesystem::path program_ = std::filesystem::canonical(EXACTVO_PROGRAM);
};

TEST(Batch, AChildThatIsNotTheProgramYetDoesNotWaitForALock) {
  const Workplace here;
  const HeldLock lock(std::filesystem::canonical(here.path()) / "lock");
  const pid_t child = ::fork();
  if (child == 0) {
    while (true) ::pause();
  }
  ASSERT_GT(child, 0);
  EXPECT_THAT(lock.awaited_by(0), IsEmpty());
  EXPECT_EQ(::kill(child, SIGKILL), 0);
  EXPECT_EQ(::waitpid(child, nullptr, 0), child);
}

TEST(Batch, OneOfTwoAtOnceMergesThePartsAndTheOtherReportsTheSame) {
  const Workplace here;
  here.write("a.wkt", kGood);
  here.write("b.wkt", kGood);
  ASSERT_EQ(here.run("batch a.wkt b.wkt --write measurements --out out --shard 1/2").status, 0);
  std::optional<HeldLock> lock(std::filesystem::canonical(here.path()) / "out/.parts/lock");
  // In folders of their own, as each leaves its output where it starts.
  const auto resumed = [&here](const std::string& folder) {
    std::filesystem::create_directory(here.path() / folder);
    const std::string command = "cd '" + here.path().string() +
                                "' && '" EXACTVO_PROGRAM
                                "' batch a.wkt b.wkt --write measurements --out out --resume >" +
                                folder + "/out 2>" + folder + "/err";
    return std::async(std::launch::async, [command] { return std::system(command.c_str()); });
  };
  std::future<int> one = resumed("one");
  std::future<int> other = resumed("other");
  EXPECT_EQ(lock->awaited_by(2).size(), 2u);
  lock.reset();
  EXPECT_EQ(one.get(), 0);
  EXPECT_EQ(other.get(), 0);
  const std::string told = here.read("one/err") + here.read("other/err");
  const std::size_t first = told.find("nothing left to do");
  EXPECT_NE(first, std::string::npos) << told;
  EXPECT_EQ(told.find("nothing left to do", first + 1), std::string::npos) << told;
  for (const char* report : {"one/out", "other/out"})
    EXPECT_THAT(here.read(report), HasSubstr("2 obstacles")) << report;
  EXPECT_TRUE(here.has("out/summary.json"));
  EXPECT_FALSE(here.has("out/.parts"));
}

TEST(Batch, AProcessThatWaitsForTheMergeOfAnotherCanBeStopped) {
  const Workplace here;
  here.write("a.wkt", kGood);
  here.write("b.wkt", kGood);
  ASSERT_EQ(here.run("batch a.wkt b.wkt --write measurements --out out --shard 1/2").status, 0);
  const HeldLock lock(std::filesystem::canonical(here.path()) / "out/.parts/lock");
  std::future<Outcome> run = std::async(
      std::launch::async, [&here] { return here.run("batch a.wkt b.wkt --write measurements --out out --resume"); });
  const std::vector<pid_t> waiting = lock.awaited_by(1);
  EXPECT_EQ(waiting.size(), 1u);
  for (const pid_t pid : waiting) EXPECT_EQ(::kill(pid, SIGTERM), 0);
  const Outcome outcome = run.get();
  EXPECT_EQ(outcome.status, 143);
  EXPECT_THAT(outcome.err, HasSubstr("interrupted; --resume goes on"));
  EXPECT_TRUE(here.has("out/.parts/run.json"));
}

TEST(Convert, SaysWhatIsLost) {
  const Workplace here;
  here.write("holed.wkt", "POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0), (1 1, 1 2, 2 2, 1 1))\nPOINT (3 3)\n");
  const Outcome outcome = here.run("convert holed.wkt out.poly.xml");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("1 hole filled"), HasSubstr("lost 1 input (")));
  here.write("grid.map", "type octile\nheight 2\nwidth 3\nmap\n@..\n@.@\n");
  const Outcome grid = here.run("convert grid.map grid.geojson");
  EXPECT_EQ(grid.status, 0) << grid.err;
  EXPECT_THAT(grid.err, HasSubstr("occupied cells: 3 of 6; they became 2 polygons"));
}

TEST(Convert, ADashIsStandardOutput) {
  const Workplace here;
  here.write("a.wkt", kClockwise);
  EXPECT_EQ(here.run("convert a.wkt -").out, kGood);
  EXPECT_THAT(here.run("convert a.wkt - --to geojson").out, HasSubstr("FeatureCollection"));
  EXPECT_THAT(here.run("generate star --count 3 --out -").out, testing::StartsWith("POLYGON"));
  EXPECT_EQ(here.run("repair a.wkt --out -").status, 2);
  EXPECT_FALSE(here.has("-"));
}

TEST(Convert, BadObstaclesStopItUnlessRepairedOrSkipped) {
  const Workplace here;
  here.write("bad.wkt", std::string(kGood) + kBowTie + kHopeless);
  const Outcome plain = here.run("convert bad.wkt out.wkt");
  EXPECT_EQ(plain.status, 2);
  EXPECT_THAT(plain.err, AllOf(HasSubstr("E_SELF_INTERSECTION"), HasSubstr("--repair")));
  EXPECT_FALSE(here.has("out.wkt"));
  EXPECT_EQ(here.run("convert bad.wkt out.wkt --skip").status, 1);
  EXPECT_EQ(here.read("out.wkt"), kGood);
  EXPECT_EQ(here.run("convert bad.wkt out.wkt --skip --repair").status, 1);
  EXPECT_NE(here.read("out.wkt"), kGood);
}

TEST(Convert, AnUnwritablePlaceLeavesNothing) {
  const Workplace here;
  here.write("a.wkt", kGood);
  here.write("file", "");
  const Outcome outcome = here.run("convert a.wkt file/out.wkt");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("E_FILE_UNWRITABLE"));
  EXPECT_EQ(here.run("convert a.wkt /dev/null/x.wkt").status, 2);
  EXPECT_EQ(here.run("convert a.wkt out.dwg").status, 2);
  EXPECT_EQ(here.files(".").size(), 4u);  // the two above, .stdout, .stderr
}

TEST(Segment, RecordsFeaturesAndAFigure) {
  const Workplace here;
  here.write("ell.wkt", "POLYGON ((0 0, 4 0, 4 1, 1 1, 1 4, 0 4, 0 0))\nLINESTRING (10 0, 10 5, 15 5)\n");
  const Outcome outcome = here.run("segment ell.wkt --json --out shapes.geojson --figure shapes.svg");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json ell = json::parse(outcome.out.substr(0, outcome.out.find('\n')));
  EXPECT_EQ(ell.at("facades_count"), 6);
  EXPECT_EQ(ell.at("pieces_count"), 2);
  EXPECT_TRUE(here.has("shapes.gp"));
  std::size_t facades = 0;
  std::size_t ellipses = 0;
  const json collection = json::parse(here.read("shapes.geojson"));
  for (const json& feature : collection.at("features")) {
    const json& properties = feature.at("properties");
    const bool is_ellipse = properties.at("shape").get<std::string>().find("ellipse") != std::string::npos;
    EXPECT_TRUE(properties.at(is_ellipse ? "ellipse_certified" : "certified"));
    EXPECT_EQ(properties.contains("certified"), !is_ellipse) << "an ellipse's outline is drawn within it";
    if (properties.at("shape") != "smallest ellipse" || properties.at("id") != ell.at("id")) continue;
    EXPECT_EQ(properties.at("center_x"), ell.at("smallest_ellipse").at("center").at(0));
    EXPECT_EQ(properties.at("l22"), ell.at("smallest_ellipse").at("l22"));
    ++ellipses;
  }
  for (const json& feature : collection.at("features"))
    facades += feature.at("properties").at("shape") == "facade" ? 1 : 0;
  EXPECT_EQ(ellipses, 1u);
  EXPECT_EQ(facades, 6u + 2u);
  EXPECT_EQ(here.run("segment ell.wkt --out shapes.jsonl").status, 0);
  EXPECT_EQ(here.read("shapes.jsonl"), outcome.out);
}

TEST(Segment, SaysWhatItWroteAndWhereNoObstacleWas) {
  const Workplace here;
  here.write("pt.wkt", "POINT (1 2)\n");
  const Outcome outcome = here.run("segment pt.wkt --out x.jsonl");
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("no obstacle in pt.wkt"), HasSubstr("wrote x.jsonl")));
}

TEST(Segment, TheMarginOfFacadesIsAnOption) {
  const Workplace here;
  here.write("tiny.wkt", "POLYGON ((0 0, 4e-9 0, 4e-9 4e-9, 0 4e-9, 0 0))\n");
  const auto semi_axis = [&](const std::string& option) {
    const Outcome outcome = here.run("segment tiny.wkt --json" + option);
    return json::parse(outcome.out).at("facade_ellipses").at(0).at("l11").get<double>();
  };
  EXPECT_GT(semi_axis(""), 0.02);
  EXPECT_LT(semi_axis(" --facade-margin 1e-10"), 1e-8);
  EXPECT_EQ(here.run("segment tiny.wkt --facade-margin -1").status, 2);
}

TEST(ObstacleVerbs, HiddenFilesInTheMakingAreNotNamed) {
  const Workplace here;
  here.write("a.wkt", kGood);
  const Outcome figure = here.run("segment a.wkt --figure /proc/x.svg");
  EXPECT_EQ(figure.status, 2);
  EXPECT_THAT(figure.err, AllOf(HasSubstr("/proc/x.svg"), testing::Not(HasSubstr("..x"))));
  const Outcome batch = here.run("batch a.wkt --out /proc/x");
  EXPECT_EQ(batch.status, 2);
  EXPECT_THAT(batch.err, AllOf(HasSubstr("/proc/x"), testing::Not(HasSubstr(".parts"))));
}

TEST(Audit, FilesThatAreNoRecordingsAreRefused) {
  const Workplace here;
  here.write("mine.json", R"({"name": "mine", "robots": []})");
  const Outcome scenario = here.run("audit mine.json");
  EXPECT_EQ(scenario.status, 2);
  EXPECT_THAT(scenario.err, HasSubstr("mine.json: found a scenario, which is no run yet, expected a recording.jsonl"));
  here.write("other.json", R"({"name": "mine"})");
  EXPECT_THAT(here.run("audit other.json").err, HasSubstr("no recording"));
  std::filesystem::create_directory(here.path() / "empty");
  EXPECT_THAT(here.run("audit empty").err, HasSubstr("path: found 'empty'"));
}

TEST(Repair, AMissingFileIsReportedOnce) {
  const Workplace here;
  const Outcome outcome = here.run("repair nofile.wkt --out x.wkt");
  EXPECT_EQ(outcome.status, 2);
  const std::string all = outcome.out + outcome.err;
  EXPECT_EQ(all.find("E_FILE_MISSING"), all.rfind("E_FILE_MISSING"));
}

TEST(Segment, WhatCannotBeUsedIsNamed) {
  const Workplace here;
  here.write("bad.wkt", std::string(kGood) + kBowTie);
  const Outcome outcome = here.run("segment bad.wkt");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("E_SELF_INTERSECTION"));
  EXPECT_EQ(here.run("segment bad.wkt --repair").status, 0);
  EXPECT_EQ(here.run("segment bad.wkt --tolerance -1").status, 2);
  EXPECT_EQ(here.run("segment bad.wkt --out x.txt").status, 2);
  EXPECT_EQ(here.run("segment nowhere.wkt").status, 2);
}

}  // namespace
}  // namespace exactvo::test
