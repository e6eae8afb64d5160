// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/rvo2.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <ostream>
#include <string>
#include <tuple>

#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/predicates.h"
#include "steering/keep_right.h"

namespace RVO {
namespace {

using exactvo::formation::Crowd;
using exactvo::formation::CrowdError;
using exactvo::formation::CrowdExplanation;
using exactvo::formation::CrowdKind;
using exactvo::formation::CrowdOptions;
using exactvo::formation::CrowdProblem;
using exactvo::formation::StepReport;
using exactvo::formation::detail::KeepRight;
using exactvo::geometry::Segment;
using exactvo::geometry::Vec2;

/// m: the finest lattice. 2^30 steps reach 4 km.
constexpr double kFinest = 0x1p-18;
/// Steps of the lattice to its end; the longest motion in a time step.
constexpr double kLatticeEnd = 0x1p30, kLongestMotion = 0x1p22;
/// Time steps at full speed that must fit before the end of a new lattice, and of one in use.
constexpr double kFitsNew = 64.0, kFitsOld = 2.0;
/// m/s, and steps of the lattice: the slowest speed limit of a crowd.
constexpr double kSlowest = 0x1p-12, kFewestSteps = 16.0;
constexpr std::size_t kMostNeighbours = 15;

Vec2 exact(const Vector2& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y())};
}

Vector2 rounded(Vec2 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y)};
}

struct Parameters {
  float neighbour_distance = 0.0F;
  std::size_t neighbours = 0;
  float time_horizon = 0.0F, time_horizon_obstacles = 0.0F, radius = 0.0F, max_speed = 0.0F;

  auto tied() const {
    return std::tie(neighbour_distance, neighbours, time_horizon, time_horizon_obstacles, radius, max_speed);
  }
  bool operator<(const Parameters& o) const { return tied() < o.tied(); }
};

struct Agent {
  Parameters parameters;
  Vector2 position, velocity, preferred;
  Vec2 at, moves;        ///< what the floats are rounded from
  bool has_met = false;  ///< another agent, in the last step
  KeepRight keep_right;
};

struct Vertex {
  Vector2 point;
  std::size_t previous, next;
};

/// The agents before a step, enough to explain it, whatever is set or added after it.
struct Before {
  std::vector<Vec2> at, moves, preferred;
  std::vector<Parameters> parameters;
  std::size_t processed = 0;  ///< vertices that were in the way: there are only more later
};

struct Explained {
  std::vector<std::size_t> agents, vertices;
  std::vector<Line> lines;
};

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

class RVOSimulator::State {
 public:
  float time_step = 0.0F, time = 0.0F;
  int threads = 1;
  std::optional<Parameters> defaults;
  Vector2 default_velocity;
  std::deque<Agent> agents;  ///< callers hold references
  std::deque<Vertex> vertices;
  std::size_t processed = 0;  ///< vertices that are in the way
  bool is_changed = true;     ///< the crowd is made anew
  StepReport report;

  /// To be set: the crowd is made anew.
  Agent& changed(std::size_t number) {
    Agent& a = agent(number);
    is_changed = true;
    return a;
  }

  Agent& agent(std::size_t number) {
    if (number < agents.size()) return agents[number];
    throw CrowdError(CrowdProblem::unknown_robot, "agent: found " + std::to_string(number) + ", expected below " +
                                                      std::to_string(agents.size()) + ", the number of agents");
  }

  const Vertex& vertex(std::size_t number) const {
    if (number < vertices.size()) return vertices[number];
    throw CrowdError(CrowdProblem::unknown_obstacle, "vertex: found " + std::to_string(number) + ", expected below " +
                                                         std::to_string(vertices.size()) + ", the number of vertices");
  }

  std::size_t add(const Vector2& position, const Parameters& parameters, const Vector2& velocity) {
    agents.push_back({parameters, position, velocity, {}, exact(position), exact(velocity), false, {}});
    is_changed = true;
    return agents.size() - 1;
  }

