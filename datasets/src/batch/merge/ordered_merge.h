// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Incremental merge of parts in order, while others are still being made: a part is merged once all before it are, by
/// whichever worker brings one, so that little is left to one thread at the end. What comes too early waits. One
/// process of a batch does so (`Journal::claim_merge`), whose inputs are all of them, in order.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "batch/merge/outputs.h"
#include "batch/plan/journal.h"

namespace exactvo::datasets::batch {

/// Number of the input, and of the chunk in it.
using PartKey = std::pair<std::size_t, std::size_t>;

/// It counts on every input coming to an end in its turn. Where one turns out to be broken after some of its parts were
/// merged, which then count for nothing, what was merged is of no use: `finish` says so.
class OrderedMerge {
 public:
  /// Starts the outputs in `journal.final_folder()`. `claim` is that of the journal, which must outlive it. Throws
  /// DataError (E_FILE_UNWRITABLE).
  OrderedMerge(const Journal& journal, FileLock claim, const BatchConfiguration& configuration,
               const std::string& provenance);
  /// Takes the outputs away that `finish` did not give out.
  ~OrderedMerge() = default;
  OrderedMerge(const OrderedMerge&) = delete;
  OrderedMerge& operator=(const OrderedMerge&) = delete;

  /// A part that was made: from any thread, which merges it and some more, if it is their turn. False where too much
  /// waits to hold it: `found` is to be told when it is on disk. Throws DataError (E_FILE_UNWRITABLE).
  bool take(PartKey key, std::shared_ptr<const std::string> bytes);
  /// A part that is on disk: from any thread. Nothing is merged.
  void found(PartKey key);
  /// The input has so many chunks, which were taken or found or will be. From any thread.
  void close(std::size_t input, std::uint64_t chunks);

  /// Merges what is left; nobody takes any more. The outputs, not finished themselves, where they hold all parts of so
  /// many inputs; else none. What `before_each` part throws, it throws.
  std::unique_ptr<Outputs> finish(
      std::size_t inputs, const std::function<void()>& before_each = [] {});

  /// In memory, of parts that wait for their turn.
  static constexpr std::uint64_t kMostBytesWaiting = std::uint64_t{32} << 20;

 private:
  using Bytes = std::shared_ptr<const std::string>;
  void put(PartKey key, Bytes bytes);
  bool counts(PartKey key) const;
  void pass_ended_inputs();
  bool next_waits();
  void merge_next(std::unique_lock<std::mutex>& lock);

  /// The journal's final folder, which goes with it unless it was given out.
  struct Folder {
    explicit Folder(const Journal& of);
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    const std::filesystem::path& path;
    bool is_given_out = false;
  };

  const Journal& journal_;
  FileLock claim_;
  Folder folder_;  ///< before the outputs, which are closed first
  std::mutex mutex_;
  std::unique_ptr<Outputs> outputs_;                ///< of whoever is merging
  std::map<PartKey, Bytes> waiting_;                ///< null where it is on disk
  std::map<std::size_t, std::uint64_t> chunks_of_;  ///< of inputs that are closed and not through
  PartKey next_{0, 0};
  std::uint64_t bytes_ = 0;  ///< of `waiting_`
  bool is_merging_ = false;
  bool is_spoiled_ = false;
};

}  // namespace exactvo::datasets::batch
