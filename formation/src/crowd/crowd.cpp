// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/crowd.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "crowd/body.h"
#include "exactvo/geometry/shape_numbers.h"
#include "exactvo/vo/lp/batch.h"
#include "scene/number_text.h"

namespace exactvo::formation {

using namespace crowd;

namespace {

/// Steps after which the height of the strips follows the density.
constexpr std::uint64_t kStepsPerStripHeight = 16;

/// Neighbours that the first search is laid out for, in a crowd as dense everywhere as its bounding box.
constexpr double kFirstGuess = 1.1;

/// At least the corners of a polygon round an ellipse.
constexpr std::size_t kMostCornersRound = 32;

/// Robots on wheels, of a task: whole packs.
constexpr std::size_t kDrivenTogether = 4096;

std::string number(double x) {
  return detail::number_text(x, 17);
}

std::string words(const char* field, double found, const std::string& expected) {
  return std::string(field) + ": found " + number(found) + ", expected " + expected;
}

void require_in_range(const char* field, double x, bool holds, const std::string& expected) {
  if (!std::isfinite(x)) throw CrowdError(CrowdProblem::not_finite, words(field, x, expected));
  if (!holds) throw CrowdError(CrowdProblem::out_of_range, words(field, x, expected));
}

bool is_power_of_two(double x) {
  int exponent = 0;
  return std::frexp(x, &exponent) == 0.5;
}

}  // namespace

const char* name(CrowdPrecision precision) {
  return precision == CrowdPrecision::float_lines ? "float" : "double";
}

bool parse(const std::string& text, CrowdPrecision& out) {
  for (const CrowdPrecision p : {CrowdPrecision::float_lines, CrowdPrecision::double_lines})
    if (text == name(p)) return out = p, true;
  return false;
}

const char* name(CrowdProblem problem) {
  constexpr const char* kNames[] = {"not-finite",    "out-of-range", "beyond-lattice",   "coincident",  "too-many",
                                    "unknown-robot", "unknown-kind", "unknown-obstacle", "wrong-count", "bad-snapshot"};
  return kNames[static_cast<int>(problem)];
}

std::vector<std::size_t> in_bytes(std::vector<std::size_t> ends, std::size_t size) {
  for (std::size_t& end : ends) end *= size;
  return ends;
}

const char* crowd_target() {
  return lp::batch_target();
}

std::vector<std::size_t> share_ends(std::size_t count, int ranks) {
  const auto shares = static_cast<std::size_t>(ranks);
  std::vector<std::size_t> ends(shares);
  for (std::size_t r = 0; r < shares; ++r) ends[r] = (r + 1) * (count / shares) + std::min(r + 1, count % shares);
  return ends;
}

namespace crowd {

void require_valid(const CrowdOptions& o) {
  require_in_range("time_step", o.time_step, o.time_step >= 0x1p-20 && o.time_step <= 0x1p20, "2^-20 to 2^20 s");
  const double q = o.position_step;
  require_in_range("position_step", q, q >= 0x1p-40 && q <= 1.0 && is_power_of_two(q),
                   "a power of two in [2^-40, 1] m");
  require_in_range("threads", o.threads, o.threads >= 0 && o.threads <= 1024, "0 to 1024");
}

static void require_valid(const CrowdWheels& w, const CrowdKind& k, const CrowdOptions& o) {
  const double time_step = o.time_step, far = kLatticeEnd * o.position_step, way = k.max_speed * time_step,
               b = w.wheel_separation, a = w.max_wheel_acceleration, least_turn = 0x1p-20 / time_step;
  require_in_range("wheel_separation", b, b > 0.0, "above 0 m");
  require_in_range("reference", w.reference, w.reference >= way && 16.0 * w.reference >= b && w.reference < far,
                   "at least " + number(std::max(way, b / 16.0)) +
                       " m, max_speed times the time step and a sixteenth of wheel_separation, and below " +
                       number(far) + " m");
  if (!(a * time_step >= k.max_speed))
    require_in_range("max_wheel_acceleration", a, false,
                     "at least " + number(k.max_speed / time_step) + " m/s^2: a wheel stops within a time step");
  if (!(w.max_angular_speed >= least_turn))
    require_in_range("max_angular_speed", w.max_angular_speed, false, "at least " + number(least_turn) + " rad/s");
  if (!(w.max_backward_speed >= 0.0))
    require_in_range("max_backward_speed", w.max_backward_speed, false, "at least 0 m/s");
}

void require_valid(const CrowdKind& k, const CrowdOptions& o) {
  const double step = o.position_step / o.time_step, far = kLatticeEnd * o.position_step;
  require_in_range("radius", k.radius, k.radius > 0.0 && k.radius < far, "above 0 and below " + number(far) + " m");
  require_in_range("max_speed", k.max_speed, k.max_speed >= 16.0 * step && k.max_speed <= 0x1p22 * step,
                   number(16.0 * step) + " to " + number(0x1p22 * step) + " m/s: 16 to 2^22 steps of the lattice");
  require_in_range("max_speed", k.max_speed, k.max_speed >= 0x1p-12 && k.max_speed <= kFastest, "2^-12 to 2^15 m/s");
  require_in_range("time_horizon", k.time_horizon, k.time_horizon >= o.time_step && k.time_horizon <= 0x1p20,
                   "the time step, " + number(o.time_step) + ", to 2^20 s");
  require_in_range("neighbour_distance", k.neighbour_distance, k.neighbour_distance > 0.0, "above 0 m");
  require_in_range("edge_horizon", k.edge_horizon,
                   k.edge_horizon == 0.0 || (k.edge_horizon >= o.time_step && k.edge_horizon <= 0x1p20),
                   "0 or the time step, " + number(o.time_step) + ", to 2^20 s");
  require_in_range("neighbours", k.neighbours, k.neighbours >= 1 && k.neighbours <= kMostNeighbours, "1 to 15");
  if (k.wheels) require_valid(*k.wheels, k, o);
}

CrowdBody::CrowdBody(const CrowdOptions& options) {
  require_valid(options);
  core = make_core(options);
}

KindId CrowdBody::add_kind(const CrowdKind& kind) {
  core->changed();
  if (core->kinds.size() == kMostKinds)
    throw CrowdError(CrowdProblem::too_many, "kinds: found one more than 2^14, expected 2^14 at most");
  require_valid(kind, core->options);
  core->kinds.push_back(kind);
  kinds_changed = edges_changed = true;
  return static_cast<KindId>(core->kinds.size() - 1);
}

RobotId CrowdBody::add_robot(Vec2 position, KindId kind, Vec2 velocity) {
  core->changed();
  if (kind >= core->kinds.size())
    throw CrowdError(CrowdProblem::unknown_kind,
                     words("kind", kind, "below " + std::to_string(core->kinds.size()) + ", the number of kinds"));
  if (!geometry::is_finite(position))
    throw CrowdError(CrowdProblem::not_finite,
                     words("position", std::isfinite(position.x) ? position.y : position.x, "a number"));
  const double x = std::nearbyint(position.x / core->options.position_step);
  const double y = std::nearbyint(position.y / core->options.position_step);
  if (!(std::max(std::fabs(x), std::fabs(y)) < kLatticeEnd))
    throw CrowdError(CrowdProblem::beyond_lattice,
                     words("position", std::fabs(x) < kLatticeEnd ? position.y : position.x,
                           "less than " + number(kLatticeEnd * core->options.position_step) + " m from 0"));
  const Motion motion = motion_of(velocity, core->kinds[kind]);
  if (core->kinds[kind].wheels && motion != Motion{})
    throw CrowdError(CrowdProblem::out_of_range,
                     words("velocity", geometry::norm(velocity), "0 m/s: robots on wheels start at rest"));
  if (free_ids.empty() && id_end == kMostRobots)
    throw CrowdError(CrowdProblem::too_many, "robots: found one more than 2^30, expected 2^30 at most");
  RobotId id = id_end;
  if (free_ids.empty())
    ++id_end;
  else
    id = free_ids.back(), free_ids.pop_back();
  core->robots.append(static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), static_cast<std::int32_t>(id), kind);
  if (core->kinds[kind].wheels) core->wheels.put(static_cast<std::int32_t>(id), half_heading_of(0.0));
  core->robots.mx[core->robots.size() - 1] = motion.x;
  core->robots.my[core->robots.size() - 1] = motion.y;
  if (!places.empty()) {
    if (places.size() <= id) places.resize(id + 1, kNowhere);
    places[id] = static_cast<std::uint32_t>(core->robots.size() - 1);
  }
  unsorted = unchecked = true;
  core->forget_preference(id);
  core->reserved_ways.forget(static_cast<std::int32_t>(id));
  return id;
}

/// The motion of the lattice nearest to the velocity, within the speed limit.
Motion CrowdBody::motion_of(Vec2 velocity, const CrowdKind& kind) const {
  const double per_speed = core->options.time_step / core->options.position_step, speed = geometry::norm(velocity);
  require_in_range("velocity", speed, speed <= kind.max_speed, "at most " + number(kind.max_speed) + " m/s, max_speed");
  double x = std::nearbyint(per_speed * velocity.x), y = std::nearbyint(per_speed * velocity.y);
  if (std::hypot(x, y) > per_speed * kind.max_speed) {
    x = std::trunc(per_speed * velocity.x);
    y = std::trunc(per_speed * velocity.y);
  }
  return {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
}

std::size_t CrowdBody::place_of(RobotId robot) {
  if (places.empty()) {
    places.assign(id_end, kNowhere);
    for (std::size_t i = 0; i < core->robots.size(); ++i)
      places[static_cast<std::size_t>(core->robots.id[i])] = static_cast<std::uint32_t>(i);
  }
  if (robot >= places.size() || places[robot] == kNowhere)
    throw CrowdError(CrowdProblem::unknown_robot, "robot " + std::to_string(robot) + ": found no robot of this id");
  return places[robot];
}

const WheelState& CrowdBody::wheels_of(RobotId robot) {
  const std::size_t at = place_of(robot);
  if (!core->kinds[core->robots.kind(at)].wheels)
    throw CrowdError(CrowdProblem::out_of_range,
                     "robot " + std::to_string(robot) + ": found a kind without wheels, expected one that has some");
  return core->wheels.state(static_cast<std::int32_t>(robot));
}

void CrowdBody::set_heading(RobotId robot, double degrees) {
  wheels_of(robot);
  require_in_range("heading", degrees, std::fabs(degrees) <= 0x1p20, "degrees, at most 2^20");
  const std::size_t at = place_of(robot);
  if (core->robots.mx[at] != 0 || core->robots.my[at] != 0)
    throw CrowdError(CrowdProblem::out_of_range,
                     "heading of robot " + std::to_string(robot) + ": found a robot that moves, expected one at rest");
  core->changed();
  core->wheels.put(static_cast<std::int32_t>(robot), half_heading_of(degrees));
}

/// As robots are about to move.
void CrowdBody::drive_wheels() {
  if (core->wheels.empty()) return;
  core->tasks.for_ranges(core->robots.size(), kDrivenTogether, [&](std::size_t first, std::size_t last, int) {
    core->wheels.drive(core->robots, first, last);
  });
}

void CrowdBody::remove_robot(RobotId robot) {
  core->changed();
  const std::size_t at = place_of(robot);
  const auto last = static_cast<RobotId>(core->robots.id[core->robots.size() - 1]);
  core->robots.remove(at);
  places[last] = static_cast<std::uint32_t>(at);
  places[robot] = kNowhere;
  free_ids.push_back(robot);
  core->reserved_ways.forget(static_cast<std::int32_t>(robot));
  unsorted = true;
}

/// How far the first search goes where nothing is known: the mean distance of the last neighbour in a crowd that fills
/// its bounding box evenly.
void CrowdBody::guess_hints() {
  Robots& r = core->robots;
  const Window w = r.bounds();
  const double area = static_cast<double>(w.x1 - w.x0 + 1) * static_cast<double>(w.y1 - w.y0 + 1);
  const double each = area / (3.14159 * static_cast<double>(r.size()));
  for (std::size_t i = 0; i < r.size(); ++i) {
    if (!is_new(i)) continue;  // a guess does not hang on earlier ones
    const CrowdKind& kind = core->kinds[r.tag[i] & Robots::kKind];
    const double guess = kFirstGuess * std::sqrt(each * kind.neighbours);
    r.hint[i] = static_cast<std::int32_t>(
        std::clamp(guess, 1.0, std::min(0x1p30, kind.neighbour_distance / core->options.position_step + 1.0)));
  }
  follow_density();
}

void CrowdBody::follow_density() {
  core->robots.follow_density(kLeastStrip / core->options.position_step, 0x1p30);
}

/// Neighbours in the order are the only ones that can stand in one place.
void CrowdBody::require_apart() const {
  const Robots& r = core->robots;
  for (std::size_t i = 0; i + 1 < r.size(); ++i) {
    if (r.x[i] != r.x[i + 1]) continue;
    for (std::size_t j = i + 1; j < r.size() && r.x[j] == r.x[i]; ++j)
      if (r.y[j] == r.y[i] && (is_new(i) || is_new(j)))
        throw CrowdError(CrowdProblem::coincident,
                         "robots " + std::to_string(r.id[i]) + " and " + std::to_string(r.id[j]) + ": found both at (" +
                             number(core->options.position_step * r.x[i]) + ", " +
                             number(core->options.position_step * r.y[i]) + "), expected each in a place of its own");
  }
}

/// Edges, and corners of bodies.
std::size_t CrowdBody::obstacle_size() const {
  std::size_t count = 0;
  for (const auto& [id, edges] : obstacles) count += edges.size();
  for (const Body& b : core->bodies.all()) count += b.corners.size();
  return count;
}

ObstacleId CrowdBody::add_obstacle(const geometry::Obstacle& obstacle) {
  core->changed();
  std::vector<geometry::Segment> added = geometry::edges_of(obstacle);
  if (obstacle_size() + added.size() > kMostEdgesOfAll)
    throw CrowdError(CrowdProblem::too_many, "edges: found more than 2^24, expected 2^24 at most");
  for (const geometry::Segment& e : added)
    for (const double v : {e.a.x, e.a.y, e.b.x, e.b.y})
      require_in_range("obstacle", v, std::fabs(v) < kFarthestEdge, "coordinates below 2^40 m");
  obstacles.emplace(next_obstacle, std::move(added));
  edges_changed = true;
  return next_obstacle++;
}

void require_valid(const geometry::ConvexShape& shape) {
  for (const double v : geometry::numbers_of(shape))
    require_in_range("body", v, std::fabs(v) < kFarthestEdge, "numbers below 2^40 m");
  if (!geometry::is_valid(shape))
    throw CrowdError(CrowdProblem::out_of_range,
                     "body: found " + geometry::to_string(shape) +
                         ", expected a radius that is not negative, a convex polygon counter-clockwise");
}

ObstacleId CrowdBody::add_body(const geometry::ConvexShape& shape, bool moves, Vec2 velocity) {
  core->changed();
  require_valid(shape);
  const auto [mx, my] = body_motion(velocity);
  if (obstacle_size() + kMostCornersRound + geometry::numbers_of(shape).size() > kMostEdgesOfAll)
    throw CrowdError(CrowdProblem::too_many, "edges and corners: found more than 2^24, expected 2^24 at most");
  Body& body = core->bodies.add(next_obstacle, shape, moves);
  body.mx = mx, body.my = my;
  return next_obstacle++;
}

std::pair<std::int32_t, std::int32_t> CrowdBody::body_motion(Vec2 velocity) const {
  const CrowdOptions& o = core->options;
  const double most = std::min(kFastest, kLongestMotion * o.position_step / o.time_step);
  for (const double v : {velocity.x, velocity.y})
    require_in_range("velocity of a body", v, std::fabs(v) <= most, "at most " + number(most) + " m/s");
  const double per_speed = o.time_step / o.position_step;
  return {static_cast<std::int32_t>(std::nearbyint(per_speed * velocity.x)),
          static_cast<std::int32_t>(std::nearbyint(per_speed * velocity.y))};
}

void CrowdBody::set_body_velocity(ObstacleId id, Vec2 velocity) {
  core->changed();
  if (!body(id).moves)
    throw CrowdError(CrowdProblem::unknown_obstacle,
                     "body " + std::to_string(id) + ": found one at rest, expected one that moves");
  const auto [mx, my] = body_motion(velocity);
  core->bodies.find(id)->mx = mx;
  core->bodies.find(id)->my = my;
}

const Body& CrowdBody::body(ObstacleId id) const {
  const Body* found = std::as_const(core->bodies).find(id);
  if (!found)
    throw CrowdError(CrowdProblem::unknown_obstacle, "body " + std::to_string(id) + ": found no body of this id");
  return *found;
}

void CrowdBody::remove_obstacle(ObstacleId obstacle) {
  core->changed();
  if (core->bodies.remove(obstacle)) return;
  if (obstacles.erase(obstacle) == 0)
    throw CrowdError(CrowdProblem::unknown_obstacle,
                     "obstacle " + std::to_string(obstacle) + ": found no obstacle of this id");
  edges_changed = true;
}

void CrowdBody::lay_out_edges() {
  if (!edges_changed) return;
  double reach = 0.0;
  for (const CrowdKind& k : core->kinds) reach = std::max(reach, edge_horizon(k) * k.max_speed + k.radius);
  std::vector<geometry::Segment> all;
  for (const auto& [id, edges] : obstacles) all.insert(all.end(), edges.begin(), edges.end());
  core->edges.set_edges(std::move(all));
  core->edges.lay_out(reach * (1.0 + 0x1p-10));
  edges_changed = false;
}

void CrowdBody::make_ready() {
  if (kinds_changed) core->take_kinds();
  kinds_changed = false;
  lay_out_edges();
  core->bodies.lay_out();
  if (!unsorted) return;
  Robots& r = core->robots;
  const Timed timed(core->options.time_phases, core->phases.sort);
  if (unchecked) {
    places.clear();
    r.shrink();
    r.sort(core->tasks);
    require_apart();
    guess_hints();
    unchecked = false;
  }
  r.sort(core->tasks);
  places.clear();
  unsorted = false;
}

/// Looks at every robot only where one could be near the end.
void CrowdBody::require_on_lattice() const {
  const Robots& r = core->robots;
  const Window w = r.bounds();
  const std::int64_t safe = kLatticeEnd - (std::int64_t{1} << 23);
  if (w.x0 > -safe && w.y0 > -safe && w.x1 < safe && w.y1 < safe) return;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const std::int64_t x = std::int64_t{r.x[i]} + r.next_mx[i], y = std::int64_t{r.y[i]} + r.next_my[i];
    if (std::max(std::abs(x), std::abs(y)) >= kLatticeEnd)
      throw CrowdError(CrowdProblem::beyond_lattice, "robot " + std::to_string(r.id[i]) + ": found a step beyond " +
                                                         number(kLatticeEnd * core->options.position_step) +
                                                         " m, expected positions below it");
  }
}

StepReport CrowdBody::step() {
  make_ready();
  const StepReport report = core->decide();
  require_on_lattice();
  for (const Body& b : core->bodies.all())
    if (std::max(std::abs(b.x), std::abs(b.y)) >= kFarthestBody)
      throw CrowdError(CrowdProblem::beyond_lattice, "body " + std::to_string(b.id) +
                                                         ": found 2^50 steps of the lattice "
                                                         "from where it was added, expected fewer");
  drive_wheels();
  core->robots.move(core->tasks);
  core->bodies.move();
  core->changed();
  if (steps++ % kStepsPerStripHeight == 0) follow_density();
  unsorted = true;
  places.clear();
  return report;
}

std::uint64_t CrowdBody::digest() const {
  const Robots& r = core->robots;
  std::vector<std::uint32_t> at(id_end, kNowhere);
  for (std::size_t i = 0; i < r.size(); ++i) at[static_cast<std::size_t>(r.id[i])] = static_cast<std::uint32_t>(i);
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a, a word at a time
  const auto add = [&](std::int64_t value) { hash = (hash ^ static_cast<std::uint64_t>(value)) * 1099511628211ULL; };
  for (const std::uint32_t i : at) {
    if (i == kNowhere) {
      add(-1);
      continue;
    }
    const std::int32_t kept = (r.tag[i] & Robots::kKept) != 0;
    for (const std::int32_t value : {r.x[i], r.y[i], r.mx[i], r.my[i], r.tag[i] & Robots::kKind, kept}) add(value);
    if (!core->kinds[r.kind(i)].wheels) continue;
    const WheelState& wheels = core->wheels.state(r.id[i]);
    for (const double half : {wheels.a, wheels.b}) add(std::llround(half * 0x1p52));
  }
  for (const Body& b : core->bodies.all())
    if (b.moves)
      for (const std::int64_t value : {std::int64_t{b.id}, b.x, b.y, std::int64_t{b.mx}, std::int64_t{b.my}})
        add(value);
  return hash;
}

}  // namespace crowd

