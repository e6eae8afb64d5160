// SPDX-License-Identifier: GPL-3.0-or-later
#include "steering/guide.h"

#include <algorithm>
#include <utility>

#include "exactvo/geometry/distance.h"
#include "scene/static_field.h"

namespace exactvo::formation::detail {
namespace {

/// m: a route keeps this much more than the radius and the margin. Half-planes keep one skin more than both, so they
/// close no gap that the route passes, and one skin is left for rounding.
constexpr double kSkins = 2.0 * kContactSkin;

/// A way must be so much wider than the margins that robots keep on it: else they have to come to its very middle,
/// which they do ever more slowly.
constexpr double kPlay = 1.25;

/// Whether the course goes on with less room after its next point, and the robot is not on that piece yet.
bool is_before_narrow(const Course& course, std::size_t next, Vec2 here) {
  constexpr double kThere = 1e-3;  // m
  if (next + 1 == course.points.size() || !(course.keeps[next + 1] < course.keeps[next])) return false;
  const geometry::Segment piece{course.points[next], course.points[next + 1]};
  return norm(here - geometry::nearest_point(piece, here)) > kThere;
}

/// Which point of the piece is nearest, as a share of it.
double share_beside(Vec2 from, Vec2 piece, Vec2 here) {
  const double length2 = geometry::dot(piece, piece);
  return length2 > 0.0 ? std::clamp(geometry::dot(here - from, piece) / length2, 0.0, 1.0) : 0.0;
}

}  // namespace

Guide::Guide(const Scenario& scenario, double most_margin, double most_radius)
    : Guide(terrain_of(scenario), scenario.unreachable, most_margin, most_radius) {}

Guide::Guide(const Terrain& terrain, Unreachable unreachable, double most_margin, double most_radius)
    : unreachable_(unreachable),
      most_margin_(most_margin),
      reach_(terrain, most_margin + kSkins + most_radius),
      nearest_(reach_),
      space_(terrain.obstacles) {}

CourseAnswer Guide::course(double radius, Vec2 from, const Destination& to) {
  CourseAnswer answer = course_to(radius, from, to);
  const bool is_out_of_reach = !answer.course && answer.defect.empty() && !answer.start_is_blocked;
  if (!is_out_of_reach || unreachable_ == Unreachable::stay) return answer;
  answer.nearest = nearest_.nearest(radius, kSkins, from, to.place);
  if (answer.nearest) answer.course = course_to(radius, from, {answer.nearest->place, 0.0}).course;
  if (!answer.course) answer.nearest.reset();
  return answer;
}

bool Guide::can_go(double radius, Vec2 from, const Destination& to) {
  return space_.is_open() || reach_.reachable_place(radius + kSkins, from, to).has_value();
}

CourseAnswer Guide::course_to(double radius, Vec2 from, const Destination& to) {
  CourseAnswer answer;
  if (space_.is_open()) {
    answer.course = direct(radius, from, to);
    return answer;
  }
  std::optional<Vec2> end = reach_.reachable_place(radius + kSkins, from, to);
  if (!end && to.reach > 0.0) end = nearest_.within_reach(radius, kSkins, from, to);
  if (!end) {
    answer.why_not = why_not(radius, from, to);
    answer.start_is_blocked = !has_room(radius, from);
    return answer;
  }
  try {
    answer.course = planned(radius, from, *end, to);
  } catch (const geometry::RouteNotProven& e) {
    answer.defect = e.what();
  }
  return answer;
}

/// Without obstacles.
Course Guide::direct(double radius, Vec2 from, const Destination& to) const {
  const double keeps = radius + most_margin_ + kSkins;
  return {{from, to.place}, {keeps, keeps}, to};
}

/// REQUIRES: a way from `from` to `end` for `radius` and the skins.
Course Guide::planned(double radius, Vec2 from, Vec2 end, const Destination& to) {
  const double least = radius + kSkins, wanted = least + most_margin_;
  const Vec2 first = roomy_place_near(radius, from, wanted), last = roomy_place_near(radius, end, wanted);
  const bool has_margin = reach_.plan(wanted).is_reachable(first, last) && has_play(radius, first, last);
  // Where the way is narrow, as much of the margin as leaves play. The radius is another for every place: such plans
  // are not kept.
  const double widest = has_margin ? wanted : std::min(wanted, reach_.map().widest_radius(first, last));
  const double keeps = has_margin ? wanted : least + (widest - least) / kPlay;
  const geometry::RouteAnswer answer =
      (has_margin ? reach_.plan(wanted) : geometry::RoutePlan(reach_.map(), widest)).query(first, last);
  Course course;
  course.to = to;
  const auto add = [&](Vec2 point, double kept) {
    course.points.push_back(point);
    course.keeps.push_back(kept);
  };
  if (first != from) add(from, least);
  for (const geometry::ExactPoint& p : std::get<geometry::Route>(answer).points)
    add(p.rounded, course.points.size() == 1 && first != from ? least : keeps);
  if (last != end) add(end, least);
  return course;
}

/// Whether some way leaves more than the margin.
bool Guide::has_play(double radius, Vec2 first, Vec2 last) {
  const double wide = radius + kSkins + kPlay * most_margin_;
  if (wide > reach_.map().largest_radius()) return true;  // far more than the obstacles' size
  return reach_.plan(wide).is_reachable(roomy_place_near(radius, first, wide), roomy_place_near(radius, last, wide));
}

/// The place, or one in sight of it that is `wanted` away from everything; the place again where none is found.
Vec2 Guide::roomy_place_near(double radius, Vec2 place, double wanted) const {
  constexpr double kFarthest = 2.0;  // margins: enough for a corner
  const double least = radius + kSkins;
  if (space_.clearance(place, wanted) >= wanted) return place;
  for (const Vec2 near : places_about(place, kFarthest * most_margin_))
    if (space_.clearance(near, wanted) >= wanted && space_.is_clear(place, near, least)) return near;
  return place;
}

/// Why there is no route.
std::string Guide::why_not(double radius, Vec2 from, const Destination& to) {
  if (reach_.reachable_place(radius, from, to))
    return "the widest way leaves the robot less than " + metres(kSkins) + " of room, too little to drive";
  std::string text = reach_.why_not(radius, from, to, "the goal");
  const bool asks_for_places_about = to.reach > 0.0 && has_room(radius, from);
  if (asks_for_places_about && !reach_.is_proven_out_of_reach(radius, from, to))
    text += "; no place within " + metres(to.reach) + " of it was found that can be reached, which is no proof";
  return text;
}

/// Whether a point of the course is in sight; `next` becomes the farthest of them, counted on from where it was. A
/// robot that was pushed nearer to an obstacle sees past it as near as it stands.
bool Guide::look_ahead(Course& course, double radius, Vec2 here) const {
  const double stands = space_.clearance(here, radius + most_margin_ + kSkins);
  const auto sees = [&](std::size_t k) {
    return space_.is_clear(here, course.points[k], std::max(radius, std::min(course.keeps[k], stands)) - 0.5 * kSkins);
  };
  std::size_t next = course.next;
  while (!sees(next))
    if (next-- == 0) return false;
  while (next + 1 < course.points.size() && !is_before_narrow(course, next, here) && sees(next + 1)) ++next;
  course.next = next;
  return true;
}

/// Along the piece after the farthest point in sight as far as it is in sight.
Heading Guide::heading_on(Course& course, double radius, Vec2 here) const {
  constexpr int kHalvings = 6;  // of a piece: where a robot heads for need not be the very farthest point
  const std::size_t next = course.next;
  const auto margin = [&](std::size_t k) { return std::max(0.0, course.keeps[k] - radius - kSkins); };
  const Vec2 from = course.points[next];
  course.seen = 0.0;
  if (next + 1 == course.points.size() || is_before_narrow(course, next, here)) return {from, margin(next)};
  const double stands = space_.clearance(here, radius + most_margin_ + kSkins);
  const double clearance = std::max(radius, std::min(course.keeps[next + 1], stands)) - 0.5 * kSkins;
  const Vec2 piece = course.points[next + 1] - from;
  // From where the robot is beside the piece: halving a long one from its start can end behind the robot.
  const double beside = share_beside(from, piece, here);
  double seen = space_.is_clear(here, from + beside * piece, clearance) ? beside : 0.0, hidden = 1.0;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (seen + hidden);
    (space_.is_clear(here, from + middle * piece, clearance) ? seen : hidden) = middle;
  }
  course.seen = seen;
  return {from + seen * piece, margin(next + 1)};
}

