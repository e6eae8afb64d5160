// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The certified crowd (formation/crowd.h) behind the names of the RVO2 library (van den Berg, Guy, Snape, Lin,
/// Manocha; gamma.cs.unc.edu/RVO2), so that a program written for RVO2 compiles unchanged: with `exactvo/rvo2` on the
/// include path, `#include "RVO.h"` finds this file. Written from scratch; it contains no code of RVO2.
///
/// Differences (docs/guide/rvo2.md has more):
///  - Motions are certified: Crowd's promises (1) to (3) and (7) hold in every step. Positions are whole multiples of a
///    lattice step, 2^-18 m within 4 km and finer than a float everywhere; floats are the nearest to them.
///  - Velocities differ from RVO2's by some 1e-5 m/s where the problem has one answer.
///  - Edges of obstacles are walls from both sides, whatever the order of the vertices.
///  - A pair of agents uses the shorter of its two time horizons.
///  - An agent has at least 1 and at most 15 nearest neighbours, whatever maxNeighbors says, and in addition all agents
///    that it could meet within the step.
///  - A radius, time horizon or speed limit below the crowd's minimum counts as that minimum: a lattice step, a time
///    step, 2^-12 m/s.
///  - Input that RVO2 leaves undefined (NaN, agents in one place, unknown agent numbers) throws formation::CrowdError.
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

/// Means "none".
inline constexpr std::size_t RVO_ERROR = static_cast<std::size_t>(-1);
/// RVO2's tolerance, for programs that use it. This header does not use it.
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
/// The vector scaled to length 1. REQUIRES: not zero.
Vector2 normalize(const Vector2& vector);

/// A half-plane of velocities: those to the left of the line are allowed.
class Line {
 public:
  Vector2 direction;  ///< of length 1
  Vector2 point;      ///< m/s
};

/// Agents are numbered from 0 in the order in which they were added, vertices of obstacles too. SI units.
class RVOSimulator {
 public:
  /// Has no defaults for agents and a time step of 0, which must be set before doStep().
  RVOSimulator();
  /// Sets the defaults that addAgent(position) uses; the arguments are as in setAgentDefaults.
  RVOSimulator(float timeStep, float neighborDist, std::size_t maxNeighbors, float timeHorizon, float timeHorizonObst,
               float radius, float maxSpeed, const Vector2& velocity = {});
  ~RVOSimulator();
  RVOSimulator(const RVOSimulator&) = delete;
  RVOSimulator& operator=(const RVOSimulator&) = delete;

  /// Adds an agent with the defaults. Returns its number, or RVO_ERROR if no defaults were set.
  std::size_t addAgent(const Vector2& position);
  /// Adds an agent: distances in m, times in s, speeds in m/s. The next step refuses values that are not finite.
  /// Returns the agent's number.
  std::size_t addAgent(const Vector2& position, float neighborDist, std::size_t maxNeighbors, float timeHorizon,
                       float timeHorizonObst, float radius, float maxSpeed, const Vector2& velocity = {});
  /// Adds a closed polygon, or with two vertices a wall. Returns the number of its first vertex; RVO_ERROR for fewer
  /// than two. Throws CrowdError if a coordinate is not finite.
  std::size_t addObstacle(const std::vector<Vector2>& vertices);
  /// From now on agents and queryVisibility take the obstacles added so far into account.
  void processObstacles();
  /// Moves all agents by one time step. If it throws CrowdError, the agents stay as they were.
  void doStep();

  ///@{
  /// These describe the last step, whatever was set or added since. The first query after a step costs O(agents).
  /// Neighbours come nearest first. An obstacle neighbour is an edge with a half-plane of its own, named by the vertex
  /// that begins it. Lines against obstacles come before lines against agents.
  std::size_t getAgentNumAgentNeighbors(std::size_t agentNo) const;
  std::size_t getAgentAgentNeighbor(std::size_t agentNo, std::size_t neighborNo) const;
  std::size_t getAgentNumObstacleNeighbors(std::size_t agentNo) const;
  std::size_t getAgentObstacleNeighbor(std::size_t agentNo, std::size_t neighborNo) const;
  std::size_t getAgentNumORCALines(std::size_t agentNo) const;
  const Line& getAgentORCALine(std::size_t agentNo, std::size_t lineNo) const;
  ///@}

  ///@{
  /// An agent's value, as it was set or as the last step left it: m, s, m/s. Throws CrowdError if there is no such
  /// agent.
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
  /// s: the simulated time, summed over all steps.
  float getGlobalTime() const;
  /// s.
  float getTimeStep() const;
  /// The number of agents.
  std::size_t getNumAgents() const;
  ///@{
  /// Vertices of obstacles: their number, places in m, and the vertices before and after along the obstacle.
  std::size_t getNumObstacleVertices() const;
  const Vector2& getObstacleVertex(std::size_t vertexNo) const;
  std::size_t getNextObstacleVertexNo(std::size_t vertexNo) const;
  std::size_t getPrevObstacleVertexNo(std::size_t vertexNo) const;
  ///@}

  ///@{
  /// Whether a disc can move straight from one point to the other with no edge of an obstacle in its interior and none
  /// touching its centre's path. The disc has the radius, or a smaller one if a point has less room. Exact, up to the
  /// last place of the radius or a rounding of the room.
  bool queryVisibility(const Vector2& point1, const Vector2& point2) const;
  bool queryVisibility(const Vector2& point1, const Vector2& point2, float radius) const;
  ///@}

  /// Sets the values that addAgent(position) uses: distances in m, times in s, speeds in m/s.
  void setAgentDefaults(float neighborDist, std::size_t maxNeighbors, float timeHorizon, float timeHorizonObst,
                        float radius, float maxSpeed, const Vector2& velocity = {});
  /// Different threads may set the preferred velocities of different agents at the same time. All other setters need
  /// one thread at a time, and they cost O(agents) at the next step.
  void setAgentPrefVelocity(std::size_t agentNo, const Vector2& prefVelocity);
  ///@{
  /// Sets an agent's value from the next step on: m, s, m/s. Throws CrowdError if there is no such agent.
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

  // Additions to RVO2.

  /// As CrowdOptions::threads; 1 at first.
  void setThreads(int threads);
  /// What happened in the last step.
  const exactvo::formation::StepReport& getStepReport() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace RVO
