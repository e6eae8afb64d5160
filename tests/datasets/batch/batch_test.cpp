// SPDX-License-Identifier: GPL-3.0-or-later
// Batches: the same bytes however they are run, stopped and gone on with; and what is refused.
#include "exactvo/datasets/batch.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "batch_folder.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/obstacle_write.h"

namespace exactvo::datasets::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class Batches : public BatchFolder {
 protected:
  Batches() : BatchFolder(2) {}
  void SetUp() override {
    BatchFolder::SetUp();
    write_inputs(folder_ / "in", 1300);
  }

  fs::path out(const std::string& name) const { return folder_ / name; }
  Json summary_of(const std::string& name) const { return Json::parse(text_of(out(name) / "summary.json")); }

  /// The lines of measurements.jsonl below the first, which is provenance.
  std::vector<Json> records_of(const std::string& name) const {
    std::istringstream lines(text_of(out(name) / "measurements.jsonl"));
    std::string line;
    std::getline(lines, line);
    std::vector<Json> records;
    while (std::getline(lines, line)) records.push_back(Json::parse(line));
    return records;
  }

  /// Where outputs are being put together.
  std::size_t folders_on_their_way(const std::string& name) const {
    std::size_t folders = 0;
    for (const auto& entry : fs::directory_iterator(out(name) / ".parts")) {
      folders += entry.path().filename().string().rfind("final.", 0) == 0 ? 1 : 0;
    }
    return folders;
  }

  /// The error of a batch that has to throw.
  static DataError refused(const BatchConfiguration& configuration, const BatchRun& run, const BatchWatch& watch = {}) {
    try {
      run_batch(configuration, run, watch);
    } catch (const DataError& error) {
      EXPECT_FALSE(error.found().empty());
      return error;
    }
    ADD_FAILURE() << "nothing thrown";
    return {DataCode::library, "", "", "nothing thrown", "a refusal"};
  }
  static DataCode refusal(const BatchConfiguration& configuration, const BatchRun& run, const BatchWatch& watch = {}) {
    return refused(configuration, run, watch).code();
  }
};

TEST_F(Batches, EveryInputAndObstacleEndsInOneWay) {
  const BatchResult result = run_batch(plain_, run_to("out"));
  EXPECT_EQ(result.end, BatchEnd::complete);
  const BatchSummary& s = result.summary;
  EXPECT_EQ(s.files.read, 6u);
  EXPECT_EQ(s.files.done, 2u);      // stars, cells
  EXPECT_EQ(s.files.repaired, 1u);  // few: a clockwise ring
  EXPECT_EQ(s.files.rejected.at("E_SELF_INTERSECTION"), 1u);
  EXPECT_EQ(s.files.rejected.at("E_FORMAT_UNKNOWN"), 1u);
  EXPECT_EQ(s.files.rejected.at("E_JSON_SYNTAX") + s.files.done + s.files.repaired + 2u, s.files.read);
  EXPECT_EQ(s.obstacles.read, s.obstacles.done + s.obstacles.repaired + s.obstacles.rejected_in_all());
  EXPECT_EQ(s.obstacles.rejected.at("E_SELF_INTERSECTION"), 2u);
  EXPECT_EQ(s.passed_over, 1u);
  EXPECT_EQ(s.certified, s.obstacles_out);
  EXPECT_EQ(s.uncertified, 0u);
}

