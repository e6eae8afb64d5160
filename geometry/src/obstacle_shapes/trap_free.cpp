// SPDX-License-Identifier: GPL-3.0-or-later
// The trap-free ellipse of an obstacle: along a way, or for every goal.
#include <algorithm>
#include <limits>
#include <optional>

#include "exact/running_error.h"
#include "exactvo/geometry/pieces.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "obstacle_shapes/steps.h"

namespace exactvo::geometry {
namespace detail {
namespace {

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

}  // namespace

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

}  // namespace detail

bool trap_free_for_every_goal(const Ellipse& ellipse) {
  EXACTVO_REQUIRE(is_valid(ConvexShape{ellipse}), to_string(ConvexShape{ellipse}));
  return detail::filtered_sign([&](auto number) { return detail::excess_of_slenderness<decltype(number)>(ellipse); }) !=
         Sign::positive;
}

}  // namespace exactvo::geometry
