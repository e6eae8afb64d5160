// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/crowd_run.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <tuple>

#include "crowd/layout.h"
#include "exactvo/formation/recording.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/told_apart.h"
#include "liveness/reservations.h"
#include "motion/differential.h"
#include "motion/leader.h"
#include "runs/robot_run.h"
#include "scene/free_space.h"
#include "scene/goals.h"
#include "scene/number_text.h"
#include "steering/guide.h"

namespace exactvo::formation {

namespace {

using namespace detail;
using crowd::SnapshotReader;
using crowd::SnapshotWriter;
using geometry::norm;
using Clock = std::chrono::steady_clock;

/// Steps after which a robot looks along its route again.
constexpr std::size_t kLookAgain = 8;

/// Neighbours of a robot, the number of RVO2's examples and of the published comparisons.
constexpr int kNeighbours = 10;

/// This many robots are named in an outcome.
constexpr std::size_t kReasonsNamed = 3;

/// The lattice reaches this many times as far as robots, goals and obstacles.
constexpr double kReach = 2.0;

/// m/s, of a moving obstacle: room below what a crowd takes for what its way is rounded by.
constexpr double kFastestBody = 0x1p14;

/// m: what lies farther out than robots, goals and obstacles is not gone to.
double extent(const Scenario& s) {
  double most = 1.0;
  const auto add = [&](Vec2 p) { most = std::max({most, std::fabs(p.x), std::fabs(p.y)}); };
  for (const Robot& r : s.robots) {
    add(r.position);
    for (const Vec2 goal : r.goals) add(goal);
  }
  for (const SceneObstacle& o : s.obstacles)
    for (const Vec2 p : geometry::vertices_of(o.shape)) add(p);
  return most;
}

/// m/s, of a moving obstacle at any time.
double fastest(const MovingObstacle& o) {
  double most = o.motion.profile.empty() ? o.motion.speed : 0.0;
  for (const SpeedKnot& knot : o.motion.profile) most = std::max(most, knot.speed);
  return most;
}

double fastest(const Scenario& s) {
  double most = 0.0;
  for (const Robot& r : s.robots) most = std::max(most, r.max_speed);
  for (const MovingObstacle& o : s.moving_obstacles) most = std::max(most, fastest(o));
  return most;
}

/// m, of the lattice of positions.
double position_step_for(const Scenario& s) {
  return crowd::lattice_for(kReach * extent(s), fastest(s) * s.time_step);
}

CrowdOptions options_of(const Scenario& s, const SimulationOptions& options) {
  CrowdOptions out;
  out.time_step = s.time_step;
  out.precision = options.precision;
  out.threads = options.threads;
  out.ranks = options.ranks;
  out.position_step = position_step_for(s);
  return out;
}

// Robots with a reservation do not evade moving obstacles, and go straight for their places, backward too.
bool has_reservations(const Scenario& s, Liveness liveness) {
  const bool drive_back = std::all_of(s.robots.begin(), s.robots.end(), [](const Robot& r) {
    return !r.drive || r.drive->max_backward_speed >= r.drive->max_wheel_speed;
  });
  return liveness == Liveness::plan && !s.robots.empty() && s.moving_obstacles.empty() && drive_back;
}

std::optional<CrowdWheels> wheels_of(const Robot& r) {
  if (!r.drive) return {};
  const DifferentialDrive& d = *r.drive;
  return CrowdWheels{d.reference, d.wheel_separation, d.max_wheel_acceleration, d.max_angular_speed,
                     d.max_backward_speed};
}

/// Crowds keep no margins. Two robots whose goals were a little nearer to each other than reservations keep would push
/// each other off them by turns.
RoomAtEnds room_at_ends_of(const Scenario& s, Liveness liveness) {
  RoomAtEnds room;
  if (has_reservations(s, liveness)) room.margin = kRoomBetweenPlaces * 2.0 * largest_radius(s.robots);
  return room;
}

class CrowdSteps final : public Stepper {
 public:
  /// All must outlive it; `sink` may be null.
  CrowdSteps(RobotsOfRun& robots, const SimulationOptions& options, Liveness liveness, RunSink* sink)
      : scenario_(robots.scenario),
        options_(options),
        liveness_(liveness),
        ranks_(options.ranks),
        sink_(sink),
        crowd_(options_of(scenario_, options)),
        ends_(share_ends(robots.size(), ranks_ ? ranks_->size() : 1)),
        robots_(robots),
        at_(robots.at),
        velocity_(robots.velocity),
        journeys_(robots.journeys),
        report_(robots.report) {
    add_robots();
    for (const SceneObstacle& o : scenario_.obstacles) o.disc ? crowd_.add_body(*o.disc) : crowd_.add_obstacle(o.shape);
    for (const MovingObstacle& o : scenario_.moving_obstacles)
      moving_.push_back(crowd_.add_moving_body(hull_of(o, {}), {}));
    crowd_.positions(at_);
    crowd_.velocities(velocity_);
    preferred_.resize(robots.size());
    turned_.resize(robots.size());
    if (journeys_.has_claims()) ends_now_.resize(robots.size());
    if (has_reservations(scenario_, liveness)) make_reservations();
    options.resume_from.empty() ? set_out() : restore(options.resume_from);
  }

