// SPDX-License-Identifier: GPL-3.0-or-later
// Parts bound while others are made: in order, whatever order they come in, and nothing of use where that fails.
#include "batch/merge/ordered_merge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <numeric>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "batch/formats/features.h"
#include "exactvo/datasets/data_error.h"
#include "temporary_folder.h"
#include "text_file.h"

namespace exactvo::datasets::test {
namespace {

using batch::OrderedMerge;
using batch::PartKey;

std::shared_ptr<const std::string> part_saying(const std::string& words) {
  batch::Part part;
  part.counts.obstacles = 1;
  part.figures = words + "\n";
  part.features.resize(batch::layers().size());
  return std::make_shared<const std::string>(to_bytes(std::move(part)));
}

std::string words_of(PartKey key) {
  return std::to_string(key.first) + "/" + std::to_string(key.second);
}

class BatchBinder : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    plain_.geopackage = plain_.geojson = plain_.pictures = false;
    journal_.emplace(folder_ / "out");
    journal_->begin({});
    start();
  }
  void TearDown() override {
    merge_.reset();
    TemporaryFolder::TearDown();
  }

  void start() {
    merge_.reset();
    merge_.emplace(*journal_, journal_->claim_merge(), plain_, "{}");
  }
  bool take(PartKey key) { return merge_->take(key, part_saying(words_of(key))); }
  void put_on_disk(PartKey key) { journal_->write(journal_->part(key.first, key.second), *part_saying(words_of(key))); }
  /// The lines after that of the provenance; "none" where the merge gives no outputs.
  std::string bound(std::size_t inputs) {
    const std::unique_ptr<batch::Outputs> outputs = merge_->finish(inputs);
    if (!outputs) return "none";
    outputs->finish();
    std::string text = read_text_file(journal_->final_folder() / "figures.jsonl");
    text.erase(0, text.find('\n') + 1);
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
  }

  BatchConfiguration plain_;
  std::optional<batch::Journal> journal_;
  std::optional<OrderedMerge> merge_;
};

TEST_F(BatchBinder, WhateverOrderPartsComeInTheyAreBoundInTheirs) {
  const std::vector<std::size_t> chunks{3, 0, 1, 2};
  std::vector<PartKey> keys;
  std::string expected;
  for (std::size_t input = 0; input < chunks.size(); ++input) {
    for (std::size_t chunk = 0; chunk < chunks[input]; ++chunk) {
      keys.emplace_back(input, chunk);
      expected += words_of({input, chunk}) + " ";
    }
  }
  std::mt19937 random(20261121);
  for (int round = 0; round < 50; ++round) {
    // Fisher and Yates; a library's shuffle is its own.
    for (std::size_t k = keys.size(); k > 1; --k) std::swap(keys[k - 1], keys[random() % k]);
    start();
    std::vector<std::size_t> not_closed(chunks.size());
    std::iota(not_closed.begin(), not_closed.end(), std::size_t{0});
    for (const PartKey& key : keys) {
      while (!not_closed.empty() && random() % 2 == 0) {
        merge_->close(not_closed.back(), chunks[not_closed.back()]);
        not_closed.pop_back();
      }
      if (random() % 3 == 0) {
        put_on_disk(key);
        merge_->found(key);
      } else {
        EXPECT_TRUE(take(key));
      }
    }
    for (const std::size_t input : not_closed) merge_->close(input, chunks[input]);
    ASSERT_EQ(bound(chunks.size()), expected) << "round " << round;
  }
}

TEST_F(BatchBinder, ManyThreadsBringPartsAndNoneIsLost) {
  constexpr std::size_t kParts = 400;
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k) {
    threads.emplace_back([&] {
      for (std::size_t chunk = next++; chunk < kParts; chunk = next++) {
        if (chunk % 5 == 0) {
          put_on_disk({0, chunk});
          merge_->found({0, chunk});
        } else {
          EXPECT_TRUE(take({0, chunk}));
        }
      }
    });
  }
  threads.emplace_back([&] { merge_->close(0, kParts); });
  for (std::thread& thread : threads) thread.join();
  std::string expected;
  for (std::size_t chunk = 0; chunk < kParts; ++chunk) expected += words_of({0, chunk}) + " ";
  EXPECT_EQ(bound(1), expected);
}