TEST_F(Batches, OutputsAgreeWithEachOther) {
  BatchConfiguration configuration;
  BatchRobot robot;
  robot.radius = 0.3;
  robot.time_horizon = 2.0;
  robot.positions = {{2000.0, 0.0}, {0.5, 0.5}};
  configuration.robot = robot;
  const BatchResult result = run_batch(configuration, run_to("out"));
  std::istringstream figures(text_of(out("out") / "measurements.jsonl"));
  std::string line;
  std::getline(figures, line);
  const Json provenance = Json::parse(line).at("provenance");
  EXPECT_EQ(provenance.at("inputs").size(), 6u);
  std::uint64_t lines = 0;
  std::uint64_t rejected = 0;
  while (std::getline(figures, line)) {
    const Json record = Json::parse(line);
    ++lines;
    if (record.at("outcome") == "rejected") {
      ++rejected;
      EXPECT_FALSE(record.at("code").get<std::string>().empty());
      continue;
    }
    EXPECT_EQ(record.at("certified"), true) << line;
    ASSERT_EQ(record.at("half_planes").size(), 2u);
    EXPECT_EQ(record.at("half_planes").at(0).at("half_planes").at(0).at("certified"), true) << line;
    EXPECT_GE(record.at("ellipse_area").get<double>() * (1.0 + 1e-12), record.at("hull_area").get<double>());
  }
  EXPECT_EQ(lines, result.summary.obstacles_out + rejected);
  for (const char* layer : {"obstacles", "hulls", "facades", "pieces", "ellipses"}) {
    const Json file = Json::parse(text_of(out("out") / (std::string(layer) + ".geojson")));
    EXPECT_FALSE(file.contains("units")) << "longitude and latitude, as every reader takes them";
    EXPECT_GE(file.at("features").size(), result.summary.obstacles_out) << layer;
  }
  if (!built_with_gdal()) return;
  ReadOptions options;
  options.keep_going = true;
  const ObstacleFile package = read_obstacles(out("out") / "obstacles.gpkg", options);
  const ObstacleFile geojson = read_obstacles(out("out") / "obstacles.geojson", options);
  EXPECT_EQ(geojson.obstacles.size(), result.summary.obstacles_out);
  EXPECT_GT(package.obstacles.size(), 5 * result.summary.obstacles_out) << "all five layers";
}

TEST_F(Batches, WorkersDoNotShowInTheBytes) {
  for (const int workers : {1, 2, 4}) {
    BatchRun run = run_to("w" + std::to_string(workers));
    run.workers = workers;
    EXPECT_TRUE(run_batch(plain_, run).was_merged_ahead);
  }
  EXPECT_EQ(difference(out("w1"), out("w2")), "");
  EXPECT_EQ(difference(out("w1"), out("w4")), "");
}

TEST_F(Batches, StoppedAnywhereAndGoneOnWithGivesTheSameBytes) {
  run_batch(plain_, run_to("whole"));
  int looks_until_stop = 0;
  for (int attempt = 0; attempt < 100; ++attempt) {
    BatchRun run = run_to("pieces");
    run.resume = attempt > 0;
    int looks = looks_until_stop++;
    const BatchResult result = run_batch(plain_, run, [&](const BatchProgress&) { return looks-- > 0; });
    if (result.end == BatchEnd::complete) break;
    EXPECT_EQ(result.end, BatchEnd::interrupted);
    EXPECT_FALSE(fs::exists(out("pieces") / "summary.json"));
    EXPECT_EQ(folders_on_their_way("pieces"), 0u);
  }
  EXPECT_GT(looks_until_stop, 4);
  EXPECT_EQ(difference(out("whole"), out("pieces")), "");
  BatchRun again = run_to("pieces");
  again.resume = true;
  EXPECT_TRUE(run_batch(plain_, again).was_complete);
}

TEST_F(Batches, ShardsMakeTheWhole) {
  run_batch(plain_, run_to("whole"));
  for (std::size_t shard = 1; shard <= 3; ++shard) {
    BatchRun run = run_to("shards");
    run.shards = 3;
    run.shard = shard;
    const BatchResult result = run_batch(plain_, run);
    EXPECT_EQ(result.end, shard < 3 ? BatchEnd::incomplete : BatchEnd::complete);
    EXPECT_FALSE(result.was_merged_ahead);
  }
  EXPECT_EQ(difference(out("whole"), out("shards")), "");
}

