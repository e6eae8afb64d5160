// SPDX-License-Identifier: GPL-3.0-or-later
// Files that once broke a reader, or would have, and a small good one of every format: read in a few seconds, into
// obstacles or a refusal with a code.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>

#include "reader_case.h"

namespace exactvo::datasets::test {

/// What ctest lists; without it the bytes of pointers.
void PrintTo(const FuzzedFormat& format, std::ostream* out) {
  *out << format.name;
}

namespace {

namespace fs = std::filesystem;

constexpr double kPatience = 10.0;  // s a case

std::string content_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

class ReaderCorpus : public ::testing::TestWithParam<FuzzedFormat> {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("exactvo_corpus_" + std::string(GetParam().name) + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_P(ReaderCorpus, EveryCaseEndsInObstaclesOrARefusal) {
  const fs::path cases = fs::path(EXACTVO_SOURCE_DIR) / "tests/corpus/readers" / GetParam().name;
  ASSERT_TRUE(fs::is_directory(cases)) << "a format without a case: " << cases;
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(cases)) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(read_case(GetParam().name, content_of(entry.path()), folder_), "") << entry.path();
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), kPatience)
        << entry.path();
    ++count;
  }
  EXPECT_GT(count, 0);
}

INSTANTIATE_TEST_SUITE_P(Formats, ReaderCorpus, ::testing::ValuesIn(fuzzed_formats()), [](const auto& each) {
  std::string name = each.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace exactvo::datasets::test
