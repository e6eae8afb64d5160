// SPDX-License-Identifier: GPL-3.0-or-later
#include "division/simplification.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyline_simplification_2/Squared_distance_cost.h>
#include <CGAL/Polyline_simplification_2/Stop_above_cost_threshold.h>
#include <CGAL/Polyline_simplification_2/simplify.h>

#include <string>

#include "cgal_guard.h"

namespace exactvo::geometry::detail {
namespace {

namespace PS = CGAL::Polyline_simplification_2;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using ChainVertex = PS::Vertex_base_2<Kernel>;
using ChainFace = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using ChainStructure = CGAL::Triangulation_data_structure_2<ChainVertex, ChainFace>;
using ChainDelaunay =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, ChainStructure, CGAL::No_constraint_intersection_tag>;
using ChainTriangulation = CGAL::Constrained_triangulation_plus_2<ChainDelaunay>;

ChainTriangulation::Constraint_id insert(ChainTriangulation& triangulation, const Chain& chain) {
  std::vector<Kernel::Point_2> points;
  points.reserve(chain.points->size());
  for (const Vec2 p : *chain.points) points.emplace_back(p.x, p.y);
  return triangulation.insert_constraint(points.begin(), points.end(), chain.closed);
}

// The remaining vertices stand in the order of the chain, so one walk finds them.
std::vector<bool> remaining(const ChainTriangulation& triangulation, ChainTriangulation::Constraint_id id,
                            const Chain& chain) {
  const std::vector<Vec2>& points = *chain.points;
  std::vector<bool> kept(points.size(), false);
  std::size_t i = 0;
  for (auto v = triangulation.vertices_in_constraint_begin(id); v != triangulation.vertices_in_constraint_end(id);
       ++v) {
    const Vec2 at = {(*v)->point().x(), (*v)->point().y()};
    while (i < points.size() && points[i] != at) ++i;
    if (i < points.size()) kept[i] = true;
  }
  return kept;
}

}  // namespace

std::vector<std::vector<bool>> kept_vertices(const std::vector<Chain>& chains, double tolerance) {
  const auto values = [&] { return std::to_string(chains.size()) + " chains, tolerance " + hex_text(tolerance); };
  return without_cgal_failures("kept_vertices", values, [&] {
    ChainTriangulation triangulation;
    std::vector<ChainTriangulation::Constraint_id> ids;
    for (const Chain& chain : chains) ids.push_back(insert(triangulation, chain));
    PS::simplify(triangulation, PS::Squared_distance_cost(), PS::Stop_above_cost_threshold(tolerance * tolerance));
    std::vector<std::vector<bool>> kept;
    for (std::size_t i = 0; i < chains.size(); ++i) kept.push_back(remaining(triangulation, ids[i], chains[i]));
    return kept;
  });
}

}  // namespace exactvo::geometry::detail