Crowd::Crowd(const CrowdOptions& options) : body_(std::make_unique<CrowdBody>(options)) {}
Crowd::Crowd(std::unique_ptr<CrowdBody> body) : body_(std::move(body)) {}
Crowd::~Crowd() = default;
Crowd::Crowd(Crowd&&) noexcept = default;
Crowd& Crowd::operator=(Crowd&&) noexcept = default;

KindId Crowd::add_kind(const CrowdKind& kind) {
  return body_->add_kind(kind);
}
RobotId Crowd::add_robot(Vec2 position, KindId kind, Vec2 velocity) {
  return body_->add_robot(position, kind, velocity);
}
void Crowd::reserve(std::size_t robots) {
  body_->core->robots.reserve(robots);
}
void Crowd::set_heading(RobotId robot, double degrees) {
  body_->set_heading(robot, degrees);
}
void Crowd::remove_robot(RobotId robot) {
  body_->remove_robot(robot);
}
ObstacleId Crowd::add_obstacle(const geometry::Obstacle& obstacle) {
  return body_->add_obstacle(obstacle);
}
ObstacleId Crowd::add_body(const geometry::ConvexShape& shape) {
  return body_->add_body(shape, false, {});
}
ObstacleId Crowd::add_moving_body(const geometry::ConvexShape& shape, Vec2 velocity) {
  return body_->add_body(shape, true, velocity);
}
void Crowd::set_body_velocity(ObstacleId body, Vec2 velocity) {
  body_->set_body_velocity(body, velocity);
}
Vec2 Crowd::body_velocity(ObstacleId body) const {
  return body_->core->bodies.velocity_of(body_->body(body));
}
Vec2 Crowd::body_displacement(ObstacleId body) const {
  const Body& b = body_->body(body);
  return options().position_step * Vec2{static_cast<double>(b.x), static_cast<double>(b.y)};
}
std::vector<CrowdBodyState> Crowd::bodies() const {
  std::vector<CrowdBodyState> all;
  for (const Body& b : body_->core->bodies.all())
    all.push_back({b.id, b.shape, b.moves, body_displacement(b.id), body_velocity(b.id)});
  return all;
}
void Crowd::remove_obstacle(ObstacleId obstacle) {
  body_->remove_obstacle(obstacle);
}
std::size_t Crowd::size() const {
  return body_->core->robots.size();
}
std::size_t Crowd::id_end() const {
  return body_->id_end;
}
const CrowdOptions& Crowd::options() const {
  return body_->core->options;
}

