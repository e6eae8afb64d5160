// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// One input of a batch, from the file to its parts.

#include <atomic>
#include <cstdint>
#include <functional>

#include "batch/merge/ordered_merge.h"
#include "batch/plan/journal.h"
#include "batch/work/thread_pool.h"
#include "exactvo/datasets/batch.h"

namespace exactvo::datasets::batch {

/// What the jobs of a run count together.
struct Counters {
  std::atomic<std::uint64_t> obstacles{0};
  std::atomic<std::uint64_t> vertices{0};
  std::atomic<std::uint64_t> nanoseconds_of_jobs{0};
};

/// What an input is processed with. All of it outlives the pool's jobs.
struct WorkContext {
  const BatchConfiguration& configuration;
  const Journal& journal;
  Counters& counters;
  ThreadPool& pool;
  OrderedMerge* merge = nullptr;  ///< where parts are merged while others are made
};

/// Leaves an input where it is when the batch is to stop.
struct Stopped {};

/// Asked while an input is read, with the share that is through; false stops: `process_input` throws Stopped.
using InputWatch = std::function<bool(double share)>;

/// Reads the input and has the pool make every part that is not there, then its facts: all is there when the pool has
/// finished, and the merge was told of it. Throws DataError for what is wrong with the output, and where the input
/// changed since it was listed (E_OTHER_RUN); its parts are then gone. Whatever else is wrong with the input becomes
/// its facts.
void process_input(const Input& input, std::size_t number, const WorkContext& context, const InputWatch& watch);

}  // namespace exactvo::datasets::batch
