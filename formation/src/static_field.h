// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The static obstacles as one robot sees them: shapes for its method and goal, and the certified half-planes they
/// give.

#include <vector>

#include "exactvo/formation/recording.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/geometry/enclosure.h"
#include "exactvo/vo/orca_obstacle.h"

namespace exactvo::formation::detail {

/// A static half-plane with what steering wants to know of it.
struct StaticConstraint {
  RecordedConstraint recorded;
  double distance = 0.0;   ///< m, robot's rim to the shape; negative in contact
  Vec2 away;               ///< unit, from the nearest point of the shape to the robot
  std::size_t shape = 0;   ///< who it is: the same number is the same shape at every step of a run
  bool trap_free = false;  ///< the shape carries the certificate for this robot's goal
};

/// How a half-plane is asked for: the point it is built at and the velocity it is built round.
struct Viewpoint {
  Vec2 position;         ///< m
  Vec2 velocity;         ///< m/s, v_opt
  double radius = 0.0;   ///< m
  double max_speed = 0;  ///< m/s
};

/// Obstacles in parts, shared by all robots of a run.
class ObstacleLibrary {
 public:
  explicit ObstacleLibrary(const Scenario& scenario);
  const std::vector<geometry::ObstacleParts>& parts() const { return parts_; }
  const std::vector<vo::OrcaChain>& chains() const { return chains_; }
  /// How many pieces the obstacles before this one have: a number for each piece of the scene.
  std::size_t first_piece(std::size_t obstacle) const { return first_piece_[obstacle]; }
  /// How many edges the chains before this one have: a number for each edge of the scene.
  std::size_t first_edge(std::size_t chain) const { return first_edge_[chain]; }

 private:
  std::vector<geometry::ObstacleParts> parts_;
  std::vector<std::size_t> first_piece_;
  std::vector<std::size_t> first_edge_;
  std::vector<vo::OrcaChain> chains_;
};

/// What the literal paper does instead of clamping tau.
enum class HorizonRule { clamped, literal };

class StaticField {
 public:
  /// Shapes for a robot of `radius` going from `start` to `goal`.
  StaticField(const ObstacleLibrary& library, const Scenario& scenario, const SimulationOptions& options, double radius,
              Vec2 start, Vec2 goal, HorizonRule rule);

  /// Half-planes of every shape within reach, nearest first.
  std::vector<StaticConstraint> constraints(const Viewpoint& from) const;

  const std::vector<geometry::Enclosure>& enclosures() const { return enclosures_; }

 private:
  double horizon(double distance, const Viewpoint& from) const;
  void add_enclosure(const geometry::Enclosure& e, std::size_t index, const Viewpoint& from,
                     std::vector<StaticConstraint>& out) const;
  /// What a half-plane is named by: the enclosure it stands for, the shape it is built on, and that one's grade.
  struct Name {
    std::size_t enclosure;
    std::size_t piece;
    std::size_t shape;
    geometry::EnclosureGrade grade;
  };
  void add_shape(const geometry::ConvexShape& shape, const Name& name, const Viewpoint& from,
                 std::vector<StaticConstraint>& out) const;
  void add_orca(const Viewpoint& from, std::vector<StaticConstraint>& out) const;

  const ObstacleLibrary* library_;
  const Scenario* scenario_;
  Method method_;
  HorizonRule rule_;
  std::vector<geometry::Enclosure> enclosures_;
};

}  // namespace exactvo::formation::detail
