// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/obstacle_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "obstacle_shapes/steps.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry {
namespace detail {

Verdict verdict_of(const Ellipse& ellipse, const ObstacleShapes& out) {
  if (!out.hull_contains.certified) return {false, "no certified hull"};
  return verdict(contains_all(ellipse, out.hull.vertices), kNotInside);
}

std::vector<const std::vector<Vec2>*> courses_of(const Obstacle& obstacle) {
  if (const auto* wall = std::get_if<Polyline>(&obstacle)) return {&wall->points};
  const auto& polygon = std::get<Polygon>(obstacle);
  std::vector<const Ring*> rings{&polygon.outer};
  for (const Ring& hole : polygon.holes) rings.push_back(&hole);
  return rings;
}

}  // namespace detail

namespace {

using detail::attempt;
using detail::courses_of;
using detail::divide;
using detail::enclose_free_of_traps;
using detail::kNotInside;
using detail::split;
using detail::verdict;
using detail::verdict_of;

bool contains_all(const ConvexPolygon& hull, const std::vector<Vec2>& points) {
  return std::all_of(points.begin(), points.end(), [&](Vec2 p) { return contains(hull, p); });
}

// --- Enclosures ---

void enclose_hull(ObstacleShapes& out) {
  attempt(out.hull_contains, [&] {
    const std::vector<Vec2> points = vertices_of(out.obstacle);
    out.hull = convex_hull(points);
    out.hull_contains = verdict(contains_all(out.hull, points), kNotInside);
  });
}

void enclose_all(const ShapeOptions& options, ObstacleShapes& out) {
  attempt(out.ellipse_contains, [&] {
    if (options.exact_smallest_ellipse) {
      out.smallest_ellipse = smallest_ellipse(out.hull.vertices);
      out.measurements.least_ellipse_area = fast_smallest_ellipse(out.hull.vertices).least_area;
    } else {
      const FastEllipse fast = fast_smallest_ellipse(out.hull.vertices);
      out.smallest_ellipse = fast.ellipse;
      out.measurements.least_ellipse_area = fast.least_area;
    }
    out.ellipse_contains = verdict_of(out.smallest_ellipse, out);
  });
}

void enclose_facades(const ShapeOptions& options, ObstacleShapes& out) {
  attempt(out.facade_ellipses_contain, [&] {
    bool all = true;
    out.facade_ellipses.reserve(out.facades.facades.size());
    for (const Segment& facade : out.facades.facades) {
      const Ellipse ellipse = facade_ellipse(facade, options.facade_ellipses);
      all = all && contains(ellipse, facade.a) && contains(ellipse, facade.b);
      out.facade_ellipses.push_back({ellipse, clearance_of_equation_8(facade, ellipse, options.robot_radius)});
    }
    out.facade_ellipses_contain = verdict(all, kNotInside);
  });
}

// --- Measurements ---

double doubled_area(const std::vector<Vec2>& ring) {
  double sum = 0.0;
  for (std::size_t i = 2; i < ring.size(); ++i) sum += cross(ring[i - 1] - ring[0], ring[i] - ring[0]);
  return sum;
}

double length_of(const std::vector<Vec2>& course, bool closed) {
  double sum = closed && course.size() > 1 ? norm(course.front() - course.back()) : 0.0;
  for (std::size_t i = 1; i < course.size(); ++i) sum += norm(course[i] - course[i - 1]);
  return sum;
}

void measure(ObstacleShapes& out) {
  ShapeMeasurements& f = out.measurements;
  const bool closed = has_interior(out.obstacle);
  const std::vector<const std::vector<Vec2>*> courses = courses_of(out.obstacle);
  f.holes = courses.size() - 1;
  for (const std::vector<Vec2>* course : courses) {
    f.vertices += course->size();
    if (closed) f.area += 0.5 * doubled_area(*course);
    f.perimeter += length_of(*course, closed);
  }
  f.hull_area = 0.5 * doubled_area(out.hull.vertices);
  f.ellipse_area = area(out.smallest_ellipse);
  if (out.trap_free.ellipse) f.trap_free_area = area(*out.trap_free.ellipse);
  const EllipseAxes axes = axes_of(out.smallest_ellipse);
  const double reach = (axes.a - axes.b) * (axes.a + axes.b);
  f.trap_free_beyond = axes.b > 0.0 ? reach / axes.b : reach > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

/// False where something can't be repaired: then there is no obstacle.
bool repair(const Obstacle& given, ObstacleShapes& out) {
  if (const auto* polyline = std::get_if<Polyline>(&given)) {
    NormalizedPolyline normal = normalize_polyline(polyline->points);
    out.valid = normal.ok();
    out.problems = std::move(normal.problems);
    out.obstacle = std::move(normal.polyline);
    return out.valid;
  }
  std::vector<Ring> rings;
  for (const Ring* ring : courses_of(given)) rings.push_back(*ring);
  NormalizedPolygon normal = normalize(rings);
  out.valid = normal.ok();
  out.problems = std::move(normal.problems);
  // A ring of an obstacle never repeats its first point, so that it does not is no finding.
  const auto is_closure = [](const RingProblem& p) { return p.code == RingProblemCode::unclosed; };
  out.problems.erase(std::remove_if(out.problems.begin(), out.problems.end(), is_closure), out.problems.end());
  out.obstacle = std::move(normal.polygon);
  return out.valid;
}

void require_sensible(const ShapeOptions& options) {
  EXACTVO_REQUIRE(std::isfinite(options.robot_radius) && options.robot_radius >= 0.0, hex_text(options.robot_radius));
  EXACTVO_REQUIRE(std::isfinite(options.facades.tolerance) && options.facades.tolerance >= 0.0,
                  hex_text(options.facades.tolerance));
  EXACTVO_REQUIRE(!options.way || (is_finite(options.way->start) && is_finite(options.way->goal)), std::string("NaN"));
}

}  // namespace

bool ObstacleShapes::certified() const {
  const TrapFreeAnswer answer = trap_free.answer;
  const bool found = answer == TrapFreeAnswer::found && trap_free.ellipse && trap_free_contains.certified;
  const bool excused = answer == TrapFreeAnswer::no_room || answer == TrapFreeAnswer::too_large;
  return valid && facades_follow.certified && pieces_cover.certified && hull_contains.certified &&
         ellipse_contains.certified && facade_ellipses_contain.certified && (found || excused);
}

ObstacleShapes shapes_of(const Obstacle& obstacle, const ShapeOptions& options) {
  require_sensible(options);
  ObstacleShapes out;
  if (options.check_validity) {
    if (!repair(obstacle, out)) return out;
  } else {
    out.obstacle = obstacle;
    out.valid = true;
  }
  divide(options, out);
  split(options, out);
  enclose_hull(out);
  enclose_all(options, out);
  enclose_facades(options, out);
  enclose_free_of_traps(options, out);
  measure(out);
  return out;
}

//   v0 o-----o v1       The fan from v0 is searched for the wedge v0, v[k], v[k+1] that x lies in;
//     / .  .  \         then one test against its far side decides.
bool contains(const ConvexPolygon& hull, Vec2 x) {
  const std::vector<Vec2>& v = hull.vertices;
  EXACTVO_REQUIRE(!v.empty(), std::string("no vertex"));
  if (v.size() == 1) return x == v[0];
  if (v.size() == 2) return detail::lies_on({v[0], v[1]}, x);
  if (orientation(v[0], v[1], x) == Sign::negative || orientation(v[0], v.back(), x) == Sign::positive) return false;
  std::size_t low = 1;
  std::size_t high = v.size() - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (orientation(v[0], v[middle], x) == Sign::negative ? high : low) = middle;
  }
  // On the rays along v0 v1 and v0 v[last] the far side alone does not keep x from lying before v0.
  if (orientation(v[low], v[high], x) == Sign::negative) return false;
  if (orientation(v[0], v[1], x) == Sign::zero) return detail::lies_on({v[0], v[1]}, x);
  if (orientation(v[0], v.back(), x) == Sign::zero) return detail::lies_on({v[0], v.back()}, x);
  return true;
}

}  // namespace exactvo::geometry
