// SPDX-License-Identifier: GPL-3.0-or-later
// A part as bytes: nothing lost, and no more room than they take.
#include "batch/part.h"

#include <gtest/gtest.h>

#include <string>

namespace exactvo::datasets::test {
namespace {

TEST(BatchPart, ItsBytesTakeTheRoomThatWasReckonedAndNoMore) {
  batch::Part part;
  part.counts.obstacles = 3;
  part.counts.certified = 2;
  part.counts.vertices = 17;
  part.figures = std::string(1000, 'f');
  for (std::size_t k = 0; k < batch::layers().size(); ++k) part.features.emplace_back(100 + k, 'l');
  part.rows = std::string(500, 'r');
  part.pictures = "<svg/>";
  const std::string bytes = batch::to_bytes(part);
  EXPECT_EQ(bytes.capacity(), bytes.size());
  const batch::Part again = batch::parse_part(bytes, "part");
  EXPECT_EQ(again.obstacles, part.obstacles);
  EXPECT_EQ(again.certified, part.certified);
  EXPECT_EQ(again.vertices, part.vertices);
  EXPECT_EQ(again.figures, part.figures);
  EXPECT_EQ(again.features, part.features);
  EXPECT_EQ(again.rows, part.rows);
  EXPECT_EQ(again.pictures, part.pictures);
}

}  // namespace
}  // namespace exactvo::datasets::test
