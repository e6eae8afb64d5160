// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/batch.h"
#include "exactvo/datasets/ranks.h"
#include "exactvo/geometry/require.h"

namespace exactvo::datasets {

bool under_mpi() {
  return false;
}

BatchResult run_batch_over_ranks(const BatchConfiguration&, const BatchRun& run, const BatchWatch&) {
  EXACTVO_REQUIRE(under_mpi(), run.out.string());
  return {};
}

std::unique_ptr<formation::Ranks> join_ranks() {
  return nullptr;
}

int ranks_started() {
  return 1;
}

}  // namespace exactvo::datasets
