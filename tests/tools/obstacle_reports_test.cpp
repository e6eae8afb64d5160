// SPDX-License-Identifier: GPL-3.0-or-later
// What the verbs for obstacle files tell: places that a user finds in the file, areas, what was left out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "run_program.h"

namespace exactvo::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(Batch, FoldersOfEarlierBatchesAreNotedAndNotRead) {
  const Workplace here;
  std::filesystem::create_directories(here.path() / "maps");
  here.write("maps/good.wkt", "POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0))\n");
  EXPECT_EQ(here.run("batch maps --out maps/one --write figures").status, 0);
  const Outcome outcome = here.run("batch maps --out two --write figures");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("note: not read: maps/one holds an earlier batch (2 files)"));
  EXPECT_THAT(outcome.out, HasSubstr("1 files: 1 done"));
}

}  // namespace
}  // namespace exactvo::test