  void decide() override {
    set_out_obstacles();
    moved_obstacles_.clear();
    for (const MovingObstacle& o : scenario_.moving_obstacles)
      moved_obstacles_.push_back({displacement_at(o, report_.time), leader_at(o.motion, report_.time).velocity});
    journeys_.look_at_moving_obstacles(report_.time, moved_obstacles_);
    for (std::size_t i = own_begin(); i < own_end(); ++i) look(i);
    if (journeys_.has_claims()) look_at_claims();
    if (reservations_) reserve();
    for (std::size_t i = own_begin(); i < own_end(); ++i)
      preferred_[i] = reservations_ && reservations_->reserved()[i] ? reservations_->preferred()[i] : preferred_of(i);
    if (options_.steering)
      steer_by(options_.steering, {own_begin(), own_end(), report_.time, at_, velocity_}, preferred_);
    // All preferred velocities to all.
    if (ranks_) ranks_->share({{preferred_.data(), in_bytes(ends_, sizeof(Vec2))}});
    crowd_.set_preferred(preferred_);
  }

  void move() override {
    const StepReport s = crowd_.step();
    report_.relaxed += s.relaxed;
    report_.cut_short += s.cut_short;
    report_.reserved += s.reserved;
    report_.overlapping += s.overlapping;
    report_.touching += s.touching;
    report_.widened += s.widened;
    report_.stopped += s.stopped;
    report_.against_robots += s.neighbours;
    report_.against_edges += s.edges;
    report_.against_bodies += s.bodies;
    crowd_.positions(at_);
    crowd_.velocities(velocity_);
    const bool obstacles_rest = end_of_step() >= journeys_.moving_until() + 2.0 * scenario_.time_step;
    if (at_ != robots_.before || !(obstacles_rest || moving_.empty())) moved_ = report_.steps + 1;
  }

  bool goes_on() const override {
    for (std::size_t i = own_begin(); i < own_end(); ++i) {
      const bool rests = journeys_.rests_beside(i) && journeys_.ends_here(i);
      if (!journeys_.at_goal(i) && !journeys_.stays(i) && !rests) return true;
    }
    return false;
  }

  /// What a step does follows from places, velocities, aims, claims and reservations, and from whose turn it is to look
  /// along its route. In as many steps as there are turns none of these has changed, from velocities of 0 on: so the
  /// next ones do what they have done.
  bool repeats_itself() const override {
    if (options_.steering) return false;  // the user may want something else at any time
    const auto is_long_ago = [this](std::size_t step) { return step + 1 + kLookAgain <= report_.steps; };
    if (!is_long_ago(std::max({moved_, claimed_, reserved_}))) return false;
    if (static_cast<double>(report_.steps - moved_) * scenario_.time_step < journeys_.longest_pause()) return false;
    if (reservations_ && std::max(moved_, reserved_) + reservations_->patience() > report_.steps) return false;
    bool is_so = true;
    for (std::size_t i = own_begin(); i < own_end(); ++i) is_so = is_so && is_long_ago(turned_[i]);
    return (ranks_ ? ranks_->least(is_so) : is_so) != 0;
  }

