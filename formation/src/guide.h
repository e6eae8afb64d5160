// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where robots head that follow proven routes (geometry/routes.h) among the static obstacles of a scene. That a route
/// exists, and that none does, is exact; which of its points a robot heads for is decided in doubles, and safety is up
/// to the half-planes, as for every preferred velocity.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/obstacle_index.h"
#include "exactvo/geometry/routes.h"

namespace exactvo::formation::detail {

/// A robot's route to one of its goals, and how far it has come.
struct Course {
  std::vector<Vec2> points;  ///< m, with start and goal
  std::size_t next = 0;      ///< the farthest of them that was in sight
  double keeps = 0.0;        ///< m: every piece stays that far from obstacles
};

/// A course, or why there is none, in words.
struct CourseAnswer {
  std::optional<Course> course;
  std::string why_not = {};
};

class Guide {
 public:
  /// `most_margin`: what robots keep beside their radius where there is room, m.
  Guide(const Scenario& scenario, double most_margin);

  /// The route that leaves a robot of `radius` the margin, or as much of it as the widest way has.
  CourseAnswer course(double radius, Vec2 from, Vec2 to);

  /// How much of the margin the course leaves a robot of `radius`, m.
  static double margin_of(const Course& course, double radius);

  /// The farthest point of the course that a robot can see: the straight way there stays clear of obstacles. Where none
  /// is in sight, the robot was pushed off, and the course is planned again from where it is.
  Vec2 heading(Course& course, double radius, Vec2 here);

 private:
  geometry::RoutePlan plan_for(double radius);
  std::string words_of(const geometry::RouteAnswer& answer) const;
  double clearance_at(Vec2 here, double enough) const;
  bool is_in_sight(Vec2 here, Vec2 there, double clearance) const;
  bool look_ahead(Course& course, Vec2 here, double clearance) const;
  Vec2 farthest_in_sight(const Course& course, Vec2 here, double clearance) const;

  const Scenario& scenario_;
  double most_margin_;
  geometry::RouteMap map_;
  std::map<double, geometry::RoutePlan> plans_;  ///< by radius: of each robot, with its margin and without
  std::vector<geometry::ObstacleIndex> obstacles_;
  geometry::BoxGrid by_place_;
};

}  // namespace exactvo::formation::detail
