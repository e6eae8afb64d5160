// SPDX-License-Identifier: GPL-3.0-or-later
// All that includes MPI.
#include "mpi/rank_library.h"

#include <mpi.h>

#include <algorithm>
#include <climits>
#include <vector>

namespace exactvo::datasets {
namespace {

void join() {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
}

void leave() {
  MPI_Finalize();
}

int rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int size() {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

long broadcast(long value) {
  MPI_Bcast(&value, 1, MPI_LONG, 0, MPI_COMM_WORLD);
  return value;
}

void least_of_each(long* values, int count) {
  MPI_Allreduce(MPI_IN_PLACE, values, count, MPI_LONG, MPI_MIN, MPI_COMM_WORLD);
}

/// MPI counts in int.
constexpr std::size_t kMostAtOnce = std::size_t{1} << 30U;
constexpr int kGatherTag = 3;

/// what(first byte, how many) for pieces that MPI can count.
template <class Do>
void in_pieces(std::size_t begin, std::size_t end, const Do& what) {
  for (std::size_t at = begin; at < end; at += kMostAtOnce) what(at, static_cast<int>(std::min(kMostAtOnce, end - at)));
}

std::size_t begin_of(int rank, const std::size_t* ends) {
  return rank > 0 ? ends[rank - 1] : 0;
}

void broadcast_from(int rank, char* bytes, std::size_t begin, std::size_t end) {
  in_pieces(begin, end,
            [&](std::size_t at, int count) { MPI_Bcast(bytes + at, count, MPI_BYTE, rank, MPI_COMM_WORLD); });
}

void share(char* bytes, const std::size_t* ends) {
  const int ranks = size();
  if (ends[ranks - 1] > INT_MAX) {
    for (int r = 0; r < ranks; ++r) broadcast_from(r, bytes, begin_of(r, ends), ends[r]);
    return;
  }
  std::vector<int> counts, begins;
  for (int r = 0; r < ranks; ++r) {
    begins.push_back(static_cast<int>(begin_of(r, ends)));
    counts.push_back(static_cast<int>(ends[r] - begin_of(r, ends)));
  }
  MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, bytes, counts.data(), begins.data(), MPI_BYTE, MPI_COMM_WORLD);
}

void gather(char* bytes, const std::size_t* ends) {
  const int own = rank();
  if (own > 0) {
    in_pieces(0, ends[own] - begin_of(own, ends),
              [&](std::size_t at, int count) { MPI_Send(bytes + at, count, MPI_BYTE, 0, kGatherTag, MPI_COMM_WORLD); });
    return;
  }
  for (int r = 1; r < size(); ++r)
    in_pieces(begin_of(r, ends), ends[r], [&](std::size_t at, int count) {
      MPI_Recv(bytes + at, count, MPI_BYTE, r, kGatherTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    });
}

void broadcast_bytes(char* bytes, std::size_t count) {
  broadcast_from(0, bytes, 0, count);
}

}  // namespace

const RankLibrary& rank_library() {
  static constexpr RankLibrary kLibrary{join,          leave, rank,   size,           broadcast,
                                        least_of_each, share, gather, broadcast_bytes};
  return kLibrary;
}

}  // namespace exactvo::datasets
