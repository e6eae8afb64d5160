// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/rvo2.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <tuple>

#include "crowd/layout.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/predicates.h"

namespace RVO {
namespace {

using exactvo::formation::Crowd;
using exactvo::formation::CrowdError;
using exactvo::formation::CrowdExplanation;
using exactvo::formation::CrowdKind;
using exactvo::formation::CrowdOptions;
using exactvo::formation::CrowdProblem;
using exactvo::formation::KindId;
using exactvo::formation::crowd::kLatticeEnd;
using exactvo::geometry::Segment;
using exactvo::geometry::Vec2;

/// Time steps at full speed that must fit before the end of a new lattice, and of one in use.
constexpr double kFitsNew = 64.0, kFitsOld = 2.0;
/// m/s, and steps of the lattice: the slowest speed limit of a crowd.
constexpr double kSlowest = 0x1p-12, kFewestSteps = 16.0;

Vec2 exact(const Vector2& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y())};
}

Vector2 rounded(Vec2 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y)};
}

void require_numbers(const std::string& what, const Vector2& v) {
  if (std::isfinite(v.x()) && std::isfinite(v.y())) return;
  throw CrowdError(CrowdProblem::not_finite,
                   what + ": found (" + std::to_string(v.x()) + ", " + std::to_string(v.y()) + "), expected numbers");
}

Line to_line(const exactvo::geometry::HalfPlane& h) {
  Line line;
  line.direction = rounded({h.normal.y, -h.normal.x});
  line.point = rounded(h.normal * (h.offset / exactvo::geometry::squared_norm(h.normal)));
  return line;
}

/// A negative number stays one, and is refused.
double at_least(double least, float value) {
  const auto given = static_cast<double>(value);
  return given < least && given >= 0.0 ? least : given;
}

std::array<double, 4> key_of(const Segment& s) {
  return {s.a.x, s.a.y, s.b.x, s.b.y};
}

}  // namespace

std::ostream& operator<<(std::ostream& stream, const Vector2& vector) {
  return stream << '(' << vector.x() << ',' << vector.y() << ')';
}

float abs(const Vector2& vector) {
  return std::sqrt(absSq(vector));
}

Vector2 normalize(const Vector2& vector) {
  return vector / abs(vector);
}

RVOSimulator::RVOSimulator(float timeStep, float neighborDist, std::size_t maxNeighbors, float timeHorizon,
                           float timeHorizonObst, float radius, float maxSpeed, const Vector2& velocity) {
  setTimeStep(timeStep);
  setAgentDefaults(neighborDist, maxNeighbors, timeHorizon, timeHorizonObst, radius, maxSpeed, velocity);
}

bool RVOSimulator::Parameters::operator<(const Parameters& o) const {
  const auto tied = [](const Parameters& p) {
    return std::tie(p.neighbour_distance, p.neighbours, p.time_horizon, p.time_horizon_obstacles, p.radius,
                    p.max_speed);
  };
  return tied(*this) < tied(o);
}

const RVOSimulator::Agent& RVOSimulator::agent(std::size_t number) const {
  if (number < agents_.size()) return agents_[number];
  throw CrowdError(CrowdProblem::unknown_robot, "agent: found " + std::to_string(number) + ", expected below " +
                                                    std::to_string(agents_.size()) + ", the number of agents");
}

/// To be set: the crowd is made anew.
RVOSimulator::Agent& RVOSimulator::changed(std::size_t number) {
  Agent& a = agent(number);
  is_changed_ = true;
  return a;
}

const RVOSimulator::Vertex& RVOSimulator::vertex(std::size_t number) const {
  if (number < vertices_.size()) return vertices_[number];
  throw CrowdError(CrowdProblem::unknown_obstacle, "vertex: found " + std::to_string(number) + ", expected below " +
                                                       std::to_string(vertices_.size()) + ", the number of vertices");
}

std::size_t RVOSimulator::add(const Vector2& position, const Parameters& parameters, const Vector2& velocity) {
  agents_.push_back({parameters, position, velocity, {}, exact(position), exact(velocity)});
  is_changed_ = true;
  return agents_.size() - 1;
}

std::size_t RVOSimulator::addAgent(const Vector2& position) {
  return defaults_ ? add(position, *defaults_, default_velocity_) : RVO_ERROR;
}

std::size_t RVOSimulator::addAgent(const Vector2& position, float neighborDist, std::size_t maxNeighbors,
                                   float timeHorizon, float timeHorizonObst, float radius, float maxSpeed,
                                   const Vector2& velocity) {
  return add(position, {neighborDist, maxNeighbors, timeHorizon, timeHorizonObst, radius, maxSpeed}, velocity);
}

