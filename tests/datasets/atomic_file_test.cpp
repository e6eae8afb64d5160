// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/atomic_file.h"

#include <sys/resource.h>

#include <csignal>

#include "refusal.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using AtomicFileTest = TemporaryFolder;

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// While it lives, a write beyond this many bytes of a file fails, as on a full disk.
class FilesUpTo {
 public:
  explicit FilesUpTo(rlim_t bytes) : signal_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FilesUpTo() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signal_);
  }
  FilesUpTo(const FilesUpTo&) = delete;
  FilesUpTo& operator=(const FilesUpTo&) = delete;

 private:
  void (*signal_)(int);
  rlimit before_{};
};

TEST_F(AtomicFileTest, NothingStandsAtThePlaceBeforeCommit) {
  AtomicFile file(folder_ / "a.txt");
  file.write(std::string(std::size_t{1} << 20, 'x'));  // more than the buffer holds
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.txt"));
  file.commit();
  EXPECT_EQ(std::filesystem::file_size(folder_ / "a.txt"), std::size_t{1} << 20);
  EXPECT_EQ(files_in(folder_), 1u);
}

TEST_F(AtomicFileTest, AnAbandonedFileLeavesTheOldOneAndNoTrace) {
  put("a.txt", "old");
  { AtomicFile(folder_ / "a.txt").write("new"); }
  EXPECT_EQ(content_of(folder_ / "a.txt"), "old");
  EXPECT_EQ(files_in(folder_), 1u);
}

TEST_F(AtomicFileTest, ReplacesWholeAndMakesMissingFolders) {
  write_file_atomically(folder_ / "b" / "c" / "a.txt", "one");
  write_file_atomically(folder_ / "b" / "c" / "a.txt", "two");
  EXPECT_EQ(content_of(folder_ / "b" / "c" / "a.txt"), "two");
}

TEST_F(AtomicFileTest, AFolderThatCannotBeMadeIsNamed) {
  put("file", "");
  const DataError error = refusal_of([&] { write_file_atomically(folder_ / "file" / "a.txt", "x"); });
  EXPECT_EQ(error.code(), DataCode::file_unwritable);
  EXPECT_NE(std::string(error.what()).find("E_FILE_UNWRITABLE"), std::string::npos);
}

TEST_F(AtomicFileTest, AFolderThatIsGoneStaysAwayWhereThatIsAsked) {
  const auto write = [&] { AtomicFile(folder_ / "gone" / "a.txt", MissingFolder::is_refused); };
  EXPECT_EQ(refusal_of(write).code(), DataCode::file_unwritable);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "gone"));
}

TEST_F(AtomicFileTest, AFullDiskLeavesTheOldFile) {
  const std::filesystem::path place = put("a.txt", "old");
  const FilesUpTo limit(100);  // bytes
  const DataError error = refusal_of([&] { write_file_atomically(place, std::string(101, 'x')); });
  EXPECT_EQ(error.code(), DataCode::file_unwritable);
  EXPECT_EQ(content_of(place), "old");
  EXPECT_EQ(files_in(folder_), 1u);
}

TEST_F(AtomicFileTest, TwoWritersOfOneFileDoNotMeet) {
  AtomicFile first(folder_ / "a.txt");
  AtomicFile second(folder_ / "a.txt");
  first.write("first");
  second.write("second");
  second.commit();
  EXPECT_EQ(content_of(folder_ / "a.txt"), "second");
  first.commit();
  EXPECT_EQ(content_of(folder_ / "a.txt"), "first");
  EXPECT_EQ(files_in(folder_), 1u);
}

TEST_F(AtomicFileTest, WritingAfterCommitIsTheCallersMistake) {
  AtomicFile file(folder_ / "a.txt");
  file.commit();
  EXPECT_THROW(file.write("x"), std::logic_error);
  EXPECT_THROW(file.commit(), std::logic_error);
}

}  // namespace
}  // namespace exactvo::datasets::test
