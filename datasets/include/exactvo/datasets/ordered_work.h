// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// An ordered pipeline: tasks come one at a time, are worked on by several threads, and are finished one at a time in
/// the order in which they came. What depends on the order, such as a file to which every task appends, is the same for
/// any number of threads (oneTBB's parallel_pipeline).

#include <functional>
#include <optional>

namespace exactvo::datasets {

/// A task in two halves.
struct OrderedTask {
  std::function<void()> work;    ///< runs in any thread, at the same time as other tasks' work
  std::function<void()> finish;  ///< runs in any thread, after `finish` of all tasks before this one
};

/// Runs the tasks that `next` returns, until it returns none, on `workers` threads (1 or more), the caller's among
/// them. Any of them calls `next`, one at a time, and works on the task at once. At most a thousand tasks are
/// unfinished at a time.
///
/// If `next`, `work` or `finish` throws: `next` is not called again; tasks before the first one that failed are
/// finished, those after it are not; when nothing runs any more, the exception of that first one is thrown.
void run_in_order(int workers, const std::function<std::optional<OrderedTask>()>& next);

}  // namespace exactvo::datasets
