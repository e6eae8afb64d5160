// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Places for the centres of discs and straight ways between them, clear of what stands still: what joint plans are
/// made on (liveness, rule R3).
///
/// A square lattice with a pitch just above a diameter lets neighbours stand side by side.
/// Guards stand in narrow places so that every free point of a fine grid sees a place; a connector stands wherever such
/// a point sees two parts of the map that nothing joins (visibility roadmaps: Simeon, Laumond and Nissoux 2000, here
/// over a grid instead of samples). Heuristic: where there is no plan on a map there may be one off it.

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "exactvo/geometry/box.h"
#include "liveness/sweeps.h"

namespace exactvo::formation::detail {

/// What stands still.
class FreeSpace {
 public:
  virtual ~FreeSpace() = default;
  virtual bool is_open() const = 0;  ///< nothing stands anywhere
  /// m, from the place to what stands nearest; beyond `enough` any number that is not less.
  virtual double clearance(Vec2 place, double enough) const = 0;
  /// Whether the straight way stays `least` (m) from everything.
  virtual bool is_clear(Vec2 from, Vec2 to, double least) const = 0;
};

/// Nothing stands anywhere.
class OpenSpace : public FreeSpace {
 public:
  bool is_open() const override { return true; }
  double clearance(Vec2, double enough) const override { return enough; }
  bool is_clear(Vec2, Vec2, double) const override { return true; }
};

using PlaceNumber = std::uint32_t;

class Roadmap {
 public:
  /// For discs of that radius, m, in the region. `space` must outlive the map.
  Roadmap(const FreeSpace& space, const geometry::Box& region, double radius);

  std::size_t size() const { return places_.size(); }
  Vec2 place(PlaceNumber p) const { return places_[p]; }
  const std::vector<PlaceNumber>& ways(PlaceNumber p) const { return ways_[p]; }

  /// The number of that place, which is added with ways to those about it if the map does not have it.
  PlaceNumber attach(Vec2 place);
  /// No way leads within `keep` (m) of a disc's centre that stays there, nor to a place there.
  void block(Vec2 centre, double keep);
  bool is_blocked(PlaceNumber p) const { return blocked_[p] != 0; }

  /// Calls visit(number) for every place within `reach` (m).
  template <class Visit>
  void for_each_near(Vec2 here, double reach, const Visit& visit) const {
    const Cell low = cell_of(here - Vec2{reach, reach}), high = cell_of(here + Vec2{reach, reach});
    for (std::int32_t y = low.y; y <= high.y; ++y)
      for (std::int32_t x = low.x; x <= high.x; ++x) {
        const auto found = cells_.find(key_of({x, y}));
        if (found == cells_.end()) continue;
        for (const PlaceNumber p : found->second)
          if (squared_norm(places_[p] - here) <= reach * reach) visit(p);
      }
  }

  /// m: as long as a way may be.
  double longest_way() const { return longest_; }

 private:
  struct Cell {
    std::int32_t x, y;
  };
  struct FreePoint {
    double clearance;
    Vec2 place;
  };
  Cell cell_of(Vec2 p) const;
  static std::uint64_t key_of(Cell c);
  PlaceNumber add(Vec2 place);
  void link(PlaceNumber a, PlaceNumber b);
  void add_lattice(const geometry::Box& region);
  std::vector<FreePoint> narrow_points(const geometry::Box& region) const;
  void add_guards(const std::vector<FreePoint>& narrow);
  void add_ways();
  void add_connectors(const std::vector<FreePoint>& narrow);

  const FreeSpace* space_;
  double diameter_, way_clearance_, longest_;
  std::vector<Vec2> places_;
  std::vector<std::vector<PlaceNumber>> ways_;
  std::vector<char> blocked_;
  std::unordered_map<std::uint64_t, std::vector<PlaceNumber>> cells_;
};

}  // namespace exactvo::formation::detail
