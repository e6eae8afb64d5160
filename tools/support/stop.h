// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a signal that ends the program takes with it: temporary folders and programs that it started. Both are known
/// to the signal handler, since a computation or a library may not return for minutes.

#include <sys/types.h>

#include <string>

namespace exactvo::tools {

/// While one lives, the first SIGINT or SIGTERM ends the program from within the handler, instead of being noted. For
/// work whose end loses nothing: a computation before anything is written, or one that writes into a staged folder.
class EndsAtOnce {
 public:
  EndsAtOnce();
  ~EndsAtOnce();
  EndsAtOnce(const EndsAtOnce&) = delete;
  EndsAtOnce& operator=(const EndsAtOnce&) = delete;
};
bool ends_at_once();

/// A folder that a signal removes with all in it, for as long as the object lives. Beyond a fixed number of them at a
/// time, further ones are not registered.
class RemovedAtEnd {
 public:
  explicit RemovedAtEnd(const std::string& folder);
  ~RemovedAtEnd();
  RemovedAtEnd(const RemovedAtEnd&) = delete;
  RemovedAtEnd& operator=(const RemovedAtEnd&) = delete;

 private:
  int slot_;
};

/// A child that a signal ends first, since it may write into such a folder. At most one at a time.
class EndedWithUs {
 public:
  explicit EndedWithUs(pid_t child);
  ~EndedWithUs();
  EndedWithUs(const EndedWithUs&) = delete;
  EndedWithUs& operator=(const EndedWithUs&) = delete;
};

/// Ends the child and removes the folders. Async-signal-safe.
void remove_what_is_unfinished();

}  // namespace exactvo::tools
