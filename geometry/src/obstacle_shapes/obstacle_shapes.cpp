// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/obstacle_shapes.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include "enclosure/ellipse_solver.h"
#include "exact/running_error.h"
#include "exactvo/geometry/pieces.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry {
namespace detail {
namespace {

constexpr const char* kNotInside = "a point lies outside";

/// Runs `action`; a failure inside becomes the verdict's reason.
template <class Action>
void attempt(Verdict& verdict, const Action& action) {
  try {
    action();
  } catch (const std::exception& failure) {
    verdict = {false, failure.what()};
  }
}

Verdict verdict(bool holds, const char* reason) {
  return holds ? Verdict{true, {}} : Verdict{false, reason};
}

/// An ellipse holds every point iff it holds the corners of their hull.
Verdict verdict_of(const Ellipse& ellipse, const ObstacleShapes& out) {
  if (!out.hull_contains.certified) return {false, "no certified hull"};
  return verdict(contains_all(ellipse, out.hull.vertices), kNotInside);
}

/// What the facades must keep to: a polygon's rings, or a wall's one chain.
std::vector<const std::vector<Vec2>*> courses_of(const Obstacle& obstacle) {
  if (const auto* wall = std::get_if<Polyline>(&obstacle)) return {&wall->points};
  const auto& polygon = std::get<Polygon>(obstacle);
  std::vector<const Ring*> rings{&polygon.outer};
  for (const Ring& hole : polygon.holes) rings.push_back(&hole);
  return rings;
}

// --- Facades and pieces, each certified to follow the obstacle ---

/// Certified: the bound is rounded up.
bool lies_within(const Segment& facade, Vec2 x, double distance) {
  if (x == facade.a || x == facade.b) return true;
  return distance_upper_bound(facade, x, largest_coordinate({facade.a, facade.b, x})) <= distance;
}

/// Follows one course along its facades, which start at `next` of the list and end where the course does.
class CourseWalk {
 public:
  CourseWalk(const std::vector<Vec2>& course, bool closed, const FacadeSet& set) : course_(course), set_(set) {
    steps_ = closed ? course.size() : course.size() - 1;
  }

  /// Whether every vertex keeps to its facade; moves `next` past the facades of this course.
  bool keeps(std::size_t& next) const {
    if (next >= set_.facades.size()) return false;
    const auto start = std::find(course_.begin(), course_.end(), set_.facades[next].a);
    if (start == course_.end()) return false;
    std::size_t at = static_cast<std::size_t>(start - course_.begin());
    for (std::size_t step = 0; step < steps_; ++step) {
      if (next >= set_.facades.size()) return false;
      const Segment& facade = set_.facades[next];
      at = (at + 1) % course_.size();
      if (course_[at] != facade.b) {
        if (!is_near(facade, course_[at])) return false;
        continue;
      }
      ++next;
      const bool last = step + 1 == steps_;
      if (!last && (next >= set_.facades.size() || set_.facades[next].a != facade.b)) return false;
      if (last) return true;
    }
    return steps_ == 0 && course_.size() == 1 && set_.facades[next++].b == course_[0];
  }

 private:
  bool is_near(const Segment& facade, Vec2 x) const {
    if (set_.deviation == 0.0) return lies_on(facade, x);
    return lies_within(facade, x, set_.deviation);
  }

