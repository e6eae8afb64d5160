// SPDX-License-Identifier: GPL-3.0-or-later
// Which files a batch takes: no outputs of earlier batches, wherever they lie.
#include "batch/plan/inputs.h"

#include <gtest/gtest.h>

#include "batch_folder.h"
#include "refusal.h"

namespace exactvo::datasets::test {
namespace {

namespace fs = std::filesystem;

class Inputs : public BatchFolder {
 protected:
  Inputs() : BatchFolder(1) {}
  void SetUp() override {
    BatchFolder::SetUp();
    write_text(folder_ / "in" / "walls.wkt", "LINESTRING (5 5, 6 6)\n");
    run_batch(plain_, run_to("in/earlier"));
  }

  /// Names below the folder, in order.
  std::vector<std::string> names(const BatchRun& run) const {
    std::vector<std::string> found;
    for (const batch::Input& input : batch::list_inputs(run.paths, run.out).files)
      found.push_back(fs::path(input.path).lexically_relative(folder_).generic_string());
    return found;
  }

  static std::vector<EarlierBatch> earlier(const BatchRun& run) {
    return batch::list_inputs(run.paths, run.out).earlier;
  }
};

using Names = std::vector<std::string>;

TEST_F(Inputs, AnEarlierOutputInAWalkedFolderIsNotReadAndNamed) {
  const BatchRun run = run_to("out");
  EXPECT_EQ(names(run), Names{"in/walls.wkt"});
  const BatchResult result = run_batch(plain_, run);
  EXPECT_EQ(result.summary.files.read, 1u);
  ASSERT_EQ(result.earlier.size(), 1u);
  EXPECT_EQ(result.earlier[0].folder, (folder_ / "in" / "earlier").generic_string());
  EXPECT_EQ(result.earlier[0].files, output_of(folder_ / "in" / "earlier").size());
}

TEST_F(Inputs, AFileOfAnEarlierOutputThatIsNamedIsRead) {
  BatchRun run = run_to("out");
  run.paths.push_back(folder_ / "in" / "earlier" / "obstacles.geojson");
  EXPECT_EQ(names(run), (Names{"in/walls.wkt", "in/earlier/obstacles.geojson"}));
}

TEST_F(Inputs, AnEarlierOutputIsNotedOnceWhateverLeadsToIt) {
  BatchRun run = run_to("out");
  run.paths.push_back(folder_ / "in" / "earlier");
  run.paths.push_back(folder_ / "in" / "." / "earlier");
  EXPECT_EQ(names(run), Names{"in/walls.wkt"});
  EXPECT_EQ(earlier(run).size(), 1u);
}

// An empty batch would take the place of a good one.
TEST_F(Inputs, WhereThereIsNothingToReadTheOutputStands) {
  BatchRun run = run_to("out");
  run_batch(plain_, run);
  const auto good = output_of(folder_ / "out");
  fs::create_directories(folder_ / "empty");
  for (const char* path : {"in/earlier", "out", "empty"}) {
    SCOPED_TRACE(path);
    run.paths = {folder_ / path};
    for (const bool resume : {false, true}) {
      run.resume = resume;
      expect_refusal(refusal_of([&] { run_batch(plain_, run); }), DataCode::file_missing, "");
      EXPECT_EQ(output_of(folder_ / "out"), good);
    }
  }
  run.paths = {folder_ / "in" / "earlier"};
  EXPECT_NE(std::string(refusal_of([&] { run_batch(plain_, run); }).what()).find("earlier holds an earlier batch"),
            std::string::npos);
}

TEST_F(Inputs, TheBatchsOwnOutputIsNeitherReadNorNamed) {
  const BatchRun run = run_to("in/earlier");
  EXPECT_EQ(names(run), Names{"in/walls.wkt"});
  EXPECT_TRUE(earlier(run).empty());
}

TEST_F(Inputs, WhatAKilledBatchHasLeftIsAnOutput) {
  fs::create_directories(folder_ / "in" / "earlier" / ".parts");
  fs::rename(folder_ / "in" / "earlier" / "summary.json", folder_ / "in" / "earlier" / ".parts" / "run.json");
  EXPECT_EQ(names(run_to("out")), Names{"in/walls.wkt"});
}

TEST_F(Inputs, AnotherProgramsSummaryHidesNothing) {
  write_text(folder_ / "in" / "other" / "summary.json", "{\"inputs\": []}\n");
  write_text(folder_ / "in" / "other" / "walls.wkt", "LINESTRING (5 5, 6 6)\n");
  write_text(folder_ / "in" / "broken" / "summary.json", "{");
  EXPECT_EQ(names(run_to("out")),
            (Names{"in/broken/summary.json", "in/other/summary.json", "in/other/walls.wkt", "in/walls.wkt"}));
}

}  // namespace
}  // namespace exactvo::datasets::test
