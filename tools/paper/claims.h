// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the paper claims, held against the runs.

#include <string>
#include <vector>

#include "paper/report_data.h"

namespace exactvo::tools {

/// An open problem of the paper is solved or not; whatever runs are missing for is not run.
enum class Verdict { holds, holds_in_part, fails, not_run, solved, not_solved };
const char* name(Verdict verdict);  ///< "holds", "holds in part", "fails", "not run", "solved", "not solved"

struct Claim {
  std::string where;     ///< "Fig. 5, Section V.A"
  std::string text;      ///< what the paper says
  Verdict verdict;       ///< of the paper's own method (of the default, for what the paper leaves open), computed
  std::string evidence;  ///< the numbers behind it, and what the default does
  std::string figure;    ///< the picture that shows it, relative to the output folder
  std::string judged;    ///< the method or controller whose runs the verdict is on
};

std::vector<Claim> claims(const ReportData& data);

/// How a claim about many runs is judged: all of them, none of them, or some.
Verdict share_verdict(std::size_t held, std::size_t all);

}  // namespace exactvo::tools
