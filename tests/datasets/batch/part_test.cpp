// SPDX-License-Identifier: GPL-3.0-or-later
// A part as bytes: nothing lost, and no more room than they take.
#include "batch/work/part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets::test {
namespace {

TEST(BatchPart, ItsBytesTakeTheRoomThatWasReckonedAndNoMore) {
  batch::Part part;
  part.counts.obstacles = 3;
  part.counts.certified = 2;
  part.counts.vertices = 17;
  part.counts.no_half_plane = 5;
  part.measurements = std::string(1000, 'f');
  for (std::size_t k = 0; k < batch::kLayers.size(); ++k) part.features.emplace_back(100 + k, 'l');
  part.pictures = "<svg/>";
  const std::string bytes = batch::to_bytes(part);
  EXPECT_EQ(bytes.capacity(), bytes.size());
  const batch::PartView again = batch::view_of_part(bytes, "part");
  EXPECT_EQ(again.counts.obstacles, part.counts.obstacles);
  EXPECT_EQ(again.counts.certified, part.counts.certified);
  EXPECT_EQ(again.counts.vertices, part.counts.vertices);
  EXPECT_EQ(again.counts.no_half_plane, part.counts.no_half_plane);
  EXPECT_EQ(again.pictures, part.pictures);
  EXPECT_EQ(again.measurements, part.measurements);
  EXPECT_TRUE(std::equal(again.features.begin(), again.features.end(), part.features.begin(), part.features.end()));
  std::istringstream stream(bytes);
  EXPECT_EQ(batch::pictures_at_start(stream, "part"), part.pictures);
  std::istringstream whole("facts\n" + bytes), longer("facts\n" + bytes + "x");
  for (std::istringstream* file : {&whole, &longer}) file->ignore(6);
  EXPECT_TRUE(batch::holds_whole_part(whole));
  EXPECT_FALSE(batch::holds_whole_part(longer));
}

TEST(BatchPart, ItsBytesCutShortAnywhereAreRefused) {
  batch::Part part;
  part.features.resize(batch::kLayers.size());
  part.pictures = "<svg/>";
  part.measurements = "{}\n";
  const std::string bytes = batch::to_bytes(part);
  const std::size_t end_of_pictures = bytes.find("<svg/>") + part.pictures.size();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THROW(batch::view_of_part(bytes.substr(0, length), "part"), DataError) << length;
    std::istringstream cut(bytes.substr(0, length));
    EXPECT_FALSE(batch::holds_whole_part(cut)) << length;
    std::istringstream stream(bytes.substr(0, length));
    if (length >= end_of_pictures) continue;
    EXPECT_THROW(batch::pictures_at_start(stream, "part"), DataError) << length;
  }
}

}  // namespace
}  // namespace exactvo::datasets::test
