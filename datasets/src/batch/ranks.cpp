// SPDX-License-Identifier: GPL-3.0-or-later
// A batch over MPI ranks: each processes its share of the inputs, as shards do, and the first merges the parts.
#include <algorithm>
#include <cstring>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "batch/merge/summary.h"
#include "batch/plan/input_record.h"
#include "batch/session.h"
#include "batch/work/coroutine.h"
#include "exactvo/datasets/ranks.h"
#include "exactvo/geometry/counted.h"

namespace exactvo::datasets {
namespace {

using batch::Session;
using formation::Ranks;

/// Whether `step` went well in every rank. The first rank in which it did not throws what it threw there; the others
/// leave quietly, so that no rank waits for one that is gone and the error is printed once.
template <class Step>
bool all_manage(Ranks& ranks, const Step& step) {
  std::exception_ptr failure;
  try {
    step();
  } catch (...) {
    failure = std::current_exception();
  }
  const std::int64_t first_failed = ranks.least(failure ? ranks.rank() : ranks.size());
  if (first_failed == ranks.rank()) std::rethrow_exception(failure);
  return first_failed == ranks.size();
}

/// A byte for each input: whether it is still to be done. Empty where the batch is complete.
std::string open_output(const Session& session, bool resume) {
  if (session.journal().look(session.identity(), resume) == batch::Journal::State::complete) return {};
  session.journal().begin(session.identity());
  std::string left;
  for (std::size_t k = 0; k < session.identity().inputs.size(); ++k)
    left += is_through(session.journal(), k) ? '0' : '1';
  return left;
}

/// The inputs of this rank: the largest first, each belongs to the rank that has the fewest bytes so far.
std::vector<std::size_t> share_of(const Ranks& ranks, const std::string& left,
                                  const std::vector<batch::Input>& inputs) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < left.size(); ++k)
    if (left[k] == '1') order.push_back(k);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return inputs[a].size > inputs[b].size; });
  std::vector<std::uint64_t> bytes(static_cast<std::size_t>(ranks.size()));
  std::vector<std::size_t> mine;
  for (const std::size_t k : order) {
    const auto least = std::min_element(bytes.begin(), bytes.end());
    *least += inputs[k].size + 1;
    if (least - bytes.begin() == ranks.rank()) mine.push_back(k);
  }
  return mine;
}

}  // namespace

BatchResult run_batch_over_ranks(const BatchConfiguration& configuration, const BatchRun& run,
                                 const BatchWatch& watch) {
  const std::unique_ptr<Ranks> joined = join_ranks();
  if (!joined) return run_batch(configuration, run, watch);
  Ranks& ranks = *joined;
  const bool is_first = ranks.rank() == 0;
  const BatchResult nothing{BatchEnd::incomplete, {}, false};
  std::optional<Session> session;
  batch::Inputs inputs;
  std::string left;
  const bool opened = all_manage(ranks, [&] {
    if (run.shards > 1)
      throw DataError(DataCode::other_run, run.out.string(), "",
                      "shard " + std::to_string(run.shard) + "/" + std::to_string(run.shards) + " in each of " +
                          geometry::counted(ranks.size(), "rank"),
                      "shards or ranks: ranks share all inputs among them");
    inputs = batch::list_inputs(run.paths, run.out, configuration.reading.format);
    session.emplace(configuration, run, std::move(inputs.files), watch);
    session->be_rank(ranks.rank(), ranks.size());
  });
  if (!opened || !all_manage(ranks, [&] {
        if (is_first) left = open_output(*session, run.resume);
      })) {
    return nothing;
  }
  left = ranks.broadcast(left);
  if (left.empty()) {
    if (!is_first) return nothing;
    return {BatchEnd::complete, batch::read_summary(run.out), true, false, std::move(inputs.earlier)};
  }
  // Shares are of numbers of inputs, so a rank that sees other files, or another folder, would do another's.
  if (!all_manage(ranks, [&] { session->journal().require_same(session->identity()); })) return nothing;
  bool stopped = false;
  if (!all_manage(ranks, [&] {
        const std::vector<std::size_t> mine = share_of(ranks, left, session->identity().inputs);
        session->plan(mine);
        try {
          session->process(mine);
        } catch (const batch::Stopped&) {
          stopped = true;
        }
      })) {
    return nothing;
  }
  // The first rank counts what all have made.
  const batch::Counts made = session->take_counts();
  for (const std::string& bytes : ranks.gather({reinterpret_cast<const char*>(&made), sizeof made})) {
    batch::Counts more;
    std::memcpy(&more, bytes.data(), sizeof more);
    session->count(more);
  }
  const bool is_interrupted = ranks.least(stopped ? 0 : 1) == 0;
  if (!is_first) return nothing;
  BatchResult result = is_interrupted ? BatchResult{BatchEnd::interrupted, {}, false} : session->finish();
  result.earlier = std::move(inputs.earlier);
  return result;
}

}  // namespace exactvo::datasets
