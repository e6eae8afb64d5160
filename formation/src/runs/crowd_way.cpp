// SPDX-License-Identifier: GPL-3.0-or-later
#include "runs/crowd_way.h"

#include <type_traits>
#include <utility>

namespace exactvo::formation::detail {

using crowd::SnapshotReader;
using crowd::SnapshotWriter;

namespace {

void require(bool holds) {
  if (!holds) crowd::refuse_snapshot("other bytes", kSnapshotOfRun);
}

/// Writes or reads the fields: `Bytes` is a SnapshotWriter or a SnapshotReader.
template <class Bytes, class Way>
void fields_of_way(Bytes& bytes, Way& way) {
  bool has_course = way.course.has_value();
  bytes.fields(way.goal, way.heading, way.arrived, way.stays, way.why_not, way.nearest, way.keep_right.held_up,
               way.turned, has_course);
  if (!has_course) return;
  if constexpr (!std::is_const_v<Way>) way.course.emplace();
  bytes.fields(way.course->points, way.course->keeps, way.course->to, way.course->next);
}

template <class Bytes, class OfRobot>
void fields_of_claim(Bytes& bytes, OfRobot& r) {
  bytes.fields(r.has_claim, r.place, r.is_goal, r.rests, r.taken_by);
}

}  // namespace

void put(SnapshotWriter& to, const CrowdWay& way) {
  fields_of_way(to, way);
}

CrowdWay get_way(SnapshotReader& from, std::size_t goals, bool is_guided) {
  CrowdWay way;
  fields_of_way(from, way);
  require(way.goal < goals && (!way.course || is_guided));
  if (way.course)
    require(way.course->next < way.course->points.size() && way.course->keeps.size() == way.course->points.size());
  return way;
}

void put(SnapshotWriter& to, const GoalClaims& claims) {
  for (const GoalClaims::OfRobot& r : claims.remembered()) fields_of_claim(to, r);
}

void get_claims(SnapshotReader& from, GoalClaims& claims) {
  std::vector<GoalClaims::OfRobot> robots(claims.remembered().size());
  for (GoalClaims::OfRobot& r : robots) fields_of_claim(from, r);
  for (const GoalClaims::OfRobot& r : robots)
    require(r.taken_by ? *r.taken_by < robots.size() && robots[*r.taken_by].has_claim : !r.rests);
  claims.remember(std::move(robots));
}

}  // namespace exactvo::formation::detail
