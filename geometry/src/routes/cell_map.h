// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The free plane cut into convex cells such that a disc of any radius can go from one place to another if and only if
/// it fits through the gates between their cells (docs/guide/routes.md has the proof).
///
///   site       a vertex, or the inside of an edge, of the planar graph of all obstacles
///   link       the shortest connection of two sites; *strict Gabriel*: its closed diametral disc meets no other site.
///              Between two vertices these are sides of triangles of the constrained Delaunay triangulation.
///   Link       below: one between a vertex v and the inside of an edge ("wall"), which ends at the foot of v
///   cell       a free triangle, cut along all Links
///   portal     a piece of an unconstrained side, or of a Link, between two cells
///   gate       what a portal is a piece of: the side or the Link; as wide as that is long
///
///        x----------f----------y   wall            The Link v-f crosses the sides of triangles between v and
///         \        .|.        /                    the wall. It is found by a search from v through sides that
///          \      . | .      /                     hold the foot of v strictly inside, whose ends lie on either
///           a-----.-|-.-----b    side              side of v-f.
///            \      |      /
///             `-----v-----'
///
/// Exact: every combinatorial decision here.

#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "routes/triangulation.h"

namespace exactvo::geometry::routing {

struct Link {
  int vertex;
  int wall;       ///< of the graph
  int a, b;       ///< the wall's ends; the vertex lies to the left of ab
  double length;  ///< m, rounded
  struct Exit {
    int triangle;
    int side;  ///< local
  };
  std::vector<Exit> exits;  ///< the sides crossed, one after the other; the last is the wall
};

/// A side of a triangle; those on a wall are two, one for each face of it.
struct Side {
  int a, b;   ///< vertices
  int right;  ///< the triangle on the right of ab; -1: a wall, or the square
  int left;
  std::vector<int> marks;  ///< the Links that cross it, from a to b
};

/// An end of a portal that is a piece of a side: a vertex, or where a Link crosses the side.
struct PortalEnd {
  int vertex = -1;
  int link = -1;
};

struct Portal {
  int left = -1;  ///< the cell to the left of from -> to
  int right = -1;
  int side = -1;  ///< the side that it is a piece of, or
  PortalEnd from, to;
  int link = -1;        ///< the Link that it is a piece of: between its crossings with
  int piece = 0;        ///< exits[piece - 1] (0: the vertex) and exits[piece]
  bool outward = true;  ///< of a Link: from -> to leads from its vertex to its foot
};

class CellMap {
 public:
  struct CellPortal {
    int portal;
    bool is_left;  ///< the cell is the portal's left one
  };
  struct Chord {
    int link;
    int side;  ///< 1: the cell lies to the left of the Link as it leaves its vertex; -1: to its right
  };

  static constexpr double kAllGates = std::numeric_limits<double>::infinity();

  /// Links that are longer than `widest_gate` (m) may be left out: a disc that narrow goes from any place to any other
  /// on this map if and only if it does on the whole one. What no disc of a plan can be stopped by joins the two cells
  /// beside it.
  CellMap(PlanarGraph graph, const Vec2 (&corners)[4], double widest_gate = kAllGates);

  struct ForPoints {};
  /// The cells as a point needs them (point_cells.cpp). No gate is too narrow for one, so that Links cut nothing, and
  /// triangles are joined across their sides as long as what comes out is convex: a search has a third of the cells to
  /// look at. Vertices, triangles and sides keep their numbers. A corner of a cell is straight only where no straight
  /// piece from inside one portal to inside another can pass it: such a piece runs inside the cell. REQUIRES:
  /// `map.has_all_gates()`.
  CellMap(const CellMap& map, ForPoints);
  /// The cells that some of its Links make, by their numbers; the others cut nothing. REQUIRES: ascending.
  CellMap(const CellMap& map, const std::vector<int>& kept_links);
  /// The Links that a search for a disc of this radius cannot do without: all that are not much wider than it, and
  /// those at corners. Along a smooth curve the vertices' Links tell a search nothing, and there are as many as cells.
  std::vector<int> needed_links(double r) const;

  bool has_all_gates() const { return widest_gate_ == kAllGates; }
  double widest_gate() const { return widest_gate_; }

  const Point& vertex(int v) const { return vertices[static_cast<std::size_t>(v)]; }
  /// A piece is an edge of the graph, or beyond those an isolated vertex, twice.
  std::pair<int, int> ends_of(int piece) const {
    const int edges = static_cast<int>(graph.edges.size());
    if (piece < edges) return {graph.edges[piece].a, graph.edges[piece].b};
    return {graph.isolated[piece - edges], graph.isolated[piece - edges]};
  }
  bool is_site(int v) const { return v < static_cast<int>(graph.vertices.size()); }
  /// The foot of the Link on its wall.
  Point foot(const Link& link) const;
  /// Where the Link crosses a side, one of its exits.
  Point crossing_of(const Link& link, const Side& side) const;
  /// The two ends of a portal, from and to.
  std::pair<Point, Point> ends_of(const Portal& portal) const;
  /// The gate's width against 2 r. Exact.
  bool link_admits(const Link& link, double r) const;
  bool side_admits(const Side& side, double r) const;
  /// The cell of a triangle in which x lies, or one of those on whose border it lies.
  int cell_in(int triangle, const Point& x) const;
  /// The mean of its vertices.
  Point middle_of(int triangle) const;
  /// Whether x lies in the closed triangle.
  bool triangle_holds(int triangle, const Point& x) const;
  /// The triangles that x lies in, their sides included: one, the two at a side, or all at a vertex, counter-clockwise.
  /// Triangle k + 1 lies behind `side_to_next` of triangle k. REQUIRES: `triangle_holds(triangle, x)`.
  struct TriangleAt {
    int triangle;
    int side_to_next;  ///< local; -1: x lies on no side of it
    int corner;        ///< local, where x is a vertex; else -1
  };
  std::vector<TriangleAt> triangles_at(int triangle, const Point& x) const;
  /// Whether the straight way to `to` leaves the point, which lies on a side or is a vertex, through one of the
  /// triangles about it that are free.
  bool opens_towards(const std::vector<TriangleAt>& about, const Point& to) const;

  PlanarGraph graph;
  std::vector<Point> vertices;  ///< the graph's, then the corners of the square
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 3>> side_of;  ///< of a triangle, its sides by number
  std::vector<Side> sides;
  std::vector<Link> links;
  std::vector<Portal> portals;
  std::vector<std::vector<CellPortal>> cell_portals;  ///< counter-clockwise round the cell
  std::vector<std::vector<Chord>> cell_chords;
  /// The first cell of each triangle; its cells end where those of the next begin (one entry more than triangles). For
  /// points a cell is one triangle or several, and this is the cell that the triangle belongs to.
  std::vector<int> first_cell;

 private:
  /// The triangles of a map, not cut into cells yet.
  struct Uncut {};
  CellMap(const CellMap& map, Uncut);
  void find_smooth_vertices();
  void triangulate_and_link(const Vec2 (&corners)[4]);
  void number_sides();

  double widest_gate_;
  std::vector<char> is_smooth_;  ///< of the graph's vertices: two walls meet there that go on in almost one direction
};

}  // namespace exactvo::geometry::routing
