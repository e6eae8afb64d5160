// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Problems from a file, as `exactvo lp` reads them.

#include <string>
#include <vector>

#include "exactvo/vo/lp/problem.h"

namespace exactvo::bench {

/// Lines of JSON or binary instances (docs/guide/linear-program.md). Throws std::runtime_error with file, place, found,
/// expected. Lines of JSON are read where the component `datasets` is built.
std::vector<lp::Problem> read_problems(const std::string& file);

/// What every competitor takes: a finite disc above 0, no box, Objective::nearest; normals are made unit vectors.
/// Throws std::runtime_error naming the problem, counted from 1.
void make_comparable(std::vector<lp::Problem>& problems, const std::string& file);

}  // namespace exactvo::bench
