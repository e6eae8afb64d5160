// SPDX-License-Identifier: GPL-3.0-or-later
// The commands of docs/guide/from-a-map.md, run as they stand there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <vector>

#include "batch_files.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

namespace fs = std::filesystem;

/// The lines of the page's first block of code.
std::vector<std::string> commands_of_the_page() {
  std::istringstream page(text_of(EXACTVO_SOURCE_DIR "/docs/guide/from-a-map.md"));
  std::vector<std::string> commands;
  std::string line;
  while (std::getline(page, line) && line != "```") {
  }
  while (std::getline(page, line) && line != "```") commands.push_back(line);
  return commands;
}

using GuidePage = TemporaryFolder;

TEST_F(GuidePage, SevenCommandsLeadFromAMapToVelocityObstacles) {
  fs::create_directories(folder_ / "bin");
  fs::create_symlink(EXACTVO_PROGRAM, folder_ / "bin" / "exactvo");
  fs::create_symlink(EXACTVO_SOURCE_DIR "/datasets", folder_ / "datasets");
  const std::vector<std::string> commands = commands_of_the_page();
  ASSERT_EQ(commands.size(), 7u);
  for (const std::string& command : commands) {
    ASSERT_EQ(command.rfind("exactvo ", 0), 0u) << command;
    const std::string all = "cd '" + folder_.string() + "' && PATH=\"$PWD/bin:$PATH\" " + command + " >log 2>&1";
    EXPECT_EQ(std::system(all.c_str()), 0) << command << "\n" << text_of(folder_ / "log");
  }
  for (const char* file : {"room.geojson", "room.svg", "route.svg", "room/summary.json", "room/index.html",
                           "pillar.svg", "run/metrics.json"}) {
    EXPECT_GT(fs::file_size(folder_ / "out" / file), 100u) << file;
  }
}

TEST_F(GuidePage, EveryHalfPlaneOfItsBatchIsCertified) {
  const std::vector<std::string> commands = commands_of_the_page();
  const auto batch = std::find_if(commands.begin(), commands.end(),
                                  [](const std::string& command) { return command.rfind("exactvo batch", 0) == 0; });
  ASSERT_NE(batch, commands.end());
  fs::create_symlink(EXACTVO_SOURCE_DIR "/datasets", folder_ / "datasets");
  const std::string words = batch->substr(std::string("exactvo").size());
  ASSERT_EQ(std::system(("cd '" + folder_.string() + "' && '" EXACTVO_PROGRAM "'" + words + " >log 2>&1").c_str()), 0);
  std::istringstream figures(text_of(folder_ / "out" / "room" / "measurements.jsonl"));
  std::string line;
  std::getline(figures, line);
  std::size_t half_planes = 0;
  while (std::getline(figures, line)) {
    const nlohmann::json record = nlohmann::json::parse(line);
    for (const auto& at : record.at("half_planes")) {
      for (const auto& half_plane : at.at("half_planes")) {
        ASSERT_FALSE(half_plane.is_null()) << line;
        EXPECT_EQ(half_plane.at("certified"), true) << line;
        ++half_planes;
      }
    }
  }
  EXPECT_GE(half_planes, 10u);
}

}  // namespace
}  // namespace exactvo::datasets::test