  const std::vector<Vec2>& course_;
  const FacadeSet& set_;
  std::size_t steps_ = 0;
};

bool facades_follow(const FacadeSet& set, const Obstacle& obstacle) {
  std::size_t next = 0;
  for (const std::vector<Vec2>* course : courses_of(obstacle)) {
    if (!CourseWalk(*course, has_interior(obstacle), set).keeps(next)) return false;
  }
  return next == set.facades.size();
}

/// A wall's own edges, straight runs merged: what half-planes of pieces keep clear of must not be simplified.
void split_wall(ObstacleShapes& out) {
  const FacadeSet edges = out.facades.deviation > 0.0 ? divide_into_facades(out.obstacle) : out.facades;
  out.pieces.assign(edges.facades.begin(), edges.facades.end());
  out.pieces_cover = verdict(edges.deviation == 0.0 && facades_follow(edges, out.obstacle), "an edge is not covered");
}

/// Facades of the courses, certified to follow them.
void divide(const ShapeOptions& options, ObstacleShapes& out) {
  attempt(out.facades_follow, [&] {
    out.facades = divide_into_facades(out.obstacle, options.facades);
    const bool within = out.facades.deviation <= options.facades.tolerance;
    out.facades_follow = verdict(within && facades_follow(out.facades, out.obstacle), "a facade leaves the boundary");
  });
}

/// Convex pieces; of a wall its own edges.
void split(const ShapeOptions& options, ObstacleShapes& out) {
  attempt(out.pieces_cover, [&] {
    if (const auto* polygon = std::get_if<Polygon>(&out.obstacle)) {
      for (ConvexPolygon& piece : convex_pieces(*polygon, options.partition)) out.pieces.emplace_back(std::move(piece));
      out.pieces_cover = {true, {}};  // convex_pieces gives no partition that it has not proved
    } else {
      split_wall(out);
    }
  });
}

// --- The trap-free ellipse: along a way, or for every goal ---

/// T^2 and D of 2 T^2 <= 9 D; see `trap_free_for_every_goal`.
template <class T>
T excess_of_slenderness(const Ellipse& e) {
  const T l11(e.l11), l21(e.l21), l22(e.l22);
  const T trace = l11 * l11 + l21 * l21 + l22 * l22;
  const T det = l11 * l22;
  return T(2.0) * (trace * trace) - T(9.0) * (det * det);
}

/// The ratio of the axes that frees every goal, a little less so that rounding leaves it below sqrt(2).
constexpr double kFreeRatio = 1.41421356237309504880 * (1.0 - 0x1p-40);

/// The smallest ellipse with axes in that ratio along the smallest ellipse's axes: the smallest circle round
/// the points squeezed along the major axis.
Ellipse smallest_free_ellipse(const std::vector<Vec2>& hull, double angle) {
  std::vector<Vec2> squeezed;
  squeezed.reserve(hull.size());
  const Vec2 middle = hull.front();
  for (const Vec2 p : hull) {
    const Vec2 turned = rotated(p - middle, -angle);
    squeezed.push_back({turned.x / kFreeRatio, turned.y});
  }
  const Disc disc = smallest_circle(squeezed);
  const Vec2 center = middle + rotated({disc.center.x * kFreeRatio, disc.center.y}, angle);
  return ellipse_from_axes(center, {disc.radius * kFreeRatio, disc.radius, angle});
}

void free_for_every_goal(ObstacleShapes& out) {
  std::optional<Ellipse> free = out.smallest_ellipse;
  if (!out.ellipse_contains.certified || !trap_free_for_every_goal(*free)) {
    const Ellipse e = smallest_free_ellipse(out.hull.vertices, axes_of(out.smallest_ellipse).angle);
    free = inflate_to_contain(e, out.hull.vertices);
  }
  if (free && trap_free_for_every_goal(*free))
    out.trap_free = {free, EnclosureGrade::trap_free, true, TrapFreeAnswer::found};
}

/// Whether the robot at one end is as near to the hull as the options forbid.
bool leaves_no_room(const ShapeOptions& options, const ConvexPolygon& hull) {
  const double near = options.robot_radius + options.enclosure.clear_of_ends + options.enclosure.least_margin;
  const ConvexShape shape = hull_shape(hull.vertices);
  const auto is_near = [&](Vec2 x) { return locate({shape, x, near}, {0.0, 0.0}) != Place::outside; };
  return is_near(options.way->start) || is_near(options.way->goal);
}

/// Why the fit found none.
TrapFreeAnswer answer_without(const ShapeOptions& options, const ConvexPolygon& hull) {
  if (leaves_no_room(options, hull)) return TrapFreeAnswer::no_room;
  const StartAndGoal& way = *options.way;
  EnclosureOptions any_size = options.enclosure;
  any_size.most_inflation = std::numeric_limits<double>::max();
  const bool exists = fit_trap_free(hull.vertices, options.robot_radius, way.start, way.goal, any_size).has_value();
  return exists ? TrapFreeAnswer::too_large : TrapFreeAnswer::failed;
}

void free_along_way(const ShapeOptions& options, ObstacleShapes& out) {
  const StartAndGoal& way = *options.way;
  const auto fitted = fit_trap_free(out.hull.vertices, options.robot_radius, way.start, way.goal, options.enclosure);
  if (!fitted) {
    out.trap_free.answer = answer_without(options, out.hull);
    return;
  }
  const bool for_every_goal = trap_free_for_every_goal(fitted->ellipse);
  out.trap_free = {fitted->ellipse, fitted->grade, for_every_goal, TrapFreeAnswer::found};
}

const char* reason_of(TrapFreeAnswer answer) {
  if (answer == TrapFreeAnswer::no_room) return "the start or the goal lies too near";
  if (answer == TrapFreeAnswer::too_large)
    return "only larger ellipses than allowed leave the start and the goal outside";
  return "no such ellipse found";
}

/// The ellipse that traps no robot on its way, or on any. REQUIRES: hull and smallest ellipse are in `out`.
void enclose_free_of_traps(const ShapeOptions& options, ObstacleShapes& out) {
  attempt(out.trap_free_contains, [&] {
    if (out.hull.vertices.empty()) {
      out.trap_free_contains = {false, "no certified hull"};
      return;
    }
    options.way ? free_along_way(options, out) : free_for_every_goal(out);
    out.trap_free_contains = out.trap_free.ellipse ? verdict_of(*out.trap_free.ellipse, out)
                                                   : Verdict{false, reason_of(out.trap_free.answer)};
  });
}

}  // namespace
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

void enclose_all(ObstacleShapes& out) {
  attempt(out.ellipse_contains, [&] {
    const FastEllipse smallest = fast_smallest_ellipse(out.hull.vertices);
    out.smallest_ellipse = smallest.ellipse;
    out.measurements.least_ellipse_area = smallest.least_area;
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
  enclose_all(out);
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

bool trap_free_for_every_goal(const Ellipse& ellipse) {
  EXACTVO_REQUIRE(is_valid(ConvexShape{ellipse}), to_string(ConvexShape{ellipse}));
  return detail::filtered_sign([&](auto number) { return detail::excess_of_slenderness<decltype(number)>(ellipse); }) !=
         Sign::positive;
}

}  // namespace exactvo::geometry
