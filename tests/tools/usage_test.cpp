// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/usage.h"

#include <gtest/gtest.h>

#include "exactvo/geometry/nearest_word.h"

namespace exactvo::tools {
namespace {

using geometry::edit_distance;
using geometry::nearest_word;

TEST(EditDistance, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("ivo", "ivo"), 0u);
  EXPECT_EQ(edit_distance("", "ivo"), 3u);
  EXPECT_EQ(edit_distance("simulat", "simulate"), 1u);
  EXPECT_EQ(edit_distance("orcaa", "orca"), 1u);
  EXPECT_EQ(edit_distance("rk5", "rk4"), 1u);
  EXPECT_EQ(edit_distance("defualt", "default"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(NearestWord, IsTheNearestAndOnlyIfNearEnough) {
  const std::vector<std::string> methods = {"orca", "ivo-edge", "ivo-cluster", "ivo"};
  EXPECT_EQ(nearest_word("ivo-clusterr", methods), "ivo-cluster");
  EXPECT_EQ(nearest_word("IVO-edge", {"ivo-edge"}), "ivo-edge");
  EXPECT_EQ(nearest_word("ORCA", methods), "orca");
  EXPECT_EQ(nearest_word("xyz", methods), "");
  EXPECT_EQ(nearest_word("q", {"r"}), "");
  EXPECT_EQ(nearest_word("orka", methods), "orca");
  EXPECT_EQ(nearest_word("something else", methods), "");
  EXPECT_EQ(nearest_word("golas", {"goal", "goals"}), "goals");
  EXPECT_EQ(nearest_word(std::string(1 << 20, 'o'), methods), "") << "at once";
  EXPECT_EQ(suggestion("something else", methods), "");
}

TEST(UsageError, SaysWhereFoundAndExpected) {
  EXPECT_STREQ(UsageError("--method", "x", "one of a b").what(), "--method: found 'x', expected one of a b");
}

}  // namespace
}  // namespace exactvo::tools
