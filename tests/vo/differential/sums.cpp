// SPDX-License-Identifier: GPL-3.0-or-later
// Minkowski sums of convex and of other polygons against CGAL's minkowski_sum_2, by convolution and by decomposition.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_vertical_decomposition_2.h>
#include <CGAL/minkowski_sum_2.h>

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/minkowski.h"
#include "geometry/random_grown.h"
#include "geometry/random_shapes.h"
#include "vo/differential/tally.h"

namespace exactvo::test {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Ring2 = CGAL::Polygon_2<Kernel>;
using Holed2 = CGAL::Polygon_with_holes_2<Kernel>;
using geometry::ConvexPolygon;
using geometry::Ring;
using geometry::Vec2;

Ring2 exact(const Ring& ring) {
  Ring2 out;
  for (const Vec2 v : ring) out.push_back({Kernel::FT(v.x), Kernel::FT(v.y)});
  return out;
}

/// Twice CGAL: by reduced convolution and by decomposition into trapezoids.
struct BothWays {
  Holed2 convolution, decomposition;
};
BothWays both(const Ring& a, const Ring& b) {
  const CGAL::Polygon_vertical_decomposition_2<Kernel> decompose;
  return {CGAL::minkowski_sum_by_reduced_convolution_2(exact(a), exact(b)),
          CGAL::minkowski_sum_2(exact(a), exact(b), decompose)};
}

/// The corners that turn, from the lowest on; rounded.
Ring corners_of(const Ring2& ring) {
  Ring out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto n = ring.size();
    if (!CGAL::collinear(ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]))
      out.push_back({CGAL::to_double(ring[i].x()), CGAL::to_double(ring[i].y())});
  }
  const auto lower = [](Vec2 p, Vec2 q) { return p.x < q.x || (p.x == q.x && p.y < q.y); };
  if (!out.empty()) std::rotate(out.begin(), std::min_element(out.begin(), out.end(), lower), out.end());
  return out;
}

/// Corner by corner. Where one side merged corners that rounding made collinear, every corner has a near one.
bool near_each_other(const Ring& a, const Ring& b, double error) {
  const auto covered = [error](const Ring& p, const Ring& q) {
    return std::all_of(p.begin(), p.end(), [&](Vec2 x) {
      double least = 1e300;
      for (std::size_t i = 0; i < q.size(); ++i) {
        const Vec2 e = q[(i + 1) % q.size()] - q[i];
        const double t = std::clamp(dot(x - q[i], e) / std::max(squared_norm(e), 1e-300), 0.0, 1.0);
        least = std::min(least, norm(x - (q[i] + t * e)));
      }
      return least <= error;
    });
  };
  return covered(a, b) && covered(b, a);
}

constexpr double kUlps = 1e-14;  // coordinates stay below 8: a few ulps for the distances of this comparison

std::string text_of(const Ring& a, const Ring& b) {
  return "ring " + geometry::to_string(a) + " (+) ring " + geometry::to_string(b);
}

bool convex_agrees(const ConvexPolygon& a, const ConvexPolygon& b) {
  const geometry::ConvexSum ours = minkowski_sum(a, b);
  const BothWays theirs = both(a.vertices, b.vertices);
  return near_each_other(ours.polygon.vertices, corners_of(theirs.convolution.outer_boundary()), ours.error + kUlps) &&
         near_each_other(ours.polygon.vertices, corners_of(theirs.decomposition.outer_boundary()), ours.error + kUlps);
}

/// A convex polygon with an area; on a grid its edges are often parallel to another's.
ConvexPolygon polygon(SeededRandom& random, bool on_grid) {
  for (;;) {
    ConvexPolygon p = on_grid ? geometry::convex_hull(grid_points(random, random.integer(3, 7), 3))
                              : random_convex_polygon(random, {}, 1.0, random.integer(3, 6));
    if (p.vertices.size() > 2) return p;
  }
}

}  // namespace

Tally compare_sums(const Asked& asked) {
  Tally tally;
  SeededRandom random(asked.seed);
  for (long i = 0; i < asked.random; ++i) {
    const ConvexPolygon a = polygon(random, false), b = polygon(random, false);
    tally.random(convex_agrees(a, b), text_of(a.vertices, b.vertices));
  }
  for (long i = 0; i < asked.constructed; ++i) {
    const ConvexPolygon a = polygon(random, true), b = polygon(random, true);
    tally.constructed(convex_agrees(a, b), text_of(a.vertices, b.vertices));
  }
  return tally;
}

}  // namespace exactvo::test
