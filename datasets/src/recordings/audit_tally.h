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
  void refuted(AuditPoint point, const std::string& what) { find(report[point], report[point].refuted, what); }
  void open(AuditPoint point, const std::string& what) { find(report[point], report[point].open, what); }

  AuditReport report;

 private:
  /// Each kind has its own bound, so that none is crowded out by another.
  void find(PointCount& point, std::size_t& counter, const std::string& what) {
    if (counter++ < kMostAuditFindings) {
      report.findings.push_back(what);
    } else {
      ++point.unlisted;
    }
  }
};

inline std::string at_row(std::size_t row, const std::string& what) {
  return "row " + std::to_string(row) + ": " + what;
}

}  // namespace exactvo::datasets
