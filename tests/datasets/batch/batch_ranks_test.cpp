// SPDX-License-Identifier: GPL-3.0-or-later
// Batches over MPI ranks: the same bytes as in one process.
#include <gtest/gtest.h>

#include <cstdlib>

#include "batch_files.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

class Ranks : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    write_inputs(folder_ / "in", 600);
    for (const int k : {1, 2, 3}) write_text(folder_ / "in" / ("m" + std::to_string(k) + ".wkt"), stars_as_wkt(k, 300));
  }

  int batch(const std::string& launcher, const std::string& out, const std::string& more = "") const {
    const std::string command = "cd '" + folder_.string() +
                                "' && OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 " + launcher +
                                " '" EXACTVO_PROGRAM "' batch in --out " + out + " -j 1 " + more + " >log 2>&1";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

TEST_F(Ranks, TwoAndFourGiveTheBytesOfOne) {
  ASSERT_EQ(batch("", "one"), 0);
  for (const std::string ranks : {"2", "4"}) {
    ASSERT_EQ(batch("mpirun --oversubscribe -n " + ranks, "ranks" + ranks), 0) << text_of(folder_ / "log");
    EXPECT_EQ(difference(folder_ / "one", folder_ / ("ranks" + ranks)), "");
  }
}

TEST_F(Ranks, WhatOneProcessRefusesSoDoRanks) {
  write_text(folder_ / "others" / "thesis.tex", "do not touch");
  EXPECT_EQ(batch("mpirun --oversubscribe -n 2", "others"), 2) << text_of(folder_ / "log");
  EXPECT_NE(text_of(folder_ / "log").find("E_FILE_UNWRITABLE"), std::string::npos);
}

TEST_F(Ranks, RanksGoOnWithWhatAProcessLeft) {
  ASSERT_EQ(batch("", "one"), 0);
  ASSERT_EQ(batch("", "left", "--shard 1/2"), 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "left" / "summary.json"));
  ASSERT_EQ(batch("mpirun --oversubscribe -n 2", "left", "--resume"), 0) << text_of(folder_ / "log");
  EXPECT_EQ(difference(folder_ / "one", folder_ / "left"), "");
}

}  // namespace
}  // namespace exactvo::datasets::test
