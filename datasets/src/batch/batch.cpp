// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/batch.h"

#include <utility>

#include "batch/merge/summary.h"
#include "batch/session.h"
#include "batch/work/coroutine.h"
#include "exactvo/geometry/require.h"

namespace exactvo::datasets {
namespace {

using batch::Session;

void require_sensible(const BatchConfiguration& configuration, const BatchRun& run) {
  EXACTVO_REQUIRE(!run.paths.empty() && !run.out.empty(), std::string("no path"));
  EXACTVO_REQUIRE(run.shard >= 1 && run.shard <= run.shards, std::to_string(run.shard));
  if (!configuration.robot) return;
  EXACTVO_REQUIRE(!configuration.robot->positions.empty() && configuration.robot->radius >= 0.0 &&
                      configuration.robot->time_horizon > 0.0,
                  std::string("a robot without position, radius or horizon"));
}

BatchResult run_share(Session& session, const BatchRun& run) {
  const bool joins = run.resume || run.shards > 1;
  if (session.journal().look(session.identity(), joins) == batch::Journal::State::complete) {
    return {BatchEnd::complete, batch::read_summary(run.out), true};
  }
  session.journal().begin(session.identity());
  if (run.shards == 1) session.merge_ahead();
  std::vector<std::size_t> mine;
  for (std::size_t k = run.shard - 1; k < session.identity().inputs.size(); k += run.shards) mine.push_back(k);
  session.plan(mine);
  try {
    session.process(mine);
  } catch (const batch::Stopped&) {
    return {BatchEnd::interrupted, {}, false};
  }
  return session.finish();
}

BatchResult run_alone(Session& session, const BatchRun& run) {
  try {
    const BatchResult result = run_share(session, run);
    if (result.end != BatchEnd::incomplete || !session.journal().another_finished(session.identity())) return result;
  } catch (const DataError&) {
    // The same batch in another process may have put everything together under this one.
    if (!session.journal().another_finished(session.identity())) throw;
  }
  return {BatchEnd::complete, batch::read_summary(run.out), true};
}

}  // namespace

std::uint64_t BatchTally::rejected_in_all() const {
  std::uint64_t sum = 0;
  for (const auto& [code, count] : rejected) sum += count;
  return sum;
}

BatchResult run_batch(const BatchConfiguration& configuration, const BatchRun& run, const BatchWatch& watch) {
  require_sensible(configuration, run);
  batch::Inputs inputs = batch::list_inputs(run.paths, run.out, configuration.reading.format);
  Session session(configuration, run, std::move(inputs.files), watch);
  BatchResult result = run_alone(session, run);
  result.earlier = std::move(inputs.earlier);
  return result;
}

}  // namespace exactvo::datasets
