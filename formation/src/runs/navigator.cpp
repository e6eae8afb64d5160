// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/navigator.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "exactvo/formation/disc_obstacle.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/excerpt.h"
#include "exactvo/geometry/pi.h"
#include "motion/differential.h"
#include "runs/own_decision.h"
#include "runs/rows.h"
#include "scene/chain.h"
#include "scene/field_problems.h"
#include "scene/free_space.h"
#include "scene/goals.h"
#include "scene/moving.h"
#include "scene/number_text.h"
#include "scene/step_limits.h"

namespace exactvo::formation {
namespace {

using namespace detail;
using geometry::norm;
using Problem = NavigatorProblem;

/// m and m/s: squares of what is below are far inside the range of doubles, and a difference keeps a micrometre.
constexpr double kMost = 0x1p30;
/// Static shapes within reach that there is memory for from the beginning.
constexpr std::size_t kMostShapes = 1000;
constexpr std::size_t kMostNeighbours = std::size_t{1} << 20;
/// Characters of a note, which are written into memory that is there.
constexpr std::size_t kNoteLength = 512;
/// What is refused with it: robots that brake rely on each other.
constexpr const char* kWithBrakes = "true with an acceleration, a braking_time or a drive";

std::string number(double x) {
  return number_text(x, 17);
}

/// "1, 2".
std::string number(Vec2 v) {
  return number(v.x) + ", " + number(v.y);
}

[[noreturn]] void refuse(Problem problem, const std::string& field, const std::string& found,
                         const std::string& expected) {
  throw NavigatorError(problem, field + ": found " + found + ", expected " + expected);
}

/// "neighbour 3 velocity"; without a number "velocity".
std::string field_of(const char* list, std::size_t k, const char* field) {
  return list ? std::string(list) + " " + std::to_string(k) + " " + field : field;
}

// Words are made for what is wrong only.

void require_vector(Vec2 v, const char* list, std::size_t k, const char* field) {
  if (!geometry::is_finite(v)) refuse(Problem::not_finite, field_of(list, k, field), number(v), "two finite numbers");
  if (!(std::max(std::fabs(v.x), std::fabs(v.y)) < kMost))
    refuse(Problem::out_of_range, field_of(list, k, field), number(v), "less than 2^30");
}

void require_positive(double x, const char* list, std::size_t k, const char* field) {
  if (!std::isfinite(x)) refuse(Problem::not_finite, field_of(list, k, field), number(x), "a finite number above 0");
  if (!(x > 0.0 && x < kMost))
    refuse(Problem::out_of_range, field_of(list, k, field), number(x), "a number above 0 and less than 2^30");
}

void require_goals(const std::vector<Vec2>& goals) {
  if (goals.empty()) refuse(Problem::no_goal, "goals", "none", "at least one");
  for (std::size_t k = 0; k < goals.size(); ++k) require_vector(goals[k], "goal", k, "position");
}

DecisionRules rules_of(const NavigatorSetup& setup) {
  DecisionRules rules{setup.method,  Guidance::none,  setup.speed_bound,       setup.horizons,
                      setup.margins, setup.time_step, setup.neighbour_distance};
  if (setup.acceleration) rules.acceleration = *setup.acceleration;
  if (setup.acceleration && setup.drive) rules.measurements = Measurements{};  // others measure it, as it may them
  const double speed = setup.drive ? setup.drive->max_wheel_speed : fastest(setup.speed_bound, setup.max_speed);
  double usual_time = 0.0;
  if (setup.acceleration) usual_time = usual_braking_time(speed, rules.acceleration, rules.time_step);
  if (setup.drive)
    usual_time = std::max(usual_time, usual_braking_time(speed, setup.drive->max_wheel_acceleration, rules.time_step));
  rules.braking_time = setup.braking_time.value_or(usual_time);
  const Horizons usual;
  for (double Horizons::*horizon : {&Horizons::most, &Horizons::orca, &Horizons::robots})
    if (rules.horizons.*horizon == usual.*horizon)
      rules.horizons.*horizon = std::max(usual.*horizon, rules.braking_time);
  return rules;
}

Robot robot_of(const NavigatorSetup& setup, std::vector<Vec2> goals) {
  Robot robot;  // stands anywhere: where it is comes with every decision
  robot.radius = setup.radius;
  robot.max_speed = setup.max_speed;
  robot.cooperates = setup.cooperates;
  robot.goals = std::move(goals);
  if (setup.drive) put_on_wheels(robot, DifferentialDrive(*setup.drive), setup.time_step, setup.drive->tracking);
  return robot;
}

/// The first of them names a field of the setup.
void require_none(const std::vector<ScenarioProblem>& problems) {
  if (problems.empty()) return;
  const ScenarioProblem& first = problems.front();
  const bool is_number = first.found.find("nan") == std::string::npos && first.found.find("inf") == std::string::npos;
  refuse(is_number ? Problem::out_of_range : Problem::not_finite, first.pointer.substr(1), first.found, first.expected);
}

/// Heading of length 1 and wheels that turn a robot by less than a half turn in a step: what one robot knows of itself
/// and another of it is the same.
OnWheels usable(const DifferentialDrive& drive, double time_step, const OnWheels& given) {
  constexpr double kUnit = 1e-6;
  require_vector(given.heading, nullptr, 0, "heading");
  if (std::fabs(norm(given.heading) - 1.0) > kUnit)
    refuse(Problem::out_of_range, "heading", number(given.heading), "a vector of length 1");
  const Vec2 wheels{given.speeds.left, given.speeds.right};
  require_vector(wheels, nullptr, 0, "wheels");
  if (!(std::fabs(wheels.y - wheels.x) * time_step < geometry::kPi * drive.wheel_separation))
    refuse(Problem::out_of_range, "wheels", number(wheels),
           "speeds that turn the robot by less than a half turn in a step");
  return {given.heading / norm(given.heading), given.speeds};
}

/// As a scenario of this robot alone, at rest, is validated.
void require_drive(const NavigatorSetup& setup) {
  Scenario s;
  s.time_step = setup.time_step;
  s.horizons = setup.horizons;
  s.braking_time = setup.braking_time;
  s.robots = {robot_of(setup, {Vec2{}})};
  s.robots[0].drive->heading = 0.0;
  s.robots[0].drive->axle = {};
  const double tracking = setup.drive->tracking;
  if (tracking != 0.0 || setup.acceleration) s.uncertainty = Uncertainty{tracking};
  if (setup.acceleration) {
    s.acceleration = Acceleration{*setup.acceleration};
    s.uncertainty->measurements = Measurements{};
  }
  put_on_wheels(s.robots[0], DifferentialDrive(*s.robots[0].drive), s.time_step, tracking);
  std::vector<ScenarioProblem> problems = detail::field_problems(s);
  const std::string of_robot = "/robots/0";
  for (ScenarioProblem& p : problems)
    if (p.pointer.rfind(of_robot, 0) == 0) p.pointer.erase(0, of_robot.size());
  require_none(problems);
}

/// Options of Method::ivo_edge, as in `simulate` by default.
geometry::FacadeEllipseOptions facade_ellipses(const Margins& margins) {
  const SimulationOptions usual;
  return {usual.facade_minor_to_major, usual.facade_fixed_minor, margins.obstacle};
}

const NavigatorSetup& checked(const NavigatorSetup& setup, const std::vector<Vec2>& goals) {
  require_goals(goals);
  if (!*name(setup.method)) refuse(Problem::out_of_range, "method", "no Method", "one");
  if (!promises_between_robots(setup.method))
    refuse(Problem::out_of_range, "method", name(setup.method), "orca, ivo-edge, ivo-cluster or ivo");
  if (setup.neighbours > kMostNeighbours)
    refuse(Problem::out_of_range, "neighbours", std::to_string(setup.neighbours), "at most 2^20");
  for (std::size_t k = 0; k < setup.obstacles.size(); ++k) {
    for (const Vec2 v : geometry::vertices_of(setup.obstacles[k].shape)) require_vector(v, "obstacle", k, "vertex");
    if (const std::optional<geometry::Disc>& disc = setup.obstacles[k].disc) {
      require_vector(disc->center, "obstacle", k, "disc centre");
      require_positive(disc->radius, "obstacle", k, "disc radius");
    }
  }
  if (!setup.drive) require_none(field_problems(setup.radius, setup.max_speed));
  require_none(field_problems(rules_of(setup), setup.arrival_tolerance));
  if (setup.acceleration) require_positive(*setup.acceleration, nullptr, 0, "acceleration");
  if (setup.braking_time) require_positive(*setup.braking_time, nullptr, 0, "braking_time");
  if (rules_of(setup).has_brakes() && !setup.cooperates)
    refuse(Problem::out_of_range, "cooperates", "false", kWithBrakes);
  if (setup.drive)
    require_drive(setup);
  else if (rules_of(setup).has_brakes())
    require_none(
        braking_problems(rules_of(setup), fastest(setup.speed_bound, setup.max_speed), setup.braking_time.has_value()));
  return setup;
}

}  // namespace

const char* name(NavigatorProblem problem) {
  constexpr const char* kNames[] = {"not-finite",     "out-of-range",    "no-goal",
                                    "time-backwards", "inside-obstacle", "coincident"};
  return kNames[static_cast<int>(problem)];
}

NavigatorSetup navigator_setup(const Scenario& scenario, std::size_t robot, Method method) {
  if (robot >= scenario.robots.size())
    refuse(Problem::out_of_range, "robot", std::to_string(robot),
           "less than the number of robots, " + std::to_string(scenario.robots.size()));
  const Robot& r = scenario.robots[robot];
  NavigatorSetup setup;
  setup.radius = r.radius;
  setup.max_speed = r.max_speed;
  setup.cooperates = r.cooperates;
  setup.id = robot;
  setup.obstacles = scenario.obstacles;
  setup.method = method;
  setup.speed_bound = scenario.speed_bound;
  setup.horizons = scenario.horizons;
  setup.margins = scenario.margins;
  setup.time_step = scenario.time_step;
  setup.arrival_tolerance = scenario.arrival_tolerance;
  setup.neighbour_distance = scenario.neighbour_distance;
  setup.drive = r.drive;
  if (scenario.acceleration && (!r.drive || measures_others(scenario))) setup.acceleration = scenario.acceleration->max;
  if (const double tau = braking_time_of(scenario); tau > 0.0) setup.braking_time = tau;  // of all robots
  return setup;
}

Neighbour neighbour_on_wheels(std::size_t id, const DifferentialDrive& drive, double time_step, Vec2 axle,
                              const OnWheels& wheels) {
  Robot robot;
  put_on_wheels(robot, drive, time_step, drive.tracking);
  const OnWheels now = usable(drive, time_step, wheels);
  return {id, axle + drive.reference * now.heading, velocity_before(drive, time_step, now), robot.radius,
          robot.max_speed};
}

std::vector<SceneObstacle> solids_of(const std::vector<SceneObstacle>& obstacles) {
  std::vector<SceneObstacle> solids;
  std::copy_if(obstacles.begin(), obstacles.end(), std::back_inserter(solids),
               [](const SceneObstacle& o) { return geometry::has_interior(o.shape); });
  return solids;
}

class Navigator::Core {
 public:
  Core(const NavigatorSetup& setup, std::vector<Vec2> goals)
      : rules_(rules_of(checked(setup, goals))),
        obstacles_(setup.obstacles),
        robot_(robot_of(setup, std::move(goals))),
        arrival_tolerance_(setup.arrival_tolerance),
        has_usual_braking_(setup.acceleration && !setup.braking_time),
        id_(setup.id),
        scene_(rules_.method, obstacles_, {robot_}, {}, facade_ellipses(rules_.margins)),
        own_(rules_, scene_.bodies()),
        rule_(pair_rule(rules_)),
        solids_(solids_of(obstacles_)) {
    if (robot_.drive && !robot_.drive->chain.empty()) space_.emplace(obstacles_);
    if (robot_.drive) limits_.emplace(*robot_.drive, rules_.time_step, rules_.braking_time);
    const std::size_t shapes = scene_.pieces_by_place().size() + scene_.facade_ellipses_by_place().size() +
                               scene_.edges_by_place().size() + obstacles_.size();
    constexpr std::size_t kLines = 8;  // against a neighbour, mostly
    const std::size_t statics = std::min(shapes, kMostShapes), others = kLines * setup.neighbours;
    measured_.reserve(setup.neighbours);
    own_.reserve(statics, others);
    others_.reserve(others);
    nearest_first_.reserve(others);
    kept_.reserve(statics + others);
    decision_.bound.reserve(4);
    decision_.note.reserve(kNoteLength);
    for (std::size_t k = 0; k < setup.neighbours; ++k) {
      slot(robots_, k, vo::BodyKind::robot);
      slot(moving_, k, vo::BodyKind::moving_obstacle);
    }
  }
  // Parts point at each other.
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;

