// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Puts parts together while others are still being made: a part is bound once all before it are, by whichever worker
/// brings one, so that the outputs grow as fast as the parts and nobody stands idle at the end. What comes too early
/// waits.

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "batch/ledger.h"
#include "batch/outputs.h"

namespace exactvo::datasets::batch {

/// Number of the input, and of the chunk in it.
using PartKey = std::pair<std::size_t, std::size_t>;

/// It counts on every input coming to an end in its turn. Where one turns out to be broken after some of its parts were
/// bound, which then count for nothing, what was bound is of no use: `finish` says so.
class Binder {
 public:
  /// Starts the outputs in `ledger.final_folder()`. `ledger` must outlive it. Throws DataError (E_FILE_UNWRITABLE).
  Binder(const Ledger& ledger, const BatchConfiguration& configuration, const std::string& provenance);
  /// Takes the outputs away that `finish` did not give out.
  ~Binder();
  Binder(const Binder&) = delete;
  Binder& operator=(const Binder&) = delete;

  /// A part that was made: from any thread, which binds it and some more, if it is their turn. False where too much
  /// waits to hold it: `found` is to be told when it is on disk. Throws DataError (E_FILE_UNWRITABLE).
  bool take(PartKey key, std::shared_ptr<const std::string> bytes);
  /// A part that is on disk: from any thread. Nothing is bound.
  void found(PartKey key);
  /// The input has so many chunks, which were taken or found or will be. From any thread.
  void close(std::size_t input, std::uint64_t chunks);

  /// Binds what is left; nobody takes any more. The outputs, not finished themselves, where they hold all parts of so
  /// many inputs; else none.
  std::unique_ptr<Outputs> finish(std::size_t inputs);

  /// In memory, of parts that wait for their turn.
  static constexpr std::uint64_t kMostBytesWaiting = std::uint64_t{32} << 20;

 private:
  using Bytes = std::shared_ptr<const std::string>;
  void put(PartKey key, Bytes bytes);
  bool counts(PartKey key) const;
  bool turn_over();
  void bind_next(std::unique_lock<std::mutex>& lock);

  const Ledger& ledger_;
  std::mutex mutex_;
  std::unique_ptr<Outputs> outputs_;                ///< of whoever is binding
  std::map<PartKey, Bytes> waiting_;                ///< null where it is on disk
  std::map<std::size_t, std::uint64_t> chunks_of_;  ///< of inputs that are closed and not through
  PartKey next_{0, 0};
  std::uint64_t bytes_ = 0;  ///< of `waiting_`
  bool is_binding_ = false;
  bool is_spoiled_ = false;
};

}  // namespace exactvo::datasets::batch
