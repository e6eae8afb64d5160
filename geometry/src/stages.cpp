// SPDX-License-Identifier: GPL-3.0-or-later
#include "stages.h"

#include <atomic>
#include <mutex>

#include "exactvo/geometry/predicates.h"

namespace exactvo::geometry {
namespace {

struct Counter;

/// The counters of the living threads, and the sums of those that ended.
struct Registry {
  std::mutex mutex;
  Counter* first = nullptr;
  StageCounts ended;
  StageCounts at_reset;
};

Registry& registry() {
  static Registry* const kRegistry = new Registry;  // never destroyed: threads may end after static destruction
  return *kRegistry;
}

/// Written by its own thread only, so an increment is a load and a store; atomic for the readers.
struct Counter {
  std::atomic<std::uint64_t> filter{0};
  std::atomic<std::uint64_t> exact{0};
  Counter* next = nullptr;

  Counter() {
    Registry& all = registry();
    const std::lock_guard<std::mutex> lock(all.mutex);
    next = all.first;
    all.first = this;
  }
  ~Counter() {
    Registry& all = registry();
    const std::lock_guard<std::mutex> lock(all.mutex);
    all.ended.filter += filter.load(std::memory_order_relaxed);
    all.ended.exact += exact.load(std::memory_order_relaxed);
    Counter** link = &all.first;
    while (*link != this) link = &(*link)->next;
    *link = next;
  }
  Counter(const Counter&) = delete;
  Counter& operator=(const Counter&) = delete;
};

thread_local Counter t_counter;

void increment(std::atomic<std::uint64_t>& counter) {
  counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

/// REQUIRES: the registry's mutex is held.
StageCounts total(const Registry& all) {
  StageCounts sum = all.ended;
  for (const Counter* c = all.first; c != nullptr; c = c->next) {
    sum.filter += c->filter.load(std::memory_order_relaxed);
    sum.exact += c->exact.load(std::memory_order_relaxed);
  }
  return sum;
}

}  // namespace

namespace detail {

void count_filter() {
  increment(t_counter.filter);
}
void count_exact() {
  increment(t_counter.exact);
}

}  // namespace detail

StageCounts stage_counts() {
  Registry& all = registry();
  const std::lock_guard<std::mutex> lock(all.mutex);
  const StageCounts now = total(all);
  return {now.filter - all.at_reset.filter, now.exact - all.at_reset.exact};
}

void reset_stage_counts() {
  Registry& all = registry();
  const std::lock_guard<std::mutex> lock(all.mutex);
  all.at_reset = total(all);
}

}  // namespace exactvo::geometry
