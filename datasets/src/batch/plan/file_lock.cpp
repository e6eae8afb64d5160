// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/plan/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

namespace exactvo::datasets::batch {
namespace {

/// Short to who presses a key, long to a processor.
constexpr std::chrono::milliseconds kBetweenLooks{20};

}  // namespace

FileLock FileLock::try_on(const std::filesystem::path& path) {
  return wait_on(path, [] { return false; });
}

// Asked again and again: a call that waits is resumed after a signal, and the user could not stop it.
FileLock FileLock::wait_on(const std::filesystem::path& path, const std::function<bool()>& keep_waiting) {
  FileLock lock;
  lock.descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  while (lock.descriptor_ >= 0 && !lock.is_held()) {
    if (::flock(lock.descriptor_, LOCK_EX | LOCK_NB) == 0) {
      lock.state_ = State::held;
    } else if (errno != EWOULDBLOCK && errno != EINTR) {
      break;
    } else if (!keep_waiting()) {
      lock.state_ = State::taken;
      break;
    } else {
      std::this_thread::sleep_for(kBetweenLooks);
    }
  }
  return lock;
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace exactvo::datasets::batch
