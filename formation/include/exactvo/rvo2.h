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

#include <cstddef>
#include <iosfwd>
#include <memory>
#include <vector>

#include "exactvo/formation/crowd.h"

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
  RVOSimulator();
  /// With the defaults that addAgent(position) uses; the arguments as in setAgentDefaults.
  RVOSimulator(float timeStep, float neighborDist, std::size_t maxNeighbors, float timeHorizon, float timeHorizonObst,
               float radius, float maxSpeed, const Vector2& velocity = {});
  ~RVOSimulator();
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
  std::size_t getAgentNumAgentNeighbors(std::size_t agentNo) const;
  std::size_t getAgentAgentNeighbor(std::size_t agentNo, std::size_t neighborNo) const;
  std::size_t getAgentNumObstacleNeighbors(std::size_t agentNo) const;
  std::size_t getAgentObstacleNeighbor(std::size_t agentNo, std::size_t neighborNo) const;
  std::size_t getAgentNumORCALines(std::size_t agentNo) const;
  const Line& getAgentORCALine(std::size_t agentNo, std::size_t lineNo) const;
  ///@}

  ///@{
  /// Of an agent, as it was set or as the last step left it: m, s, m/s. Throws CrowdError for a number of no agent.
  const Vector2& getAgentPosition(std::size_t agentNo) const;
  const Vector2& getAgentVelocity(std::size_t agentNo) const;
  const Vector2& getAgentPrefVelocity(std::size_t agentNo) const;
  std::size_t getAgentMaxNeighbors(std::size_t agentNo) const;
  float getAgentMaxSpeed(std::size_t agentNo) const;
  float getAgentNeighborDist(std::size_t agentNo) const;
  float getAgentRadius(std::size_t agentNo) const;
  float getAgentTimeHorizon(std::size_t agentNo) const;
  float getAgentTimeHorizonObst(std::size_t agentNo) const;
  ///@}
  /// s: how much time all steps took.
  float getGlobalTime() const;
  /// s.
  float getTimeStep() const;
  /// How many agents there are.
  std::size_t getNumAgents() const;
  ///@{
  /// Vertices of obstacles: their number, places in m, and the vertices before and after along the obstacle.
  std::size_t getNumObstacleVertices() const;
  const Vector2& getObstacleVertex(std::size_t vertexNo) const;
  std::size_t getNextObstacleVertexNo(std::size_t vertexNo) const;
  std::size_t getPrevObstacleVertexNo(std::size_t vertexNo) const;
  ///@}

  ///@{
  /// Whether a disc gets straight from one point to the other without an edge of an obstacle in its interior, and no
  /// edge touches the way itself. The disc has the radius, or less where a point has less room. Exact, up to the last
  /// place of the radius or a rounding of the room.
  bool queryVisibility(const Vector2& point1, const Vector2& point2) const;
  bool queryVisibility(const Vector2& point1, const Vector2& point2, float radius) const;
  ///@}

  /// What addAgent(position) gives an agent: distances in m, times in s, speeds in m/s.
  void setAgentDefaults(float neighborDist, std::size_t maxNeighbors, float timeHorizon, float timeHorizonObst,
                        float radius, float maxSpeed, const Vector2& velocity = {});
  /// Of different agents from different threads, if need be. The others: from one thread at a time. All but the
  /// preferred velocity cost O(agents) at the next step.
  void setAgentPrefVelocity(std::size_t agentNo, const Vector2& prefVelocity);
  ///@{
  /// Of an agent, from the next step on: m, s, m/s. Throws CrowdError for a number of no agent.
  void setAgentPosition(std::size_t agentNo, const Vector2& position);
  void setAgentVelocity(std::size_t agentNo, const Vector2& velocity);
  void setAgentMaxNeighbors(std::size_t agentNo, std::size_t maxNeighbors);
  void setAgentMaxSpeed(std::size_t agentNo, float maxSpeed);
  void setAgentNeighborDist(std::size_t agentNo, float neighborDist);
  void setAgentRadius(std::size_t agentNo, float radius);
  void setAgentTimeHorizon(std::size_t agentNo, float timeHorizon);
  void setAgentTimeHorizonObst(std::size_t agentNo, float timeHorizonObst);
  ///@}
  /// s, > 0.
  void setTimeStep(float timeStep);

  // What RVO2 has not.

  /// As CrowdOptions::threads; 1 at first.
  void setThreads(int threads);
  /// What happened in the last step.
  const exactvo::formation::StepReport& getStepReport() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace RVO
