// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The certified crowd (formation/crowd.h) behind the names of the RVO2 library (van den Berg, Guy, Snape, Lin,
/// Manocha; gamma.cs.unc.edu/RVO2), so that a program written for RVO2 compiles unchanged: with `exactvo/rvo2` on the
/// include path, `#include "RVO.h"` finds this file. Written afresh; nothing of RVO2 is in it.
///
/// What is different (docs/guide/rvo2.md has more):
///  - Motions are certified: Crowd's promises (1) to (3) and (7) hold in every step. Positions are whole multiples of a
///    lattice step, 2^-18 m within 4 km and finer than a float everywhere; floats are the nearest to them.
///  - Velocities differ from RVO2's by some 1e-5 m/s where the problem has one answer.
///  - Edges of obstacles are walls from both sides, whatever the order of the vertices.
///  - A pair of agents looks ahead the shorter of its two time horizons.
///  - An agent has at least 1 and at most 15 nearest neighbours, whatever maxNeighbors says, and beyond them all that
///    can be met within the step.
///  - A radius, time horizon or speed limit below what the crowd takes counts as the least that it does: a lattice
///    step, a time step, 2^-12 m/s.
///  - What RVO2 leaves undefined (NaN, agents in one place, numbers of no agent) throws formation::CrowdError.
///
/// REQUIRES: processObstacles() after the last addObstacle(), as in RVO2; a time step before the first doStep().

#include <array>
#include <cstddef>
#include <deque>
#include <iosfwd>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "exactvo/formation/crowd.h"
#include "exactvo/geometry/box_grid.h"

#ifndef RVO_EXPORT
/// Stands before declarations of RVO2; empty here.
#define RVO_EXPORT
#endif

namespace RVO {

/// What stands for "none".
inline constexpr std::size_t RVO_ERROR = static_cast<std::size_t>(-1);
/// RVO2's tolerance, for programs that use it; nothing here does.
inline constexpr float RVO_EPSILON = 0.00001F;

/// A vector of floats; arithmetic rounded.
class Vector2 {
 public:
  /// (0, 0).
  constexpr Vector2() = default;
  /// (x, y).
  constexpr Vector2(float x, float y) : x_(x), y_(y) {}

  ///@{
  /// Coordinates.
  constexpr float x() const { return x_; }
  constexpr float y() const { return y_; }
  ///@}

  /// Turned by half a turn.
  constexpr Vector2 operator-() const { return {-x_, -y_}; }
  /// The scalar product.
  constexpr float operator*(const Vector2& o) const { return x_ * o.x_ + y_ * o.y_; }
  ///@{
  /// Coordinate by coordinate.
  constexpr Vector2 operator*(float s) const { return {x_ * s, y_ * s}; }
  constexpr Vector2 operator/(float s) const { return {x_ / s, y_ / s}; }
  constexpr Vector2 operator+(const Vector2& o) const { return {x_ + o.x_, y_ + o.y_}; }
  constexpr Vector2 operator-(const Vector2& o) const { return {x_ - o.x_, y_ - o.y_}; }
  ///@}
  ///@{
  /// Whether both coordinates are equal.
  constexpr bool operator==(const Vector2& o) const { return x_ == o.x_ && y_ == o.y_; }
  constexpr bool operator!=(const Vector2& o) const { return !(*this == o); }
  ///@}
  ///@{
  /// In place, coordinate by coordinate.
  constexpr Vector2& operator*=(float s) { return *this = *this * s; }
  constexpr Vector2& operator/=(float s) { return *this = *this / s; }
  constexpr Vector2& operator+=(const Vector2& o) { return *this = *this + o; }
  constexpr Vector2& operator-=(const Vector2& o) { return *this = *this - o; }
  ///@}

 private:
  float x_ = 0.0F;
  float y_ = 0.0F;
};

/// Coordinate by coordinate.
constexpr Vector2 operator*(float s, const Vector2& v) {
  return v * s;
}
/// "(1,2.5)".
std::ostream& operator<<(std::ostream& stream, const Vector2& vector);
/// The length.
float abs(const Vector2& vector);
/// The square of the length.
constexpr float absSq(const Vector2& vector) {
  return vector * vector;
}
/// The determinant: positive where b lies counter-clockwise of a.
constexpr float det(const Vector2& a, const Vector2& b) {
  return a.x() * b.y() - a.y() * b.x();
}
/// Positive where c lies to the left of the line from a to b. Rounded.
constexpr float leftOf(const Vector2& a, const Vector2& b, const Vector2& c) {
  return det(a - c, b - a);
}
/// Of length 1. REQUIRES: not zero.
Vector2 normalize(const Vector2& vector);

/// A half-plane of velocities: what lies to the left of the line is allowed.
class Line {
 public:
  Vector2 direction;  ///< of length 1
  Vector2 point;      ///< m/s
};

/// Agents are numbered from 0 in the order in which they were added, vertices of obstacles too. SI units.
class RVOSimulator {
 public:
  /// Without defaults for agents; time step 0, to be set before doStep().
  RVOSimulator() = default;
  /// With the defaults that addAgent(position) uses; the arguments as in setAgentDefaults.
  RVOSimulator(float timeStep, float neighborDist, std::size_t maxNeighbors, float timeHorizon, float timeHorizonObst,
               float radius, float maxSpeed, const Vector2& velocity = {});
  RVOSimulator(const RVOSimulator&) = delete;
  RVOSimulator& operator=(const RVOSimulator&) = delete;

