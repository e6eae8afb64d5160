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
inline void count_exact() {
  StageCounter& mine = t_stage_counter;
  if (!mine.known) register_stage_counter();
  increment(mine.exact);
}

}  // namespace exactvo::geometry::detail
