// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The turns of the shortest curve through given portals: a funnel (Lee and Preparata 1984). Rounded; for a
/// point it decides by exact turns. (Where walls end beside another by a rounding, several portals lie almost on one
/// line.)

#include <cstddef>
#include <vector>

#include "routes/plan.h"

namespace exactvo::geometry::routing {

/// Portals crossed one after the other, each from one of its sides.
class PortalRow {
 public:
  /// `portals` as they are crossed from the cell `start` on.
  PortalRow(const ClearancePlan& plan, const std::vector<int>& portals, int start);
  /// `from_left`: of each portal, whether it is crossed from its left cell.
  PortalRow(const ClearancePlan& plan, const std::vector<int>& portals, std::vector<bool> from_left)
      : plan_(&plan), portals_(&portals), from_left_(std::move(from_left)) {}

  std::size_t size() const { return portals_->size(); }
  /// Whether the ends are vertices, as they are for a point, and not rounded places beside them.
  bool has_exact_ends() const { return plan_->radius() == 0.0; }
  /// That end, a fraction where the vertex is one. REQUIRES: `has_exact_ends()`.
  Point exact_end(std::size_t k, bool left) const {
    const int v = vertex(k, left);
    return v >= 0 ? plan_->map().vertex(v) : Point(end(k, left));
  }
  int portal(std::size_t k) const { return (*portals_)[k]; }
  bool is_from_left(std::size_t k) const { return from_left_[k]; }
  /// Where the centre can be on the k-th portal: the end on the left of the way, or on its right.
  Vec2 end(std::size_t k, bool left) const {
    const ShrunkPortal& q = plan_->shrunk(portal(k));
    return left == from_left_[k] ? q.to : q.from;
  }
  /// The vertex at that end; -1: none.
  int vertex(std::size_t k, bool left) const {
    const ShrunkPortal& q = plan_->shrunk(portal(k));
    return left == from_left_[k] ? q.to_corner : q.from_corner;
  }

 private:
  const ClearancePlan* plan_;
  const std::vector<int>* portals_;
  std::vector<bool> from_left_;
};

/// The shortest curve turns round the left or right end of the portal at that place.
struct Turn {
  std::size_t at;
  bool left;
};

std::vector<Turn> turns_through(const PortalRow& row, Vec2 s, Vec2 t);

}  // namespace exactvo::geometry::routing
