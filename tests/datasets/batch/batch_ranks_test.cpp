// SPDX-License-Identifier: GPL-3.0-or-later
// Batches over MPI ranks: the same bytes as in one process.
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "batch_files.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

/// The status of a whole batch: some of its inputs are rejected.
constexpr int kSomeRejected = 1;

class Ranks : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    write_inputs(folder_ / "in", 600);
    for (const int k : {1, 2, 3}) write_text(folder_ / "in" / ("m" + std::to_string(k) + ".wkt"), stars_as_wkt(k, 300));
  }

  /// The status; 124 where it did not end within a minute. Under a sanitizer leaks are Open MPI's: in modules that it
  /// unloads, so that none could be named.
  int run(const std::string& words) const {
    const std::string command = "cd '" + folder_.string() +
                                "' && OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 " +
                                "LSAN_OPTIONS=detect_leaks=0 timeout 60 " + words + " >log 2>&1";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  int batch(const std::string& launcher, const std::string& out, const std::string& more = "") const {
    return run(launcher + " '" EXACTVO_PROGRAM "' batch in --out " + out + " -j 1 " + more);
  }
  std::string log() const { return text_of(folder_ / "log"); }
};

TEST_F(Ranks, TwoAndFourGiveTheBytesOfOne) {
  ASSERT_EQ(batch("", "one"), kSomeRejected);
  for (const std::string ranks : {"2", "4"}) {
    ASSERT_EQ(batch("mpirun --oversubscribe -n " + ranks, "ranks" + ranks), kSomeRejected) << text_of(folder_ / "log");
    EXPECT_EQ(difference(folder_ / "one", folder_ / ("ranks" + ranks)), "");
  }
}

TEST_F(Ranks, RefuseWhatOneProcessRefuses) {
  write_text(folder_ / "others" / "thesis.tex", "do not touch");
  EXPECT_EQ(batch("mpirun --oversubscribe -n 2", "others"), 2) << text_of(folder_ / "log");
  EXPECT_NE(text_of(folder_ / "log").find("E_FILE_UNWRITABLE"), std::string::npos);
}

TEST_F(Ranks, RanksGoOnWithWhatAProcessLeft) {
  ASSERT_EQ(batch("", "one"), kSomeRejected);
  ASSERT_EQ(batch("", "left", "--shard 1/2"), 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "left" / "summary.json"));
  ASSERT_EQ(batch("mpirun --oversubscribe -n 2", "left", "--resume"), kSomeRejected) << text_of(folder_ / "log");
  EXPECT_EQ(difference(folder_ / "one", folder_ / "left"), "");
}

TEST_F(Ranks, ADamagedPartEndsAllRanks) {
  ASSERT_EQ(batch("", "left", "--shard 1/2"), 0);
  write_text(folder_ / "left" / ".parts" / "000000.input", "{\n");
  EXPECT_EQ(batch("mpirun --oversubscribe -n 3", "left", "--resume"), 2) << log();
  EXPECT_NE(log().find("000000.input"), std::string::npos) << log();
}

TEST_F(Ranks, AFailureInARankThatWorksEndsAllRanks) {
  ASSERT_EQ(batch("", "left", "--shard 1/9"), 0);
  // A file where the chunks of the largest input are to go.
  write_text(folder_ / "left" / ".parts" / "000008", "in the way");
  write_text(folder_ / "left" / ".parts" / "000007", "in the way");
  write_text(folder_ / "left" / ".parts" / "000006", "in the way");
  EXPECT_EQ(batch("mpirun --oversubscribe -n 3", "left", "--resume"), 2) << log();
  EXPECT_NE(log().find("E_FILE_UNWRITABLE"), std::string::npos) << log();
}

TEST_F(Ranks, ARankThatSeesOtherFilesIsRefused) {
  write_text(folder_ / "a" / "in" / "one.wkt", stars_as_wkt(1, 20));
  write_text(folder_ / "a" / "in" / "two.wkt", stars_as_wkt(2, 20));
  write_text(folder_ / "b" / "in" / "one.wkt", stars_as_wkt(1, 20));
  write_text(folder_ / "b" / "in" / "two.wkt", stars_as_wkt(3, 20));
  const std::string out = "'" + (folder_ / "out").string() + "'";
  const auto rank_in = [&](const std::string& where) {
    return "-n 1 -wdir '" + (folder_ / where).string() + "' '" EXACTVO_PROGRAM "' batch in --out " + out + " -j 1";
  };
  EXPECT_EQ(run("mpirun --oversubscribe " + rank_in("a") + " : " + rank_in("b")), 2) << log();
  EXPECT_NE(log().find("E_OTHER_RUN"), std::string::npos) << log();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "summary.json"));
}

TEST_F(Ranks, APathThatOneRankMissesEndsAllRanks) {
  const std::string out = "'" + (folder_ / "out").string() + "'";
  const auto rank_of = [&](const std::string& in) {
    return "-n 1 '" EXACTVO_PROGRAM "' batch " + in + " --out " + out + " -j 1";
  };
  EXPECT_EQ(run("mpirun --oversubscribe " + rank_of("in") + " : " + rank_of("nowhere")), 2) << log();
  EXPECT_NE(log().find("E_FILE_MISSING"), std::string::npos) << log();
}

TEST_F(Ranks, ShardsOfRanksAreRefused) {
  EXPECT_EQ(batch("mpirun --oversubscribe -n 2", "out", "--shard 1/2"), 2) << log();
  EXPECT_NE(log().find("shard 1/2"), std::string::npos) << log();
}

TEST_F(Ranks, TheFirstRankCountsWhatTheOthersDid) {
  ASSERT_EQ(batch("mpirun --oversubscribe -n 3", "out"), kSomeRejected) << log();
  const auto summary = nlohmann::json::parse(text_of(folder_ / "out" / "summary.json"));
  EXPECT_EQ(summary.at("times").at("obstacles"), summary.at("obstacles"));
  EXPECT_EQ(summary.at("times").at("vertices"), summary.at("vertices"));
  EXPECT_GT(summary.at("times").at("obstacles_per_second").get<double>(), 0.0);
  EXPECT_GT(summary.at("times").at("seconds_of_jobs").get<double>(), 0.0);
  EXPECT_EQ(summary.at("times").at("workers"), 3);
}

}  // namespace
}  // namespace exactvo::datasets::test
