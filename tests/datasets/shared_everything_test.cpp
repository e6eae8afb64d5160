// SPDX-License-Identifier: GPL-3.0-or-later
// Every public file, of whatever kind: read, or refused by name; never a crash, never long, and the books balance.
#include <gtest/gtest.h>

#include <chrono>

#include "exactvo/datasets/obstacle_file.h"
#include "shared_data.h"

namespace exactvo::datasets::test {
namespace {

constexpr double kPatience = 10.0;  // s a file

TEST(SharedEverything, EveryFileIsReadOrRefusedByName) {
  EXACTVO_NEEDS_SHARED_DATA();
  ReadOptions options;
  options.keep_going = true;
  std::size_t read = 0;
  std::size_t refused = 0;
  for (const ManifestRow& row : manifest()) {
    SCOPED_TRACE(row.path);
    const auto start = std::chrono::steady_clock::now();
    try {
      const ObstacleFile file = read_obstacles(shared_data() / row.path, options);
      const ReadCounts& n = file.counts;
      EXPECT_EQ(n.read, n.done + n.repaired + n.passed_over + n.rejected);
      EXPECT_EQ(n.rejected, file.rejected.size());
      ++read;
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find(row.path), std::string::npos) << error.what();
      std::printf("%s: %s\n", row.path.c_str(), code_name(error.code()));
      ++refused;
    }
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), kPatience);
  }
  EXPECT_EQ(read + refused, manifest().size());
  EXPECT_GT(read, built_with_gdal() ? 130u : 60u);
}

}  // namespace
}  // namespace exactvo::datasets::test