std::size_t RVOSimulator::addObstacle(const std::vector<Vector2>& vertices) {
  const std::size_t first = vertices_.size(), count = vertices.size();
  if (count < 2) return RVO_ERROR;
  for (std::size_t k = 0; k < count; ++k) require_numbers("obstacle vertex " + std::to_string(k), vertices[k]);
  for (std::size_t k = 0; k < count; ++k)
    vertices_.push_back({vertices[k], first + (k + count - 1) % count, first + (k + 1) % count});
  return first;
}

void RVOSimulator::processObstacles() {
  processed_ = vertices_.size();
  edges_.clear();
  vertex_of_.clear();
  std::vector<exactvo::geometry::Box> boxes;
  for (std::size_t k = 0; k < processed_; ++k) {
    edges_.push_back({exact(vertices_[k].point), exact(vertices_[vertices_[k].next].point)});
    vertex_of_.emplace(key_of(edges_.back()), k);
    boxes.emplace_back();
    boxes.back().add(edges_.back().a);
    boxes.back().add(edges_.back().b);
  }
  edges_by_place_ = exactvo::geometry::BoxGrid(std::move(boxes));
  is_changed_ = true;
}

// --- Steps ---

double RVOSimulator::fastest() const {
  float most = 0.0F;
  for (const Agent& a : agents_) most = std::max(most, a.parameters.max_speed);
  return static_cast<double>(most);
}

/// m
double RVOSimulator::farthest() const {
  double most = 0.0;
  for (const Agent& a : agents_) most = std::max({most, std::fabs(a.at.x), std::fabs(a.at.y)});
  return most;
}

CrowdKind RVOSimulator::kind_of(const Parameters& p, const CrowdOptions& options) {
  for (const float value : {p.neighbour_distance, p.time_horizon, p.time_horizon_obstacles, p.radius, p.max_speed})
    if (!std::isfinite(value))
      throw CrowdError(CrowdProblem::not_finite, "parameters: found " + std::to_string(value) + ", expected numbers");
  const double step = options.position_step / options.time_step;
  CrowdKind kind;
  kind.radius = at_least(options.position_step, p.radius);
  kind.max_speed = at_least(std::max(kSlowest, kFewestSteps * step), p.max_speed);
  kind.time_horizon = at_least(options.time_step, p.time_horizon);
  kind.edge_horizon = at_least(options.time_step, p.time_horizon_obstacles);
  kind.neighbour_distance = at_least(options.position_step, p.neighbour_distance);
  kind.neighbours =
      static_cast<int>(std::clamp<std::size_t>(p.neighbours, 1, exactvo::formation::crowd::kMostNeighbours));
  return kind;
}

/// Of agents among the first `processed` vertices.
Crowd RVOSimulator::crowd_of(const Agents& agents, std::size_t processed, const CrowdOptions& options) const {
  Crowd crowd(options);
  for (std::size_t first = 0; first < processed;) {
    exactvo::geometry::Polyline line;
    std::size_t k = first;
    do {
      line.points.push_back(exact(vertices_[k].point));
      k = vertices_[k].next;
    } while (k != first);
    const std::size_t count = line.points.size();
    if (count > 2) line.points.push_back(line.points.front());
    crowd.add_obstacle(line);
    first += count;
  }
  crowd.reserve(agents.size());
  std::map<Parameters, KindId> kinds;
  for (std::size_t i = 0; i < agents.size(); ++i) {
    try {
      const Agent& a = agents[i];
      const CrowdKind kind = kind_of(a.parameters, crowd.options());
      auto known = kinds.find(a.parameters);
      if (known == kinds.end()) known = kinds.emplace(a.parameters, crowd.add_kind(kind)).first;
      const double speed = exactvo::geometry::norm(a.moves);
      const double share = speed > kind.max_speed ? kind.max_speed / speed * (1.0 - 0x1p-40) : 1.0;
      crowd.add_robot(a.at, known->second, share * a.moves);
    } catch (const CrowdError& e) {
      throw CrowdError(e.problem(), "agent " + std::to_string(i) + ": " + e.what());
    }
  }
  return crowd;
}

void RVOSimulator::remake() {
  CrowdOptions options;
  options.time_step = static_cast<double>(time_step_);
  const double way = options.time_step * fastest();
  options.position_step = exactvo::formation::crowd::lattice_for(farthest() + kFitsNew * way, way);
  options.threads = threads_;
  crowd_ = crowd_of(agents_, processed_, options);
  is_changed_ = false;
}

std::vector<Vec2> RVOSimulator::preferred_of(const Agents& agents) {
  std::vector<Vec2> all;
  all.reserve(agents.size());
  for (const Agent& a : agents) all.push_back(exact(a.preferred));
  return all;
}

