// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A lock on a file, which is released when its process ends, however it ends.

#include <filesystem>
#include <functional>
#include <utility>

namespace exactvo::datasets::batch {

class FileLock {
 public:
  enum class State {
    held,
    taken,      ///< by another process, when waiting ended
    unlockable  ///< the file can't be made, or its file system has no locks: nobody holds one
  };

  /// Makes the file, and does not wait.
  static FileLock try_on(const std::filesystem::path& path);
  /// Waits as long as `keep_waiting`, asked many times a second, says so.
  static FileLock wait_on(const std::filesystem::path& path, const std::function<bool()>& keep_waiting);

  FileLock() = default;  ///< of no file
  FileLock(FileLock&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), state_(std::exchange(other.state_, State::unlockable)) {}
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock();

  State state() const { return state_; }
  bool is_held() const { return state_ == State::held; }

 private:
  int descriptor_ = -1;
  State state_ = State::unlockable;
};

}  // namespace exactvo::datasets::batch
