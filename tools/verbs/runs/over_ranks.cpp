// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/runs/over_ranks.h"

#include "support/rank_watch.h"
#include "support/terminal.h"

namespace exactvo::tools {

ExitCode over_ranks(formation::Ranks& ranks, const std::function<ExitCode()>& work) {
  if (ranks.rank() > 0) set_quiet(true);
  try {
    const RankWatch watch(ranks);
    const ExitCode code = work();
    ranks.least(0);  // the others stay until the first has written everything
    return code;
  } catch (const formation::AnotherRankFailed&) {
    return ExitCode::success;
  } catch (...) {
    if (!ranks.fail()) return ExitCode::success;
    throw;
  }
}

}  // namespace exactvo::tools
