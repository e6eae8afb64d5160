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

TEST_F(Inputs, EveryFileHasItsOwnHash) {
  fs::create_directories(folder_ / "maps" / "pictures");
  write_text(folder_ / "maps" / "floor.yaml",
             "image: pictures/floor.pgm\nresolution: 1\norigin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.2\n");
  write_text(folder_ / "maps" / "pictures" / "floor.pgm", "P2 2 2 255\n0 255\n255 255\n");
  const auto inputs = batch::list_inputs({folder_ / "maps"}, folder_ / "out").files;
  ASSERT_EQ(inputs.size(), 1u);
  const batch::InputHashes& hashes = inputs[0].hashes;
  EXPECT_EQ(hashes.sha256, sha256_of_file(folder_ / "maps" / "floor.yaml"));
  ASSERT_EQ(hashes.read_with.size(), 1u);
  EXPECT_EQ(hashes.read_with[0].path, (folder_ / "maps" / "pictures" / "floor.pgm").generic_string());
  EXPECT_EQ(hashes.read_with[0].sha256, sha256_of_file(folder_ / "maps" / "pictures" / "floor.pgm"));
  BatchRun run = run_to("out");
  run.paths = {folder_ / "maps"};
  run_batch(plain_, run);
  const std::string summary = content_of(run.out / "summary.json");
  EXPECT_NE(summary.find("\"sha256\": \"" + hashes.sha256), std::string::npos) << summary;
  EXPECT_NE(summary.find("\"sha256\": \"" + hashes.read_with[0].sha256), std::string::npos) << summary;
}

TEST_F(Inputs, NotesOnWholeFilesAreGathered) {
  write_text(folder_ / "maps" / "a.csv", "id,WKT\n1,\"LINESTRING (5 5, 6 6)\"\n");
  write_text(folder_ / "maps" / "b.csv", "id,WKT\n1,\"LINESTRING (5 5, 6 7)\"\n");
  if (!built_with_gdal()) GTEST_SKIP() << "built without GDAL";
  BatchRun run = run_to("out");
  run.paths = {folder_ / "maps"};
  const auto expect_one_note = [&] {
    const std::vector<BatchNote> notes = run_batch(plain_, run).summary.notes;
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].text, "taken as metres: names no reference system");
    EXPECT_EQ(notes[0].files, 2u);
    EXPECT_EQ(notes[0].file, (folder_ / "maps" / "a.csv").generic_string());
  };
  expect_one_note();
  run.resume = true;
  expect_one_note();  // of a batch that is complete, from its summary
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
