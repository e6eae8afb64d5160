// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a run over ranks says when one of them dies. mpirun then sends the others SIGTERM and, a second later, SIGKILL;
/// by then they wait for the dead one, so that it is said in the signal handler.

#include "exactvo/formation/ranks.h"

namespace exactvo::tools {

/// While it lives, SIGTERM or SIGINT ends the process after half a second if it has not ended by itself: the first
/// rank, or if that is gone the second, says which rank of its machine is gone (E_RANK_LOST). All ranks make one at
/// once.
class RankWatch {
 public:
  /// Throws AnotherRankFailed.
  explicit RankWatch(formation::Ranks& ranks);
  ~RankWatch();
  RankWatch(const RankWatch&) = delete;
  RankWatch& operator=(const RankWatch&) = delete;

  /// That a snapshot will be there to go on from.
  static void keeps_snapshots();
};

/// For the signal handlers; async-signal-safe.
bool watches_ranks();
/// Starts the half second.
void begin_end_of_rank();
/// At its end.
void say_which_rank_is_lost();

}  // namespace exactvo::tools
