// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/merged_triangles.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "exactvo/geometry/predicates.h"

namespace exactvo::geometry::detail {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
enum class Side { unknown, inside, outside };
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::size_t, Kernel>;
using PlainFace = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using FaceBase = CGAL::Triangulation_face_base_with_info_2<Side, Kernel, PlainFace>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_tag>;

/// Three numbers of vertices, counter-clockwise.
using Triangle = std::array<std::size_t, 3>;

/// All vertices, ring after ring, and the edges between them by number.
struct Outline {
  std::vector<Vec2> points;
  std::vector<std::pair<std::size_t, std::size_t>> edges;
};

Outline outline_of(const std::vector<Ring>& rings) {
  Outline outline;
  for (const Ring& ring : rings) {
    const std::size_t base = outline.points.size();
    for (std::size_t i = 0; i < ring.size(); ++i) outline.edges.emplace_back(base + i, base + (i + 1) % ring.size());
    outline.points.insert(outline.points.end(), ring.begin(), ring.end());
  }
  return outline;
}

// Where rings touch, the first vertex there stands for all.
Triangulation triangulation_of(const Outline& outline) {
  Triangulation triangulation;
  std::vector<Triangulation::Vertex_handle> vertices;
  Triangulation::Face_handle near;
  for (std::size_t i = 0; i < outline.points.size(); ++i) {
    const std::size_t before = triangulation.number_of_vertices();
    vertices.push_back(triangulation.insert({outline.points[i].x, outline.points[i].y}, near));
    if (triangulation.number_of_vertices() > before) vertices.back()->info() = i;
    near = vertices.back()->face();
  }
  for (const auto& [from, to] : outline.edges) triangulation.insert_constraint(vertices[from], vertices[to]);
  return triangulation;
}

// Floods from beyond the hull: crossing an edge of the ring changes sides.
void mark_sides(Triangulation& triangulation) {
  for (const auto face : triangulation.all_face_handles()) face->info() = Side::unknown;
  std::vector<Triangulation::Face_handle> open{triangulation.infinite_face()};
  open.front()->info() = Side::outside;
  while (!open.empty()) {
    const auto face = open.back();
    open.pop_back();
    for (int i = 0; i < 3; ++i) {
      const auto next = face->neighbor(i);
      if (next->info() != Side::unknown) continue;
      const bool crosses = face->is_constrained(i);
      next->info() = crosses == (face->info() == Side::outside) ? Side::inside : Side::outside;
      open.push_back(next);
    }
  }
}

// Counter-clockwise triangles of vertex numbers, least number first, in ascending order.
std::vector<Triangle> triangles_of(const Outline& outline) {
  Triangulation triangulation = triangulation_of(outline);
  mark_sides(triangulation);
  std::vector<Triangle> triangles;
  for (const auto face : triangulation.finite_face_handles()) {
    if (face->info() != Side::inside) continue;
    Triangle t{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.push_back(t);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// The triangles as loops of half-edges; dropping a diagonal joins the loops on both sides of it.
///
///      before \   / after              The diagonal h and its twin t may go where the turns
///        -----> o ----->               before(h) -> after(t) at one end and before(t) -> after(h)
///             t | h                    at the other stay left or straight.
///        <----- o <-----
class Loops {
 public:
  Loops(const std::vector<Vec2>& points, const std::vector<Triangle>& triangles) : points_(points) {
    edges_.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) add(t);
    find_twins();
  }

  void drop_diagonals() {
    for (std::size_t h = 0; h < edges_.size(); ++h) {
      const std::optional<std::size_t> twin = edges_[h].twin;
      if (!twin || h > *twin) continue;
      if (stays_convex(h, *twin) && stays_convex(*twin, h)) drop(h, *twin);
    }
  }

  std::vector<ConvexPolygon> pieces() const {
    std::vector<ConvexPolygon> pieces;
    std::vector<bool> taken(edges_.size(), false);
    for (std::size_t first = 0; first < edges_.size(); ++first) {
      if (taken[first] || edges_[first].dropped) continue;
      pieces.emplace_back();
      for (std::size_t h = first; !taken[h]; h = edges_[h].after) {
        taken[h] = true;
        pieces.back().vertices.push_back(points_[edges_[h].from]);
      }
    }
    return pieces;
  }

 private:
  struct HalfEdge {
    std::size_t from = 0;
    std::size_t before = 0;
    std::size_t after = 0;
    std::optional<std::size_t> twin{};  ///< none where the edge is the ring's
    bool dropped = false;
  };

  void add(const Triangle& t) {
    const std::size_t base = edges_.size();
    for (std::size_t i = 0; i < 3; ++i) {
      edges_.push_back({t[i], base + (i + 2) % 3, base + (i + 1) % 3, std::nullopt, false});
    }
  }

  // The two half-edges between the same two vertices.
  void find_twins() {
    std::vector<std::array<std::size_t, 3>> all;  // the lesser and the greater end, and the half-edge
    all.reserve(edges_.size());
    for (std::size_t h = 0; h < edges_.size(); ++h) {
      const std::size_t from = edges_[h].from;
      const std::size_t to = edges_[edges_[h].after].from;
      all.push_back({std::min(from, to), std::max(from, to), h});
    }
    std::sort(all.begin(), all.end());
    for (std::size_t k = 1; k < all.size(); ++k) {
      const auto [low, high, edge] = all[k - 1];
      if (low != all[k][0] || high != all[k][1]) continue;
      edges_[edge].twin = all[k][2];
      edges_[all[k][2]].twin = edge;
    }
  }

  // At the vertex where h begins and its twin ends.
  bool stays_convex(std::size_t h, std::size_t twin) const {
    const Vec2 at = points_[edges_[h].from];
    const Vec2 from = points_[edges_[edges_[h].before].from];
    const Vec2 to = points_[edges_[edges_[edges_[twin].after].after].from];
    return orientation(from, at, to) != Sign::negative;
  }

  void link(std::size_t first, std::size_t second) {
    edges_[first].after = second;
    edges_[second].before = first;
  }

  void drop(std::size_t h, std::size_t t) {
    link(edges_[h].before, edges_[t].after);
    link(edges_[t].before, edges_[h].after);
    edges_[h].dropped = edges_[t].dropped = true;
  }

  const std::vector<Vec2>& points_;
  std::vector<HalfEdge> edges_;
};

}  // namespace

std::vector<ConvexPolygon> merged_triangles(const std::vector<Ring>& rings) {
  const Outline outline = outline_of(rings);
  Loops loops(outline.points, triangles_of(outline));
  loops.drop_diagonals();
  return loops.pieces();
}

}  // namespace exactvo::geometry::detail
