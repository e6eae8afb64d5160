// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Measurements of a run on a crowd (crowd_run.h), by the rules of metrics.h, from the places and velocities of its
/// rows. What needs half-planes is not measured: `active_set_switches` and `uncertified_half_planes` are 0 and mean
/// nothing.
///
/// See also: metrics.h measures runs whose decisions are kept.

#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "exactvo/formation/crowd_run.h"
#include "exactvo/formation/metrics.h"

namespace exactvo::formation {

/// Clearances are measured for at most this many robots: with more they would take longer than the run.
inline constexpr std::size_t kMostClearances = 2000;

/// Takes the states of a run as it is made, in memory that does not grow with the run.
class CrowdEvaluator : public RunSink {
 public:
  /// Hands everything on to `next`, if there is one. `scenario` and `next` must outlive it.
  explicit CrowdEvaluator(const Scenario& scenario, RunSink* next = nullptr);
  ~CrowdEvaluator() override;
  void add_state(const RunState& now) override;
  void save(std::ostream& to) override;
  /// Throws CrowdError (bad_snapshot).
  void restore(const RunState& now, std::istream& from) override;

  /// After the run. Clearances and collisions are certified as those of metrics.h, and null of more than
  /// `kMostClearances` robots.
  Metrics finish(const RunReport& report, std::vector<std::string> warnings) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace exactvo::formation
