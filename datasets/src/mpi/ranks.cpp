// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/ranks.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "exactvo/datasets/batch.h"
#include "mpi/rank_library.h"

namespace exactvo::datasets {
namespace {

using formation::AnotherRankFailed;

/// Before each exchange the ranks agree on whether all of them are still at it, so that one that fails between two
/// exchanges takes part in that agreement alone.
class MpiRanks final : public formation::Ranks {
 public:
  MpiRanks() {
    mpi_.join();
    rank_ = mpi_.rank();
    size_ = mpi_.size();
  }
  ~MpiRanks() override { mpi_.leave(); }

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void share(void* bytes, const std::vector<std::size_t>& ends) override {
    agree();
    mpi_.share(static_cast<char*>(bytes), ends.data());
  }

  void add(std::int64_t* values, std::size_t count) override {
    agree();
    mpi_.add(values, static_cast<int>(count));
  }

  std::int64_t least(std::int64_t value) override {
    agree();
    return mpi_.least(value);
  }

  std::vector<std::string> gather(const std::string& own) override {
    std::vector<std::size_t> ends(static_cast<std::size_t>(size_));
    ends[static_cast<std::size_t>(rank_)] = own.size();
    std::vector<std::size_t> places;
    for (std::size_t r = 0; r < ends.size(); ++r) places.push_back((r + 1) * sizeof(std::size_t));
    share(ends.data(), places);
    for (std::size_t r = 1; r < ends.size(); ++r) ends[r] += ends[r - 1];
    std::string all = own;
    if (rank_ == 0) all.resize(ends.back());
    agree();  // there was room for all
    mpi_.gather(all.data(), ends.data());
    std::vector<std::string> parts;
    if (rank_ > 0) return parts;
    for (std::size_t r = 0; r < ends.size(); ++r) {
      const std::size_t begin = r > 0 ? ends[r - 1] : 0;
      parts.push_back(all.substr(begin, ends[r] - begin));
    }
    return parts;
  }

  std::string broadcast(const std::string& bytes) override {
    agree();
    std::string all = rank_ == 0 ? bytes : std::string();
    const long size = mpi_.broadcast(static_cast<long>(all.size()));
    all.resize(static_cast<std::size_t>(size));
    agree();
    mpi_.broadcast_bytes(all.data(), all.size());
    return all;
  }

  bool fail() override { return mpi_.least(rank_) == rank_; }

 private:
  void agree() const {
    if (mpi_.least(size_) < size_) throw AnotherRankFailed();
  }

  const RankLibrary& mpi_ = rank_library();
  int rank_ = 0, size_ = 1;
};

static_assert(sizeof(std::int64_t) == sizeof(long) && alignof(std::int64_t) == alignof(long));

}  // namespace

std::unique_ptr<formation::Ranks> join_ranks() {
  if (!under_mpi()) return nullptr;
  auto ranks = std::make_unique<MpiRanks>();
  if (ranks->size() == 1) return nullptr;
  return ranks;
}

int ranks_started() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* words = std::getenv(name)) return std::max(1, std::atoi(words));
  return 1;
}

}  // namespace exactvo::datasets
