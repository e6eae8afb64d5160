// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A verb in several ranks at once: one of them speaks, and what fails in one ends all.

#include <functional>

#include "exactvo/formation/ranks.h"
#include "verb.h"

namespace exactvo::tools {

/// Runs `work` in every rank. What the first that fails throws is thrown there; the others end quietly, with success:
/// mpirun answers with the status of the one that failed. All but the first rank are quiet.
ExitCode over_ranks(formation::Ranks& ranks, const std::function<ExitCode()>& work);

}  // namespace exactvo::tools
