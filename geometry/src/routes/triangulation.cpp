// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <boost/functional/hash.hpp>
#include <limits>
#include <sstream>
#include <unordered_map>
#include <utility>

namespace exactvo::geometry::routing {
namespace {

using Doubles = CGAL::Exact_predicates_inexact_constructions_kernel;
using Fractions = CGAL::Exact_predicates_exact_constructions_kernel;

Fractions::FT number_of(const Rational& x) {
  using Exact = Fractions::FT::ET;
  std::istringstream text(x.get_num().get_str() + "/" + x.get_den().get_str());
  Exact exact;
  text >> exact;
  return Fractions::FT(exact);
}

Doubles::Point_2 point_of(const Point& p, const Doubles&) {
  return {p.rounded().x, p.rounded().y};
}
Fractions::Point_2 point_of(const Point& p, const Fractions&) {
  if (p.is_double()) return {p.rounded().x, p.rounded().y};
  const Vector<Rational> exact = p.exact();
  return {number_of(exact.x), number_of(exact.y)};
}

template <typename Kernel>
std::vector<Triangle> triangles_over(const PlanarGraph& graph, const Vec2 (&corners)[4]) {
  using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
  using FaceBase =
      CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
  using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
  using Cdt = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure,
                                                         CGAL::No_constraint_intersection_requiring_constructions_tag>;
  std::vector<std::pair<typename Kernel::Point_2, int>> points;
  for (std::size_t i = 0; i < graph.vertices.size(); ++i)
    points.emplace_back(point_of(graph.vertices[i], Kernel()), static_cast<int>(i));
  for (const Vec2& corner : corners) points.emplace_back(point_of(corner, Kernel()), static_cast<int>(points.size()));
  Cdt cdt;
  cdt.insert(points.begin(), points.end());
  std::vector<typename Cdt::Vertex_handle> handle(points.size());
  for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) handle[v->info()] = v;
  using Ends = std::pair<int, int>;  // the lesser one first
  std::unordered_map<Ends, int, boost::hash<Ends>> wall_of(graph.edges.size());
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const PlanarGraph::Edge& e = graph.edges[i];
    cdt.insert_constraint(handle[e.a], handle[e.b]);
    wall_of.emplace(std::minmax(e.a, e.b), static_cast<int>(i));
  }
  int count = 0;
  for (auto f = cdt.all_faces_begin(); f != cdt.all_faces_end(); ++f) f->info() = cdt.is_infinite(f) ? -1 : count++;
  std::vector<Triangle> triangles(static_cast<std::size_t>(count));
  for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
    Triangle& t = triangles[f->info()];
    for (int i = 0; i < 3; ++i) {
      t.vertex[i] = f->vertex(i)->info();
      t.neighbour[i] = f->neighbor(i)->info();
      t.wall[i] = -1;
      if (!f->is_constrained(i)) continue;
      const int a = f->vertex(Cdt::ccw(i))->info(), b = f->vertex(Cdt::cw(i))->info();
      t.wall[i] = wall_of.at(std::minmax(a, b));
    }
  }
  return triangles;
}

/// Counts, from the square inward, in how many solids each triangle lies.
void mark_free(const PlanarGraph& graph, std::vector<Triangle>& triangles) {
  constexpr int kUnknown = std::numeric_limits<int>::min();
  std::vector<int> solids(triangles.size(), kUnknown);
  std::vector<int> pending;
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const Triangle& t = triangles[f];
    if (solids[f] != kUnknown || std::none_of(t.neighbour, t.neighbour + 3, [](int n) { return n < 0; })) continue;
    solids[f] = 0;
    pending.push_back(static_cast<int>(f));
  }
  while (!pending.empty()) {
    const int f = pending.back();
    pending.pop_back();
    const Triangle& t = triangles[f];
    for (int i = 0; i < 3; ++i) {
      if (t.neighbour[i] < 0 || solids[t.neighbour[i]] != kUnknown) continue;
      int change = 0;
      if (t.wall[i] >= 0) {
        const PlanarGraph::Edge& wall = graph.edges[t.wall[i]];
        const bool on_its_left = wall.a == t.vertex[(i + 1) % 3];
        change = on_its_left ? -wall.winding : wall.winding;
      }
      solids[t.neighbour[i]] = solids[f] + change;
      pending.push_back(t.neighbour[i]);
    }
  }
  for (std::size_t f = 0; f < triangles.size(); ++f) triangles[f].free = solids[f] == 0;
}

}  // namespace

std::vector<Triangle> triangulate(const PlanarGraph& graph, const Vec2 (&corners)[4]) {
  const bool doubles =
      std::all_of(graph.vertices.begin(), graph.vertices.end(), [](const Point& p) { return p.is_double(); });
  std::vector<Triangle> triangles =
      doubles ? triangles_over<Doubles>(graph, corners) : triangles_over<Fractions>(graph, corners);
  mark_free(graph, triangles);
  return triangles;
}

}  // namespace exactvo::geometry::routing
