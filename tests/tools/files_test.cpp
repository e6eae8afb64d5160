// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/files.h"

#include <gtest/gtest.h>
#include <stdlib.h>  // mkdtemp

#include <fstream>
#include <iterator>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/metrics_file.h"

namespace exactvo::tools {
namespace {

namespace fs = std::filesystem;

class StagedFolderTest : public testing::Test {
 protected:
  StagedFolderTest() {
    std::string name = (fs::temp_directory_path() / "exactvo_files_XXXXXX").string();
    root_ = ::mkdtemp(name.data());
  }
  ~StagedFolderTest() override { fs::remove_all(root_); }

  std::string text(const std::string& name) const {
    std::ifstream file(root_ / name);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  fs::path root_;
};

TEST_F(StagedFolderTest, LeavesNoTraceUnlessPublished) {
  {
    const StagedFolder folder(root_ / "out");
    write_text(folder.path() / "a", "1");
    EXPECT_FALSE(fs::exists(root_ / "out"));
  }
  EXPECT_TRUE(fs::is_empty(root_));
}

TEST_F(StagedFolderTest, AppearsWholeUnderMissingParents) {
  StagedFolder folder(root_ / "deep" / "er" / "out/");
  write_text(folder.path() / "a", "1");
  folder.publish();
  EXPECT_EQ(text("deep/er/out/a"), "1");
}

TEST_F(StagedFolderTest, ReplacesFileByFileInAFolderThatIsThere) {
  fs::create_directories(root_ / "out" / "sub");
  write_text(root_ / "out" / "a", "old");
  write_text(root_ / "out" / "mine", "kept");
  {
    StagedFolder folder(root_ / "out");
    write_text(folder.path() / "a", "new");
    make_folder(folder.path() / "sub");
    write_text(folder.path() / "sub" / "b", "new too");
    folder.publish("a");
  }
  EXPECT_EQ(text("out/a"), "new");
  EXPECT_EQ(text("out/sub/b"), "new too");
  EXPECT_EQ(text("out/mine"), "kept");
  EXPECT_EQ(std::distance(fs::directory_iterator(root_), fs::directory_iterator()), 1) << "only out";
}

TEST_F(StagedFolderTest, RefusesAFileInItsPlace) {
  write_text(root_ / "out", "a file");
  EXPECT_THROW(StagedFolder(root_ / "out"), datasets::DataError);
  EXPECT_EQ(text("out"), "a file");
}

TEST_F(StagedFolderTest, AFolderOfOthersIsNoPlaceForOutput) {
  EXPECT_NO_THROW(check_output_folder(root_ / "missing"));
  EXPECT_NO_THROW(check_output_folder(root_)) << "empty";
  write_text(root_ / "thesis.tex", "mine");
  EXPECT_THROW(check_output_folder(root_), datasets::DataError);
  write_text(root_ / "summary.json", "{\"my\": \"summary\"}");
  EXPECT_THROW(check_output_folder(root_), datasets::DataError) << "of another program";
  write_text(root_ / "metrics.json", datasets::metrics_json({}, {}));
  EXPECT_NO_THROW(check_output_folder(root_)) << "an earlier output";
  fs::remove(root_ / "metrics.json");
  write_text(root_ / "summary.json", datasets::summary_json({datasets::metrics_json({}, {})}));
  EXPECT_NO_THROW(check_output_folder(root_)) << "an earlier report";
}

TEST_F(StagedFolderTest, WritingWhereNothingCanBeNamesThePath) {
  try {
    write_text(root_ / "missing" / "file", "x");
    FAIL() << "written into a folder that does not exist";
  } catch (const datasets::DataError& error) {
    EXPECT_EQ(error.code(), datasets::DataCode::file_unwritable);
    EXPECT_EQ(error.file(), (root_ / "missing" / "file").string());
  }
}

}  // namespace
}  // namespace exactvo::tools
