// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The figure of `monitor`: the first lines, each with its way, what of it is proven clear, and what ends that.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/monitor.h"
#include "figures/figure.h"
#include "figures/outlines.h"

namespace exactvo::tools {

/// One line and its answer.
struct JudgedLine {
  std::string title;  ///< of its panel
  std::vector<formation::MonitorArc> whole, proven;
  std::vector<formation::Mover> movers;
  formation::MonitorVerdict verdict;
};

class MonitorPicture {
 public:
  static constexpr std::size_t kMostPanels = 6;

  /// The setup with its obstacles.
  explicit MonitorPicture(formation::MonitorSetup setup) : setup_(std::move(setup)) {}

  bool is_empty() const { return lines_.empty(); }
  bool is_full() const { return lines_.size() == kMostPanels; }
  void add(JudgedLine line) { lines_.push_back(std::move(line)); }
  Figure figure(const std::string& title) const;

 private:
  formation::MonitorSetup setup_;
  std::vector<JudgedLine> lines_;
};

}  // namespace exactvo::tools
