// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/obstacle_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "division/chain_fit.h"
#include "exact/exact_number.h"
#include "exact/running_error.h"
#include "exact/stages.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry {
namespace {

constexpr const char* kNotInside = "a point lies outside";

/// What must lie in the enclosures, and the course that the facades must keep to.
struct Subject {
  std::vector<Vec2> points;                ///< every vertex or hit, finite
  std::vector<std::vector<Vec2>> courses;  ///< rings and chains
  bool closed = false;                     ///< courses are rings
};

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

bool contains_all(const Ellipse& ellipse, const std::vector<Vec2>& points) {
  return std::all_of(points.begin(), points.end(), [&](Vec2 p) { return contains(ellipse, p); });
}

bool contains_all(const ConvexPolygon& hull, const std::vector<Vec2>& points) {
  return std::all_of(points.begin(), points.end(), [&](Vec2 p) { return contains(hull, p); });
}

// --- Facades ---

/// Certified: the bound is rounded up.
bool lies_within(const Segment& facade, Vec2 x, double distance) {
  if (x == facade.a || x == facade.b) return true;
  return detail::distance_upper_bound(facade, x, detail::largest_coordinate({facade.a, facade.b, x})) <= distance;
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
    if (set_.deviation == 0.0) return detail::lies_on(facade, x);
    return lies_within(facade, x, set_.deviation);
  }

  const std::vector<Vec2>& course_;
  const FacadeSet& set_;
  std::size_t steps_ = 0;
};

bool facades_follow(const FacadeSet& set, const Subject& subject) {
  std::size_t next = 0;
  for (const std::vector<Vec2>& course : subject.courses) {
    if (!CourseWalk(course, subject.closed, set).keeps(next)) return false;
  }
  return next == set.facades.size();
}

void divide(const Subject& subject, const ShapeOptions& options, ObstacleShapes& out) {
  attempt(out.facades_follow, [&] {
    out.facades = divide_into_facades(out.obstacle, options.facades);
    const bool within = out.facades.deviation <= options.facades.tolerance;
    out.facades_follow = verdict(within && facades_follow(out.facades, subject), "a facade leaves the boundary");
  });
}

// --- Pieces ---

/// A wall's own edges, straight runs merged: what half-planes of pieces keep clear of must not be simplified.
void split_wall(const Subject& subject, ObstacleShapes& out) {
  const FacadeSet edges = out.facades.deviation > 0.0 ? divide_into_facades(out.obstacle) : out.facades;
  out.pieces.assign(edges.facades.begin(), edges.facades.end());
  out.pieces_cover = verdict(edges.deviation == 0.0 && facades_follow(edges, subject), "an edge is not covered");
}

void split(const Subject& subject, const ShapeOptions& options, ObstacleShapes& out) {
  attempt(out.pieces_cover, [&] {
    if (const auto* polygon = std::get_if<Polygon>(&out.obstacle)) {
      for (ConvexPolygon& piece : convex_pieces(*polygon, options.partition)) out.pieces.emplace_back(std::move(piece));
      out.pieces_cover = {true, {}};  // convex_pieces gives no partition that it has not proved
    } else {
      split_wall(subject, out);
    }
  });
}

// --- Enclosures ---

void enclose_hull(const Subject& subject, ObstacleShapes& out) {
  attempt(out.hull_contains, [&] {
    out.hull = convex_hull(subject.points);
    out.hull_contains = verdict(contains_all(out.hull, subject.points), kNotInside);
  });
}

/// An ellipse holds every point iff it holds the corners of their hull.
Verdict verdict_of(const Ellipse& ellipse, const ObstacleShapes& out) {
  if (!out.hull_contains.certified) return {false, "no certified hull"};
  return verdict(contains_all(ellipse, out.hull.vertices), kNotInside);
}