  void process() {
    processed = vertices.size();
    edges_.clear();
    vertex_of_.clear();
    std::vector<exactvo::geometry::Box> boxes;
    for (std::size_t k = 0; k < processed; ++k) {
      edges_.push_back({exact(vertices[k].point), exact(vertices[vertices[k].next].point)});
      vertex_of_.emplace(key_of(edges_.back()), k);
      boxes.emplace_back();
      boxes.back().add(edges_.back().a);
      boxes.back().add(edges_.back().b);
    }
    edges_by_place_ = exactvo::geometry::BoxGrid(std::move(boxes));
    is_changed = true;
  }

  void step() {
    if (is_changed || !crowd_) remake();
    std::vector<Vec2> preferred;
    preferred.reserve(agents.size());
    for (Agent& a : agents) preferred.push_back(kept_right(a));
    crowd_->set_preferred(preferred);
    Before before;
    before.preferred = std::move(preferred);
    before.parameters = parameters_of_agents();
    before.processed = processed;
    crowd_->positions(before.at);
    crowd_->velocities(before.moves);
    report = crowd_->step();
    before_ = std::move(before);
    before_options_ = crowd_->options();
    before_crowd_.reset();
    explained_.clear();
    read();
    time += time_step;
  }

  /// Agents that others hold up turn to the right: where RVO2's would pass through each other, these would stand.
  /// Agents have no goals, so they turn as much near them.
  static Vec2 kept_right(Agent& a) {
    if (!exactvo::geometry::is_finite(exact(a.preferred))) return exact(a.preferred);  // the step refuses it
    if (!a.has_met) a.keep_right = {};
    return a.keep_right.turned(exact(a.preferred), a.moves, 0.0, KeepRight::kPatience, exactvo::geometry::kInfinity,
                               1.0);
  }