const CrowdKind& Crowd::kind(KindId kind) const {
  const auto& kinds = body_->core->kinds;
  if (kind >= kinds.size())
    throw CrowdError(CrowdProblem::unknown_kind,
                     words("kind", kind, "below " + std::to_string(kinds.size()) + ", the number of kinds"));
  return kinds[kind];
}

void Crowd::set_preferred(const std::vector<Vec2>& by_id) {
  if (by_id.size() < id_end())
    throw CrowdError(CrowdProblem::wrong_count, words("preferred velocities", static_cast<double>(by_id.size()),
                                                      std::to_string(id_end()) + ", one for each id"));
  body_->core->set_preferred(by_id);
  body_->core->steering = nullptr;
  body_->core->changed();
}

void Crowd::set_steering(Steering steering) {
  body_->core->steering = std::move(steering);
  body_->core->changed();
}

void Crowd::set_reservations(const std::vector<Vec2>& place, const std::vector<std::uint8_t>& reserved) {
  for (const std::size_t count : {place.size(), reserved.size()})
    if (count < id_end())
      throw CrowdError(CrowdProblem::wrong_count, words("reservations", static_cast<double>(count),
                                                        std::to_string(id_end()) + ", one for each id"));
  for (std::size_t id = 0; id < id_end(); ++id)
    if (reserved[id] != 0 && !geometry::is_finite(place[id]))
      throw CrowdError(CrowdProblem::not_finite, "reserved place of robot " + std::to_string(id) +
                                                     ": found a coordinate that is no number, expected metres");
  const auto end = static_cast<std::ptrdiff_t>(id_end());
  body_->core->reserved_ways.set({place.begin(), place.begin() + end}, {reserved.begin(), reserved.begin() + end});
  body_->core->changed();
}