void enclose_all(const ShapeOptions& options, ObstacleShapes& out) {
  attempt(out.ellipse_contains, [&] {
    if (options.exact_smallest_ellipse) {
      out.smallest_ellipse = smallest_ellipse(out.hull.vertices);
      out.figures.least_ellipse_area = area(out.smallest_ellipse);
    } else {
      const FastEllipse fast = fast_smallest_ellipse(out.hull.vertices);
      out.smallest_ellipse = fast.ellipse;
      out.figures.least_ellipse_area = fast.least_area;
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

// --- The trap-free ellipse ---

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

/// Of all ellipses with axes in that ratio along the smallest ellipse's axes, the smallest: the smallest circle round
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

/// Doubles the step until every point is inside; all three entries grow alike, so the axes keep their ratio.
std::optional<Ellipse> grown_to_contain(const Ellipse& e, const std::vector<Vec2>& points) {
  constexpr double kFirstStep = 0x1p-50;
  for (double step = 0.0; step < 1.0; step = std::max(kFirstStep, 2.0 * step)) {
    const double f = 1.0 + step;
    const Ellipse grown{e.center, e.l11 * f, e.l21 * f, e.l22 * f};
    if (contains_all(grown, points)) return grown;
  }
  return std::nullopt;
}

void free_for_every_goal(ObstacleShapes& out) {
  std::optional<Ellipse> free = out.smallest_ellipse;
  if (!out.ellipse_contains.certified || !trap_free_for_every_goal(*free)) {
    const Ellipse e = smallest_free_ellipse(out.hull.vertices, axes_of(out.smallest_ellipse).angle);
    free = grown_to_contain(e, out.hull.vertices);
  }
  if (free && trap_free_for_every_goal(*free))
    out.trap_free = {free, EnclosureGrade::trap_free, true, TrapFreeAnswer::found};
}

ConvexShape shape_of_hull(const ConvexPolygon& hull) {
  if (hull.vertices.size() > 2) return hull;
  return Segment{hull.vertices.front(), hull.vertices.back()};
}

/// Whether the robot at one end is as near to the hull as the options forbid.
bool leaves_no_room(const ShapeOptions& options, const ConvexPolygon& hull) {
  const double near = options.robot_radius + options.enclosure.clear_of_ends + options.enclosure.least_margin;
  const ConvexShape shape = shape_of_hull(hull);
  const auto is_near = [&](Vec2 x) { return locate({shape, x, near}, {0.0, 0.0}) != Place::outside; };
  return is_near(options.way->start) || is_near(options.way->goal);
}

/// Why the fit found none.
TrapFreeAnswer answer_without(const ShapeOptions& options, const ConvexPolygon& hull) {
  if (leaves_no_room(options, hull)) return TrapFreeAnswer::no_room;
  const Way& way = *options.way;
  EnclosureOptions any_size = options.enclosure;
  any_size.most_inflation = std::numeric_limits<double>::max();
  const bool exists = fit_trap_free(hull.vertices, options.robot_radius, way.start, way.goal, any_size).has_value();
  return exists ? TrapFreeAnswer::too_large : TrapFreeAnswer::failed;
}

void free_along_way(const ShapeOptions& options, ObstacleShapes& out) {
  const Way& way = *options.way;
  const auto fitted = fit_trap_free(out.hull.vertices, options.robot_radius, way.start, way.goal, options.enclosure);
  if (!fitted) {
    out.trap_free.answer = answer_without(options, out.hull);
    return;
  }
  const bool for_every_goal = trap_free_for_every_goal(fitted->ellipse);
  out.trap_free = {fitted->ellipse, fitted->grade, for_every_goal, TrapFreeAnswer::found};
}

const char* reason_of(TrapFreeAnswer answer) {
  switch (answer) {
    case TrapFreeAnswer::no_room:
      return "the start or the goal lies too near";
    case TrapFreeAnswer::too_large:
      return "only larger ellipses than allowed leave the start and the goal outside";
    case TrapFreeAnswer::found:
    case TrapFreeAnswer::failed:
      break;
  }
  return "no such ellipse found";
}

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

// --- Figures ---

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

void measure(const Subject& subject, ObstacleShapes& out) {
  ShapeFigures& f = out.figures;
  f.vertices = subject.points.size();
  f.holes = subject.closed ? subject.courses.size() - 1 : 0;
  for (const std::vector<Vec2>& course : subject.courses) {
    if (subject.closed) f.area += 0.5 * doubled_area(course);
    f.perimeter += length_of(course, subject.closed);
  }
  f.hull_area = 0.5 * doubled_area(out.hull.vertices);
  f.ellipse_area = area(out.smallest_ellipse);
  if (out.trap_free.ellipse) f.trap_free_area = area(*out.trap_free.ellipse);
  const EllipseAxes axes = axes_of(out.smallest_ellipse);
  const double reach = (axes.a - axes.b) * (axes.a + axes.b);
  f.trap_free_beyond = axes.b > 0.0 ? reach / axes.b : reach > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

void enclose_and_measure(const Subject& subject, const ShapeOptions& options, ObstacleShapes& out) {
  enclose_hull(subject, out);
  enclose_all(options, out);
  enclose_facades(options, out);
  enclose_free_of_traps(options, out);
  measure(subject, out);
}

Subject subject_of(const Obstacle& obstacle) {
  Subject subject;
  subject.points = vertices_of(obstacle);
  if (const auto* polygon = std::get_if<Polygon>(&obstacle)) {
    subject.closed = true;
    subject.courses.push_back(polygon->outer);
    subject.courses.insert(subject.courses.end(), polygon->holes.begin(), polygon->holes.end());
  } else {
    subject.courses.push_back(std::get<Polyline>(obstacle).points);
  }
  return subject;
}

/// False where something can't be mended: then there is no obstacle.
bool put_right(const Obstacle& given, ObstacleShapes& out) {
  if (const auto* polyline = std::get_if<Polyline>(&given)) {
    NormalizedPolyline normal = normalize_polyline(polyline->points);
    out.valid = normal.ok();
    out.problems = std::move(normal.problems);
    out.obstacle = std::move(normal.polyline);
    return out.valid;
  }
  const auto& polygon = std::get<Polygon>(given);
  std::vector<Ring> rings{polygon.outer};
  rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
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

std::vector<Vec2> finite_points(const std::vector<Vec2>& points) {
  std::vector<Vec2> finite;
  std::copy_if(points.begin(), points.end(), std::back_inserter(finite), [](Vec2 p) { return is_finite(p); });
  return finite;
}

/// Points stand for walls: every one lies within the deviation of its facade.
Verdict points_near_facades(const std::vector<Vec2>& points, const DividedPoints& divided) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_finite(points[i])) continue;
    const bool near =
        divided.facade_of[i] && lies_within(divided.facades[*divided.facade_of[i]], points[i], divided.deviation);
    if (!near) return {false, "a point lies off its facade"};
  }
  return {true, {}};
}

template <class Divide>
ObstacleShapes shapes_of_hits(const std::vector<Vec2>& hits, const ShapeOptions& options, const Divide& divide_hits) {
  require_sensible(options);
  ObstacleShapes out;
  const Subject subject{finite_points(hits), {}, false};
  if (subject.points.empty()) {
    out.problems.push_back({RingProblemCode::too_few_points, 0, 0, {}, false});
    return out;
  }
  out.valid = true;
  attempt(out.facades_follow, [&] {
    const DividedPoints divided = divide_hits();
    out.facades = {divided.facades, divided.deviation};
    out.facades_follow = points_near_facades(hits, divided);
  });
  if (!out.facades.facades.empty()) out.obstacle = Polyline{{out.facades.facades[0].a, out.facades.facades[0].b}};
  out.pieces.assign(out.facades.facades.begin(), out.facades.facades.end());
  out.pieces_cover = out.facades_follow;
  enclose_and_measure(subject, options, out);
  return out;
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
    if (!put_right(obstacle, out)) return out;
  } else {
    out.obstacle = obstacle;
    out.valid = true;
  }
  const Subject subject = subject_of(out.obstacle);
  divide(subject, options, out);
  split(subject, options, out);
  enclose_and_measure(subject, options, out);
  return out;
}

ObstacleShapes shapes_of_points(const std::vector<Vec2>& points, const PointOptions& how, const ShapeOptions& options) {
  return shapes_of_hits(points, options, [&] { return divide_points(points, how); });
}

ObstacleShapes shapes_of_scan(const std::vector<Vec2>& hits, const ScanOptions& how, const ShapeOptions& options) {
  return shapes_of_hits(hits, options, [&] { return divide_scan(hits, how); });
}

bool trap_free_for_every_goal(const Ellipse& ellipse) {
  EXACTVO_REQUIRE(is_valid(ConvexShape{ellipse}), to_string(ConvexShape{ellipse}));
  const detail::Tracked approx = excess_of_slenderness<detail::Tracked>(ellipse);
  if (detail::decided(approx)) {
    detail::count_filter();
    return approx.value < 0.0;
  }
  detail::count_exact();
  return detail::sign_of(excess_of_slenderness<detail::Exact>(ellipse)) != Sign::positive;
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
