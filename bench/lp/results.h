// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What the arena measured, and the figures it is held against.

#include <map>
#include <string>
#include <vector>

namespace exactvo::bench {

/// Median ns a solve of one solver on one set.
struct Results {
  std::map<std::string, std::map<std::string, double>> ns;  ///< by set, then by solver
  std::map<std::string, double> exact_share;                ///< by set: of the certified batch, in [0, 1]

  /// How many times as long `slower` takes as `faster`; 0 where one is missing.
  double ratio(const std::string& set, const std::string& slower, const std::string& faster) const;
};

/// The sets that the table of figures needs.
std::vector<std::string> sets_of_figures();

/// One line of the table: what is asked, what was measured, whether that reaches it.
struct FigureRow {
  std::string what;
  double reach = 0.0;
  double measured = 0.0;  ///< 0 where something is missing
  bool at_most = false;   ///< else at least
  bool reached() const;
};

std::vector<FigureRow> figures_of(const Results& results);

void print_figures(const std::vector<FigureRow>& rows);

}  // namespace exactvo::bench