TEST_F(Batches, OtherInputsOptionsAndVersionsAreRefused) {
  BatchRun run = run_to("out");
  const auto stop_at_once = [](const BatchProgress&) { return false; };
  ASSERT_EQ(run_batch(plain_, run, stop_at_once).end, BatchEnd::interrupted);
  EXPECT_EQ(refusal(plain_, run), DataCode::other_run) << "unfinished, and no --resume";
  run.resume = true;
  BatchConfiguration other = plain_;
  other.shapes.facades.tolerance = 0.1;
  EXPECT_EQ(refusal(other, run), DataCode::other_run);
  EXPECT_EQ(refused(other, run).found(), "an output of other options: /shapes/facade_tolerance 0");
  BatchConfiguration with_robot = plain_;
  with_robot.robot = BatchRobot{0.5, 2.0, {0, 0}, {{1, 1}}, std::nullopt};
  EXPECT_EQ(refused(with_robot, run).found(), "an output of other options: /robot not given");
  BatchConfiguration limited = plain_;
  limited.memory_limit = 1000000;
  EXPECT_EQ(refusal(limited, run), DataCode::other_run) << "it decides what is refused for its size";
  const fs::path run_file = out("out") / ".parts" / "run.json";
  const std::string there = text_of(run_file);
  std::string older = there;
  older.replace(older.find("\"version\": \"") + 12, 1, "9");
  write_text(run_file, older);
  EXPECT_EQ(refusal(plain_, run), DataCode::other_run);
  write_text(run_file, there);
  write_text(folder_ / "in" / "few.wkt", "LINESTRING (0 0, 9 9)\n");
  EXPECT_EQ(refusal(plain_, run), DataCode::other_run) << "an input changed";
}

TEST_F(Batches, FilesThatAreReadWithAnInputBelongToIt) {
  const std::string picture = "P2 2 2 255\n0 255\n255 255\n";
  write_text(folder_ / "in" / "floor.yaml",
             "image : 'floor.pgm'  # drawn by hand\nresolution: 1\norigin: [0, 0, 0]\n"
             "occupied_thresh: 0.65\nfree_thresh: 0.2\nnegate: 0\n");
  write_text(folder_ / "in" / "floor.pgm", picture);
  write_text(folder_ / "beside" / "walls.wkt", "LINESTRING (5 5, 6 6)\n");
  write_text(folder_ / "in" / "one.json", R"({"robots": [{"start": [0, 0], "goal": [1, 0], "radius": 0.1}],)"
                                          R"( "obstacles": [{"file": "../beside/walls.wkt"}]})");
  BatchRun run = run_to("out");
  const BatchResult first = run_batch(plain_, run, [](const BatchProgress&) { return false; });
  ASSERT_EQ(first.end, BatchEnd::interrupted);
  run.resume = true;
  write_text(folder_ / "beside" / "walls.wkt", "LINESTRING (5 5, 6 7)\n");
  EXPECT_EQ(refusal(plain_, run), DataCode::other_run) << "a file that a scenario names";
  write_text(folder_ / "beside" / "walls.wkt", "LINESTRING (5 5, 6 6)\n");
  write_text(folder_ / "in" / "floor.pgm", "P2 2 2 255\n0 0\n255 255\n");
  EXPECT_EQ(refusal(plain_, run), DataCode::other_run) << "the picture of a map";
  write_text(folder_ / "in" / "floor.pgm", picture);
  const BatchResult rest = run_batch(plain_, run);
  EXPECT_EQ(rest.summary.files.read, 8u) << "the picture is none of them";
}

TEST_F(Batches, AnInputThatChangesUnderTheBatchIsReported) {
  const fs::path few = folder_ / "in" / "few.wkt";
  const std::string there = text_of(few);
  BatchRun run = run_to("out");
  const auto changes = [&](const BatchProgress& progress) {
    if (progress.doing == few.generic_string()) write_text(few, "LINESTRING (0 0, 9 9)\n");
    return true;
  };
  EXPECT_EQ(refusal(plain_, run, changes), DataCode::other_run);
  EXPECT_FALSE(fs::exists(run.out / "summary.json"));
  write_text(few, there);
  run.resume = true;
  run_batch(plain_, run);
  run_batch(plain_, run_to("whole"));
  EXPECT_EQ(difference(out("whole"), out("out")), "") << "nothing of the other bytes is left";
}

