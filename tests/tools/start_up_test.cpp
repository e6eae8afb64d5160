// SPDX-License-Identifier: GPL-3.0-or-later
// GDAL, SQLite and MPI are loaded when they are asked for, and found beside the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "exactvo/datasets/obstacle_file.h"
#include "tools/run_program.h"

namespace exactvo::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const char* const kSquareGeoJson =
    R"({"type": "Polygon", "coordinates": [[[0, 0], [0.001, 0], [0.001, 0.001], [0, 0.001], [0, 0]]]})";
const char* const kVo =
    "vo --obstacle 'POLYGON((2 -1, 4 -1, 4 1, 2 1, 2 -1))' --position 0,0 --velocity 1,0 --radius 0.3 --time-horizon 3";

/// Which of GDAL, SQLite and MPI the dynamic linker loads while the program runs, at its start or later.
std::set<std::string> loaded_by(const Workplace& here, const std::string& arguments) {
  const Outcome run = here.run(arguments, "LD_DEBUG=files LD_DEBUG_OUTPUT=loaded");
  EXPECT_EQ(run.status, 0) << arguments << "\n" << run.err;
  std::set<std::string> found;
  bool has_seen_any = false;
  for (const auto& entry : fs::directory_iterator(here.path())) {
    if (entry.path().filename().string().rfind("loaded.", 0) != 0) continue;
    const std::string text = here.read(entry.path().filename().string());
    has_seen_any = has_seen_any || text.find("libstdc++.so") != std::string::npos;
    for (const std::string name : {"libgdal.so", "libsqlite3.so", "libmpi.so"}) {
      if (text.find(name) != std::string::npos) found.insert(name);
    }
    fs::remove(entry.path());
  }
  EXPECT_TRUE(has_seen_any) << "the dynamic linker says nothing: the test looks at the wrong place";
  return found;
}

TEST(StartUp, LoadsNoLibraryThatIsNotNeeded) {
  const Workplace here;
  here.write("square.wkt", "POLYGON((0 0, 1 0, 1 1, 0 1, 0 0))");
  here.write("problem.jsonl", R"({"bound": {"disc": 2}, "preferred": [1, 0], "constraints": []})");
  for (const std::string& arguments :
       {std::string("--version"), std::string("--help"), std::string(kVo) + " --json", std::string("lp problem.jsonl"),
        std::string("validate square.wkt"), std::string("convert square.wkt square.sumo.xml --to sumo-poly"),
        "simulate '" + data_file("paper/A10.json") + "' --json"}) {
    EXPECT_EQ(loaded_by(here, arguments), std::set<std::string>{}) << arguments;
  }
}

TEST(StartUp, LoadsGdalForAVectorFileAndNoMpi) {
  if (!datasets::built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  const Workplace here;
  here.write("square.geojson", kSquareGeoJson);
  const std::set<std::string> loaded = loaded_by(here, "validate square.geojson");
  EXPECT_EQ(loaded.count("libgdal.so"), 1u);
  EXPECT_EQ(loaded.count("libmpi.so"), 0u);
}

/// The program alone, in `bin` of the workplace.
class MovedProgram : public testing::Test {
 protected:
  MovedProgram() {
    fs::create_directories(here_.path() / "bin");
    fs::copy_file(EXACTVO_PROGRAM, here_.path() / "bin/exactvo");
    here_.write("square.geojson", kSquareGeoJson);
    here_.write("square.wkt", "POLYGON((0 0, 1 0, 1 1, 0 1, 0 0))");
  }
  Outcome run(const std::string& arguments) const { return here_.run("--version; bin/exactvo " + arguments, "true"); }
  fs::path module() const {
    return (here_.path() / "bin" / EXACTVO_MODULE_FOLDER / "exactvo_gdal.so").lexically_normal();
  }

  Workplace here_;
};

TEST_F(MovedProgram, NamesTheModuleThatIsMissing) {
  if (!datasets::built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  EXPECT_EQ(run("validate square.wkt").status, 0);
  const Outcome refused = run("validate square.geojson");
  EXPECT_NE(refused.status, 0);
  EXPECT_THAT(refused.out + refused.err, HasSubstr(module().string()));
  EXPECT_THAT(refused.out + refused.err, HasSubstr("E_FORMAT_UNAVAILABLE"));
  const Outcome converted = run("convert square.wkt square.gpkg");
  EXPECT_EQ(converted.status, 2);
  EXPECT_THAT(converted.err, HasSubstr(module().string()));
  EXPECT_FALSE(here_.has("square.gpkg"));
}

TEST_F(MovedProgram, RefusesABatchWithoutItsModuleBeforeTheWork) {
  if (!datasets::built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  fs::create_directories(here_.path() / "in");
  here_.write("in/square.wkt", "POLYGON((0 0, 1 0, 1 1, 0 1, 0 0))");
  const Outcome refused = run("batch in --out out --write measurements,geopackage");
  EXPECT_EQ(refused.status, 2) << refused.out << refused.err;
  EXPECT_THAT(refused.err, HasSubstr(module().string()));
  EXPECT_FALSE(here_.has("out/.parts"));
}

TEST_F(MovedProgram, RefusesALibraryThatIsNotItsModule) {
  if (!datasets::built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  fs::create_directories(module().parent_path());
  std::ofstream(module()) << "no library";
  EXPECT_THAT(run("convert square.wkt square.gpkg").err, HasSubstr("cannot be loaded"));
  const fs::path other = fs::path(EXACTVO_PROGRAM).parent_path() / EXACTVO_MODULE_FOLDER / "exactvo_mpi.so";
  if (!fs::exists(other)) return;  // built without MPI
  fs::copy_file(other, module(), fs::copy_options::overwrite_existing);
  EXPECT_THAT(run("convert square.wkt square.gpkg").err, HasSubstr("another module"));
}

TEST_F(MovedProgram, FindsItsModulesBesideIt) {
  if (!datasets::built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  fs::create_directories(module().parent_path());
  fs::copy_file(fs::path(EXACTVO_PROGRAM).parent_path() / EXACTVO_MODULE_FOLDER / "exactvo_gdal.so", module());
  const Outcome converted = run("convert square.wkt square.gpkg");
  EXPECT_EQ(converted.status, 0) << converted.err;
  EXPECT_TRUE(here_.has("square.gpkg"));
}

}  // namespace
}  // namespace exactvo::test