  void end_step(bool is_stopped) override {
    const bool is_due = options_.snapshot_every > 0 && report_.steps % options_.snapshot_every == 0;
    if (options_.keep_snapshot && (is_due || is_stopped) && gather_journeys()) options_.keep_snapshot(snapshot());
  }

  bool finish() override {
    report_.digest = crowd_.digest();
    for (std::size_t i = own_begin(); i < own_end(); ++i) look(i);
    if (journeys_.has_claims()) look_at_claims();
    return gather_journeys();
  }

  std::string why_not_there(std::size_t i) const override { return journeys_.why_not_there(i); }
  std::size_t most_named() const override { return kReasonsNamed; }
  const Crowd* crowd() const override { return &crowd_; }

 private:
  void set_out() {
    for (std::size_t i = own_begin(); i < own_end(); ++i) {
      journeys_.set_out(i);
      journeys_.look_along(i);
    }
    if (sink_) sink_->add_state(state_of(robots_, &crowd_));
  }

  /// s: when the present step ends.
  double end_of_step() const { return static_cast<double>(report_.steps + 1) * scenario_.time_step; }

  void make_reservations() {
    space_.emplace(scenario_.obstacles);
    reservations_.emplace(*space_, journeys_.size(), scenario_.time_step, largest_radius(scenario_.robots));
    under_way_.resize(journeys_.size());
  }

  // --- Ranks: each looks where robots own_begin() to own_end() are to go ---

  std::size_t own_begin() const {
    return ranks_ && ranks_->rank() > 0 ? ends_[static_cast<std::size_t>(ranks_->rank()) - 1] : 0;
  }
  std::size_t own_end() const { return ends_[ranks_ ? static_cast<std::size_t>(ranks_->rank()) : 0]; }

  /// All journeys come to the first rank. Returns whether it is this one.
  bool gather_journeys() {
    if (ranks_) {
      const auto digest = static_cast<std::int64_t>(crowd_.digest() >> 1U);
      const std::int64_t least = ranks_->least(digest), most = -ranks_->least(-digest);
      if (least < most) throw RanksDiffer();
      std::ostringstream own;
      SnapshotWriter to(own);
      for (std::size_t i = own_begin(); i < own_end(); ++i) put(to, i);
      const std::vector<std::string> all = ranks_->gather(own.str());
      for (std::size_t r = 1; r < all.size(); ++r) {
        std::istringstream bytes(all[r]);
        SnapshotReader from(bytes, kSnapshotOfRun);
        for (std::size_t i = ends_[r - 1]; i < ends_[r]; ++i) get(from, i);
      }
    }
    return !ranks_ || ranks_->rank() == 0;
  }

  void put(SnapshotWriter& to, std::size_t i) const {
    journeys_.put(i, to);
    to.put(turned_[i]);
  }
  void get(SnapshotReader& from, std::size_t i) {
    journeys_.get(i, from);
    from.get(turned_[i]);
  }

  // --- Snapshots: the run, the crowd, the sink, and a checksum ---

  /// REQUIRES: all journeys are here.
  std::string snapshot() const {
    std::ostringstream run, crowd, sink, whole;
    SnapshotWriter of_run(run), to(whole);
    of_run.put(journeys_.size());
    for_each_count(report_, [&](const auto& count) { of_run.put(count); });
    of_run.fields(moved_, claimed_, reserved_);
    journeys_.put_shared(of_run);
    for (std::size_t i = 0; i < journeys_.size(); ++i) put(of_run, i);
    if (reservations_) reservations_->put(of_run);
    crowd_.snapshot(crowd);
    if (sink_) sink_->save(sink);
    to.fields(run.str(), crowd.str(), sink.str());
    to.finish();
    return whole.str();
  }

