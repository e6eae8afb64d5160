// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Swept clearances of a recording: every robot against obstacles, moving obstacles and the other robots, over each
/// step as it was driven. Certified lower bounds, all roundings taken off.

#include <memory>
#include <optional>
#include <vector>

#include "exactvo/formation/metrics.h"
#include "snapshot_bytes.h"

namespace exactvo::formation::detail {

struct Clearances {
  std::vector<std::optional<double>> to_obstacles;  ///< m, per robot; moving ones included
  std::optional<double> between_robots;             ///< m
  std::vector<Collision> collisions;                ///< in the order of their beginnings
};

/// Where robots are in a row, and whose decision then could not keep every half-plane.
struct RowState {
  struct Robot {
    Vec2 position, velocity;
    bool relaxed = false;
    std::optional<OnWheels> wheels = {};  ///< of a robot with a footprint
  };
  double time = 0.0;
  std::vector<Robot> robots;
};

/// Takes the rows of a run one after the other, and keeps the last two.
class ClearanceSweep {
 public:
  /// Uses what is known of `run` before its first row: motion, time step, tracking gain. Both must outlive it.
  ClearanceSweep(const Scenario& scenario, const Recording& run);
  ~ClearanceSweep();
  void add(const Step& row);
  void add(RowState row);
  /// Over all rows so far.
  Clearances result() const;

  /// For a snapshot of a run along straight ways; `get` throws CrowdError (bad_snapshot).
  void put(crowd::SnapshotWriter& to) const;
  void get(crowd::SnapshotReader& from);

 private:
  class Sweep;
  std::unique_ptr<Sweep> sweep_;
};

/// The clearances of robots and of the run, and its collisions. REQUIRES: `m` has its robots.
void write_clearances(Clearances clearances, Metrics& m);

/// "COLLISION: R1 overlapped ...; ", of the deepest one; empty where there is none.
std::string collision_words(const Metrics& m);

}  // namespace exactvo::formation::detail
