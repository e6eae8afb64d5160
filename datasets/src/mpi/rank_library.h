// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What is done with MPI, as a table of functions: a program either links it or loads it when it runs in ranks
/// (modules/loader.cpp). A failure in one rank ends all of them, as a scheduler expects.

#include <memory>

#include "exactvo/formation/ranks.h"

namespace exactvo::datasets {

struct RankLibrary {
  /// Joins the ranks that mpirun has started, until the object goes; once in a process.
  std::unique_ptr<formation::Ranks> (*join)();
};

/// Throws DataError (E_FORMAT_UNAVAILABLE) where a program loads it and cannot.
const RankLibrary& rank_library();

}  // namespace exactvo::datasets
