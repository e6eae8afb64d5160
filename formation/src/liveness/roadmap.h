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
#include <optional>
#include <vector>

#include "exactvo/geometry/box.h"
#include "liveness/sweeps.h"
#include "scene/cells.h"
#include "scene/free_space.h"

namespace exactvo::formation::detail {

using PlaceNumber = std::uint32_t;

/// What ways keep from obstacles beside the radius, in diameters.
inline constexpr double kWayGap = 0.01;

/// How many places narrow parts have.
enum class Detail {
  seen,   ///< every free point sees one
  dense,  ///< every free point has one within half a diameter: also at the ends of niches
  walls,  ///< as dense, with places beside the walls: where two have just room to pass each other
};

class Roadmap {
 public:
  /// For discs of that radius, m, in the region. `space` must outlive the map.
  Roadmap(const FreeSpace& space, const geometry::Box& region, double radius, Detail detail = Detail::seen);

  std::size_t size() const { return places_.size(); }
  Vec2 place(PlaceNumber p) const { return places_[p]; }
  const std::vector<PlaceNumber>& ways(PlaceNumber p) const { return ways_[p]; }

  /// Places that the lattice of such a map can have.
  static double lattice_places(const geometry::Box& region, double radius);

  /// The number of that place, which is added with ways to those about it if the map does not have it, for a disc of
  /// that radius, m. These keep clear of what blocks as `block` says. A place that is nearer to something than places
  /// of the map are has ways that come no nearer, and no larger disc has room there.
  PlaceNumber attach(Vec2 place, double radius);
  /// The same; nothing, and nothing added, where no way would lead there.
  std::optional<PlaceNumber> attach_where_joined(Vec2 place, double radius);
  /// m: the largest radius that has room there.
  double room(PlaceNumber p) const { return room_[p]; }
  /// No way leads within `keep` (m) of a disc's centre that stays there, nor to a place there.
  void block(Vec2 centre, double keep);
  bool is_blocked(PlaceNumber p) const { return blocked_[p] != 0; }

  /// Calls visit(number) for every place within `reach` (m).
  template <class Visit>
  void for_each_near(Vec2 here, double reach, const Visit& visit) const {
    cells_.for_each_about(here, reach, [&](PlaceNumber p) {
      if (squared_norm(places_[p] - here) <= reach * reach) visit(p);
    });
  }

 private:
  struct FreePoint {
    double clearance;
    Vec2 place;
  };
  struct Neighbours {
    std::optional<PlaceNumber> same;  ///< already there
    std::vector<PlaceNumber> joined;  ///< those that a way leads to
    bool is_tight = false;            ///< nearer to something than places of the map are
  };
  Neighbours neighbours_of(Vec2 place) const;
  PlaceNumber attach(Vec2 place, double radius, const Neighbours& neighbours);
  bool is_clear_of_blocked(Vec2 place, Vec2 to) const;
  PlaceNumber add(Vec2 place);
  void link(PlaceNumber a, PlaceNumber b);
  void add_lattice(const geometry::Box& region);
  std::vector<FreePoint> narrow_points(const geometry::Box& region) const;
  void add_guards(const std::vector<FreePoint>& narrow, Detail detail);
  void add_places_beside_walls();
  void add_ways();
  void add_connectors(const std::vector<FreePoint>& narrow);

  const FreeSpace* space_;
  double diameter_, way_clearance_, longest_;
  std::vector<Vec2> places_;
  std::vector<std::vector<PlaceNumber>> ways_;
  std::vector<char> blocked_;
  std::vector<double> room_;
  std::vector<geometry::Disc> blocking_;  ///< whose radius is what ways keep from the centre
  Cells<PlaceNumber> cells_;
};

}  // namespace exactvo::formation::detail