TEST_F(BatchBinder, NothingComesOutWithoutAPart) {
  take({0, 0});
  take({0, 2});
  merge_->close(0, 3);
  EXPECT_EQ(bound(1), "none");
}

TEST_F(BatchBinder, NothingComesOutWithoutAnInput) {
  take({0, 0});
  merge_->close(0, 1);
  EXPECT_EQ(bound(2), "none");
}

TEST_F(BatchBinder, NothingComesOutBeforeAnInputIsClosed) {
  take({0, 0});
  EXPECT_EQ(bound(1), "none");
}

TEST_F(BatchBinder, AnInputBrokenBeforeItsTurnLeavesNothingBehind) {
  take({1, 0});
  take({1, 1});
  merge_->close(1, 0);
  take({1, 2});  // was under way
  take({0, 0});
  merge_->close(0, 1);
  take({2, 0});
  merge_->close(2, 1);
  EXPECT_EQ(bound(3), "0/0 2/0 ");
}

TEST_F(BatchBinder, AnInputBrokenAfterItsPartsWereBoundSpoilsWhatWasBound) {
  take({0, 0});
  merge_->close(0, 0);
  take({1, 0});
  merge_->close(1, 1);
  EXPECT_EQ(bound(2), "none");
}

TEST_F(BatchBinder, WhatItCannotHoldItFindsOnDisk) {
  const std::string much(OrderedMerge::kMostBytesWaiting / 2, 'x');
  EXPECT_TRUE(merge_->take({0, 1}, part_saying(much)));
  EXPECT_FALSE(merge_->take({0, 2}, part_saying(much)));
  put_on_disk({0, 2});
  merge_->found({0, 2});
  EXPECT_TRUE(merge_->take({0, 0}, part_saying(much)));  // its turn, however much waits
  merge_->close(0, 3);
  EXPECT_EQ(bound(1), much + " " + much + " 0/2 ");
}

TEST_F(BatchBinder, WhatAnotherProcessTookAwayIsNotGivenOut) {
  take({0, 0});
  merge_->close(0, 1);
  std::filesystem::remove_all(journal_->final_folder());
  EXPECT_EQ(bound(1), "none");
}

TEST_F(BatchBinder, APartThatIsNoneIsToldAndSpoilsTheRest) {
  journal_->write(journal_->part(0, 0), "no part");
  merge_->found({0, 0});
  EXPECT_THROW(take({0, 1}), DataError);
  merge_->close(0, 2);
  EXPECT_EQ(bound(1), "none");
}

TEST_F(BatchBinder, WhatIsThrownBeforeAPartEndsIt) {
  put_on_disk({0, 0});
  merge_->found({0, 0});
  merge_->close(0, 1);
  EXPECT_THROW(merge_->finish(1, [] { throw std::runtime_error("stopped"); }), std::runtime_error);
}

TEST_F(BatchBinder, OneProcessAtATimeMayBindAheadAndItsFolderIsLeftAlone) {
  EXPECT_FALSE(journal_->claim_merge().is_held());
  const batch::Journal other(folder_ / "out");
  EXPECT_FALSE(other.claim_merge().is_held());
  other.start_final(batch::Journal::LockState::end);
  EXPECT_TRUE(std::filesystem::exists(journal_->final_folder()));
  merge_.reset();
  EXPECT_TRUE(other.claim_merge().is_held());
}

TEST_F(BatchBinder, WhatTheDeadLeftIsTakenAway) {
  merge_.reset();
  const std::filesystem::path left = folder_ / "out" / ".parts" / "final.0123";
  std::filesystem::create_directories(left);
  start();
  EXPECT_FALSE(std::filesystem::exists(left));
  EXPECT_TRUE(std::filesystem::exists(journal_->final_folder()));
}

TEST_F(BatchBinder, WithoutPartsNothingIsStartedNorMade) {
  merge_.reset();
  std::filesystem::remove_all(folder_ / "out" / ".parts");
  EXPECT_FALSE(journal_->claim_merge().is_held());
  EXPECT_THROW(journal_->start_final(batch::Journal::LockState::neither), DataError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / ".parts"));
}

TEST_F(BatchBinder, UnfinishedItTakesItsFolderAway) {
  take({0, 0});
  EXPECT_TRUE(std::filesystem::exists(journal_->final_folder()));
  merge_.reset();
  EXPECT_FALSE(std::filesystem::exists(journal_->final_folder()));
}

}  // namespace
}  // namespace exactvo::datasets::test
