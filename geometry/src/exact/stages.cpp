// SPDX-License-Identifier: GPL-3.0-or-later
#include "exact/stages.h"

#include <algorithm>
#include <mutex>
#include <vector>

#include "exactvo/geometry/predicates.h"

namespace exactvo::geometry {
namespace {

using detail::StageCounter;

/// The counters of the living threads, and the sums of those that ended.
struct Registry {
  std::mutex mutex;
  std::vector<const StageCounter*> living;
  StageCounts ended;
  StageCounts at_reset;
};

Registry& registry() {
  static Registry* const kRegistry = new Registry;  // never destroyed: threads may end after static destruction
  return *kRegistry;
}

void add(StageCounts& sum, const StageCounter& counter) {
  sum.filter += counter.filter.load(std::memory_order_relaxed);
  sum.exact += counter.exact.load(std::memory_order_relaxed);
}

/// In the registry from construction to the end of its thread.
struct Membership {
  const StageCounter* counter = &detail::t_stage_counter;

  Membership() {
    Registry& all = registry();
    const std::lock_guard<std::mutex> lock(all.mutex);
    all.living.push_back(counter);
  }
  ~Membership() {
    Registry& all = registry();
    const std::lock_guard<std::mutex> lock(all.mutex);
    add(all.ended, *counter);
    all.living.erase(std::find(all.living.begin(), all.living.end(), counter));
  }
  Membership(const Membership&) = delete;
  Membership& operator=(const Membership&) = delete;
};

/// REQUIRES: the registry's mutex is held.
StageCounts total(const Registry& all) {
  StageCounts sum = all.ended;
  for (const StageCounter* counter : all.living) add(sum, *counter);
  return sum;
}

}  // namespace

void detail::register_stage_counter() {
  thread_local const Membership kMembership;
  t_stage_counter.known = kMembership.counter != nullptr;
}

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
