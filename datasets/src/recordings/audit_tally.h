// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Counts of an audit by point, with the first findings of each in words.

#include <array>
#include <string>

#include "exactvo/datasets/audit.h"

namespace exactvo::datasets {

class AuditTally {
 public:
  void proven(AuditPoint point) { ++report[point].proven; }
  void refuted(AuditPoint point, const std::string& what) { find(report[point].refuted, what); }
  void open(AuditPoint point, const std::string& what) { find(report[point].open, what); }

  AuditReport report;

 private:
  /// Every kind is heard once, whatever the others fill.
  void find(std::size_t& counter, const std::string& what) {
    if (counter++ == 0 || report.findings.size() < kMostAuditFindings) report.findings.push_back(what);
  }
};

inline std::string at_row(std::size_t row, const std::string& what) {
  return "row " + std::to_string(row) + ": " + what;
}

}  // namespace exactvo::datasets
