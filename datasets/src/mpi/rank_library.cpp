// SPDX-License-Identifier: GPL-3.0-or-later
// All that includes MPI.
#include "mpi/rank_library.h"

#include <mpi.h>

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

long least(long value) {
  long least = value;
  MPI_Allreduce(&value, &least, 1, MPI_LONG, MPI_MIN, MPI_COMM_WORLD);
  return least;
}

void send(const long* values, int count, int to, int tag) {
  MPI_Send(values, count, MPI_LONG, to, tag, MPI_COMM_WORLD);
}

int receive(long* values, int count, int tag) {
  MPI_Status status;
  MPI_Recv(values, count, MPI_LONG, MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &status);
  return status.MPI_SOURCE;
}

}  // namespace

const RankLibrary& rank_library() {
  static constexpr RankLibrary kLibrary{join, leave, rank, size, broadcast, least, send, receive};
  return kLibrary;
}

}  // namespace exactvo::datasets
