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

/// Before anything else travels the ranks agree on whether all of them are still at it, so that one that fails between
/// two exchanges takes part in that agreement alone. What `least` asks goes along with it.
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

  /// In one piece: what a rank gives of all arrays stands side by side on the way.
  void share(const std::vector<formation::SharedArray>& arrays) override {
    std::vector<std::size_t> ends(static_cast<std::size_t>(size_));
    for (const auto& array : arrays)
      for (std::size_t r = 0; r < ends.size(); ++r) ends[r] += array.ends[r];
    on_the_way_.resize(ends.back());
    const auto own = static_cast<std::size_t>(rank_);
    for_parts(arrays, own, ends,
              [&](char* part, char* there, std::size_t size) { std::copy(part, part + size, there); });
    agree();
    mpi_.share(on_the_way_.data(), ends.data());
    for (std::size_t r = 0; r < ends.size(); ++r)
      if (r != own)
        for_parts(arrays, r, ends,
                  [&](char* part, char* there, std::size_t size) { std::copy(there, there + size, part); });
  }

  std::int64_t least(std::int64_t value) override { return agree(value); }

  std::vector<std::string> gather(const std::string& own) override {
    std::vector<std::size_t> ends(static_cast<std::size_t>(size_));
    ends[static_cast<std::size_t>(rank_)] = own.size();
    std::vector<std::size_t> places;
    for (std::size_t r = 0; r < ends.size(); ++r) places.push_back((r + 1) * sizeof(std::size_t));
    share({{ends.data(), places}});
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

  bool fail() override {
    long values[] = {rank_, 0};
    mpi_.least_of_each(values, 2);
    return values[0] == rank_;
  }

 private:
  /// What all ranks do first, whatever they want: the first that has failed, and the least value.
  long agree(long value = 0) const {
    long values[] = {size_, value};
    mpi_.least_of_each(values, 2);
    if (values[0] < size_) throw AnotherRankFailed();
    return values[1];
  }

  /// what(in the array, on the way, bytes) for the parts that a rank gives.
  template <class Do>
  void for_parts(const std::vector<formation::SharedArray>& arrays, std::size_t rank,
                 const std::vector<std::size_t>& ends, const Do& what) {
    char* there = on_the_way_.data() + (rank > 0 ? ends[rank - 1] : 0);
    for (const auto& array : arrays) {
      const std::size_t begin = rank > 0 ? array.ends[rank - 1] : 0, size = array.ends[rank] - begin;
      what(static_cast<char*>(array.bytes) + begin, there, size);
      there += size;
    }
  }

  const RankLibrary& mpi_ = rank_library();
  int rank_ = 0, size_ = 1;
  std::vector<char> on_the_way_;
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
