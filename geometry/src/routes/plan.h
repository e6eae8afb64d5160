// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a disc of one radius makes of a cell map: which gates it fits through (exact), which cells hang together
/// (exact), and, for the search, where its centre can be on each portal (rounded).

#include <algorithm>
#include <cmath>
#include <vector>

#include "routes/cell_map.h"
#include "routes/piece_tree.h"

namespace exactvo::geometry::routing {

/// Share of the radius: portals that are too narrow by less count as open, by less than a thousand times that as nearly
/// open.
inline constexpr double kOpenSlack = 1e-9;

/// The part of a portal where a centre can be, as its left cell sees it.
struct ShrunkPortal {
  Vec2 from, to;
  int from_corner = -1, to_corner = -1;     ///< the vertex that a path turns round at that end; -1: none
  bool from_turns = true, to_turns = true;  ///< whether a shortest path can turn there at all
  bool from_moved = true, to_moved = true;  ///< whether shrinking moved that end
  bool open = false;                        ///< not empty, as far as doubles tell
  bool nearly = false;                      ///< not clearly empty
  double size = 0.0;                        ///< m: its ends are rounded as numbers of this size are
  bool tight = false;  ///< its gate is hardly wider than the disc: to be crossed through the exact middle
};

/// An open portal as it is passed out of a cell. Those of a cell lie beside each other: a search looks at little else.
struct Passage {
  Vec2 left, right;  ///< its ends, seen on the way out
  double width;      ///< m, between them
  double size;       ///< `ShrunkPortal::size`
  int portal;
  int to;  ///< the cell behind it
  bool left_turns, right_turns;
  bool from_left;  ///< out of the portal's left cell
  bool leads_into_dead_end;
};

class ClearancePlan {
 public:
  /// REQUIRES: radius >= 0, finite.
  ClearancePlan(const CellMap& map, const PieceTree& grid, double radius);

  const CellMap& map() const { return *map_; }
  const PieceTree& grid() const { return *grid_; }
  double radius() const { return radius_; }
  bool admits(const Portal& portal) const {
    return portal.link >= 0 ? link_admits_[portal.link] : side_admits_[portal.side];
  }
  bool link_admits(int link) const { return link_admits_[link]; }
  bool side_admits(int side) const { return side_admits_[side]; }
  const ShrunkPortal& shrunk(int portal) const { return shrunk_[portal]; }
  /// Equal for two cells iff a disc can go from one to the other.
  std::size_t component(int cell) const { return component_[cell]; }
  /// Ends of portals round the same vertex between which the centre can go from end to end have the same sector.
  struct InSector {
    int number;
    double at;  ///< m, along the sector: from one end to another the centre goes no farther than their difference
  };
  /// `end` is 2 portal + (0: from, 1: to).
  const InSector& sector(int end) const { return sectors_[end]; }
  Vec2 end_at(int end) const { return end % 2 ? shrunk_[end / 2].to : shrunk_[end / 2].from; }
  /// The ways out of a cell, counter-clockwise.
  struct Passages {
    const Passage *first, *last;
    const Passage* begin() const { return first; }
    const Passage* end() const { return last; }
  };
  Passages passages(int cell) const {
    return {passages_.data() + first_passage_[cell], passages_.data() + first_passage_[cell + 1]};
  }
  /// A cell that leads nowhere but to one other: that one; -1 elsewhere.
  int way_out(int cell) const { return way_out_[cell]; }

  /// The first piece nearer to x than the radius (where that is 0: that x lies on), -1 where there is none. Exact.
  int piece_too_near(const Point& x) const;
  /// Whether the disc can move straight from p to q: every piece stays at least a radius away, and a point (radius 0)
  /// touches none. Exact.
  bool is_clear(const Point& p, const Point& q) const;
  /// Whether a point touches no piece on its way from p to q, except at an end that may touch.
  bool is_clear_but_at(const Point& p, const Point& q, bool p_may, bool q_may) const;
  /// The pieces nearer than r to x, each once, ascending.
  std::vector<int> pieces_within(Vec2 x, double r) const;

 private:
  void decide_gates();
  void find_components();
  void shrink_all();
  void find_turns();
  void find_sectors();
  void find_ways_out();
  void list_passages();
  ShrunkPortal shrunk_link(const Portal& portal) const;
  ShrunkPortal shrunk_side(const Portal& portal) const;

  const CellMap* map_;
  const PieceTree* grid_;
  double radius_;
  std::vector<char> link_admits_, side_admits_;
  std::vector<ShrunkPortal> shrunk_;
  std::vector<std::size_t> component_;
  std::vector<int> way_out_;
  std::vector<InSector> sectors_;
  std::vector<Passage> passages_;
  std::vector<std::size_t> first_passage_;  ///< of a cell
};

}  // namespace exactvo::geometry::routing
