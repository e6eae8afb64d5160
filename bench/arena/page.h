// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The arena's results as a page: one table and one picture per suite, and what others have published beside ours.

#include <ostream>
#include <string>
#include <vector>

#include "run.h"

namespace exactvo::bench {

struct PageFacts {
  std::string version, commit, build_type, processor;
  std::size_t jobs = 1;
  bool is_complete = true;  ///< every run that was asked for is there
};

/// `methods` in the order of columns. Suites without results are left out.
void write_page(std::ostream& out, const std::vector<RunResult>& results, const std::vector<std::string>& methods,
                const PageFacts& facts);

}  // namespace exactvo::bench