  void restore(const std::string& bytes) {
    std::istringstream whole(bytes);
    SnapshotReader from(whole, kSnapshotOfRun);
    std::istringstream run(from.get<std::string>()), crowd(from.get<std::string>()), sink(from.get<std::string>());
    from.finish();
    SnapshotReader of_run(run, kSnapshotOfRun);
    require(is_at_end(whole) && of_run.get<std::size_t>() == journeys_.size());
    for_each_count(report_, [&](auto& count) { of_run.get(count); });
    of_run.fields(moved_, claimed_, reserved_);
    journeys_.get_shared(of_run);
    for (std::size_t i = 0; i < journeys_.size(); ++i) get(of_run, i);
    if (reservations_) reservations_->get(of_run);
    const CrowdOptions wanted = crowd_.options();
    crowd_ = Crowd::restored(crowd, options_.threads, ranks_);
    const CrowdOptions& found = crowd_.options();
    require(is_at_end(run) && found.time_step == wanted.time_step && found.position_step == wanted.position_step &&
            found.precision == wanted.precision && crowd_.id_end() == journeys_.size());
    crowd_.positions(at_);
    crowd_.velocities(velocity_);
    if (sink_) sink_->restore(state_of(robots_, &crowd_), sink);
  }

  static bool is_at_end(std::istream& from) { return from.peek() == std::istream::traits_type::eof(); }
  static void require(bool holds) {
    if (!holds) crowd::refuse_snapshot("other bytes", kSnapshotOfRun);
  }

  /// What adds up from step to step.
  template <class Report, class Visit>
  static void for_each_count(Report& r, const Visit& visit) {
    for (auto* count : {&r.steps, &r.relaxed, &r.cut_short, &r.reserved, &r.overlapping, &r.touching, &r.widened,
                        &r.stopped, &r.against_robots, &r.against_edges, &r.against_bodies})
      visit(*count);
    for (auto* number : {&r.time, &r.path_length}) visit(*number);
  }

  void add_robots() {
    std::map<std::array<double, 7>, KindId> kinds;
    crowd_.reserve(scenario_.robots.size());
    for (std::size_t i = 0; i < scenario_.robots.size(); ++i) {
      const Robot& r = scenario_.robots[i];
      try {
        const CrowdWheels w = wheels_of(r).value_or(CrowdWheels{});
        const std::array key{r.radius,
                             r.max_speed,
                             w.reference,
                             w.wheel_separation,
                             w.max_wheel_acceleration,
                             w.max_angular_speed,
                             w.max_backward_speed};
        auto known = kinds.find(key);
        if (known == kinds.end()) known = kinds.emplace(key, crowd_.add_kind(kind_of(r))).first;
        add_robot(r, known->second);
      } catch (const CrowdError& e) {
        throw CrowdError(e.problem(), "robot " + r.id + ": " + e.what());
      }
    }
  }

  void add_robot(const Robot& r, KindId kind) {
    const double speed = norm(r.velocity), share = speed > r.max_speed ? r.max_speed / speed * (1.0 - 0x1p-40) : 1.0;
    const RobotId id = crowd_.add_robot(r.position, kind, share * r.velocity);
    if (r.drive) crowd_.set_heading(id, r.drive->heading);
  }

  CrowdKind kind_of(const Robot& r) const {
    CrowdKind kind;
    kind.radius = r.radius;
    kind.max_speed = r.max_speed;
    kind.time_horizon = scenario_.horizons.orca;
    kind.neighbour_distance = scenario_.neighbour_distance;
    kind.neighbours = kNeighbours;
    kind.wheels = wheels_of(r);
    return kind;
  }

  // --- One robot ---

  void look(std::size_t i) {
    const Journey& j = journeys_[i];
    const auto aim = [&] {
      return std::tuple(j.goal, j.heading.x, j.heading.y, journeys_.stays(i), j.course ? j.course->next : 0);
    };
    const auto before = aim();
    if (journeys_.pass_goal(i)) journeys_.look_along(i);
    journeys_.look_whether_it_waits(i, velocity_[i] == Vec2{});
    journeys_.go_round(i);
    if (journeys_.at_goal(i) || j.waits_for_room || j.nearest || (report_.steps + i) % kLookAgain == 0)
      journeys_.look_along(i);
    if (!journeys_.take_note(i).empty() || aim() != before) turned_[i] = report_.steps;
  }

  Vec2 preferred_of(std::size_t i) {
    const Vec2 wish = kept_right(i);
    return scenario_.robots[i].drive ? turned_aside(crowd_.heading(static_cast<RobotId>(i)), wish) : wish;
  }

