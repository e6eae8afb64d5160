// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Counts which stage of a predicate answered. A counter a thread, since a shared one would cost more than the filters.

#include <atomic>
#include <cstdint>

namespace exactvo::geometry::detail {

/// Written by its own thread only, so an increment is a load and a store; atomic for the readers. Constant-initialised
/// and trivially destroyed, so that reaching it takes no guard.
struct StageCounter {
  std::atomic<std::uint64_t> filter{0};
  std::atomic<std::uint64_t> exact{0};
  bool known = false;  ///< to the registry of stages.cpp
};
/// Found without a call (which would cost the filters their registers), as what is there from a program's start is.
#if defined(__GNUC__) && defined(__ELF__)
[[gnu::tls_model("initial-exec")]]
#endif
inline thread_local StageCounter t_stage_counter;

/// Makes the calling thread's counter known until the thread ends.
void register_stage_counter();

inline void increment(std::atomic<std::uint64_t>& counter) {
  counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

inline void count_filter() {
  StageCounter& mine = t_stage_counter;
  if (!mine.known) register_stage_counter();
  increment(mine.filter);
}
/// Counts and hands the answer on, so that nothing need be kept across the call that makes a counter known.
[[gnu::noinline, gnu::cold]] inline bool count_first_filtered(bool answer) {
  register_stage_counter();
  increment(t_stage_counter.filter);
  return answer;
}
inline bool count_filtered(bool answer) {
  StageCounter& mine = t_stage_counter;
  if (!mine.known) return count_first_filtered(answer);
  increment(mine.filter);
  return answer;
}
inline void count_exact() {
  StageCounter& mine = t_stage_counter;
  if (!mine.known) register_stage_counter();
  increment(mine.exact);
}

}  // namespace exactvo::geometry::detail