  void set_goals(std::vector<Vec2> goals) {
    require_goals(goals);
    robot_.goals = std::move(goals);
    goal_ = 0;
    way_.field.reset();
  }

  const Decision& decide(const NavigatorState& given, const std::vector<Neighbour>& neighbours,
                         const std::vector<MovingBody>& moving) {
    const NavigatorState now = robot_.drive ? of_reference_point(given) : given;
    require_state(now);
    require_neighbours(now, neighbours);
    require_moving(moving);
    now_ = now;
    has_decided_ = true;
    look_at_others(neighbours, moving);
    decision_.note.clear();
    decision_.mode = Mode::direct;
    decision_.side = 0;
    head_for_goal();
    own_.look(*way_.field, here());
    const double most = robot_.drive ? robot_.drive->max_wheel_acceleration : rules_.acceleration;
    const Vec2 straight = own_.steer(way_, {now.time, here(), goal(), has_arrived(), most}, decision_);
    const Vec2 preferred = robot_.drive ? turned_aside(now.wheels.heading, straight) : straight;
    own_.choose(preferred, here(), others_, decision_, kept_);
    if (rules_.has_brakes()) keep_braking_possible(neighbours);
    return decision_;
  }

  const std::vector<DecisionConstraint>& constraints() const { return kept_; }
  const vo::BodyTable& bodies() const { return scene_.bodies(); }
  std::size_t goal_number() const { return goal_; }
  Twist twist() const {
    if (!robot_.drive || !has_decided_) return {};
    const WheelSpeeds w = twist_of(*robot_.drive, rules_.time_step, now_.wheels.heading, decision_.chosen).wheels;
    return {0.5 * (w.left + w.right), (w.right - w.left) / robot_.drive->wheel_separation, w};
  }
  bool has_arrived() const { return has_decided_ && is_last_goal() && is_within_reach(); }

