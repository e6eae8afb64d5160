// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/escape.h"

#include <gtest/gtest.h>

namespace exactvo::tools {
namespace {

TEST(Shown, LeavesWordsOfEveryLanguageAlone) {
  for (const char* word : {"", "plain", "Büro 3 — Schreibtisch", "机器人", "a'b\"c\\d`e{f}^_@"}) {
    EXPECT_EQ(shown(word), word);
    EXPECT_FALSE(has_control_characters(word));
  }
}

TEST(Shown, WritesControlCharactersOut) {
  EXPECT_EQ(shown("a\nb\tc\rd\x1b[2J\x7f"), "a\\nb\\tc\\x0dd\\x1b[2J\\x7f");
  EXPECT_EQ(shown(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(shown("\xc2\x9b"), "\\xc2\\x9b") << "the one-byte CSI, in UTF-8";
  EXPECT_EQ(shown("\xe2\x80\xae"), "\\xe2\\x80\\xae") << "right-to-left override";
  EXPECT_TRUE(has_control_characters("a\n"));
}

TEST(Shown, WritesOutWhatIsNoUtf8) {
  EXPECT_EQ(shown("\xff"), "\\xff");
  EXPECT_EQ(shown("\xc3"), "\\xc3") << "cut short";
  EXPECT_EQ(shown("\xc0\x8a"), "\\xc0\\x8a") << "a line feed in too many bytes";
  EXPECT_EQ(shown("\x9b"), "\\x9b");
}

TEST(ShownLines, KeepsLineFeedsOnly) {
  EXPECT_EQ(shown_lines("a\nb\r\x1b"), "a\nb\\x0d\\x1b");
}

}  // namespace
}  // namespace exactvo::tools
