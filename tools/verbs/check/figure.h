// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The figure of `exactvo check`: all ways on the map with the places of overlaps, and the first overlaps from near,
/// with the bodies to scale where they are deepest. Keeps thinned ways, and of each agent the rows since a little
/// before.

#include <array>
#include <vector>

#include "figures/figure.h"
#include "figures/outlines.h"
#include "support/checked_file.h"

namespace exactvo::tools {

class CheckPicture {
 public:
  CheckPicture(const CheckedFile& asked, const std::vector<geometry::RigidBody>& bodies);

  void add(const datasets::TrajectoryRow& row);
  void add(const geometry::MotionEvent& event);
  Figure figure(const geometry::MotionCheck& check) const;

 private:
  static constexpr std::size_t kRecent = 16;  ///< rows
  static constexpr std::size_t kMostNear = 5;

  struct Agent {
    Points way;
    std::array<Vec2, kRecent> recent;  ///< a ring
    std::size_t rows = 0;
  };
  /// One overlap from near.
  struct Close {
    geometry::MotionEvent event;
    Points way, other_way;
  };

  Points recent_of(std::size_t agent) const;

  const CheckedFile& asked_;
  const std::vector<geometry::RigidBody>& bodies_;
  double least_step_;  ///< m, between points of a thinned way
  std::vector<Agent> agents_;
  Points places_;
  std::vector<Close> close_;
};

}  // namespace exactvo::tools