  RobotStep recorded() const {
    RobotStep step = undecided(now_.position, now_.velocity);
    if (robot_.drive) step.wheels = now_.wheels;
    static_cast<Decision&>(step) = decision_;
    step.constraints = kept_;
    step.measured = measured_;
    return step;
  }

  GoalBodies goal_bodies() const {
    return {heads_since_, id_, goal_, way_.field ? way_.field->shapes() : std::vector<std::size_t>{}};
  }

 private:
  Vec2 goal() const { return robot_.goals[goal_]; }
  Viewpoint here() const {
    Viewpoint here{now_.position, now_.velocity, obstacle_radius(robot_), robot_.max_speed};
    here.robot = id_;
    here.body = scene_.robot(0);
    if (limits_) here.wheels = &on_wheels_;
    return here;
  }
  /// What was chosen is the wish.
  void keep_braking_possible(const std::vector<Neighbour>& neighbours) {
    const Viewpoint braked = after_braking(rules_, here());
    own_.look(*way_.field, braked);
    others_.clear();
    measured_.clear();
    const Party self{id_, 0, {now_.position, braked.velocity, robot_.radius}, robot_.max_speed, true};
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
      const Neighbour& n = neighbours[k];
      if (!n.measured && !is_in_sight(n)) continue;
      Party other{n.id, robots_[k], {n.position, n.velocity, n.radius}, n.max_speed, true};
      if (n.measured) {
        measured_.push_back({n.id, n.position, n.velocity, n.measured->age});
        const Party now{id_, 0, {now_.position, now_.velocity, robot_.radius}, robot_.max_speed, true};
        add_own_side_constraints(rules_, now, other, *n.measured, n.measured->age, others_);
        continue;
      }
      other.disc.velocity = rules_.braked(n.velocity);
      others_.push_back(braking_pair(self, other, rules_.braking_time).of_a);
    }
    nearest_first_.sort(scene_.bodies(), now_.position, others_);
    const Vec2 wish = decision_.chosen;
    const auto choose = [&](Vec2 preferred) { own_.choose(preferred, here(), others_, decision_, kept_); };
    choose(wish);
    if (limits_)
      keep_wheels_within_limits(on_wheels_, braked.velocity, decision_, choose,
                                [&](Vec2 u) { return may_turn(braked.velocity, u); });
    // Within less room than there is between doubles: braking satisfies all of them.
    if (decision_.status == lp::Status::optimal) return;
    choose(braked.velocity);
    if (limits_ && !(limits_->allows(on_wheels_.state.heading, on_wheels_.state.speeds, decision_.chosen) &&
                     may_turn(braked.velocity, decision_.chosen)))
      decision_.status = lp::Status::relaxed;  // data from which no braking is possible
  }
  /// A footprint has room to turn on the way of u; it always has while it brakes.
  bool may_turn(Vec2 braked, Vec2 u) const {
    return !space_ || u == braked ||
           links_are_clear(*space_, *robot_.drive, now_.position, now_.wheels.heading, u, rules_.braking_time);
  }
  bool is_in_sight(const Neighbour& n) const {
    return norm(n.position - now_.position) <=
           sight_of(rules_, robot_.radius + n.radius, robot_.max_speed + n.max_speed);
  }
  bool is_last_goal() const { return goal_ + 1 == robot_.goals.size(); }
  bool is_within_reach() const { return norm(goal() - now_.position) <= reach_of(robot_, goal_, arrival_tolerance_); }

