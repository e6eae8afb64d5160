// SPDX-License-Identifier: GPL-3.0-or-later
// Batches on a file system without locks, as some network mounts are: no process waits for another, and nothing is
// lost.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <thread>
#include <utility>

#include "batch/plan/journal.h"
#include "batch_folder.h"
#include "exactvo/datasets/atomic_file.h"

namespace {
bool locks_are_known = true;
int locks_asked_for = 0;
}  // namespace

/// Stands before the C library's in this program.
extern "C" int flock(int descriptor, int operation) noexcept {
  ++locks_asked_for;
  if (locks_are_known) return static_cast<int>(::syscall(SYS_flock, descriptor, operation));
  errno = ENOLCK;
  return -1;
}

namespace exactvo::datasets::test {
namespace {

namespace fs = std::filesystem;

class WithoutLocks : public BatchFolder {
 protected:
  WithoutLocks() : BatchFolder(1) {}  // a child of fork has no threads but its own
  void SetUp() override {
    BatchFolder::SetUp();
    write_inputs(folder_ / "in", 700);
    locks_asked_for = 0;
  }
  void TearDown() override {
    locks_are_known = true;
    BatchFolder::TearDown();
  }

  BatchRun run_to(const std::string& out) const {
    BatchRun run = BatchFolder::run_to(out);
    run.resume = true;
    return run;
  }
  std::string difference_from_whole(const std::string& out) const {
    return difference(folder_ / "whole", folder_ / out);
  }
};

TEST_F(WithoutLocks, OneProcessWritesTheSame) {
  EXPECT_TRUE(run_batch(plain_, run_to("whole")).was_merged_ahead);
  const int asked_with_locks = locks_asked_for;
  locks_are_known = false;
  const BatchResult result = run_batch(plain_, run_to("out"));
  EXPECT_EQ(result.end, BatchEnd::complete);
  EXPECT_FALSE(result.was_merged_ahead) << "no process knows whether another one would";
  EXPECT_GT(locks_asked_for, asked_with_locks);
  EXPECT_EQ(difference_from_whole("out"), "");
}

/// Where processes wait for each other, for a minute at most.
class Meeting {
 public:
  explicit Meeting(int processes) : processes_(processes) {
    void* shared = ::mmap(nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    arrived_ = new (shared) std::atomic<int>(0);
  }
  ~Meeting() { ::munmap(arrived_, sizeof(std::atomic<int>)); }
  Meeting(const Meeting&) = delete;
  Meeting& operator=(const Meeting&) = delete;

  void arrive() const {
    ++*arrived_;
    for (int looks = 0; *arrived_ < processes_ && looks < 60000; ++looks)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  int arrived() const { return *arrived_; }

 private:
  int processes_;
  std::atomic<int>* arrived_;
};

/// 0 where the batch ended as it should.
int status_of_batch(const BatchConfiguration& configuration, const BatchRun& run, const Meeting& meeting) {
  try {
    bool has_arrived = false;
    run_batch(configuration, run, [&](const BatchProgress& progress) {
      if (progress.doing == "putting the parts together" && !std::exchange(has_arrived, true)) meeting.arrive();
      return true;
    });
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

TEST_F(WithoutLocks, ThreeProcessesPutTheSamePartsTogetherAtOnce) {
  run_batch(plain_, run_to("whole"));
  locks_are_known = false;
  constexpr int kProcesses = 3;
  const Meeting meeting(kProcesses);
  std::vector<pid_t> processes;
  for (int k = 0; k < kProcesses; ++k) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(status_of_batch(plain_, run_to("out"), meeting));
    processes.push_back(child);
  }
  for (const pid_t process : processes) {
    int status = 0;
    ::waitpid(process, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  }
  EXPECT_EQ(meeting.arrived(), kProcesses);  // all of them were in it at once
  EXPECT_TRUE(run_batch(plain_, run_to("out")).was_complete);
  EXPECT_EQ(difference_from_whole("out"), "");
}

TEST_F(WithoutLocks, TheLastProcessTakesNothingAway) {
  locks_are_known = false;
  const fs::path out = folder_ / "out";
  batch::Journal first(out);
  batch::Journal last(out);
  first.begin({});
  for (const batch::Journal* journal : {&first, &last}) {
    journal->start_final();
    AtomicFile file(journal->final_folder() / "measurements.jsonl", MissingFolder::is_refused);
    file.commit();
  }
  write_file_atomically(first.final_folder() / "summary.json", "{}");
  const auto any_output = [](const std::string& name) { return name.front() != '.'; };
  first.publish("summary.json", any_output);
  EXPECT_THROW(AtomicFile(last.final_folder() / "summary.json", MissingFolder::is_refused), DataError);
  EXPECT_THROW(last.publish("summary.json", any_output), DataError);
  EXPECT_FALSE(last.is_open());
  EXPECT_TRUE(fs::exists(out / "measurements.jsonl"));
  EXPECT_TRUE(fs::exists(out / "summary.json"));
}

}  // namespace
}  // namespace exactvo::datasets::test