/// Where agents are now; a coarser lattice is due before the end of this one.
void RVOSimulator::read() {
  std::vector<Vec2> at, moves;
  crowd_->positions(at);
  crowd_->velocities(moves);
  for (std::size_t i = 0; i < agents_.size(); ++i) {
    Agent& a = agents_[i];
    a.at = at[i];
    a.moves = moves[i];
    a.position = rounded(a.at);
    a.velocity = rounded(a.moves);
  }
  const double way = static_cast<double>(time_step_) * fastest();
  if (farthest() + kFitsOld * way >= kLatticeEnd * crowd_->options().position_step) is_changed_ = true;
}

void RVOSimulator::doStep() {
  if (is_changed_ || !crowd_) remake();
  crowd_->set_preferred(preferred_of(agents_));
  report_ = crowd_->step();
  before_ = agents_;
  processed_before_ = processed_;
  options_before_ = crowd_->options();
  crowd_before_.reset();
  explained_.clear();
  read();
  time_ += time_step_;
}

const RVOSimulator::Explained& RVOSimulator::explained(std::size_t number) const {
  static const Explained kNone;
  agent(number);
  const std::lock_guard<std::mutex> lock(explaining_);
  const auto known = explained_.find(number);
  if (known != explained_.end()) return known->second;
  if (number >= before_.size()) return kNone;  // no step since it was added
  if (!crowd_before_) {
    Crowd made = crowd_of(before_, processed_before_, options_before_);
    made.set_preferred(preferred_of(before_));
    crowd_before_ = std::move(made);
  }
  Explained words;
  const CrowdExplanation e = crowd_before_->explain(static_cast<exactvo::formation::RobotId>(number));
  for (const CrowdExplanation::Edge& edge : e.edges) {
    const auto vertex = vertex_of_.find(key_of(edge.edge));
    words.vertices.push_back(vertex == vertex_of_.end() ? RVO_ERROR : vertex->second);
    words.lines.push_back(to_line(edge.half_plane));
  }
  for (const CrowdExplanation::Neighbour& neighbour : e.neighbours) {
    words.agents.push_back(neighbour.robot);
    words.lines.push_back(to_line(neighbour.half_plane));
  }
  return explained_.emplace(number, std::move(words)).first->second;
}

// --- Visibility ---

/// m, to the nearest edge, rounded down; anything else beyond `enough`.
double RVOSimulator::room_at(Vec2 here, double enough) const {
  constexpr double kBelow = 1.0 - 0x1p-40;
  double least = 2.0 * enough;
  edges_by_place_.for_each_within(here, enough,
                                  [&](std::size_t k) { least = std::min(least, distance(edges_[k], here)); });
  return kBelow * least;
}

bool RVOSimulator::queryVisibility(const Vector2& point1, const Vector2& point2, float radius) const {
  require_numbers("point1", point1);
  require_numbers("point2", point2);
  require_numbers("radius", {radius, 0.0F});
  const Vec2 from = exact(point1), to = exact(point2);
  const auto wanted = static_cast<double>(radius);
  exactvo::geometry::Box window;
  window.add(from);
  window.add(to);
  const Vec2 reach{wanted, wanted};
  // The predicate is of the closed disc, and touching is no collision.
  const double open = std::min({std::nextafter(wanted, 0.0), room_at(from, wanted), room_at(to, wanted)});
  bool clear = true;
  edges_by_place_.for_each_meeting({window.low - reach, window.high + reach}, [&](std::size_t k) {
    clear = clear && !intersect(edges_[k], Segment{from, to}) &&
            !(wanted > 0.0 && segment_meets({edges_[k], from, open}, to - from, 1.0));
  });
  return clear;
}

// --- Settings ---

void RVOSimulator::setAgentDefaults(float neighborDist, std::size_t maxNeighbors, float timeHorizon,
                                    float timeHorizonObst, float radius, float maxSpeed, const Vector2& velocity) {
  defaults_ = {neighborDist, maxNeighbors, timeHorizon, timeHorizonObst, radius, maxSpeed};
  default_velocity_ = velocity;
}

void RVOSimulator::setAgentPosition(std::size_t agentNo, const Vector2& position) {
  Agent& a = changed(agentNo);
  a.position = position;
  a.at = exact(position);
}

void RVOSimulator::setAgentVelocity(std::size_t agentNo, const Vector2& velocity) {
  Agent& a = changed(agentNo);
  a.velocity = velocity;
  a.moves = exact(velocity);
}

void RVOSimulator::setTimeStep(float timeStep) {
  time_step_ = timeStep;
  is_changed_ = true;
}

void RVOSimulator::setThreads(int threads) {
  threads_ = threads;
  is_changed_ = true;
}

}  // namespace RVO
