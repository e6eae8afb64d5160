// SPDX-License-Identifier: GPL-3.0-or-later
// The journal of a batch: one lock, whose holder alone clears up after the dead; outputs that go unless they are
// published.
#include "batch/plan/journal.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>

#include "batch/merge/outputs.h"
#include "exactvo/datasets/data_error.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

namespace fs = std::filesystem;
using batch::Journal;
using batch::Outputs;

class BatchJournal : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    plain_.geopackage = plain_.geojson = plain_.pictures = false;
    journal_.emplace(folder_ / "out");
    journal_->begin({});
  }

  static Journal::Lock lock(Journal& journal) {
    return journal.lock([] { return false; });
  }

  BatchConfiguration plain_;
  std::optional<Journal> journal_;
};

TEST_F(BatchJournal, OneProcessAtATimeMergesAndItsFolderIsLeftAlone) {
  ASSERT_EQ(lock(*journal_), Journal::Lock::held);
  EXPECT_EQ(lock(*journal_), Journal::Lock::held) << "it has it already";
  const Outputs outputs(*journal_, plain_, "{}");
  Journal other(folder_ / "out");
  EXPECT_EQ(lock(other), Journal::Lock::taken);
  other.start_final();
  EXPECT_TRUE(fs::exists(journal_->final_folder()));
  EXPECT_TRUE(fs::exists(other.final_folder()));
  journal_.reset();
  EXPECT_EQ(lock(other), Journal::Lock::held);
}

TEST_F(BatchJournal, WaiterGetsLockWhenHolderExits) {
  ASSERT_EQ(lock(*journal_), Journal::Lock::held);
  Journal other(folder_ / "out");
  int asked = 0;
  const auto keep_waiting = [&] {
    if (++asked == 3) journal_.reset();
    return asked < 1000;
  };
  EXPECT_EQ(other.lock(keep_waiting), Journal::Lock::held);
  EXPECT_EQ(asked, 3);
}

TEST_F(BatchJournal, TheHolderOfTheLockRemovesWhatDeadProcessesLeft) {
  const fs::path left = folder_ / "out" / ".parts" / "final.0123";
  fs::create_directories(left);
  journal_->start_final();
  EXPECT_TRUE(fs::exists(left)) << "without the lock its process may live";
  ASSERT_EQ(lock(*journal_), Journal::Lock::held);
  journal_->start_final();
  EXPECT_FALSE(fs::exists(left));
  EXPECT_TRUE(fs::exists(journal_->final_folder()));
}

TEST_F(BatchJournal, WithoutPartsNothingIsStartedNorMade) {
  fs::remove_all(folder_ / "out" / ".parts");
  EXPECT_EQ(lock(*journal_), Journal::Lock::unlockable);
  EXPECT_THROW(journal_->start_final(), DataError);
  EXPECT_THROW(Outputs(*journal_, plain_, "{}"), DataError);
  EXPECT_FALSE(fs::exists(folder_ / "out" / ".parts"));
}

TEST_F(BatchJournal, OutputsThatAreNotPublishedTakeTheirFolderAway) {
  {
    const Outputs outputs(*journal_, plain_, "{}");
    EXPECT_TRUE(fs::exists(journal_->final_folder()));
  }
  EXPECT_FALSE(fs::exists(journal_->final_folder()));
}

}  // namespace
}  // namespace exactvo::datasets::test
