// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where robots head that follow proven routes (geometry/routes.h) among the static obstacles of a scene. That a route
/// exists, and that none does, is exact; which of its points a robot heads for is decided in doubles, and safety is up
/// to the half-planes, as for every preferred velocity.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/routes.h"
#include "reach/nearest_place.h"
#include "reach/reachability.h"
#include "scene/free_space.h"

namespace exactvo::formation::detail {

/// A robot's route to one of its goals, and how far it has come.
struct Course {
  std::vector<Vec2> points;   ///< m, with start and end
  std::vector<double> keeps;  ///< m, of each point: how far the piece that leads there stays from obstacles, up to
                              ///< the rounding of its ends
  Destination to;             ///< the end is its place, or one within reach of it
  std::size_t next = 0;       ///< the farthest of the points that was in sight
  double seen = 0.0;          ///< of the piece after it, how much was in sight, as a share
};

/// A course, or why there is none.
struct CourseAnswer {
  std::optional<Course> course;
  std::optional<NearestPlace> nearest = {};  ///< where the course ends that does not lead to the destination
  std::string why_not = {};                  ///< why the goal is out of reach
  std::string defect = {};                   ///< why a way that exists could not be proven: never to be seen
  bool start_is_blocked = false;             ///< it has no room where it is: moved away it may have a course
};

/// Where a robot heads now.
struct Heading {
  Vec2 place;           ///< m
  double margin = 0.0;  ///< m: what is kept from obstacles beside the radius on the way there
  bool is_new = false;  ///< the course was planned again, as nothing of it was in sight
};

class Guide {
 public:
  /// `most_margin`: what robots keep beside their radius where there is room, m. `most_radius`: of what is guided, m,
  /// beside the robots. The scenario's obstacles must outlive the guide.
  Guide(const Scenario& scenario, double most_margin, double most_radius = 0.0);
  Guide(const Terrain& terrain, Unreachable unreachable, double most_margin, double most_radius = 0.0);
  Guide(const Guide&) = delete;

  double most_margin() const { return most_margin_; }

  /// Whether a course leads to the destination itself.
  bool can_go(double radius, Vec2 from, const Destination& to);

  /// Which places can be reached at all.
  Reachability& reachability() { return reach_; }

  /// The route that leaves a robot of `radius` the margin, or most of what the widest way has. Where an end leaves
  /// less, the margin is kept on the way between. Where the destination is out of reach and the scenario says so, the
  /// course leads to the nearest place.
  CourseAnswer course(double radius, Vec2 from, const Destination& to);

  /// The farthest point of the course that a robot can see: the straight way there stays clear of obstacles. Where none
  /// is in sight, the robot was pushed off, and the course is planned again from where it is.
  Heading heading(Course& course, double radius, Vec2 here);

  /// m, straight to where the robot heads, and on along the rest of the course.
  double way_left(const Course& course, Vec2 here) const;

  /// What it goes round.
  const FreeSpace& space() const { return space_; }

  /// Whether a robot has room to plan a course.
  bool has_room(double radius, Vec2 here) const;

  /// A place straight away from the nearest obstacle, at which a robot has room. REQUIRES: it has none here.
  Vec2 way_out(double radius, Vec2 here) const;

 private:
  CourseAnswer course_to(double radius, Vec2 from, const Destination& to);
  Course direct(double radius, Vec2 from, const Destination& to) const;
  Course planned(double radius, Vec2 from, Vec2 end, const Destination& to);
  bool has_play(double radius, Vec2 first, Vec2 last);
  Vec2 roomy_place_near(double radius, Vec2 place, double wanted) const;
  std::string why_not(double radius, Vec2 from, const Destination& to);
  bool look_ahead(Course& course, double radius, Vec2 here) const;
  Heading heading_on(Course& course, double radius, Vec2 here) const;

  Unreachable unreachable_;
  double most_margin_;
  Reachability reach_;
  NearestPlaces nearest_;
  ObstacleSpace space_;
};

/// The guide of a run; nothing where its robots go without.
std::optional<Guide> guide_for(const Scenario& scenario, const SimulationOptions& options);

}  // namespace exactvo::formation::detail
