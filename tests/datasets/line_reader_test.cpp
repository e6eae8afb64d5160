// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/line_reader.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets {
namespace {

namespace fs = std::filesystem;

class Lines : public testing::Test {
 protected:
  ~Lines() override { fs::remove(path_); }

  std::vector<std::string> lines_of(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    TextLines stream(path_, TableLines::kLongestLine);
    std::vector<std::string> lines;
    std::string_view line;
    while (stream.next(line)) {
      lines.emplace_back(line);
      EXPECT_EQ(stream.number(), lines.size());
    }
    EXPECT_FALSE(stream.next(line)) << "the end stays the end";
    return lines;
  }

  const std::string path_ =
      (fs::temp_directory_path() /
       ("exactvo_lines_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
        std::to_string(testing::UnitTest::GetInstance()->random_seed()) +
        std::to_string(reinterpret_cast<std::uintptr_t>(this))))
          .string();
};

using Strings = std::vector<std::string>;

TEST_F(Lines, EndsInEveryWayThatTextEnds) {
  EXPECT_EQ(lines_of(""), Strings{});
  EXPECT_EQ(lines_of("a"), Strings{"a"});
  EXPECT_EQ(lines_of("a\n"), Strings{"a"});
  EXPECT_EQ(lines_of("\n\na\r\n\r\nb"), (Strings{"", "", "a\r", "\r", "b"}));
}

TEST_F(Lines, AcrossBlocksAsGetline) {
  std::string text;
  for (std::size_t k = 0; k < 5000; ++k) text += std::string(k * 7919 % 211, 'x') + std::to_string(k) + "\n";
  Strings expected;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) expected.push_back(line);
  EXPECT_GT(text.size(), 4 * TableLines::kLongestLine);
  EXPECT_EQ(lines_of(text), expected);
}

TEST_F(Lines, ALineMayBeAsLongAsTheLimitAndNoLonger) {
  const std::string longest(TableLines::kLongestLine, 'x');
  EXPECT_EQ(lines_of("a\n" + longest + "\nb\n"), (Strings{"a", longest, "b"}));
  EXPECT_EQ(lines_of("a\n" + longest), (Strings{"a", longest}));
  for (const std::string end : {"\nb\n", "", "xxxx\n"}) {
    try {
      lines_of("a\n" + longest + "x" + end);
      ADD_FAILURE() << "a line beyond the limit was given";
    } catch (const DataError& error) {
      EXPECT_EQ(error.code(), DataCode::size);
      EXPECT_EQ(error.place(), "line 2");
    }
  }
}

TEST_F(Lines, ATableSkipsWhatHoldsNothingAndItsMark) {
  std::ofstream(path_, std::ios::binary) << "\xEF\xBB\xBF"
                                            "a,b\r\n\n# comment\n  1, 2 \n";
  TableLines table(path_);
  ASSERT_TRUE(table.next_filled());
  EXPECT_EQ(table.line(), "a,b");
  ASSERT_TRUE(table.next_filled());
  EXPECT_EQ(table.line(), "1, 2");
  EXPECT_EQ(table.number(), 4u);
  EXPECT_FALSE(table.next_filled());
}

TEST_F(Lines, CommasWithinQuotationMarksPartNothing) {
  std::ofstream(path_, std::ios::binary) << "\"a, b\",1, \"2\" ,\n1, 2,3\n1 2\t3\n\"a\"\"b\",\n\"a,\n";
  TableLines table(path_);
  for (const Strings& fields :
       {Strings{"a, b", "1", "2", ""}, Strings{"1", "2", "3"}, Strings{"1", "2", "3"}, Strings{"a\"b", ""}}) {
    ASSERT_TRUE(table.next_filled());
    EXPECT_EQ(table.fields(), fields);
  }
  ASSERT_TRUE(table.next_filled());
  EXPECT_THROW(table.fields(), DataError) << "a quotation mark that is not closed";
}

TEST_F(Lines, AMissingFileIsRefusedAndSoIsAFolder) {
  for (const auto& [file, code] : {std::pair{path_ + ".missing", DataCode::file_missing},
                                   std::pair{fs::temp_directory_path().string(), DataCode::file_unreadable}}) {
    try {
      const TableLines stream(file);
      ADD_FAILURE() << file;
    } catch (const DataError& error) {
      EXPECT_EQ(error.code(), code);
    }
  }
}

}  // namespace
}  // namespace exactvo::datasets