StepReport Crowd::step() {
  return body_->step();
}

void Crowd::positions(std::vector<Vec2>& by_id) const {
  body_->fill(by_id, [&](std::size_t i) { return body_->position(i); });
}

void Crowd::velocities(std::vector<Vec2>& by_id) const {
  body_->fill(by_id, [&](std::size_t i) { return body_->velocity(i); });
}

void Crowd::kept(std::vector<std::uint8_t>& by_id) const {
  const Robots& r = body_->core->robots;
  body_->fill(by_id, [&](std::size_t i) { return (r.tag[i] & Robots::kKept) != 0; });
}

void Crowd::met(std::vector<std::uint8_t>& by_id) const {
  const Robots& r = body_->core->robots;
  body_->fill(by_id, [&](std::size_t i) { return (r.next_kept[i] & Robots::kHasMet) != 0; });
}

Vec2 Crowd::position(RobotId robot) const {
  return body_->position(body_->place_of(robot));
}

Vec2 Crowd::velocity(RobotId robot) const {
  return body_->velocity(body_->place_of(robot));
}

Vec2 Crowd::heading(RobotId robot) const {
  return body_->wheels_of(robot).ahead;
}

Vec2 Crowd::wheel_speeds(RobotId robot) const {
  const WheelState& wheels = body_->wheels_of(robot);
  return options().position_step / options().time_step * Vec2{wheels.left, wheels.right};
}

KindId Crowd::kind_of(RobotId robot) const {
  return static_cast<KindId>(body_->core->robots.kind(body_->place_of(robot)));
}

CrowdExplanation Crowd::explain(RobotId robot) const {
  body_->place_of(robot);
  body_->make_ready();
  return body_->core->explain(body_->place_of(robot));
}

void Crowd::snapshot(std::ostream& to) const {
  body_->make_ready();
  write_snapshot(*body_, to);
}

Crowd Crowd::restored(std::istream& from, int threads, Ranks* ranks) {
  CrowdOptions options = read_options(from);
  options.threads = threads;
  options.ranks = ranks;
  auto body = std::make_unique<CrowdBody>(options);
  read_snapshot(*body, from);
  return Crowd(std::move(body));
}

std::uint64_t Crowd::digest() const {
  return body_->digest();
}
std::size_t Crowd::bytes() const {
  return body_->bytes();
}
const CrowdPhases& Crowd::phases() const {
  return body_->core->phases;
}

}  // namespace exactvo::formation
