// SPDX-License-Identifier: GPL-3.0-or-later
#include "runs/crowd_way.h"

#include <cstdint>
#include <utility>

namespace exactvo::formation::detail {

using crowd::SnapshotReader;
using crowd::SnapshotWriter;

namespace {

void require(bool holds) {
  if (!holds) crowd::refuse_snapshot("other bytes", kSnapshotOfRun);
}

/// Whether there is one, then it or what stands for none.
template <class A>
void put_if_any(SnapshotWriter& to, const std::optional<A>& value) {
  to.put(value.has_value());
  to.put(value.value_or(A{}));
}
template <class A>
std::optional<A> get_if_any(SnapshotReader& from) {
  const bool is_any = from.get<bool>();
  const A value = from.get<A>();
  return is_any ? std::optional(value) : std::nullopt;
}

}  // namespace

void put_count(SnapshotWriter& to, std::size_t count) {
  to.put(static_cast<std::uint64_t>(count));
}
std::size_t get_count(SnapshotReader& from) {
  return static_cast<std::size_t>(from.get<std::uint64_t>());
}

void put(SnapshotWriter& to, const CrowdWay& way) {
  put_count(to, way.goal);
  to.put(way.heading);
  put_if_any(to, way.arrived);
  to.put(way.stays);
  to.put_list(way.why_not);
  put_if_any(to, way.nearest);
  put_count(to, way.turned);
  to.put(way.course.has_value());
  if (!way.course) return;
  to.put_list(way.course->points);
  to.put_list(way.course->keeps);
  to.put(way.course->to);
  put_count(to, way.course->next);
}

CrowdWay get_way(SnapshotReader& from, std::size_t goals, bool is_guided) {
  CrowdWay way;
  way.goal = get_count(from);
  require(way.goal < goals);
  way.heading = from.get<Vec2>();
  way.arrived = get_if_any<double>(from);
  way.stays = from.get<bool>();
  way.why_not = from.get_list<std::string>();
  way.nearest = get_if_any<NearestPlace>(from);
  way.turned = get_count(from);
  const bool has_course = from.get<bool>();
  require(!has_course || is_guided);
  if (!has_course) return way;
  Course& course = way.course.emplace();
  course.points = from.get_list<std::vector<Vec2>>();
  course.keeps = from.get_list<std::vector<double>>();
  course.to = from.get<Destination>();
  course.next = get_count(from);
  require(course.next < course.points.size() && course.keeps.size() == course.points.size());
  return way;
}

void put(SnapshotWriter& to, const GoalClaims& claims) {
  for (const GoalClaims::OfRobot& r : claims.remembered()) {
    to.put(r.has_claim);
    to.put(r.place);
    to.put(r.is_goal);
    to.put(r.rests);
    put_if_any(to, r.taken_by);
  }
}

void get_claims(SnapshotReader& from, GoalClaims& claims) {
  std::vector<GoalClaims::OfRobot> robots(claims.remembered().size());
  for (GoalClaims::OfRobot& r : robots) {
    r.has_claim = from.get<bool>();
    r.place = from.get<Vec2>();
    r.is_goal = from.get<bool>();
    r.rests = from.get<bool>();
    r.taken_by = get_if_any<std::size_t>(from);
  }
  for (const GoalClaims::OfRobot& r : robots)
    require(r.taken_by ? *r.taken_by < robots.size() && robots[*r.taken_by].has_claim : !r.rests);
  claims.remember(std::move(robots));
}

}  // namespace exactvo::formation::detail
