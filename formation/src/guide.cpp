// SPDX-License-Identifier: GPL-3.0-or-later
#include "guide.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "static_field.h"

namespace exactvo::formation::detail {
namespace {

using geometry::norm;
using geometry::RouteAnswer;
using geometry::Segment;

/// m: a route keeps this much more than the radius and the margin. Half-planes keep one skin more than both, so they
/// close no gap that the route passes, and one skin is left for rounding.
constexpr double kSkins = 2.0 * kContactSkin;

std::vector<geometry::Obstacle> shapes_of(const Scenario& scenario) {
  std::vector<geometry::Obstacle> all;
  for (const SceneObstacle& o : scenario.obstacles) all.push_back(o.shape);
  return all;
}

/// Starts, goals and their surroundings, where robots may be pushed.
geometry::RouteMapOptions reach_of(const Scenario& scenario, double margin) {
  geometry::Box box;
  for (const SceneObstacle& o : scenario.obstacles)
    for (const Vec2 p : geometry::vertices_of(o.shape)) box.add(p);
  geometry::RouteMapOptions options;
  for (const Robot& r : scenario.robots) {
    options.largest_radius = std::max(options.largest_radius, r.radius + margin + kSkins);
    for (Vec2 p : r.goals) options.largest_distance = std::max(options.largest_distance, norm(p - r.position));
    if (!scenario.obstacles.empty())
      options.largest_distance = std::max(options.largest_distance, 2.0 * geometry::distance_below(box, r.position));
  }
  options.largest_distance = 2.0 * options.largest_distance + 100.0 * options.largest_radius;
  return options;
}

std::string metres(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g m", x);
  return text;
}

}  // namespace

Guide::Guide(const Scenario& scenario, double most_margin)
    : scenario_(scenario), most_margin_(most_margin), map_(shapes_of(scenario), reach_of(scenario, most_margin)) {
  std::vector<geometry::Box> boxes;
  for (const SceneObstacle& o : scenario.obstacles) {
    obstacles_.emplace_back(o.shape);
    boxes.push_back(obstacles_.back().box());
  }
  by_place_ = geometry::BoxGrid(std::move(boxes));
}

geometry::RoutePlan Guide::plan_for(double radius) {
  return plans_.try_emplace(radius, map_, radius).first->second;
}

CourseAnswer Guide::course(double radius, Vec2 from, Vec2 to) {
  if (!map_.covers(from) || !map_.covers(to)) return {std::nullopt, "it is too far from all obstacles"};
  const double wanted = radius + most_margin_ + kSkins;
  const bool has_margin = plan_for(wanted).is_reachable(from, to);
  const double keeps = has_margin ? wanted : map_.widest_radius(from, to);
  if (keeps < radius) return {std::nullopt, words_of(plan_for(radius).query(from, to))};
  if (keeps < radius + kSkins)
    return {std::nullopt, "the widest way leaves it less than " + metres(kSkins) + " of room: too little to drive"};
  try {
    // The widest radius is another for every place: such plans are not kept.
    const RouteAnswer answer = (has_margin ? plan_for(wanted) : geometry::RoutePlan(map_, keeps)).query(from, to);
    Course course;
    course.keeps = keeps;
    for (const geometry::ExactPoint& p : std::get<geometry::Route>(answer).points) course.points.push_back(p.rounded);
    return {std::move(course), ""};
  } catch (const geometry::RouteNotProven& e) {
    return {std::nullopt, std::string("a way exists, but none could be proven (") + e.what() + ")"};
  }
}

/// Why there is no route.
std::string Guide::words_of(const RouteAnswer& answer) const {
  const auto name = [&](const geometry::EdgeName& edge) { return scenario_.obstacles[edge.obstacle].id; };
  if (const auto* blocked = std::get_if<geometry::Blocked>(&answer))
    return std::string(blocked->end == geometry::Blocked::End::start ? "it" : "the goal") +
           (blocked->inside ? " lies inside " : " is nearer than its radius to ") + name(blocked->by);
  const auto& chain = std::get<geometry::Separated>(answer).chain;
  std::size_t gaps = 0, widest = 0;
  double width = -1.0;
  for (std::size_t k = 0; k < chain.size(); ++k) {
    if (!chain[k].gap_follows) continue;
    ++gaps;
    const double mine = norm(chain[(k + 1) % chain.size()].point.rounded - chain[k].point.rounded);
    if (!(mine > width)) continue;
    width = mine;
    widest = k;
  }
  if (gaps == 0) return "obstacles without a gap lie round one of the two";
  const std::string one = name(chain[widest].on), other = name(chain[(widest + 1) % chain.size()].on);
  return "a chain of obstacles with " + std::to_string(gaps) + (gaps == 1 ? " gap" : " gaps") +
         " separates it from its goal; the widest, " + metres(width) + " at " + one +
         (one == other ? "" : " and " + other) + ", is narrower than the robot";
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
    CourseAnswer again = this->course(radius, here, course.points.back());
    if (!again.course) return course.points[course.next];
    course = std::move(*again.course);
    if (!look_ahead(course, here, clearance()))
      return course.points[std::min<std::size_t>(1, course.points.size() - 1)];
  }
  return course.next + 1 == course.points.size() ? course.points.back() : farthest_in_sight(course, here, clearance());
}

}  // namespace exactvo::formation::detail
