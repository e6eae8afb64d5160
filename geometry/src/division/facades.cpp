// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/facades.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "division/simplification.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/support.h"
#include "rings/ring_contacts.h"

namespace exactvo::geometry {
namespace {

// A chain of the obstacle without consecutive repeats, and which of its vertices the facades keep. A closed one starts
// at its lexicographically least vertex, which is a corner wherever the ring was started.
struct Course {
  std::vector<Vec2> points;
  bool closed = false;
  std::vector<bool> kept;

  std::size_t next(std::size_t i) const { return (i + 1) % points.size(); }
};

std::vector<Vec2> without_repeats(std::vector<Vec2> points) {
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

Course closed_course(const Ring& ring) {
  Course course;
  course.points = without_repeats(ring);
  while (course.points.size() > 1 && course.points.front() == course.points.back()) course.points.pop_back();
  course.closed = true;
  const auto least = std::min_element(course.points.begin(), course.points.end(), detail::lexicographically_less);
  std::rotate(course.points.begin(), least, course.points.end());
  return course;
}

std::vector<Course> courses_of(const Obstacle& obstacle) {
  if (const auto* polyline = std::get_if<Polyline>(&obstacle))
    return {Course{without_repeats(polyline->points), false, {}}};
  const auto& polygon = std::get<Polygon>(obstacle);
  std::vector<Course> courses = {closed_course(polygon.outer)};
  for (const Ring& hole : polygon.holes) courses.push_back(closed_course(hole));
  return courses;
}

// Whether b lies on the straight way from a to c: the vertex b is no corner.
bool is_straight(Vec2 a, Vec2 b, Vec2 c) {
  const auto less = detail::lexicographically_less;
  return orientation(a, b, c) == Sign::zero && less(a, b) == less(b, c) && b != c;
}

void keep_corners(Course& course) {
  const std::size_t n = course.points.size();
  course.kept.assign(n, true);
  Vec2 corner = course.points.front();
  for (std::size_t i = 1; i < n; ++i) {
    const bool last = i + 1 == n && !course.closed;
    course.kept[i] = last || !is_straight(corner, course.points[i], course.points[course.next(i)]);
    if (course.kept[i]) corner = course.points[i];
  }
}

void drop_unkept(Course& course) {
  std::vector<Vec2> corners;
  for (std::size_t i = 0; i < course.points.size(); ++i) {
    if (course.kept[i]) corners.push_back(course.points[i]);
  }
  course.points = std::move(corners);
  course.kept.assign(course.points.size(), true);
}

double largest_coordinate(const std::vector<Course>& courses) {
  double largest = 0.0;
  for (const Course& course : courses) largest = std::max(largest, detail::largest_coordinate(course.points));
  return largest;
}

/// Douglas and Peucker (1973) between i and j: keeps points until all others are certified within the tolerance of the
/// segments between the kept ones. Returns the largest certified distance. j may be points.size(), which stands for the
/// first point again.
double refine_gap(const std::vector<Vec2>& points, std::vector<bool>& kept, std::size_t i, std::size_t j,
                  double tolerance, double largest) {
  double deviation = 0.0;
  std::vector<std::pair<std::size_t, std::size_t>> gaps = {{i, j}};
  while (!gaps.empty()) {
    const auto [from, to] = gaps.back();
    gaps.pop_back();
    const Segment edge = {points[from], points[to < points.size() ? to : 0]};
    double most = 0.0;
    std::size_t farthest = from;
    for (std::size_t k = from + 1; k < to; ++k) {
      const double d = detail::distance_upper_bound(edge, points[k], largest);
      if (d > most) farthest = k;
      most = std::max(most, d);
    }
    if (most <= tolerance) {
      deviation = std::max(deviation, most);
      continue;
    }
    kept[farthest] = true;
    gaps.emplace_back(from, farthest);
    gaps.emplace_back(farthest, to);
  }
  return deviation;
}

double refine(Course& course, double tolerance, double largest) {
  const std::size_t n = course.points.size();
  const std::size_t end = course.closed ? n : n - 1;
  double deviation = 0.0;
  for (std::size_t i = 0; i < end;) {
    std::size_t j = i + 1;
    while (j < end && !course.kept[j]) ++j;
    deviation = std::max(deviation, refine_gap(course.points, course.kept, i, j, tolerance, largest));
    i = j;
  }
  return deviation;
}

bool each_has_enough_points(const std::vector<Course>& courses) {
  return std::all_of(courses.begin(), courses.end(),
                     [](const Course& c) { return c.points.size() >= (c.closed ? 3U : 2U); });
}

void keep_only_ends(Course& course) {
  const std::size_t n = course.points.size();
  course.kept.assign(n, false);
  course.kept.front() = true;
  if (!course.closed) course.kept.back() = true;
}

// CGAL's simplification keeps what does not cross from crossing. Where chains already meet (a self-crossing wall, rings
// that touch) there is nothing to keep, and Douglas and Peucker's rule does alone.
double simplify(std::vector<Course>& courses, double tolerance) {
  const double largest = largest_coordinate(courses);
  const double budget = tolerance - 32.0 * kUnitRoundoff * largest;  // so that CGAL's choice passes the certified bound
  for (Course& course : courses) keep_only_ends(course);
  std::vector<detail::Chain> chains;
  for (const Course& course : courses) chains.push_back({&course.points, course.closed});
  if (budget > 0.0 && each_has_enough_points(courses) && !detail::find_contact(chains)) {
    const auto kept = detail::kept_vertices(chains, budget);
    for (std::size_t i = 0; i < courses.size(); ++i) courses[i].kept = kept[i];
  }
  double deviation = 0.0;
  for (Course& course : courses) deviation = std::max(deviation, refine(course, tolerance, largest));
  return deviation;
}

bool is_usable(const Obstacle& obstacle) {
  const std::vector<Vec2> vertices = vertices_of(obstacle);
  const auto* polygon = std::get_if<Polygon>(&obstacle);
  const bool rings_filled = polygon == nullptr || std::none_of(polygon->holes.begin(), polygon->holes.end(),
                                                               [](const Ring& hole) { return hole.empty(); });
  const bool shell_filled = polygon == nullptr || !polygon->outer.empty();
  return !vertices.empty() && rings_filled && shell_filled && std::all_of(vertices.begin(), vertices.end(), is_finite);
}

}  // namespace

FacadeSet divide_into_facades(const Obstacle& obstacle, const FacadeOptions& options) {
  EXACTVO_REQUIRE(std::isfinite(options.tolerance) && options.tolerance >= 0.0, hex_text(options.tolerance));
  EXACTVO_REQUIRE(is_usable(obstacle), excerpt(vertices_of(obstacle)));
  std::vector<Course> courses = courses_of(obstacle);
  FacadeSet result;
  for (Course& course : courses) {
    keep_corners(course);
    drop_unkept(course);
  }
  if (options.tolerance > 0.0) {
    result.deviation = simplify(courses, options.tolerance);
    for (Course& course : courses) drop_unkept(course);
  }
  for (const Course& course : courses) {
    const std::vector<Vec2>& p = course.points;
    for (std::size_t i = 1; i < p.size(); ++i) result.facades.push_back({p[i - 1], p[i]});
    if ((course.closed && p.size() > 1) || p.size() == 1) result.facades.push_back({p.back(), p.front()});
  }
  return result;
}

}  // namespace exactvo::geometry
