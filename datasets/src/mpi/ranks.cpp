// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/ranks.h"

#include <algorithm>
#include <cstdlib>

#include "exactvo/datasets/batch.h"
#include "mpi/rank_library.h"

namespace exactvo::datasets {

bool under_mpi() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_SIZE", "SLURM_MPI_TYPE"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

std::unique_ptr<formation::Ranks> join_ranks() {
  if (!under_mpi()) return nullptr;
  std::unique_ptr<formation::Ranks> ranks = rank_library().join();
  return ranks->size() == 1 ? nullptr : std::move(ranks);
}

int ranks_started() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* words = std::getenv(name)) return std::max(1, std::atoi(words));
  return 1;
}

}  // namespace exactvo::datasets
