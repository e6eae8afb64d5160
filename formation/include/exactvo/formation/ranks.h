// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Processes, or threads, that step one crowd together (CrowdOptions::ranks). Each has a whole crowd of its own and
/// makes the same calls with the same arguments; in a step each decides for an equal share of the robots, and what they
/// decided is shared. A share is a stretch of the sorted order: neighbouring strips of the plane. Exact: every rank
/// ends with the bits that one alone would have.
///
/// Any failure in one rank ends all ranks: the failing rank calls `fail` once, and the others learn of it in their next
/// call.
///
/// See also: datasets/ranks.h has those of mpirun.

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace exactvo::formation {

/// Another rank has failed and says why; nothing of this rank's own is wrong.
class AnotherRankFailed : public std::runtime_error {
 public:
  AnotherRankFailed() : std::runtime_error("another rank has failed") {}  ///< What `Ranks` throw.
};

/// An array that all ranks have, of which each fills a part.
struct SharedArray {
  void* bytes = nullptr;          ///< where it begins
  std::vector<std::size_t> ends;  ///< rank r fills the bytes from ends[r - 1] (of rank 0: 0) to ends[r]; not decreasing
};

/// All but `rank`, `size` and `fail` are called by all ranks in the same order, from one thread of each, and throw
/// AnotherRankFailed where one has failed.
class Ranks {
 public:
  virtual ~Ranks() = default;
  /// The number of this rank, from 0.
  virtual int rank() const = 0;
  /// The number of ranks, at least 1.
  virtual int size() const = 0;
  /// Each rank has filled its parts of these arrays; then all have all. REQUIRES: the same ends in every rank.
  virtual void share(const std::vector<SharedArray>& arrays) = 0;
  /// The least of the values that the ranks give.
  virtual std::int64_t least(std::int64_t value) = 0;
  /// In rank 0 the texts of all ranks, by rank; elsewhere none.
  virtual std::vector<std::string> gather(const std::string& own) = 0;
  /// The text of rank 0, in every rank.
  virtual std::string broadcast(const std::string& bytes) = 0;
  /// This rank cannot go on, and nothing but the end may follow. True in the first of those that fail at the same time:
  /// it says why.
  virtual bool fail() = 0;
};

/// Where the shares of `count` things end, by rank: as equal as can be.
std::vector<std::size_t> share_ends(std::size_t count, int ranks);
/// The same ends in bytes, of things of this size.
std::vector<std::size_t> in_bytes(std::vector<std::size_t> ends, std::size_t size);

}  // namespace exactvo::formation