  Vec2 kept_right(std::size_t i) {
    const Vec2 preferred = journeys_.beside_taken(i, journeys_.preferred(i));
    if (liveness_ == Liveness::off || options_.steering) return preferred;
    const double held_up = journeys_[i].keep_right.held_up;
    const bool waits = journeys_[i].cut_by.has_value();  // not for robots
    const Vec2 turned = journeys_.kept_right(i, preferred, velocity_[i], 0.0, KeepRight::kPatience, !waits);
    if (journeys_[i].keep_right.held_up != held_up) turned_[i] = report_.steps;
    return turned;
  }

  void look_at_claims() {
    for (std::size_t i = own_begin(); i < own_end(); ++i) ends_now_[i] = journeys_.end_now(i, true);
    if (ranks_) ranks_->share({{ends_now_.data(), in_bytes(ends_, sizeof(EndNow))}});
    if (journeys_.look_at_claims(ends_now_)) claimed_ = report_.steps;
  }

  // --- Reservations ---

  void reserve() {
    for (std::size_t i = own_begin(); i < own_end(); ++i) under_way_[i] = under_way(i);
    if (ranks_) ranks_->share({{under_way_.data(), in_bytes(ends_, sizeof(RobotUnderWay))}});
    reservations_->look(under_way_);
    if (reservations_->has_changed()) reserved_ = report_.steps;
    crowd_.set_reservations(reservations_->places(), reservations_->reserved());
  }

  RobotUnderWay under_way(std::size_t i) const {
    const Journey& j = journeys_[i];
    RobotUnderWay r;
    r.position = at_[i];
    r.velocity = velocity_[i];
    r.radius = scenario_.robots[i].radius;
    r.max_speed = scenario_.robots[i].max_speed;
    r.leg = static_cast<std::uint32_t>(j.goal);
    r.yields = journeys_.stays(i) || journeys_.is_taken(i);
    r.goal = journeys_.end_of(i);
    r.is_at_goal = !j.nearest && journeys_.at_goal(i);
    r.ahead.front() = j.heading;
    if (!j.course) return r;
    const std::vector<Vec2>& points = j.course->points;
    std::size_t k = j.course->next + 1;
    for (; k < points.size() && r.corners_ahead < RobotUnderWay::kMostAhead; ++k)
      r.ahead[r.corners_ahead++] = points[k];
    for (; k < points.size(); ++k) r.rest += norm(points[k] - points[k - 1]);
    return r;
  }

  /// Straight on to where each is at the end of the step, up to half a step of the lattice.
  void set_out_obstacles() {
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      const Vec2 way =
          displacement_at(scenario_.moving_obstacles[k], end_of_step()) - crowd_.body_displacement(moving_[k]);
      crowd_.set_body_velocity(moving_[k], way / scenario_.time_step);
    }
  }

  const Scenario& scenario_;
  const SimulationOptions& options_;
  Liveness liveness_;
  Ranks* ranks_;
  RunSink* sink_;
  Crowd crowd_;
  std::vector<std::size_t> ends_;  ///< of the shares of the robots, by rank
  RobotsOfRun& robots_;
  std::vector<Vec2>&at_, &velocity_;
  Journeys& journeys_;
  RunReport& report_;
  std::vector<Vec2> preferred_;
  std::vector<std::size_t> turned_;  ///< step at which a journey has changed last
  std::vector<ObstacleId> moving_;
  std::vector<MovedObstacle> moved_obstacles_;
  std::vector<EndNow> ends_now_;        ///< with claims
  std::optional<ObstacleSpace> space_;  ///< with reservations
  std::optional<Reservations> reservations_;
  std::vector<RobotUnderWay> under_way_;
  std::size_t reserved_ = 0;  ///< step at which a reservation changed last
  std::size_t moved_ = 0;     ///< the last step in which something moved
  std::size_t claimed_ = 0;   ///< step at which a claim changed last
};

}  // namespace