TEST_F(Batches, AnErrorOfAReaderConcernsOneFile) {
  write_text(folder_ / "in" / "long.yaml", "image: " + std::string(5000, 'x') +
                                               "\nresolution: 1\norigin: [0, 0, 0]\n"
                                               "occupied_thresh: 0.65\nfree_thresh: 0.2\nnegate: 0\n");
  const BatchResult result = run_batch(plain_, run_to("out"));
  EXPECT_EQ(result.summary.files.rejected.at("E_LIBRARY"), 1u);
  EXPECT_EQ(result.summary.files.read, 7u);
}

TEST_F(Batches, PipesAndLinksToFoldersAreCountedAndNotFollowed) {
  ASSERT_EQ(::mkfifo((folder_ / "in" / "pipe.wkt").c_str(), 0600), 0);
  write_text(folder_ / "beside" / "walls.wkt", "LINESTRING (5 5, 6 6)\n");
  fs::create_directory_symlink(folder_ / "beside", folder_ / "in" / "link");
  fs::create_directory_symlink(folder_ / "in", folder_ / "in" / "round");
  const BatchResult result = run_batch(plain_, run_to("out"));
  EXPECT_EQ(result.summary.files.read, 9u);
  EXPECT_EQ(result.summary.files.rejected.at("E_FILE_UNREADABLE"), 3u);
}

TEST_F(Batches, AMapHidesNothingOutsideItsFolderNorWhatIsNamed) {
  const std::string rest = "\nresolution: 1\norigin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.2\nnegate: 0\n";
  write_text(folder_ / "maps" / "below" / "floor.yaml", "image: ../walls.wkt" + rest);
  write_text(folder_ / "maps" / "walls.wkt", "LINESTRING (5 5, 6 6)\n");
  write_text(folder_ / "maps" / "own.yaml", "image: own.pgm" + rest);
  write_text(folder_ / "maps" / "own.pgm", "P2 2 2 255\n0 255\n255 255\n");
  BatchRun run = run_to("out");
  run.paths = {folder_ / "maps"};
  EXPECT_EQ(run_batch(plain_, run).summary.files.read, 3u) << "own.pgm alone belongs to a map";
  run = run_to("named");
  run.paths = {folder_ / "maps", folder_ / "maps" / "own.pgm"};
  EXPECT_EQ(run_batch(plain_, run).summary.files.read, 4u);
}

