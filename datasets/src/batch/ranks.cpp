// SPDX-License-Identifier: GPL-3.0-or-later
// A batch over MPI ranks: the first hands out inputs, largest first, so that a slow map does not hold up the rest.
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "batch/assemble.h"
#include "batch/session.h"
#include "exactvo/geometry/require.h"

namespace exactvo::datasets {
namespace {

using batch::Ledger;
using batch::Session;

/// What ranks tell each other: a rank asks for work (and says what became of the last), the first answers.
enum Tag : int { kAsk = 1, kWork = 2 };
enum Said : long { kReady = 0, kDone = 1, kStopped = 2, kFailed = 3 };
constexpr long kNoMore = -1;

/// MPI lives as long as the object; a failure in one rank ends all of them, as a scheduler expects.
class World {
 public:
  World() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  ~World() { MPI_Finalize(); }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }

  /// From the first rank to all.
  long broadcast(long value) const {
    MPI_Bcast(&value, 1, MPI_LONG, 0, MPI_COMM_WORLD);
    return value;
  }

 private:
  int rank_ = 0;
  int size_ = 1;
};

void send(long value, int to, Tag tag) {
  MPI_Send(&value, 1, MPI_LONG, to, tag, MPI_COMM_WORLD);
}

long receive(int from, Tag tag, int* sender = nullptr) {
  long value = 0;
  MPI_Status status;
  MPI_Recv(&value, 1, MPI_LONG, from, tag, MPI_COMM_WORLD, &status);
  if (sender != nullptr) *sender = status.MPI_SOURCE;
  return value;
}

std::vector<std::size_t> largest_first(const std::vector<batch::Input>& inputs) {
  std::vector<std::size_t> order(inputs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return inputs[a].size > inputs[b].size; });
  return order;
}

/// The first rank: answers whoever asks until all is handed out and every rank has been told so.
class Foreman {
 public:
  Foreman(const Session& session, int ranks, BatchWatch watch)
      : session_(session),
        watch_(std::move(watch)),
        order_(largest_first(session.identity().inputs)),
        at_work_(ranks - 1) {
    const Ledger& ledger = session.ledger();
    const auto is_there = [&](std::size_t k) { return is_through(ledger, k); };
    order_.erase(std::remove_if(order_.begin(), order_.end(), is_there), order_.end());
    progress_.inputs = order_.size();
  }

  /// False where the watch, or a rank, stopped it.
  bool hand_out() {
    while (at_work_ > 0) {
      int sender = 0;
      const long said = receive(MPI_ANY_SOURCE, kAsk, &sender);
      if (said == kDone) ++progress_.inputs_done;
      if (said == kStopped || said == kFailed) stopped_ = true;
      if (said == kFailed) failed_ = true;
      answer(sender);
    }
    return !stopped_;
  }
  bool failed() const { return failed_; }

 private:
  void answer(int rank) {
    const bool go_on = !stopped_ && next_ < order_.size() && look(order_[next_]);
    if (go_on) return send(static_cast<long>(order_[next_++]), rank, kWork);
    send(kNoMore, rank, kWork);
    --at_work_;
  }

  bool look(std::size_t input) {
    progress_.doing = session_.identity().inputs[input].name;
    progress_.share_done =
        static_cast<double>(progress_.inputs_done) / static_cast<double>(std::max<std::size_t>(progress_.inputs, 1));
    stopped_ = watch_ && !watch_(progress_);
    return !stopped_;
  }

  const Session& session_;
  BatchWatch watch_;
  std::vector<std::size_t> order_;
  std::size_t next_ = 0;
  int at_work_;
  bool stopped_ = false;
  bool failed_ = false;
  BatchProgress progress_;
};

/// Another rank: asks, works, asks again. A failure of its own is thrown after the first rank was told.
void work(Session& session) {
  long said = kReady;
  std::optional<DataError> failure;
  for (;;) {
    send(said, 0, kAsk);
    const long input = receive(0, kWork);
    if (input == kNoMore) break;
    said = kDone;
    try {
      session.process(static_cast<std::size_t>(input));
      session.wait();
    } catch (const batch::Stopped&) {
      said = kStopped;
    } catch (const DataError& error) {
      said = kFailed;
      failure = error;
    }
  }
  if (failure) throw DataError(*failure);
}

/// Opens the output in the first rank; the others learn whether there is something to do.
long open_output(const World& world, Session& session, bool resume) {
  enum : long { kGo, kComplete, kRefused };
  long verdict = kRefused;
  if (world.rank() == 0) {
    try {
      const bool complete = session.ledger().look(session.identity(), resume) == Ledger::State::complete;
      if (!complete) session.ledger().begin(session.identity());
      verdict = complete ? kComplete : kGo;
    } catch (const DataError&) {
      world.broadcast(kRefused);
      throw;
    }
  }
  return world.broadcast(verdict);
}

}  // namespace

bool under_mpi() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_SIZE", "SLURM_MPI_TYPE"}) {
    if (std::getenv(name) != nullptr) return true;
  }
  return false;
}

BatchResult run_batch_over_ranks(const BatchConfiguration& configuration, const BatchRun& run,
                                 const BatchWatch& watch) {
  const World world;
  if (world.size() == 1) return run_batch(configuration, run, watch);
  Session session(configuration, run, batch::identity_of(configuration, batch::list_inputs(run.paths, run.out)), {});
  const long verdict = open_output(world, session, run.resume);
  if (verdict == 1 && world.rank() == 0) return {BatchEnd::complete, batch::read_summary(run.out), true};
  if (verdict != 0) return {BatchEnd::incomplete, {}, false};
  if (world.rank() > 0) {
    work(session);
    return {BatchEnd::incomplete, {}, false};
  }
  Foreman foreman(session, world.size(), watch);
  if (!foreman.hand_out()) {
    return {foreman.failed() ? BatchEnd::incomplete : BatchEnd::interrupted, {}, false};
  }
  return session.finish();
}

std::string mpi_release() {
  int major = 0;
  int minor = 0;
  MPI_Get_version(&major, &minor);
  return "MPI " + std::to_string(major) + "." + std::to_string(minor);
}

}  // namespace exactvo::datasets
