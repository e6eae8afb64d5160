// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Temporary folders and child processes to clean up when a signal ends the program. The signal handler does it, since
/// a computation or a library may not return for minutes.

#include <sys/types.h>

#include <cstddef>
#include <string>

namespace exactvo::tools {

/// While one lives, the first SIGINT or SIGTERM ends the program from within the handler, instead of being noted. For
/// work whose end loses nothing: a computation before anything is written, or one that writes into a staged folder.
class TerminateOnSignal {
 public:
  /// `words`: what has become of the output, for the message; they must outlive the program. Throws Interrupted where a
  /// signal has come before.
  explicit TerminateOnSignal(const char* words = "nothing was written");
  ~TerminateOnSignal();
  TerminateOnSignal(const TerminateOnSignal&) = delete;
  TerminateOnSignal& operator=(const TerminateOnSignal&) = delete;
};
/// The words of the one that was made last; null where none lives. Async-signal-safe.
const char* words_of_termination();

/// A folder that a signal removes with all in it, for as long as the object lives. Beyond a fixed number of them at a
/// time, further ones are not registered.
class RemoveFolderOnSignal {
 public:
  explicit RemoveFolderOnSignal(const std::string& folder);
  ~RemoveFolderOnSignal();
  RemoveFolderOnSignal(const RemoveFolderOnSignal&) = delete;
  RemoveFolderOnSignal& operator=(const RemoveFolderOnSignal&) = delete;

 private:
  int slot_;
};

/// How many children a signal can end.
inline constexpr std::size_t kMostChildren = 16;

/// Children that a signal ends first, since they may write into such a folder. At most one of these objects lives at a
/// time.
class KillChildrenOnSignal {
 public:
  KillChildrenOnSignal() = default;
  ~KillChildrenOnSignal();
  KillChildrenOnSignal(const KillChildrenOnSignal&) = delete;
  KillChildrenOnSignal& operator=(const KillChildrenOnSignal&) = delete;

  /// REQUIRES: fewer than kMostChildren so far.
  void add(pid_t child);

 private:
  std::size_t count_ = 0;
};

/// On stderr. Async-signal-safe.
void write_words(const char* words);

/// Ends the child and removes the folders. Async-signal-safe.
void remove_what_is_unfinished();

}  // namespace exactvo::tools
