// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How far the static obstacles are from places and straight ways: what routes and joint plans are made of. In doubles,
/// up to rounding: exact or certified answers are geometry's (routes.h), and half-planes see to safety.

#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/obstacle_index.h"

namespace exactvo::formation::detail {

/// What stands still.
class FreeSpace {
 public:
  virtual ~FreeSpace() = default;
  virtual bool is_open() const = 0;  ///< nothing stands anywhere
  /// m, from the place to what stands nearest, negative inside it; beyond `enough` any number that is not less.
  virtual double clearance(geometry::Vec2 place, double enough) const = 0;
  /// Whether the straight way stays `least` (m) from everything.
  virtual bool is_clear(geometry::Vec2 from, geometry::Vec2 to, double least) const = 0;
};

/// Among the static obstacles of a scene, which are looked up by place. Without obstacles it is open.
class ObstacleSpace : public FreeSpace {
 public:
  explicit ObstacleSpace(const std::vector<SceneObstacle>& obstacles);

  bool is_open() const override { return obstacles_.empty(); }
  double clearance(geometry::Vec2 place, double enough) const override;
  bool is_clear(geometry::Vec2 from, geometry::Vec2 to, double least) const override;

  /// m, away from the nearest point of an edge, to the place; 0 where none is within `reach` (m).
  geometry::Vec2 from_nearest_edge(geometry::Vec2 place, double reach) const;

 private:
  std::vector<std::vector<geometry::Segment>> edges_;  ///< of each obstacle
  std::vector<geometry::ObstacleIndex> obstacles_;
  geometry::BoxGrid by_place_;
};

}  // namespace exactvo::formation::detail
