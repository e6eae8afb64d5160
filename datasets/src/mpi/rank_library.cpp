// SPDX-License-Identifier: GPL-3.0-or-later
// All that includes MPI.
#include "mpi/rank_library.h"

#include <mpi.h>

#include <algorithm>
#include <climits>
#include <string>
#include <vector>

namespace exactvo::datasets {
namespace {

using Ends = std::vector<std::size_t>;

std::size_t begin_of(std::size_t rank, const Ends& ends) {
  return rank > 0 ? ends[rank - 1] : 0;
}

/// what(first byte, how many) for pieces that MPI can count, which counts in int.
template <class Do>
void in_pieces(std::size_t begin, std::size_t end, const Do& what) {
  constexpr std::size_t kMostAtOnce = std::size_t{1} << 30U;
  for (std::size_t at = begin; at < end; at += kMostAtOnce) what(at, static_cast<int>(std::min(kMostAtOnce, end - at)));
}

void broadcast_from(std::size_t rank, char* bytes, std::size_t begin, std::size_t end) {
  in_pieces(begin, end, [&](std::size_t at, int count) {
    MPI_Bcast(bytes + at, count, MPI_BYTE, static_cast<int>(rank), MPI_COMM_WORLD);
  });
}

/// Before anything else travels the ranks agree on whether all of them are still at it, so that one that fails between
/// two exchanges takes part in that agreement alone. What `least` asks goes along with it.
class MpiRanks final : public formation::Ranks {
 public:
  MpiRanks() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  ~MpiRanks() override { MPI_Finalize(); }

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  /// In one piece: what a rank gives of all arrays stands side by side on the way.
  void share(const std::vector<formation::SharedArray>& arrays) override {
    Ends ends(static_cast<std::size_t>(size_));
    for (const auto& array : arrays)
      for (std::size_t r = 0; r < ends.size(); ++r) ends[r] += array.ends[r];
    on_the_way_.resize(ends.back());
    const auto own = static_cast<std::size_t>(rank_);
    for_parts(arrays, own, ends,
              [&](char* part, char* there, std::size_t size) { std::copy(part, part + size, there); });
    agree();
    share_bytes(ends);
    for (std::size_t r = 0; r < ends.size(); ++r)
      if (r != own)
        for_parts(arrays, r, ends,
                  [&](char* part, char* there, std::size_t size) { std::copy(there, there + size, part); });
  }

  std::int64_t least(std::int64_t value) override { return agree(value); }

  std::vector<std::string> gather(const std::string& own) override {
    constexpr int kTag = 3;
    Ends ends(static_cast<std::size_t>(size_));
    ends[static_cast<std::size_t>(rank_)] = own.size();
    Ends places;
    for (std::size_t r = 0; r < ends.size(); ++r) places.push_back((r + 1) * sizeof(std::size_t));
    share({{ends.data(), places}});
    std::vector<std::string> parts{own};
    if (rank_ == 0)
      for (std::size_t r = 1; r < ends.size(); ++r) parts.emplace_back(ends[r], '\0');
    agree();  // there was room for all
    if (rank_ > 0) {
      in_pieces(0, own.size(), [&](std::size_t at, int count) {
        MPI_Send(own.data() + at, count, MPI_BYTE, 0, kTag, MPI_COMM_WORLD);
      });
      return {};
    }
    for (std::size_t r = 1; r < ends.size(); ++r)
      in_pieces(0, ends[r], [&](std::size_t at, int count) {
        MPI_Recv(parts[r].data() + at, count, MPI_BYTE, static_cast<int>(r), kTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      });
    return parts;
  }

  std::string broadcast(const std::string& bytes) override {
    agree();
    std::string all = rank_ == 0 ? bytes : std::string();
    auto size = static_cast<long>(all.size());
    MPI_Bcast(&size, 1, MPI_LONG, 0, MPI_COMM_WORLD);
    all.resize(static_cast<std::size_t>(size));
    agree();
    broadcast_from(0, all.data(), 0, all.size());
    return all;
  }

  bool fail() override {
    long values[] = {rank_, 0};
    take_least(values);
    return values[0] == rank_;
  }

 private:
  /// Each value becomes the least that any rank gives.
  static void take_least(long (&values)[2]) {
    MPI_Allreduce(MPI_IN_PLACE, values, 2, MPI_LONG, MPI_MIN, MPI_COMM_WORLD);
  }

  /// What all ranks do first, whatever they want: the first that has failed, and the least value.
  long agree(long value = 0) const {
    long values[] = {size_, value};
    take_least(values);
    if (values[0] < size_) throw formation::AnotherRankFailed();
    return values[1];
  }

  /// Each rank has filled its own part of the bytes; afterwards every rank has all of them.
  void share_bytes(const Ends& ends) {
    if (ends.back() > INT_MAX) {
      for (std::size_t r = 0; r < ends.size(); ++r) broadcast_from(r, on_the_way_.data(), begin_of(r, ends), ends[r]);
      return;
    }
    std::vector<int> counts, begins;
    for (std::size_t r = 0; r < ends.size(); ++r) {
      begins.push_back(static_cast<int>(begin_of(r, ends)));
      counts.push_back(static_cast<int>(ends[r] - begin_of(r, ends)));
    }
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, on_the_way_.data(), counts.data(), begins.data(), MPI_BYTE,
                   MPI_COMM_WORLD);
  }

  /// what(in the array, on the way, bytes) for the parts that a rank gives.
  template <class Do>
  void for_parts(const std::vector<formation::SharedArray>& arrays, std::size_t rank, const Ends& ends,
                 const Do& what) {
    char* there = on_the_way_.data() + begin_of(rank, ends);
    for (const auto& array : arrays) {
      const std::size_t begin = begin_of(rank, array.ends), size = array.ends[rank] - begin;
      what(static_cast<char*>(array.bytes) + begin, there, size);
      there += size;
    }
  }

  int rank_ = 0, size_ = 1;
  std::vector<char> on_the_way_;
};

static_assert(sizeof(std::int64_t) == sizeof(long) && alignof(std::int64_t) == alignof(long));

}  // namespace

const RankLibrary& rank_library() {
  static constexpr RankLibrary kLibrary{
      []() -> std::unique_ptr<formation::Ranks> { return std::make_unique<MpiRanks>(); }};
  return kLibrary;
}

}  // namespace exactvo::datasets
