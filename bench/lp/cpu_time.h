// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <time.h>

namespace exactvo::bench {

/// ns, processor time of this thread alone: others on the machine do not count, though they use its caches.
inline double thread_nanoseconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

}  // namespace exactvo::bench