  const Explained& explained(std::size_t number) {
    agent(number);
    const std::lock_guard<std::mutex> lock(explaining_);
    const auto known = explained_.find(number);
    if (known != explained_.end()) return known->second;
    Explained words;
    if (number >= before_.at.size()) return none_;  // no step since it was added
    if (!before_crowd_) {
      Crowd made(before_options_);
      fill(made, before_);
      made.set_preferred(before_.preferred);
      before_crowd_ = std::move(made);
    }
    const CrowdExplanation e = before_crowd_->explain(static_cast<exactvo::formation::RobotId>(number));
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

  bool is_visible(Vec2 from, Vec2 to, double radius) const {
    exactvo::geometry::Box window;
    window.add(from);
    window.add(to);
    const Vec2 reach{radius, radius};
    // The predicate is of the closed disc, and touching is no collision.
    const double open = std::min(std::nextafter(radius, 0.0), std::min(room_at(from, radius), room_at(to, radius)));
    bool clear = true;
    edges_by_place_.for_each_meeting({window.low - reach, window.high + reach}, [&](std::size_t k) {
      clear = clear && !intersect(edges_[k], Segment{from, to}) &&
              !(radius > 0.0 && segment_meets({edges_[k], from, open}, to - from, 1.0));
    });
    return clear;
  }

 private:
  /// m, to the nearest edge, rounded down; anything else beyond `enough`.
  double room_at(Vec2 here, double enough) const {
    constexpr double kBelow = 1.0 - 0x1p-40;
    double least = 2.0 * enough;
    edges_by_place_.for_each_within(here, enough,
                                    [&](std::size_t k) { least = std::min(least, distance(edges_[k], here)); });
    return kBelow * least;
  }

  double fastest() const {
    float most = 0.0F;
    for (const Agent& a : agents) most = std::max(most, a.parameters.max_speed);
    return static_cast<double>(most);
  }

  /// m
  double farthest() const {
    double most = 0.0;
    for (const Agent& a : agents) most = std::max({most, std::fabs(a.at.x), std::fabs(a.at.y)});
    return most;
  }

  double lattice_for(double way) const {
    double step = kFinest;
    while (step < 1.0 && (farthest() + kFitsNew * way >= kLatticeEnd * step || way > kLongestMotion * step))
      step *= 2.0;
    return step;
  }

  static CrowdKind kind_of(const Parameters& p, const CrowdOptions& options) {
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
    kind.neighbours = static_cast<int>(std::clamp<std::size_t>(p.neighbours, 1, kMostNeighbours));
    return kind;
  }

  /// A negative number stays one, and is refused.
  static double at_least(double least, float value) {
    const auto given = static_cast<double>(value);
    return given < least && given >= 0.0 ? least : given;
  }

  void remake() {
    CrowdOptions options;
    options.time_step = static_cast<double>(time_step);
    options.position_step = lattice_for(options.time_step * fastest());
    options.threads = threads;
    Crowd made(options);
    Before now;
    for (const Agent& a : agents) now.at.push_back(a.at), now.moves.push_back(a.moves);
    now.parameters = parameters_of_agents();
    now.processed = processed;
    fill(made, now);
    crowd_ = std::move(made);
    is_changed = false;
  }

  std::vector<Parameters> parameters_of_agents() const {
    std::vector<Parameters> all;
    all.reserve(agents.size());
    for (const Agent& a : agents) all.push_back(a.parameters);
    return all;
  }

  void fill(Crowd& crowd, const Before& state) const {
    for (std::size_t first = 0; first < state.processed;) {
      exactvo::geometry::Polyline line;
      std::size_t k = first;
      do {
        line.points.push_back(exact(vertices[k].point));
        k = vertices[k].next;
      } while (k != first);
      const std::size_t count = line.points.size();
      if (count > 2) line.points.push_back(line.points.front());
      crowd.add_obstacle(line);
      first += count;
    }
    const std::vector<Vec2>& moves = state.moves;
    crowd.reserve(state.at.size());
    std::map<Parameters, exactvo::formation::KindId> kinds;
    for (std::size_t i = 0; i < state.at.size(); ++i) {
      try {
        const Parameters& parameters = state.parameters[i];
        const CrowdKind kind = kind_of(parameters, crowd.options());
        auto known = kinds.find(parameters);
        if (known == kinds.end()) known = kinds.emplace(parameters, crowd.add_kind(kind)).first;
        const double speed = exactvo::geometry::norm(moves[i]);
        const double share = speed > kind.max_speed ? kind.max_speed / speed * (1.0 - 0x1p-40) : 1.0;
        crowd.add_robot(state.at[i], known->second, share * moves[i]);
      } catch (const CrowdError& e) {
        throw CrowdError(e.problem(), "agent " + std::to_string(i) + ": " + e.what());
      }
    }
  }

  /// Where agents are now; a coarser lattice is due before the end of this one.
  void read() {
    crowd_->positions(now_at_);
    crowd_->velocities(now_moves_);
    crowd_->met(now_met_);
    for (std::size_t i = 0; i < agents.size(); ++i) {
      Agent& a = agents[i];
      a.has_met = now_met_[i] != 0;
      a.at = now_at_[i];
      a.moves = now_moves_[i];
      a.position = rounded(a.at);
      a.velocity = rounded(a.moves);
    }
    const double way = static_cast<double>(time_step) * fastest();
    if (farthest() + kFitsOld * way >= kLatticeEnd * crowd_->options().position_step) is_changed = true;
  }

  std::optional<Crowd> crowd_, before_crowd_;
  Before before_;
  CrowdOptions before_options_;
  const Explained none_{};
  std::mutex explaining_;
  std::map<std::size_t, Explained> explained_;
  std::vector<Segment> edges_;  ///< by the vertex that begins them
  std::map<std::array<double, 4>, std::size_t> vertex_of_;
  exactvo::geometry::BoxGrid edges_by_place_;
  std::vector<Vec2> now_at_, now_moves_;
  std::vector<std::uint8_t> now_met_;
};

RVOSimulator::RVOSimulator() : state_(std::make_unique<State>()) {}

RVOSimulator::RVOSimulator(float timeStep, float neighborDist, std::size_t maxNeighbors, float timeHorizon,
                           float timeHorizonObst, float radius, float maxSpeed, const Vector2& velocity)
    : RVOSimulator() {
  setTimeStep(timeStep);
  setAgentDefaults(neighborDist, maxNeighbors, timeHorizon, timeHorizonObst, radius, maxSpeed, velocity);
}

RVOSimulator::~RVOSimulator() = default;

std::size_t RVOSimulator::addAgent(const Vector2& position) {
  return state_->defaults ? state_->add(position, *state_->defaults, state_->default_velocity) : RVO_ERROR;
}

std::size_t RVOSimulator::addAgent(const Vector2& position, float neighborDist, std::size_t maxNeighbors,
                                   float timeHorizon, float timeHorizonObst, float radius, float maxSpeed,
                                   const Vector2& velocity) {
  return state_->add(position, {neighborDist, maxNeighbors, timeHorizon, timeHorizonObst, radius, maxSpeed}, velocity);
}

std::size_t RVOSimulator::addObstacle(const std::vector<Vector2>& vertices) {
  const std::size_t first = state_->vertices.size(), count = vertices.size();
  if (count < 2) return RVO_ERROR;
  for (std::size_t k = 0; k < count; ++k) require_numbers("obstacle vertex " + std::to_string(k), vertices[k]);
  for (std::size_t k = 0; k < count; ++k)
    state_->vertices.push_back({vertices[k], first + (k + count - 1) % count, first + (k + 1) % count});
  return first;
}

void RVOSimulator::processObstacles() {
  state_->process();
}
void RVOSimulator::doStep() {
  state_->step();
}

std::size_t RVOSimulator::getAgentNumAgentNeighbors(std::size_t agentNo) const {
  return state_->explained(agentNo).agents.size();
}
std::size_t RVOSimulator::getAgentAgentNeighbor(std::size_t agentNo, std::size_t neighborNo) const {
  return state_->explained(agentNo).agents.at(neighborNo);
}
std::size_t RVOSimulator::getAgentNumObstacleNeighbors(std::size_t agentNo) const {
  return state_->explained(agentNo).vertices.size();
}
std::size_t RVOSimulator::getAgentObstacleNeighbor(std::size_t agentNo, std::size_t neighborNo) const {
  return state_->explained(agentNo).vertices.at(neighborNo);
}
std::size_t RVOSimulator::getAgentNumORCALines(std::size_t agentNo) const {
  return state_->explained(agentNo).lines.size();
}
const Line& RVOSimulator::getAgentORCALine(std::size_t agentNo, std::size_t lineNo) const {
  return state_->explained(agentNo).lines.at(lineNo);
}

const Vector2& RVOSimulator::getAgentPosition(std::size_t agentNo) const {
  return state_->agent(agentNo).position;
}
const Vector2& RVOSimulator::getAgentVelocity(std::size_t agentNo) const {
  return state_->agent(agentNo).velocity;
}
const Vector2& RVOSimulator::getAgentPrefVelocity(std::size_t agentNo) const {
  return state_->agent(agentNo).preferred;
}
std::size_t RVOSimulator::getAgentMaxNeighbors(std::size_t agentNo) const {
  return state_->agent(agentNo).parameters.neighbours;
}
float RVOSimulator::getAgentMaxSpeed(std::size_t agentNo) const {
  return state_->agent(agentNo).parameters.max_speed;
}
float RVOSimulator::getAgentNeighborDist(std::size_t agentNo) const {
  return state_->agent(agentNo).parameters.neighbour_distance;
}
float RVOSimulator::getAgentRadius(std::size_t agentNo) const {
  return state_->agent(agentNo).parameters.radius;
}
float RVOSimulator::getAgentTimeHorizon(std::size_t agentNo) const {
  return state_->agent(agentNo).parameters.time_horizon;
}
float RVOSimulator::getAgentTimeHorizonObst(std::size_t agentNo) const {
  return state_->agent(agentNo).parameters.time_horizon_obstacles;
}
float RVOSimulator::getGlobalTime() const {
  return state_->time;
}
float RVOSimulator::getTimeStep() const {
  return state_->time_step;
}
std::size_t RVOSimulator::getNumAgents() const {
  return state_->agents.size();
}
std::size_t RVOSimulator::getNumObstacleVertices() const {
  return state_->vertices.size();
}
const Vector2& RVOSimulator::getObstacleVertex(std::size_t vertexNo) const {
  return state_->vertex(vertexNo).point;
}
std::size_t RVOSimulator::getNextObstacleVertexNo(std::size_t vertexNo) const {
  return state_->vertex(vertexNo).next;
}
std::size_t RVOSimulator::getPrevObstacleVertexNo(std::size_t vertexNo) const {
  return state_->vertex(vertexNo).previous;
}

bool RVOSimulator::queryVisibility(const Vector2& point1, const Vector2& point2) const {
  return queryVisibility(point1, point2, 0.0F);
}
bool RVOSimulator::queryVisibility(const Vector2& point1, const Vector2& point2, float radius) const {
  require_numbers("point1", point1);
  require_numbers("point2", point2);
  require_numbers("radius", {radius, 0.0F});
  return state_->is_visible(exact(point1), exact(point2), static_cast<double>(radius));
}

void RVOSimulator::setAgentDefaults(float neighborDist, std::size_t maxNeighbors, float timeHorizon,
                                    float timeHorizonObst, float radius, float maxSpeed, const Vector2& velocity) {
  state_->defaults = {neighborDist, maxNeighbors, timeHorizon, timeHorizonObst, radius, maxSpeed};
  state_->default_velocity = velocity;
}
void RVOSimulator::setAgentPrefVelocity(std::size_t agentNo, const Vector2& prefVelocity) {
  state_->agent(agentNo).preferred = prefVelocity;
}
void RVOSimulator::setAgentPosition(std::size_t agentNo, const Vector2& position) {
  Agent& a = state_->changed(agentNo);
  a.position = position;
  a.at = exact(position);
}
void RVOSimulator::setAgentVelocity(std::size_t agentNo, const Vector2& velocity) {
  Agent& a = state_->changed(agentNo);
  a.velocity = velocity;
  a.moves = exact(velocity);
}
void RVOSimulator::setAgentMaxNeighbors(std::size_t agentNo, std::size_t maxNeighbors) {
  state_->changed(agentNo).parameters.neighbours = maxNeighbors;
}
void RVOSimulator::setAgentMaxSpeed(std::size_t agentNo, float maxSpeed) {
  state_->changed(agentNo).parameters.max_speed = maxSpeed;
}
void RVOSimulator::setAgentNeighborDist(std::size_t agentNo, float neighborDist) {
  state_->changed(agentNo).parameters.neighbour_distance = neighborDist;
}
void RVOSimulator::setAgentRadius(std::size_t agentNo, float radius) {
  state_->changed(agentNo).parameters.radius = radius;
}
void RVOSimulator::setAgentTimeHorizon(std::size_t agentNo, float timeHorizon) {
  state_->changed(agentNo).parameters.time_horizon = timeHorizon;
}
void RVOSimulator::setAgentTimeHorizonObst(std::size_t agentNo, float timeHorizonObst) {
  state_->changed(agentNo).parameters.time_horizon_obstacles = timeHorizonObst;
}
void RVOSimulator::setTimeStep(float timeStep) {
  state_->time_step = timeStep;
  state_->is_changed = true;
}
void RVOSimulator::setThreads(int threads) {
  state_->threads = threads;
  state_->is_changed = true;
}
const StepReport& RVOSimulator::getStepReport() const {
  return state_->report;
}

}  // namespace RVO
