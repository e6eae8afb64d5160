// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Robot steps a second of `simulate` on every scene in one table, of two builds side by side: ratios say more than
/// rates, which belong to a machine.

#include <string>

namespace exactvo::bench {

struct TableOptions {
  std::string self;     ///< this program's path
  std::string against;  ///< another build's bench_simulate; empty: none
  std::string scenes;   ///< a regular expression of scene names; empty: all
  std::string method = "ivo";
  double duration = 0.0;  ///< s, that no run is longer than; 0: as the scenes are
  int rounds = 1;         ///< in which the builds take turns
};

/// Runs the programs scene by scene, one after the other, and prints the table as Markdown, the CPU above it: medians
/// of the rounds, and the quartiles of the ratio. Where the labels (digests of the runs) differ, it says so: then the
/// two do not drive the same runs. Throws std::runtime_error where a program cannot be run.
void print_table(const TableOptions& options);

}  // namespace exactvo::bench
