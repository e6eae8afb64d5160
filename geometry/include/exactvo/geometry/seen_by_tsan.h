// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Tells ThreadSanitizer of an order that it cannot see, since the system's oneTBB is not instrumented: tasks see what
/// was there when they were handed out, and a thread that waits for them sees what they left. Tasks stay unordered
/// among themselves, so that a race between two of them is reported. Nothing in any other build.

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace exactvo::geometry {

#if defined(__SANITIZE_THREAD__)
/// Addresses that name an order; what stands there has no meaning.
inline char tasks_given, tasks_done;
/// Call before tasks are handed out, and once more after it if they may wait for long: ThreadSanitizer forgets old
/// writers.
inline void gives_tasks() {
  __tsan_release(&tasks_given);
}
inline void has_waited() {
  __tsan_acquire(&tasks_done);
}
/// Lives while a task works. What was handed over must not be read before.
struct TaskAtWork {
  TaskAtWork() { __tsan_acquire(&tasks_given); }
  ~TaskAtWork() { __tsan_release(&tasks_done); }
};
#else
/// Nothing, in a build without ThreadSanitizer.
inline void gives_tasks() {}
/// Nothing, in a build without ThreadSanitizer.
inline void has_waited() {}
/// Nothing, in a build without ThreadSanitizer.
struct TaskAtWork {
  /// Not `= default`: no code reads the object, and compilers would warn.
  TaskAtWork() {}
};
#endif

}  // namespace exactvo::geometry