  NavigatorState of_reference_point(const NavigatorState& given) {
    constexpr double kRounding = 1.0 + 1e-9;
    const DifferentialDrive& drive = *robot_.drive;
    require_vector(given.position, nullptr, 0, "position");
    const Vec2 wheels{given.wheels.speeds.left, given.wheels.speeds.right};
    require_vector(wheels, nullptr, 0, "wheels");
    if (std::max(std::fabs(wheels.x), std::fabs(wheels.y)) > kRounding * drive.max_wheel_speed)
      refuse(Problem::out_of_range, "wheels", number(wheels),
             "speeds within max_wheel_speed, " + number(drive.max_wheel_speed));
    NavigatorState now = given;
    now.wheels = usable(drive, rules_.time_step, given.wheels);
    now.position = given.position + drive.reference * now.wheels.heading;
    now.velocity = velocity_before(drive, rules_.time_step, now.wheels);
    on_wheels_ = {&*limits_, now.wheels};
    return now;
  }

  void require_state(const NavigatorState& now) {
    if (!std::isfinite(now.time)) refuse(Problem::not_finite, "time", number(now.time), "a finite number");
    require_vector(now.position, nullptr, 0, "position");
    require_vector(now.velocity, nullptr, 0, "velocity");
    if (has_decided_ && now.time < now_.time)
      refuse(Problem::time_backwards, "time", number(now.time), "no time before " + number(now_.time));
    if (const SceneObstacle* o = obstacle_round(now.position))
      refuse(Problem::inside_obstacle, "position", number(now.position),
             "a place that is not inside obstacle '" + o->id + "'");
  }

