// SPDX-License-Identifier: GPL-3.0-or-later
// A batch over MPI ranks: the first hands out inputs, largest first, so that a slow map does not hold up the rest.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "batch/merge/summary.h"
#include "batch/plan/input_record.h"
#include "batch/session.h"
#include "batch/work/coroutine.h"
#include "exactvo/geometry/counted.h"
#include "mpi/rank_library.h"

namespace exactvo::datasets {
namespace {

using batch::Journal;
using batch::Session;

/// What ranks tell each other: a rank asks for work (and says what became of the last), the first answers.
enum Tag : int { kAsk = 1, kWork = 2 };
enum Said : long { kReady = 0, kDone = 1, kStopped = 2, kFailed = 3 };
constexpr long kNoMore = -1;

/// A rank's report: what became of its last input, and what it has made since the report before.
struct Report {
  long said = kReady;
  batch::Counts made;
};
constexpr int kLongsOfReport = 4;

/// MPI lives as long as the object; a failure in one rank ends all of them, as a scheduler expects.
class World {
 public:
  World() {
    rank_library().join();
    rank = rank_library().rank();
    size = rank_library().size();
  }
  ~World() { rank_library().leave(); }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  int rank = 0;
  int size = 1;
};

/// Whether `step` went well in every rank. The first rank in which it did not throws what it threw there; the others
/// leave quietly, so that nobody waits for a rank that is gone and what is wrong is said once.
template <class Step>
bool all_manage(const World& world, const Step& step) {
  std::exception_ptr failure;
  try {
    step();
  } catch (...) {
    failure = std::current_exception();
  }
  long first_failed = failure ? world.rank : world.size;
  rank_library().least_of_each(&first_failed, 1);
  if (first_failed == world.rank) std::rethrow_exception(failure);
  return first_failed == world.size;
}

void send_work(long input, int to) {
  rank_library().send(&input, 1, to, kWork);
}

long receive_work() {
  long input = 0;
  rank_library().receive(&input, 1, kWork);
  return input;
}

void send_report(const Report& report) {
  const std::array<long, kLongsOfReport> values{report.said, static_cast<long>(report.made.obstacles),
                                                static_cast<long>(report.made.vertices),
                                                static_cast<long>(report.made.nanoseconds)};
  rank_library().send(values.data(), kLongsOfReport, 0, kAsk);
}

Report receive_report(int& sender) {
  std::array<long, kLongsOfReport> values{};
  sender = rank_library().receive(values.data(), kLongsOfReport, kAsk);
  Report report;
  report.said = values[0];
  report.made.obstacles = static_cast<std::uint64_t>(values[1]);
  report.made.vertices = static_cast<std::uint64_t>(values[2]);
  report.made.nanoseconds = static_cast<std::uint64_t>(values[3]);
  return report;
}

std::vector<std::size_t> largest_first(const std::vector<batch::Input>& inputs) {
  std::vector<std::size_t> order(inputs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return inputs[a].size > inputs[b].size; });
  return order;
}

/// The first rank: answers whoever asks until all is handed out and every rank has been told so.
class Coordinator {
 public:
  Coordinator(Session& session, int ranks)
      : session_(session), at_work_(ranks - 1), last_(static_cast<std::size_t>(ranks)) {}

  /// False where the watch, or a rank, stopped it. A failure of its own is thrown once every rank was told to stop.
  bool hand_out() {
    try_to([&] { queue_inputs(); });
    while (at_work_ > 0) {
      int rank = 0;
      const Report report = receive_report(rank);
      hear(report, last_[static_cast<std::size_t>(rank)]);
      answer(rank);
    }
    if (failure_) std::rethrow_exception(failure_);
    return !stopped_;
  }
  bool a_rank_failed() const { return a_rank_failed_; }

 private:
  template <class Action>
  void try_to(const Action& action) {
    try {
      action();
    } catch (...) {
      failure_ = std::current_exception();
      stopped_ = true;
    }
  }

  /// What is through already is nobody's work.
  void queue_inputs() {
    order_ = largest_first(session_.identity().inputs);
    const auto is_there = [&](std::size_t k) { return is_through(session_.journal(), k); };
    order_.erase(std::remove_if(order_.begin(), order_.end(), is_there), order_.end());
    session_.plan(order_);
  }