  /// With the defaults; RVO_ERROR where none were set.
  std::size_t addAgent(const Vector2& position);
  /// Distances in m, times in s, speeds in m/s. What is not finite is refused by the next step. Returns the
  /// agent's number.
  std::size_t addAgent(const Vector2& position, float neighborDist, std::size_t maxNeighbors, float timeHorizon,
                       float timeHorizonObst, float radius, float maxSpeed, const Vector2& velocity = {});
  /// A closed polygon, or with two vertices a wall: the number of its first vertex; RVO_ERROR for fewer than two.
  /// Throws CrowdError where a coordinate is no number.
  std::size_t addObstacle(const std::vector<Vector2>& vertices);
  /// From now on the obstacles added so far are in the way of agents and of queryVisibility.
  void processObstacles();
  /// Throws CrowdError; the agents are then as they were before.
  void doStep();

  ///@{
  /// Of the last step, whatever was set or added since. The first query after a step costs O(agents). Neighbours:
  /// nearest first; of obstacles those with a half-plane of their own, by the vertex that begins the edge. Lines: of
  /// obstacles, then of agents.
  std::size_t getAgentNumAgentNeighbors(std::size_t agentNo) const { return explained(agentNo).agents.size(); }
  std::size_t getAgentAgentNeighbor(std::size_t agentNo, std::size_t neighborNo) const {
    return explained(agentNo).agents.at(neighborNo);
  }
  std::size_t getAgentNumObstacleNeighbors(std::size_t agentNo) const { return explained(agentNo).vertices.size(); }
  std::size_t getAgentObstacleNeighbor(std::size_t agentNo, std::size_t neighborNo) const {
    return explained(agentNo).vertices.at(neighborNo);
  }
  std::size_t getAgentNumORCALines(std::size_t agentNo) const { return explained(agentNo).lines.size(); }
  const Line& getAgentORCALine(std::size_t agentNo, std::size_t lineNo) const {
    return explained(agentNo).lines.at(lineNo);
  }
  ///@}

  ///@{
  /// Of an agent, as it was set or as the last step left it: m, s, m/s. Throws CrowdError for a number of no agent.
  const Vector2& getAgentPosition(std::size_t agentNo) const { return agent(agentNo).position; }
  const Vector2& getAgentVelocity(std::size_t agentNo) const { return agent(agentNo).velocity; }
  const Vector2& getAgentPrefVelocity(std::size_t agentNo) const { return agent(agentNo).preferred; }
  std::size_t getAgentMaxNeighbors(std::size_t agentNo) const { return agent(agentNo).parameters.neighbours; }
  float getAgentMaxSpeed(std::size_t agentNo) const { return agent(agentNo).parameters.max_speed; }
  float getAgentNeighborDist(std::size_t agentNo) const { return agent(agentNo).parameters.neighbour_distance; }
  float getAgentRadius(std::size_t agentNo) const { return agent(agentNo).parameters.radius; }
  float getAgentTimeHorizon(std::size_t agentNo) const { return agent(agentNo).parameters.time_horizon; }
  float getAgentTimeHorizonObst(std::size_t agentNo) const { return agent(agentNo).parameters.time_horizon_obstacles; }
  ///@}
  /// s: how much time all steps took.
  float getGlobalTime() const { return time_; }
  /// s.
  float getTimeStep() const { return time_step_; }
  /// How many agents there are.
  std::size_t getNumAgents() const { return agents_.size(); }
  ///@{
  /// Vertices of obstacles: their number, places in m, and the vertices before and after along the obstacle.
  std::size_t getNumObstacleVertices() const { return vertices_.size(); }
  const Vector2& getObstacleVertex(std::size_t vertexNo) const { return vertex(vertexNo).point; }
  std::size_t getNextObstacleVertexNo(std::size_t vertexNo) const { return vertex(vertexNo).next; }
  std::size_t getPrevObstacleVertexNo(std::size_t vertexNo) const { return vertex(vertexNo).previous; }
  ///@}

  /// Whether a disc gets straight from one point to the other without an edge of an obstacle in its interior, and no
  /// edge touches the way itself. The disc has the radius, or less where a point has less room. Exact, up to the last
  /// place of the radius or a rounding of the room.
  bool queryVisibility(const Vector2& point1, const Vector2& point2, float radius = 0.0F) const;