Heading Guide::heading(Course& course, double radius, Vec2 here) {
  if (look_ahead(course, radius, here)) return heading_on(course, radius, here);
  if (!has_room(radius, here)) return {way_out(radius, here)};
  CourseAnswer again = course_to(radius, here, course.to);
  if (!again.course) return {course.points[course.next]};
  course = std::move(*again.course);
  Heading found{course.points[std::min<std::size_t>(1, course.points.size() - 1)]};
  if (look_ahead(course, radius, here)) found = heading_on(course, radius, here);
  found.is_new = true;
  return found;
}

double Guide::way_left(const Course& course, Vec2 here) const {
  const std::size_t last = course.points.size() - 1;
  const Vec2 from = course.points[course.next], to = course.points[std::min(course.next + 1, last)];
  const Vec2 place = from + course.seen * (to - from);
  double way = norm(place - here) + norm(to - place);
  for (std::size_t k = course.next + 1; k < last; ++k) way += norm(course.points[k + 1] - course.points[k]);
  return way;
}

bool Guide::has_room(double radius, Vec2 here) const {
  const double enough = radius + kSkins;
  return space_.clearance(here, enough) >= enough;
}

Vec2 Guide::way_out(double radius, Vec2 here) const {
  const double wanted = radius + 2.0 * kSkins;
  const Vec2 away = space_.from_nearest_edge(here, wanted);
  return here + (wanted - norm(away)) * geometry::normalized(away);
}

std::optional<Guide> guide_for(const Scenario& scenario, const SimulationOptions& options) {
  if (guidance_of(scenario, options) == Guidance::none) return std::nullopt;
  return std::optional<Guide>(std::in_place, scenario, takes_edges(options.method) ? 0.0 : scenario.margins.obstacle);
}

}  // namespace exactvo::formation::detail
