// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Moving obstacles that stand still for now, and guides that lead round them. Which of them stand is known from the
/// rows so far alone; that a route leads round them holds as long as they stand.

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "exactvo/formation/recording.h"
#include "snapshot_bytes.h"
#include "steering/guide.h"

namespace exactvo::formation::detail {

/// Which moving obstacles stand, each with the displacement that it has come to, m.
using Standing = std::vector<std::pair<std::size_t, Vec2>>;

void put_standing(crowd::SnapshotWriter& to, const Standing& standing);
/// `obstacles`: how many there are. Throws CrowdError (bad_snapshot).
Standing get_standing(crowd::SnapshotReader& from, std::size_t obstacles);

/// Leads round these obstacles, and stays valid after they have moved on.
struct Detour {
  Standing round;
  std::shared_ptr<Guide> guide;
};

class StandingObstacles {
 public:
  /// The scenario must outlive this. `most_margin`: as of the guide.
  StandingObstacles(const Scenario& scenario, double most_margin);

  /// Where moving obstacles are now. Called in every row, in order.
  void look(double time, const std::vector<MovedObstacle>& moving);

  /// Counts the rows in which other obstacles stood than in the row before.
  std::size_t changes() const { return changes_; }

  /// The first of those that stand which comes nearer than `radius` to the rest of the course from `here` on.
  std::optional<std::size_t> in_the_way(const Course& course, Vec2 here, double radius) const;

  Detour detour() { return detour(now_); }
  Detour detour(const Standing& round);

  void put(crowd::SnapshotWriter& to) const;
  /// Throws CrowdError (bad_snapshot).
  void get(crowd::SnapshotReader& from);

 private:
  /// The static obstacles with those that stand.
  struct World {
    Standing standing;
    std::vector<SceneObstacle> obstacles;
    std::optional<Guide> guide = {};
  };

  void stand(Standing standing);

  const Scenario& scenario_;
  double most_margin_;
  std::vector<Vec2> displacement_;  ///< m, of each in the last row
  std::vector<double> since_;       ///< s, how long it has been there
  Standing now_;
  std::vector<geometry::Obstacle> shapes_;  ///< of `now_`
  std::size_t changes_ = 0;
  std::deque<std::shared_ptr<World>> worlds_;  ///< the last that were asked for
};

}  // namespace exactvo::formation::detail
