// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Ranges of robots, or of other work, on oneTBB's threads. What a range computes must not depend on where ranges
/// begin.

#include <algorithm>
#include <cstddef>
#include <memory>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "exactvo/geometry/seen_by_tsan.h"

namespace exactvo::formation::detail {

class Tasks {
 public:
  /// 0: as many as there are.
  explicit Tasks(int threads) : threads_(threads > 0 ? threads : tbb::this_task_arena::max_concurrency()) {}

  int threads() const { return threads_; }

  /// what(first, last, thread), thread below threads().
  template <class Do>
  void for_ranges(std::size_t count, std::size_t grain, const Do& what) {
    if (threads_ == 1 || count <= grain) {
      for (std::size_t first = 0; first < count; first += grain) what(first, std::min(count, first + grain), 0);
      return;
    }
    if (!arena_) arena_ = std::make_unique<tbb::task_arena>(threads_);
    geometry::gives_tasks();
    arena_->execute([&] {
      const tbb::blocked_range<std::size_t> ranges(0, (count + grain - 1) / grain, 1);
      const auto some = [&](const tbb::blocked_range<std::size_t>& r) {
        const geometry::TaskAtWork seen;
        for (std::size_t k = r.begin(); k < r.end(); ++k)
          what(k * grain, std::min(count, (k + 1) * grain), tbb::this_task_arena::current_thread_index());
      };
      tbb::parallel_for(ranges, some, tbb::simple_partitioner());
    });
    geometry::has_waited();
  }

 private:
  int threads_;
  std::unique_ptr<tbb::task_arena> arena_;
};

}  // namespace exactvo::formation::detail