namespace {

/// What `CrowdWheels` asks for, and that one disc is the whole body.
template <class Require>
void require_drive(const Robot& r, const std::string& pointer, double time_step, const Require& require) {
  const auto number = [](double x) { return number_text(x, 6); };
  const DifferentialDrive& d = *r.drive;
  const std::string kinematics = pointer + "/kinematics/";
  require(d.footprint.empty(), pointer + "/footprint", "a footprint", "a radius, for a crowd");
  require(d.max_wheel_acceleration * time_step >= d.max_wheel_speed, kinematics + "max_wheel_acceleration",
          number(d.max_wheel_acceleration) + " m/s^2",
          "at least " + number(d.max_wheel_speed / time_step) +
              " m/s^2, for a crowd, whose robots stop within a time step, or a time_step of at least " +
              number(d.max_wheel_speed / d.max_wheel_acceleration) + " s");
  const double least = std::max(d.max_wheel_speed * time_step, d.wheel_separation / 16.0);
  require(d.reference >= least, kinematics + "reference", number(d.reference) + " m",
          "at least " + number(least) + " m, for a crowd: the way of a time step, and wheel_separation / 16");
}

}  // namespace

std::vector<ScenarioProblem> crowd_problems(const Scenario& s) {
  std::vector<ScenarioProblem> problems;
  const auto require = [&](bool holds, const std::string& pointer, const std::string& found,
                           const std::string& expected) {
    if (!holds && problems.empty()) problems.push_back({pointer, found, expected});
  };
  require(!s.formation, "/formation", "a formation", "robots with goals, for a crowd");
  for (std::size_t k = 0; k < s.moving_obstacles.size(); ++k)
    require(fastest(s.moving_obstacles[k]) <= kFastestBody, "/moving_obstacles/" + std::to_string(k),
            geometry::lossless(fastest(s.moving_obstacles[k])) + " m/s",
            "at most " + detail::metres(kFastestBody, 6) + "/s, for a crowd");
  require(!s.acceleration, "/acceleration", "an acceleration", "none, for a crowd, whose velocities jump");
  require(!s.separate, "/separate", "true", "false, for a crowd");
  for (std::size_t i = 0; i < s.robots.size() && problems.empty(); ++i)
    if (s.robots[i].drive) require_drive(s.robots[i], "/robots/" + std::to_string(i), s.time_step, require);
  require(s.speed_bound == SpeedBoundKind::disc, "/speed_bound", "box", "disc, for a crowd");
  const double step = position_step_for(s);
  const auto [tolerance, least] = geometry::told_apart(s.arrival_tolerance, step, 6);
  require(s.arrival_tolerance >= step, "/arrival_tolerance", tolerance + " m",
          "at least " + least + " m, the lattice of positions of a crowd of this extent and speed");
  for (std::size_t i = 0; i < s.robots.size() && problems.empty(); ++i)
    require(s.robots[i].cooperates, "/robots/" + std::to_string(i) + "/cooperates", "false", "true, for a crowd");
  return problems;
}

Liveness crowd_liveness(const Scenario& scenario, const SimulationOptions& options) {
  const Liveness wanted = options.liveness.value_or(scenario.liveness);
  return options.steering && wanted == Liveness::plan ? Liveness::bias : wanted;
}

RunReport run_crowd(const Scenario& scenario, const SimulationOptions& options, RunSink* sink) {
  const std::vector<ScenarioProblem> problems = crowd_problems(scenario);
  EXACTVO_REQUIRE(problems.empty(), problems.front().pointer + ": " + problems.front().found);
  const Clock::time_point start = Clock::now();
  RunSchedule schedule(scenario, options, std::chrono::milliseconds{0});
  std::optional<Guide> guide;
  if (options.guidance.value_or(scenario.guidance) == Guidance::route) guide.emplace(scenario, 0.0);
  EXACTVO_REQUIRE(!options.half_planes, "half_planes: a function, expected none on a crowd; `simulate` takes them");
  EXACTVO_REQUIRE(promises_between_robots(options.method), std::string("method: ") + name(options.method) +
                                                               ", expected orca, which a crowd drives by; `simulate` "
                                                               "has the other methods");
  const Liveness liveness = crowd_liveness(scenario, options);
  RobotsOfRun robots(scenario, guide ? &*guide : nullptr, liveness, room_at_ends_of(scenario, liveness),
                     scenario.horizons.orca, TakenOnTheWay::passed_beside);
  RunSink* const first_sink = options.ranks && options.ranks->rank() > 0 ? nullptr : sink;
  CrowdSteps steps(robots, options, liveness, first_sink);
  RunReport report = RobotRun(robots, steps, schedule, first_sink, options.ranks).run();
  report.wall_time = std::chrono::duration<double>(Clock::now() - start).count();
  return report;
}

}  // namespace exactvo::formation
