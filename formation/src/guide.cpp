// SPDX-License-Identifier: GPL-3.0-or-later
#include "guide.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "exactvo/geometry/distance.h"
#include "static_field.h"

namespace exactvo::formation::detail {
namespace {

using geometry::norm;
using geometry::RouteAnswer;
using geometry::Segment;

/// m: a route keeps this much more than the radius and the margin. Half-planes keep one skin more than both, so they
/// close no gap that the route passes, and one skin is left for rounding.
constexpr double kSkins = 2.0 * kContactSkin;

std::string metres(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g m", x);
  return text;
}

}  // namespace

Guide::Guide(const Scenario& scenario, double most_margin)
    : most_margin_(most_margin), reach_(scenario, most_margin + kSkins) {
  std::vector<geometry::Box> boxes;
  for (const SceneObstacle& o : scenario.obstacles) {
    edges_.push_back(geometry::edges_of(o.shape));
    obstacles_.emplace_back(o.shape);
    boxes.push_back(obstacles_.back().box());
  }
  by_place_ = geometry::BoxGrid(std::move(boxes));
}

CourseAnswer Guide::course(double radius, Vec2 from, const Destination& to) {
  const std::optional<Vec2> end = reach_.reachable_place(radius + kSkins, from, to);
  if (!end) return {std::nullopt, why_not(radius, from, to), !has_room(radius, from)};
  const double wanted = radius + most_margin_ + kSkins;
  const bool has_margin = reach_.plan(wanted).is_reachable(from, *end);
  const double keeps = has_margin ? wanted : reach_.map().widest_radius(from, *end);
  try {
    // The widest radius is another for every place: such plans are not kept.
    const RouteAnswer answer =
        (has_margin ? reach_.plan(wanted) : geometry::RoutePlan(reach_.map(), keeps)).query(from, *end);
    Course course;
    course.to = to;
    course.keeps = keeps;
    for (const geometry::ExactPoint& p : std::get<geometry::Route>(answer).points) course.points.push_back(p.rounded);
    return {std::move(course)};
  } catch (const geometry::RouteNotProven& e) {
    return {std::nullopt, std::string("a way exists, but none could be proven (") + e.what() + ")"};
  }
}

/// Why there is no route.
std::string Guide::why_not(double radius, Vec2 from, const Destination& to) {
  if (reach_.reachable_place(radius, from, to))
    return "the widest way leaves the robot less than " + metres(kSkins) + " of room: too little to drive";
  std::string text = reach_.why_not(radius, from, to, "the goal");
  if (to.reach > 0.0 && has_room(radius, from) && !reach_.is_proven_out_of_reach(radius, from, to))
    text += "; no place within " + metres(to.reach) + " of it was found that can be reached, which is no proof";
  return text;
}

double Guide::margin_of(const Course& course, double radius) {
  return std::max(0.0, course.keeps - radius - kSkins);
}

/// m, from the centre; beyond `enough` any number that is not less.
double Guide::clearance_at(Vec2 here, double enough) const {
  double least = enough;
  by_place_.for_each_within(here, enough, [&](std::size_t o) {
    least = std::min(least, obstacles_[o].swept_distance({here, here}, enough));
  });
  return least;
}

bool Guide::is_in_sight(Vec2 here, Vec2 there, double clearance) const {
  const Vec2 reach{clearance, clearance};
  geometry::Box box;
  box.add(here);
  box.add(there);
  bool clear = true;
  by_place_.for_each_meeting({box.low - reach, box.high + reach}, [&](std::size_t o) {
    clear = clear && obstacles_[o].swept_distance(Segment{here, there}, clearance) >= clearance;
  });
  return clear;
}

/// Whether a point of the course is in sight; `next` becomes the farthest of them, counted on from where it was.
bool Guide::look_ahead(Course& course, Vec2 here, double clearance) const {
  std::size_t next = course.next;
  while (!is_in_sight(here, course.points[next], clearance))
    if (next-- == 0) return false;
  while (next + 1 < course.points.size() && is_in_sight(here, course.points[next + 1], clearance)) ++next;
  course.next = next;
  return true;
}

/// On the piece after the farthest point in sight.
Vec2 Guide::farthest_in_sight(const Course& course, Vec2 here, double clearance) const {
  constexpr int kHalvings = 6;  // of a piece: where a robot heads for need not be the very farthest point
  const Vec2 from = course.points[course.next], piece = course.points[course.next + 1] - from;
  double seen = 0.0, hidden = 1.0;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (seen + hidden);
    (is_in_sight(here, from + middle * piece, clearance) ? seen : hidden) = middle;
  }
  return from + seen * piece;
}

Vec2 Guide::heading(Course& course, double radius, Vec2 here) {
  // A robot that was pushed nearer to an obstacle sees past it as near as it stands.
  const auto clearance = [&] {
    return std::max(radius, std::min(course.keeps, clearance_at(here, course.keeps))) - 0.5 * kSkins;
  };
  if (!look_ahead(course, here, clearance())) {
    if (!has_room(radius, here)) return way_out(radius, here);
    CourseAnswer again = this->course(radius, here, course.to);
    if (!again.course) return course.points[course.next];
    course = std::move(*again.course);
    if (!look_ahead(course, here, clearance()))
      return course.points[std::min<std::size_t>(1, course.points.size() - 1)];
  }
  return course.next + 1 == course.points.size() ? course.points.back() : farthest_in_sight(course, here, clearance());
}

bool Guide::has_room(double radius, Vec2 here) const {
  const double enough = radius + kSkins;
  return clearance_at(here, enough) >= enough;
}

Vec2 Guide::way_out(double radius, Vec2 here) const {
  const double wanted = radius + 2.0 * kSkins;
  double least = wanted;
  Vec2 away;
  by_place_.for_each_within(here, wanted, [&](std::size_t o) {
    for (const Segment& edge : edges_[o]) {
      const Vec2 from = here - geometry::nearest_point(edge, here);
      if (!(norm(from) < least)) continue;
      least = norm(from);
      away = from;
    }
  });
  return here + (wanted - least) * geometry::normalized(away);
}

std::optional<Guide> guide_for(const Scenario& scenario, const SimulationOptions& options) {
  if (guidance_of(scenario, options) == Guidance::none) return std::nullopt;
  return std::optional<Guide>(std::in_place, scenario,
                              options.method == Method::orca ? 0.0 : scenario.margins.obstacle);
}

}  // namespace exactvo::formation::detail