  /// `input`: the rank's last one.
  void hear(const Report& report, std::size_t input) {
    session_.count(report.made);
    if (report.said == kDone) session_.count_input(input);
    if (report.said == kStopped || report.said == kFailed) stopped_ = true;
    if (report.said == kFailed) a_rank_failed_ = true;
  }

  void answer(int rank) {
    long work = kNoMore;
    try_to([&] {
      if (stopped_ || next_ == order_.size()) return;
      stopped_ = !session_.look(session_.identity().inputs[order_[next_]].name);
      if (!stopped_) work = static_cast<long>(order_[next_++]);
    });
    if (work == kNoMore) {
      --at_work_;
    } else {
      last_[static_cast<std::size_t>(rank)] = static_cast<std::size_t>(work);
    }
    send_work(work, rank);
  }

  Session& session_;
  std::vector<std::size_t> order_;
  std::size_t next_ = 0;
  int at_work_;
  std::vector<std::size_t> last_;  ///< the input that each rank was given last
  bool stopped_ = false;
  bool a_rank_failed_ = false;
  std::exception_ptr failure_;
};

/// Another rank: asks, works, asks again. A failure of its own, of whatever kind, is thrown after the first rank was
/// told: it sends nobody further work, and nobody waits for this one.
void work(Session& session) {
  Report report;
  std::exception_ptr failure;
  for (;;) {
    report.made = session.take_counts();
    send_report(report);
    const long input = receive_work();
    if (input == kNoMore) break;
    report.said = kDone;
    try {
      session.process({static_cast<std::size_t>(input)});
    } catch (const batch::Stopped&) {
      report.said = kStopped;
    } catch (...) {
      report.said = kFailed;
      failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

enum Verdict : long { kGo, kComplete };

/// Opens the output, in the first rank.
Verdict open_output(const Session& session, bool resume) {
  if (session.journal().look(session.identity(), resume) == Journal::State::complete) return kComplete;
  session.journal().begin(session.identity());
  return kGo;
}

/// Shares the work out; every rank has the same batch before it.
BatchResult share_out(const World& world, Session& session) {
  const BatchResult nothing{BatchEnd::incomplete, {}, false};
  if (world.rank > 0) {
    work(session);
    return nothing;
  }
  session.joined_by(world.size - 1);
  Coordinator coordinator(session, world.size);
  if (coordinator.hand_out()) return session.finish();
  return coordinator.a_rank_failed() ? nothing : BatchResult{BatchEnd::interrupted, {}, false};
}

void refuse_shards(const BatchRun& run, int ranks) {
  if (run.shards == 1) return;
  throw DataError(DataCode::other_run, run.out.string(), "",
                  "shard " + std::to_string(run.shard) + "/" + std::to_string(run.shards) + " in each of " +
                      geometry::counted(ranks, "rank"),
                  "shards or ranks: ranks share all inputs among them");
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
  if (world.size == 1) return run_batch(configuration, run, watch);
  const BatchResult nothing{BatchEnd::incomplete, {}, false};
  std::optional<Session> session;
  batch::Inputs inputs;
  Verdict verdict = kGo;
  const bool opened = all_manage(world, [&] {
    refuse_shards(run, world.size);
    inputs = batch::list_inputs(run.paths, run.out, configuration.reading.format);
    session.emplace(configuration, run, std::move(inputs.files), world.rank == 0 ? watch : BatchWatch{});
  });
  if (!opened || !all_manage(world, [&] {
        if (world.rank == 0) verdict = open_output(*session, run.resume);
      })) {
    return nothing;
  }
  if (rank_library().broadcast(verdict) == kComplete) {
    if (world.rank > 0) return nothing;
    return {BatchEnd::complete, batch::read_summary(run.out), true, false, std::move(inputs.earlier)};
  }
  // Work is told by its number, so a rank that sees other files, or another folder, would do another's.
  if (!all_manage(world, [&] { session->journal().require_same(session->identity()); })) return nothing;
  BatchResult result = share_out(world, *session);
  if (world.rank == 0) result.earlier = std::move(inputs.earlier);
  return result;
}

}  // namespace exactvo::datasets