/// The status of a process that can open no further file: 42 where the error is that the folder of `run` can't be read.
int status_without_descriptors(const BatchConfiguration& configuration, const BatchRun& run) {
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit limit{0, 0};
    ::setrlimit(RLIMIT_NOFILE, &limit);
    int status = 0;
    try {
      run_batch(configuration, run);
    } catch (const DataError& error) {
      status = error.code() == DataCode::file_unreadable ? 42 : 43;
    }
    ::_exit(status);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(Batches, AFolderThatCantBeWalkedIsNotAnEmptyOne) {
  EXPECT_EQ(status_without_descriptors(plain_, run_to("out")), 42);
}

TEST_F(Batches, AFolderOfOthersIsLeftAlone) {
  write_text(out("out") / "thesis.tex", "do not touch");
  EXPECT_EQ(refusal(plain_, run_to("out")), DataCode::file_unwritable);
  EXPECT_EQ(output_of(out("out")).size(), 1u);
  const std::string mine = "{\n  \"my\": \"summary\"\n}\n";
  write_text(out("mine") / "summary.json", mine);
  write_text(out("mine") / "index.html", "mine too");
  BatchRun run = run_to("mine");
  for (const bool resume : {false, true}) {
    run.resume = resume;
    EXPECT_EQ(refusal(plain_, run), DataCode::file_unwritable);
  }
  EXPECT_EQ(text_of(out("mine") / "summary.json"), mine);
  EXPECT_EQ(text_of(out("mine") / "index.html"), "mine too");
}

TEST_F(Batches, AnotherOutputIntoTheFolderLeavesNothingOfTheLast) {
  run_batch(plain_, run_to("out"));
  ASSERT_TRUE(fs::exists(out("out") / "pieces.geojson"));
  write_text(out("out") / "page-12.html", "a page of more inputs");
  write_text(out("out") / "page-one.html", "somebody's own");
  BatchConfiguration figures;
  figures.geopackage = figures.geojson = figures.pictures = false;
  run_batch(figures, run_to("out"));
  run_batch(figures, run_to("fresh"));
  EXPECT_EQ(difference(out("fresh"), out("out")), "page-one.html ");
}

TEST_F(Batches, TwoProcessesAtOneBatchMakeOneOutput) {
  BatchRun run = run_to("both");
  run.workers = 1;  // a child of fork has no threads but its own
  run.resume = true;
  std::vector<pid_t> processes;
  for (int k = 0; k < 2; ++k) {
    const pid_t child = ::fork();
    if (child == 0) {
      int status = 1;
      try {
        run_batch(plain_, run);
        status = 0;
      } catch (const std::exception&) {
      }
      ::_exit(status);
    }
    processes.push_back(child);
  }
  for (const pid_t process : processes) {
    int status = 0;
    ::waitpid(process, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  }
  run_batch(plain_, run_to("whole"));
  EXPECT_EQ(difference(out("whole"), out("both")), "");
}

TEST_F(Batches, ARateIsGivenOnlyWhereItIsKnown) {
  run_batch(plain_, run_to("whole"));
  EXPECT_GT(summary_of("whole").at("times").at("obstacles_per_second").get<double>(), 0.0);
  for (std::size_t shard = 1; shard <= 2; ++shard) {
    BatchRun run = run_to("shards");
    run.shards = 2;
    run.shard = shard;
    run_batch(plain_, run);
  }
  EXPECT_TRUE(summary_of("shards").at("times").at("obstacles_per_second").is_null());
  EXPECT_TRUE(summary_of("shards").at("times").at("vertices_per_second").is_null());
}

TEST_F(Batches, MissingPathsAreReportedAtOnce) {
  BatchRun run = run_to("out");
  run.paths.push_back(folder_ / "nowhere");
  EXPECT_EQ(refusal(plain_, run), DataCode::file_missing);
  EXPECT_FALSE(fs::exists(run.out));
}

TEST_F(Batches, FilesThatCantBeReadAreRejectedAndTheRestGoesOn) {
  fs::create_symlink("gone.wkt", folder_ / "in" / "link.wkt");
  const BatchResult result = run_batch(plain_, run_to("out"));
  EXPECT_EQ(result.summary.files.rejected.at("E_FILE_MISSING"), 1u);
  EXPECT_EQ(result.summary.files.done, 2u);
}

TEST_F(Batches, AFolderRemovedUnderTheBatchIsReported) {
  const BatchRun run = run_to("out");
  int looks = 0;
  const auto removes = [&](const BatchProgress&) {
    // Moved in one step: taking away file by file would meet the workers' own files as they come and go.
    if (++looks == 3) fs::rename(run.out, run.out.string() + "-gone");
    return true;
  };
  EXPECT_EQ(refusal(plain_, run, removes), DataCode::file_unwritable);
  EXPECT_FALSE(fs::exists(run.out / "summary.json"));
}

/// The status with which a process ends that may write no file of more than `bytes`.
int status_with_files_up_to(std::size_t bytes, const BatchConfiguration& configuration, const BatchRun& run) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    int status = 0;
    try {
      run_batch(configuration, run);
    } catch (const DataError& error) {
      status = error.code() == DataCode::file_unwritable ? 42 : 43;
    }
    ::_exit(status);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(Batches, AFullDiskIsReportedAndLosesNothing) {
  BatchRun run = run_to("out");
  run.workers = 1;  // a child of fork has no threads but its own
  BatchConfiguration configuration;
  configuration.geopackage = false;
  BatchRun ahead = run_to("ahead");
  ahead.workers = 1;
  EXPECT_EQ(status_with_files_up_to(5000000, configuration, ahead), 42) << "the parts fit, an output doesn't";
  EXPECT_EQ(folders_on_their_way("ahead"), 0u);
  ahead.resume = true;
  run_batch(configuration, ahead);
  EXPECT_EQ(status_with_files_up_to(20000, configuration, run), 42) << "a part doesn't fit";
  run.resume = true;
  EXPECT_EQ(status_with_files_up_to(5000000, configuration, run), 42) << "the parts fit, an output doesn't";
  EXPECT_FALSE(fs::exists(run.out / "measurements.jsonl")) << "nothing is published before all is there";
  run_batch(configuration, run);
  run_batch(configuration, run_to("whole"));
  EXPECT_EQ(difference(out("whole"), out("out")), "");
  EXPECT_EQ(difference(out("whole"), out("ahead")), "");
}

TEST_F(Batches, APartThatIsCutOffIsMadeAgain) {
  BatchRun shard = run_to("out");
  shard.shards = shard.shard = 6;  // stars.wkt, of several parts
  ASSERT_EQ(run_batch(plain_, shard).end, BatchEnd::incomplete);
  const fs::path part = out("out") / ".parts" / "000005" / "000001";
  ASSERT_GT(fs::file_size(part), 100u);
  fs::resize_file(part, fs::file_size(part) - 1);
  BatchRun run = run_to("out");
  run.resume = true;
  EXPECT_TRUE(run_batch(plain_, run).was_merged_ahead) << "parts that are there are merged in their turn";
  run_batch(plain_, run_to("whole"));
  EXPECT_EQ(difference(out("whole"), out("out")), "");
}

TEST_F(Batches, FactsThatAreCutOffAreMadeAgain) {
  for (const std::string cut : {"000000.input", "000005.input"}) {
    BatchRun shards = run_to(cut);
    shards.shards = 7;
    for (shards.shard = 1; shards.shard <= 6; ++shards.shard)
      if (shards.shard != 2) run_batch(plain_, shards);
    const fs::path facts = out(cut) / ".parts" / cut;
    fs::resize_file(facts, fs::file_size(facts) - 1);
    BatchRun run = run_to(cut);
    run.resume = true;
    EXPECT_EQ(run_batch(plain_, run).end, BatchEnd::complete);
    if (!fs::exists(out("whole"))) run_batch(plain_, run_to("whole"));
    EXPECT_EQ(difference(out("whole"), out(cut)), "") << cut;
  }
}

TEST_F(Batches, AFileBrokenAfterPartsOfItWereBoundLeavesNothingOfThem) {
  if (!built_with_gdal()) GTEST_SKIP() << "a build without GDAL";
  const fs::path large = folder_ / "in" / "a" / "large.fgb";
  fs::create_directories(large.parent_path());
  write_obstacles(large, read_obstacles(folder_ / "in" / "stars.wkt").obstacles);
  fs::resize_file(large, fs::file_size(large) / 5 * 4);
  BatchRun one_worker = run_to("ahead");
  one_worker.workers = 1;
  const BatchResult ahead = run_batch(plain_, one_worker);
  EXPECT_FALSE(ahead.was_merged_ahead);
  EXPECT_EQ(ahead.summary.rejected_files.front().path, large.generic_string());
  for (std::size_t shard = 1; shard <= 2; ++shard) {
    BatchRun run = run_to("shards");
    run.shards = 2;
    run.shard = shard;
    run_batch(plain_, run);
  }
  EXPECT_EQ(difference(out("ahead"), out("shards")), "");
}

TEST_F(Batches, RepairsAreCountedAndShown) {
  BatchConfiguration configuration;
  configuration.reading.repair = true;
  const BatchResult result = run_batch(configuration, run_to("out"));
  EXPECT_EQ(result.summary.obstacles.rejected_in_all(), 0u);
  EXPECT_EQ(result.summary.obstacles.repaired, 3u);
  EXPECT_GT(result.summary.obstacles_out, result.summary.obstacles.read) << "a bow tie is two triangles";
  EXPECT_EQ(result.summary.uncertified, 0u);
}

TEST_F(Batches, AMemoryLimitRefusesWhatIsReadWholeAndChangesNothingElse) {
  write_text(
      folder_ / "in" / "maps" / "large.map", "type octile\nheight 300\nwidth 300\nmap\n" + [] {
        std::string rows;
        for (int k = 0; k < 300; ++k) rows += std::string(300, k % 2 == 0 ? '.' : '@') + "\n";
        return rows;
      }());
  run_batch(plain_, run_to("free"));
  BatchConfiguration limited;
  limited.memory_limit = 1000000;  // a 20th of it is less than the map's 90 kB
  BatchRun run = run_to("limited");
  const BatchResult result = run_batch(limited, run);
  EXPECT_EQ(result.summary.files.rejected.at("E_SIZE"), 1u);
  const auto is_of_map = [](const Json& record) {
    return record.at("file").get<std::string>().find("large.map") != std::string::npos;
  };
  std::vector<Json> free = records_of("free");
  EXPECT_EQ(std::count_if(free.begin(), free.end(), is_of_map), 150);
  free.erase(std::remove_if(free.begin(), free.end(), is_of_map), free.end());
  EXPECT_GT(free.size(), 1300u);
  EXPECT_EQ(free, records_of("limited"));
}

using Streams = TemporaryFolder;

TEST_F(Streams, AVectorFileIsReadOrTheMissingLibraryIsNamed) {
  write_text(folder_ / "one.geojson",
             R"({"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[[0,0],[1,1]]}})");
  std::size_t obstacles = 0;
  std::string words;
  try {
    obstacles = read_obstacles(folder_ / "one.geojson").obstacles.size();
  } catch (const DataError& error) {
    EXPECT_EQ(error.code(), DataCode::format_unavailable);
    words = error.what();
  }
  EXPECT_EQ(obstacles, built_with_gdal() ? 1u : 0u);
  EXPECT_EQ(words.find("without GDAL") != std::string::npos, !built_with_gdal()) << words;
}

