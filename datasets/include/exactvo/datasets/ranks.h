// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The ranks of mpirun, for a crowd that is stepped over them (formation/ranks.h).

#include <memory>

#include "exactvo/formation/ranks.h"

namespace exactvo::datasets {

/// Joins the ranks that mpirun has started, until the object goes; once in a process. Null where this process is alone:
/// started by itself, as the only rank, or in a build without MPI. Throws DataError (E_FORMAT_UNAVAILABLE) where a
/// program cannot load the module for MPI.
std::unique_ptr<formation::Ranks> join_ranks();

/// How many ranks the launcher says that it has started, without joining them: 1 where it says nothing.
int ranks_started();

}  // namespace exactvo::datasets