  /// What addAgent(position) gives an agent: distances in m, times in s, speeds in m/s.
  void setAgentDefaults(float neighborDist, std::size_t maxNeighbors, float timeHorizon, float timeHorizonObst,
                        float radius, float maxSpeed, const Vector2& velocity = {});
  /// Of different agents from different threads, if need be. The others: from one thread at a time. All but the
  /// preferred velocity cost O(agents) at the next step.
  void setAgentPrefVelocity(std::size_t agentNo, const Vector2& prefVelocity) {
    agent(agentNo).preferred = prefVelocity;
  }
  ///@{
  /// Of an agent, from the next step on: m, s, m/s. Throws CrowdError for a number of no agent.
  void setAgentPosition(std::size_t agentNo, const Vector2& position);
  void setAgentVelocity(std::size_t agentNo, const Vector2& velocity);
  void setAgentMaxNeighbors(std::size_t agentNo, std::size_t maxNeighbors) {
    changed(agentNo).parameters.neighbours = maxNeighbors;
  }
  void setAgentMaxSpeed(std::size_t agentNo, float maxSpeed) { changed(agentNo).parameters.max_speed = maxSpeed; }
  void setAgentNeighborDist(std::size_t agentNo, float neighborDist) {
    changed(agentNo).parameters.neighbour_distance = neighborDist;
  }
  void setAgentRadius(std::size_t agentNo, float radius) { changed(agentNo).parameters.radius = radius; }
  void setAgentTimeHorizon(std::size_t agentNo, float timeHorizon) {
    changed(agentNo).parameters.time_horizon = timeHorizon;
  }
  void setAgentTimeHorizonObst(std::size_t agentNo, float timeHorizonObst) {
    changed(agentNo).parameters.time_horizon_obstacles = timeHorizonObst;
  }
  ///@}
  /// s, > 0.
  void setTimeStep(float timeStep);

  // What RVO2 has not.

  /// As CrowdOptions::threads; 1 at first.
  void setThreads(int threads);
  /// What happened in the last step.
  const exactvo::formation::StepReport& getStepReport() const { return report_; }

 private:
  struct Parameters {
    float neighbour_distance = 0.0F;
    std::size_t neighbours = 0;
    float time_horizon = 0.0F, time_horizon_obstacles = 0.0F, radius = 0.0F, max_speed = 0.0F;

    bool operator<(const Parameters& o) const;
  };
  struct Agent {
    Parameters parameters;
    Vector2 position, velocity, preferred;
    exactvo::geometry::Vec2 at, moves;  ///< what the floats are rounded from
  };
  using Agents = std::deque<Agent>;  // callers hold references
  struct Vertex {
    Vector2 point;
    std::size_t previous, next;
  };
  struct Explained {
    std::vector<std::size_t> agents, vertices;
    std::vector<Line> lines;
  };

  const Agent& agent(std::size_t number) const;
  Agent& agent(std::size_t number) { return const_cast<Agent&>(std::as_const(*this).agent(number)); }
  Agent& changed(std::size_t number);
  const Vertex& vertex(std::size_t number) const;
  std::size_t add(const Vector2& position, const Parameters& parameters, const Vector2& velocity);
  double room_at(exactvo::geometry::Vec2 here, double enough) const;
  double fastest() const;
  double farthest() const;
  static exactvo::formation::CrowdKind kind_of(const Parameters& p, const exactvo::formation::CrowdOptions& options);
  static std::vector<exactvo::geometry::Vec2> preferred_of(const Agents& agents);
  exactvo::formation::Crowd crowd_of(const Agents& agents, std::size_t processed,
                                     const exactvo::formation::CrowdOptions& options) const;
  void remake();
  void read();
  const Explained& explained(std::size_t number) const;

  float time_step_ = 0.0F, time_ = 0.0F;
  int threads_ = 1;
  std::optional<Parameters> defaults_;
  Vector2 default_velocity_;
  Agents agents_;
  std::deque<Vertex> vertices_;
  std::size_t processed_ = 0;  ///< vertices that are in the way
  bool is_changed_ = true;     ///< the crowd is made anew
  std::optional<exactvo::formation::Crowd> crowd_;
  exactvo::formation::StepReport report_;
  std::vector<exactvo::geometry::Segment> edges_;  ///< by the vertex that begins them
  std::map<std::array<double, 4>, std::size_t> vertex_of_;
  exactvo::geometry::BoxGrid edges_by_place_;

  // Before the last step: enough to explain it, whatever is set or added after it.
  Agents before_;
  std::size_t processed_before_ = 0;  ///< there are only more later
  exactvo::formation::CrowdOptions options_before_;
  mutable std::optional<exactvo::formation::Crowd> crowd_before_;
  mutable std::map<std::size_t, Explained> explained_;
  mutable std::mutex explaining_;
};

}  // namespace RVO