  /// The obstacle that x is inside of, or null. Near to where nothing was, it looks no more.
  const SceneObstacle* obstacle_round(Vec2 x) {
    constexpr double kLooksRound = 2.0;  // m
    constexpr double kRounding = 1e-6;   // m: more than distances are off by
    if (norm(x - clear_place_) < clear_) return nullptr;
    const double clear = solids_.clearance(x, kLooksRound);
    if (clear < 0.0)
      for (const SceneObstacle& o : obstacles_)
        if (signed_distance(o, x) < 0.0) return &o;
    clear_place_ = x;
    clear_ = clear - kRounding;
    return nullptr;
  }

  void require_neighbours(const NavigatorState& now, const std::vector<Neighbour>& neighbours) const {
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
      const Neighbour& n = neighbours[k];
      require_vector(n.position, "neighbour", k, "position");
      require_vector(n.velocity, "neighbour", k, "velocity");
      require_positive(n.radius, "neighbour", k, "radius");
      require_positive(n.max_speed, "neighbour", k, "max_speed");
      if (n.measured) require_bounds(*n.measured, k);
      if (rules_.has_brakes() && !n.cooperates)
        refuse(Problem::out_of_range, field_of("neighbour", k, "cooperates"), "false", kWithBrakes);
      if (rules_.acceleration < geometry::kInfinity) require_same_braking(n.max_speed, k);
      if (n.position == now.position)
        refuse(Problem::coincident, field_of("neighbour", k, "position"), number(n.position),
               "another place than the robot's own");
    }
  }

  void require_bounds(const Measurements& bounds, std::size_t k) const {
    if (!(rules_.acceleration < geometry::kInfinity))
      refuse(Problem::out_of_range, field_of("neighbour", k, "measured"), "a measured neighbour",
             "one that has told where it is, or an acceleration of the setup");
    constexpr std::pair<const char*, double Measurements::*> kBounds[] = {
        {"measured.position", &Measurements::position},
        {"measured.velocity", &Measurements::velocity},
        {"measured.age", &Measurements::age}};
    for (const auto& [field, bound] : kBounds)
      if (!(bounds.*bound >= 0.0 && bounds.*bound < kMost))
        refuse(std::isfinite(bounds.*bound) ? Problem::out_of_range : Problem::not_finite,
               field_of("neighbour", k, field), number(bounds.*bound), "a number, 0 or more and less than 2^30");
  }

  /// One braking time for all is what the promise rests on.
  void require_same_braking(double max_speed, std::size_t k) const {
    const double speed = fastest(rules_.speed_bound, max_speed), tau = rules_.braking_time;
    const bool has_another =
        has_usual_braking_ && usual_braking_time(speed, rules_.acceleration, rules_.time_step) != tau;
    if (!has_another && speed < tau * rules_.acceleration) return;
    refuse(Problem::out_of_range, field_of("neighbour", k, "max_speed"), number(max_speed),
           has_another ? "the robot's own, or the same braking_time given to all robots"
                       : "less than braking_time times acceleration, " + number(tau * rules_.acceleration) + " m/s");
  }

  void require_moving(const std::vector<MovingBody>& moving) const {
    if (rules_.has_brakes() && !moving.empty())
      refuse(Problem::out_of_range, "moving bodies", std::to_string(moving.size()),
             "none with an acceleration, a braking_time or a drive");
    for (std::size_t k = 0; k < moving.size(); ++k) {
      require_vector(moving[k].velocity, "moving body", k, "velocity");
      if (!geometry::is_valid(moving[k].shape))
        refuse(Problem::out_of_range, field_of("moving body", k, "shape"), geometry::excerpt(moving[k].shape),
               "a valid convex shape");
    }
  }

  /// The body of the k-th of a list. Its owner is its place in the list: the neighbour at that place changes.
  vo::BodyTable::Number slot(std::vector<vo::BodyTable::Number>& slots, std::size_t k, vo::BodyKind kind) {
    while (slots.size() <= k) slots.push_back(scene_.bodies().add({kind, geometry::Disc{}, {}, {slots.size()}}));
    return slots[k];
  }

  void look_at_others(const std::vector<Neighbour>& neighbours, const std::vector<MovingBody>& moving) {
    others_.clear();
    const Party self{id_, 0, {now_.position, now_.velocity, robot_.radius}, robot_.max_speed, robot_.cooperates};
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
      const Neighbour& n = neighbours[k];
      if (!self.yields || !is_in_sight(n)) continue;
      const vo::BodyTable::Number body = slot(robots_, k, vo::BodyKind::robot);
      scene_.bodies().move(body, geometry::Disc{n.position, n.radius}, n.velocity);
      const Party other{n.id, body, {n.position, n.velocity, n.radius}, n.max_speed, n.cooperates};
      others_.push_back(against_each_other(self, other, rule_).of_a);
    }
    nearest_first_.sort(scene_.bodies(), now_.position, others_);
    for (std::size_t k = 0; k < moving.size(); ++k) {
      const vo::BodyTable::Number body = slot(moving_, k, vo::BodyKind::moving_obstacle);
      scene_.bodies().move(body, moving[k].shape, moving[k].velocity);
      add_moving_constraint(rules_, here(), scene_.bodies(), body, k, others_);
    }
  }

  void head_for_goal() {
    if (!way_.field) begin_goal();
    if (is_last_goal() || !is_within_reach()) return;
    ++goal_;
    add_note(decision_.note, passed_goal_words(goal_));
    begin_goal();
  }

  void begin_goal() {
    way_.head_for(goal(), scene_, rules_, obstacle_radius(robot_), now_.position);
    heads_since_ = now_.time;
  }

  DecisionRules rules_;
  std::vector<SceneObstacle> obstacles_;
  Robot robot_;
  std::optional<WheelLimits> limits_;  ///< of its drive
  WheelsNow on_wheels_{};              ///< with a drive
  double arrival_tolerance_;           ///< m
  bool has_usual_braking_;             ///< an acceleration, and no braking time was given
  std::size_t id_;
  Scene scene_;
  OwnDecision own_;
  vo::ReciprocalOptions rule_;
  ObstacleSpace solids_;                ///< what one can be inside of
  std::optional<ObstacleSpace> space_;  ///< of a footprint
  Vec2 clear_place_;
  double clear_ = -1.0;  ///< m: so far round `clear_place_` no point is inside an obstacle
  OwnWay way_;
  NavigatorState now_;
  bool has_decided_ = false;
  std::size_t goal_ = 0;
  double heads_since_ = 0.0;                            ///< s
  std::vector<vo::BodyTable::Number> robots_, moving_;  ///< bodies, in the order of the lists
  // Memory that a decision leaves to the next.
  std::vector<Constraint> others_;
  NearestFirst nearest_first_;
  Decision decision_;
  std::vector<DecisionConstraint> kept_;
  std::vector<MeasuredRobot> measured_;  ///< neighbours, in the last decision
};

Navigator::Navigator(const NavigatorSetup& setup, std::vector<Vec2> goals)
    : core_(std::make_unique<Core>(setup, std::move(goals))) {}
Navigator::~Navigator() = default;
Navigator::Navigator(Navigator&&) noexcept = default;
Navigator& Navigator::operator=(Navigator&&) noexcept = default;

void Navigator::set_goals(std::vector<Vec2> goals) {
  core_->set_goals(std::move(goals));
}

const Decision& Navigator::decide(const NavigatorState& now, const std::vector<Neighbour>& neighbours,
                                  const std::vector<MovingBody>& moving) {
  return core_->decide(now, neighbours, moving);
}

const std::vector<DecisionConstraint>& Navigator::constraints() const {
  return core_->constraints();
}

const vo::BodyTable& Navigator::bodies() const {
  return core_->bodies();
}

std::size_t Navigator::goal() const {
  return core_->goal_number();
}

bool Navigator::has_arrived() const {
  return core_->has_arrived();
}

RobotStep Navigator::recorded() const {
  return core_->recorded();
}

Twist Navigator::twist() const {
  return core_->twist();
}

GoalBodies Navigator::goal_bodies() const {
  return core_->goal_bodies();
}

}  // namespace exactvo::formation