TEST_F(Streams, LargeWktIsTheSameInBlocks) {
  std::string text = "# not a geometry\n";
  while (text.size() < 3500000)
    text += stars_as_wkt(text.size(), 500) +
            "GEOMETRYCOLLECTION (\nPOINT (1 1),\n"
            "POLYGON ((0 0, 1 0,\n1 1, 0 0)))\nPOLYGON ((0 0, 1\n";
  write_text(folder_ / "large.wkt", text);
  ReadOptions options;
  options.format = "wkt";
  options.keep_going = true;
  const ObstacleFile whole = parse_wkt(text, (folder_ / "large.wkt").string(), options);
  std::vector<formation::SceneObstacle> obstacles;
  std::vector<std::string> refusals;
  const ObstacleFile streamed =
      read_obstacles(folder_ / "large.wkt", options,
                     {[&](formation::SceneObstacle o, bool) { obstacles.push_back(std::move(o)); },
                      [&](const DataError& error) { refusals.push_back(error.what()); },
                      {}});
  ASSERT_EQ(obstacles.size(), whole.obstacles.size());
  EXPECT_EQ(streamed.counts.read, whole.counts.read);
  EXPECT_TRUE(streamed.obstacles.empty());
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    ASSERT_EQ(obstacles[k].id, whole.obstacles[k].id);
    ASSERT_EQ(vertices_of(obstacles[k].shape), vertices_of(whole.obstacles[k].shape)) << k;
  }
  ASSERT_EQ(refusals.size(), whole.rejected.size());
  for (std::size_t k = 0; k < refusals.size(); ++k) EXPECT_EQ(refusals[k], whole.rejected[k].what());
}

}  // namespace
}  // namespace exactvo::datasets::test
