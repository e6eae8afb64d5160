// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/crowd_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "crowd/layout.h"
#include "exactvo/formation/recording.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/told_apart.h"
#include "liveness/reservations.h"
#include "motion/leader.h"
#include "runs/crowd_way.h"
#include "scene/free_space.h"
#include "scene/goals.h"
#include "scene/number_text.h"
#include "steering/goal_claims.h"
#include "steering/guide.h"
#include "steering/last_places.h"

namespace exactvo::formation {

namespace {

using namespace detail;
using crowd::refuse_snapshot;
using crowd::SnapshotReader;
using crowd::SnapshotWriter;
using geometry::norm;
using Clock = std::chrono::steady_clock;

/// Steps after which a robot looks along its route again.
constexpr std::size_t kLookAgain = 8;

/// Neighbours of a robot, the number of RVO2's examples and of the published comparisons.
constexpr int kNeighbours = 10;

/// The lattice reaches so many times as far as robots, goals and obstacles.
constexpr double kReach = 2.0;

/// m/s, of a moving obstacle: room below what a crowd takes for what its way is rounded by.
constexpr double kFastestBody = 0x1p14;

/// s that a run goes on after all have arrived, for those that were pushed off their goals to return.
constexpr double kReturn = 60.0;

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

CrowdOptions options_of(const Scenario& s, const CrowdRunOptions& options) {
  CrowdOptions out;
  out.time_step = s.time_step;
  out.precision = options.precision;
  out.threads = options.threads;
  out.ranks = options.ranks;
  out.position_step = position_step_for(s);
  return out;
}

class CrowdRun {
 public:
  CrowdRun(const Scenario& scenario, const CrowdRunOptions& options, CrowdSink* sink)
      : scenario_(scenario),
        options_(options),
        ranks_(options.ranks),
        sink_(is_first() ? sink : nullptr),
        crowd_(options_of(scenario, options)),
        ends_(share_ends(scenario.robots.size(), ranks_ ? ranks_->size() : 1)) {
    add_robots();
    for (const SceneObstacle& o : scenario.obstacles) o.disc ? crowd_.add_body(*o.disc) : crowd_.add_obstacle(o.shape);
    for (const MovingObstacle& o : scenario.moving_obstacles) {
      moving_.push_back(crowd_.add_moving_body(hull_of(o, {}), {}));
      moving_until_ = std::max(moving_until_, rests_from(o.motion));
    }
    if (options.guidance.value_or(scenario.guidance) == Guidance::route) guide_.emplace(scenario, 0.0);
    ways_.resize(scenario.robots.size());
    preferred_.resize(scenario.robots.size());
    crowd_.positions(at_);
    make_claims();
    make_reservations();
  }

  CrowdRunReport run() {
    const Clock::time_point start = Clock::now();
    options_.resume_from.empty() ? begin() : restore(options_.resume_from);
    const auto most = static_cast<std::size_t>(std::ceil(scenario_.time_limit / scenario_.time_step - 1e-9));
    for (After after = what_follows(false); report_.steps < most && after == After::step;) {
      step();
      after = what_follows(options_.progress && !options_.progress(report_.time));
      report_.interrupted = after == After::stop;
      const bool is_due = options_.snapshot_every > 0 && report_.steps % options_.snapshot_every == 0;
      if (options_.keep_snapshot && (is_due || report_.interrupted)) keep_snapshot();
    }
    finish();
    report_.wall_time = std::chrono::duration<double>(Clock::now() - start).count();
    return report_;
  }

 private:
  void begin() {
    report_.robots = ways_.size();
    for (std::size_t i = own_begin(); i < own_end(); ++i) set_out(i);
    if (sink_) sink_->begin(crowd_);
  }

  /// Where goals are nearer to each other than radii take.
  void make_claims() {
    if (scenario_.liveness == Liveness::off) return;
    const RoomAtEnds room;
    if (any_leave_no_room(scenario_, goals(), room)) last_places_ = last_places(scenario_, room);
    const bool may_end_elsewhere = guide_ && scenario_.unreachable == Unreachable::nearest;
    if (!may_end_elsewhere && (last_places_.empty() || !any_leave_no_room(scenario_, goals(), room))) return;
    claims_.emplace(scenario_, room, scenario_.horizons.orca);
    now_.resize(ways_.size());
  }

  void make_reservations() {
    // Robots with a reservation do not evade moving obstacles.
    if (scenario_.liveness != Liveness::plan || scenario_.robots.empty() || !scenario_.moving_obstacles.empty()) return;
    double widest = 0.0;
    for (const Robot& r : scenario_.robots) widest = std::max(widest, r.radius);
    space_.emplace(scenario_.obstacles);
    reservations_.emplace(*space_, ways_.size(), scenario_.time_step, widest);
    under_way_.resize(ways_.size());
  }

  /// Of all robots, the last ones where these stand aside.
  std::vector<RobotPlace> goals() const {
    std::vector<RobotPlace> all;
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      for (const Vec2 goal : scenario_.robots[i].goals) all.push_back({i, goal});
      if (!last_places_.empty()) all.back().place = last_places_[i];
    }
    return all;
  }

  // --- Ranks: each looks where robots own_begin() to own_end() are to go ---

  bool is_first() const { return !ranks_ || ranks_->rank() == 0; }
  std::size_t own_begin() const {
    return ranks_ && !is_first() ? ends_[static_cast<std::size_t>(ranks_->rank()) - 1] : 0;
  }
  std::size_t own_end() const { return ends_[ranks_ ? static_cast<std::size_t>(ranks_->rank()) : 0]; }

  /// All preferred velocities to all.
  void share_preferred() {
    if (ranks_) ranks_->share({{preferred_.data(), in_bytes(ends_, sizeof(Vec2))}});
  }

  /// All ways to the first rank, which says whether it is this one.
  bool gather_ways() {
    count_arrived();
    if (!ranks_) return true;
    require_same_states();
    std::ostringstream own;
    SnapshotWriter to(own);
    for (std::size_t i = own_begin(); i < own_end(); ++i) put(to, ways_[i]);
    const std::vector<std::string> all = ranks_->gather(own.str());
    for (std::size_t r = 1; r < all.size(); ++r) {
      std::istringstream bytes(all[r]);
      SnapshotReader from(bytes, kSnapshotOfRun);
      for (std::size_t i = ends_[r - 1]; i < ends_[r]; ++i) ways_[i] = get_way_of(from, i);
    }
    count_arrived();
    return is_first();
  }

  void count_arrived() {
    report_.arrived = static_cast<std::size_t>(
        std::count_if(ways_.begin(), ways_.end(), [](const CrowdWay& way) { return way.arrived.has_value(); }));
  }

  void require_same_states() const {
    const auto digest = static_cast<std::int64_t>(crowd_.digest() >> 1U);
    const std::int64_t least = ranks_->least(digest), most = -ranks_->least(-digest);
    if (least < most) throw RanksDiffer();
  }

  // --- Snapshots: the run, the crowd, the sink, and a checksum ---

  void keep_snapshot() {
    if (gather_ways()) options_.keep_snapshot(snapshot());
  }

  /// REQUIRES: all ways are here.
  std::string snapshot() const {
    std::ostringstream run, crowd, sink, whole;
    SnapshotWriter of_run(run), to(whole);
    of_run.put(ways_.size());
    for_each_count(report_, [&](const auto& count) { of_run.put(count); });
    of_run.fields(moved_, claimed_, all_arrived_, reserved_);
    for (const CrowdWay& way : ways_) put(of_run, way);
    if (claims_) put(of_run, *claims_);
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
    require(is_at_end(whole) && of_run.get<std::size_t>() == ways_.size());
    for_each_count(report_, [&](auto& count) { of_run.get(count); });
    of_run.fields(moved_, claimed_, all_arrived_, reserved_);
    for (std::size_t i = 0; i < ways_.size(); ++i) ways_[i] = get_way_of(of_run, i);
    if (claims_) get_claims(of_run, *claims_);
    if (reservations_) reservations_->get(of_run);
    const CrowdOptions wanted = crowd_.options();
    crowd_ = Crowd::restored(crowd, options_.threads, ranks_);
    const CrowdOptions& found = crowd_.options();
    require(is_at_end(run) && found.time_step == wanted.time_step && found.position_step == wanted.position_step &&
            found.precision == wanted.precision && crowd_.id_end() == ways_.size());
    crowd_.positions(at_);
    if (sink_) sink_->restore(crowd_, sink);
  }

  CrowdWay get_way_of(SnapshotReader& from, std::size_t i) const {
    return get_way(from, scenario_.robots[i].goals.size(), guide_.has_value());
  }

  static bool is_at_end(std::istream& from) { return from.peek() == std::istream::traits_type::eof(); }
  static void require(bool holds) {
    if (!holds) refuse_snapshot("other bytes", kSnapshotOfRun);
  }

  /// What adds up from step to step.
  template <class Report, class Visit>
  static void for_each_count(Report& r, const Visit& visit) {
    for (auto* count : {&r.robots, &r.arrived, &r.steps, &r.relaxed, &r.cut_short, &r.reserved, &r.overlapping,
                        &r.touching, &r.widened, &r.stopped, &r.half_planes, &r.edges, &r.bodies})
      visit(*count);
    for (auto* number : {&r.time, &r.path_length}) visit(*number);
  }

  void add_robots() {
    std::map<std::tuple<double, double>, KindId> kinds;
    crowd_.reserve(scenario_.robots.size());
    for (std::size_t i = 0; i < scenario_.robots.size(); ++i) {
      const Robot& r = scenario_.robots[i];
      try {
        auto known = kinds.find({r.radius, r.max_speed});
        if (known == kinds.end())
          known = kinds.emplace(std::tuple(r.radius, r.max_speed), crowd_.add_kind(kind_of(r))).first;
        add_robot(r, known->second);
      } catch (const CrowdError& e) {
        throw CrowdError(e.problem(), "robot " + r.id + ": " + e.what());
      }
    }
  }

  void add_robot(const Robot& r, KindId kind) {
    const double speed = norm(r.velocity), share = speed > r.max_speed ? r.max_speed / speed * (1.0 - 0x1p-40) : 1.0;
    crowd_.add_robot(r.position, kind, share * r.velocity);
  }

  CrowdKind kind_of(const Robot& r) const {
    CrowdKind kind;
    kind.radius = r.radius;
    kind.max_speed = r.max_speed;
    kind.time_horizon = scenario_.horizons.orca;
    kind.neighbour_distance = scenario_.neighbour_distance;
    kind.neighbours = kNeighbours;
    return kind;
  }

  Vec2 goal_of(std::size_t i) const { return scenario_.robots[i].goals[ways_[i].goal]; }

  bool has_last_goal(std::size_t i) const { return ways_[i].goal + 1 == scenario_.robots[i].goals.size(); }
  Vec2 aim_of(std::size_t i) const { return has_last_goal(i) && !last_places_.empty() ? last_places_[i] : goal_of(i); }

  /// For the present goal.
  void set_out(std::size_t i) {
    CrowdWay& way = ways_[i];
    const Vec2 aim = aim_of(i);
    const double reach =
        std::max(0.0, reach_of(scenario_.robots[i], way.goal, scenario_.arrival_tolerance) - norm(aim - goal_of(i)));
    way.heading = aim;
    if (!guide_) return;
    CourseAnswer answer = guide_->course(scenario_.robots[i].radius, at_[i], {aim, reach});
    way.course = std::move(answer.course);
    way.stays = !way.course;
    way.nearest = answer.nearest;
    way.why_not = answer.defect.empty() ? std::move(answer.why_not) : std::move(answer.defect);
  }

  void look(std::size_t i) {
    CrowdWay& way = ways_[i];
    const auto aim = [&] { return std::tuple(way.goal, way.heading.x, way.heading.y, way.stays); };
    const auto before = aim();
    const std::size_t next = way.course ? way.course->next : 0;
    bool is_new = false;
    if (has_reached_goal(i)) pass(i);
    const bool is_back = way.arrived && (!reservations_ || is_at_goal(i));
    const bool looks = way.course && !is_back && (report_.steps + i) % kLookAgain == 0;
    if (way.nearest) way.stays = norm(at_[i] - way.nearest->place) <= scenario_.arrival_tolerance;
    if (looks) {
      const Heading to = guide_->heading(*way.course, scenario_.robots[i].radius, at_[i]);
      way.heading = to.place;
      is_new = to.is_new;
    }
    if (is_new || aim() != before || (way.course && way.course->next != next)) way.turned = report_.steps;
  }

  bool is_at_goal(std::size_t i) const {
    return norm(at_[i] - goal_of(i)) <= reach_of(scenario_.robots[i], ways_[i].goal, scenario_.arrival_tolerance);
  }
  /// A goal on the way that is taken is passed beside it.
  bool has_reached_goal(std::size_t i) const { return is_at_goal(i) || (!has_last_goal(i) && rests_beside(i)); }

  /// Its goal is reached: on to the next.
  void pass(std::size_t i) {
    CrowdWay& way = ways_[i];
    if (way.goal + 1 < scenario_.robots[i].goals.size()) {
      ++way.goal;
      set_out(i);
    } else if (!way.arrived) {
      way.arrived = report_.time;
      way.heading = aim_of(i);
    }
  }

  // --- Ends that are taken ---

  Vec2 end_of(std::size_t i) const { return ways_[i].nearest ? ways_[i].nearest->place : aim_of(i); }

  void look_at_claims() {
    for (std::size_t i = own_begin(); i < own_end(); ++i) {
      const CrowdWay& way = ways_[i];
      const bool counts = way.nearest || way.course || !guide_, is_last = counts && ends_here(i);
      const bool is_there = way.nearest ? way.stays : is_at_goal(i);
      now_[i] = {at_[i], end_of(i), counts, is_last, !way.nearest, is_there, true};
    }
    if (ranks_) ranks_->share({{now_.data(), in_bytes(ends_, sizeof(EndNow))}});
    if (claims_->look(now_)) claimed_ = report_.steps;
  }

  /// It goes to no other goal.
  bool ends_here(std::size_t i) const { return has_last_goal(i) || ways_[i].nearest; }
  bool is_taken(std::size_t i) const { return claims_ && claims_->taken_by(i); }
  bool rests_beside(std::size_t i) const { return claims_ && claims_->rests(i); }

  Vec2 preferred_of(std::size_t i) const {
    const Vec2 way = ways_[i].heading - at_[i];
    const double length = norm(way);
    const double speed = std::min(scenario_.robots[i].max_speed, length / scenario_.time_step);
    const Vec2 preferred = ways_[i].stays || length == 0.0 ? Vec2{} : (speed / length) * way;
    return is_taken(i) && !now_[i].is_there ? claims_->beside_taken_place(i, preferred) : preferred;
  }

  /// Rule R1.
  Vec2 kept_right(std::size_t i, Vec2 preferred) {
    if (scenario_.liveness == Liveness::off) return preferred;
    CrowdWay& way = ways_[i];
    const double before = way.keep_right.held_up;
    const Vec2 turned = way.keep_right.turned(preferred, velocity_[i], 0.0, KeepRight::kPatience,
                                              norm(end_of(i) - at_[i]), scenario_.robots[i].radius);
    if (way.keep_right.held_up != before) way.turned = report_.steps;
    return turned;
  }

  // --- Reservations ---

  void reserve() {
    for (std::size_t i = own_begin(); i < own_end(); ++i) under_way_[i] = under_way(i);
    if (ranks_) ranks_->share({{under_way_.data(), in_bytes(ends_, sizeof(RobotUnderWay))}});
    reservations_->look(under_way_);
    if (reservations_->has_changed()) reserved_ = report_.steps;
    crowd_.set_reservations(reservations_->places(), reservations_->reserved());
  }

  bool has_reserved(std::size_t i) const { return reservations_ && reservations_->reserved()[i] != 0; }

  RobotUnderWay under_way(std::size_t i) const {
    const CrowdWay& way = ways_[i];
    RobotUnderWay r;
    r.position = at_[i];
    r.velocity = velocity_[i];
    r.radius = scenario_.robots[i].radius;
    r.max_speed = scenario_.robots[i].max_speed;
    r.leg = static_cast<std::uint32_t>(way.goal);
    r.yields = way.stays || is_taken(i);
    r.goal = end_of(i);
    r.is_at_goal = ends_here(i) && !way.nearest && is_at_goal(i);
    r.ahead.front() = way.heading;
    if (!way.course) return r;
    const std::vector<Vec2>& points = way.course->points;
    std::size_t k = way.course->next + 1;
    for (; k < points.size() && r.corners_ahead < RobotUnderWay::kMostAhead; ++k)
      r.ahead[r.corners_ahead++] = points[k];
    for (; k < points.size(); ++k) r.rest += norm(points[k] - points[k - 1]);
    return r;
  }

  /// Straight on to where each is at the end of the step, up to half a step of the lattice.
  void set_out_obstacles() {
    const double end = static_cast<double>(report_.steps + 1) * scenario_.time_step;
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      const Vec2 way = displacement_at(scenario_.moving_obstacles[k], end) - crowd_.body_displacement(moving_[k]);
      crowd_.set_body_velocity(moving_[k], way / scenario_.time_step);
    }
  }

  void step() {
    set_out_obstacles();
    for (std::size_t i = own_begin(); i < own_end(); ++i) look(i);
    if (claims_) look_at_claims();
    crowd_.velocities(velocity_);
    if (reservations_) reserve();
    for (std::size_t i = own_begin(); i < own_end(); ++i)
      preferred_[i] = has_reserved(i) ? reservations_->preferred()[i] : kept_right(i, preferred_of(i));
    share_preferred();
    crowd_.set_preferred(preferred_);
    const StepReport s = crowd_.step();
    ++report_.steps;
    report_.time = static_cast<double>(report_.steps) * scenario_.time_step;
    report_.relaxed += s.relaxed;
    report_.cut_short += s.cut_short;
    report_.reserved += s.reserved;
    report_.overlapping += s.overlapping;
    report_.touching += s.touching;
    report_.widened += s.widened;
    report_.stopped += s.stopped;
    report_.half_planes += s.neighbours;
    report_.edges += s.edges;
    report_.bodies += s.bodies;
    before_.swap(at_);
    crowd_.positions(at_);
    for (std::size_t i = 0; i < at_.size(); ++i) report_.path_length += norm(at_[i] - before_[i]);
    if (at_ != before_ || report_.time < moving_until_ + 2.0 * scenario_.time_step) moved_ = report_.steps;
    if (sink_) sink_->add_step(crowd_, report_.steps);
  }

  /// The least of what the ranks want.
  enum class After { stop, step, returns, nothing };
  After what_follows(bool is_stopped) {
    After own = After::stop;
    if (!is_stopped) own = someone_goes_on() ? After::step : someone_returns() ? After::returns : After::nothing;
    const After all = ranks_ ? static_cast<After>(ranks_->least(static_cast<int>(own))) : own;
    report_.stands_still = all == After::step && repeats_itself();
    if (report_.stands_still) return After::nothing;
    if (all != After::returns) return all;
    if (!all_arrived_) all_arrived_ = report_.steps;
    const double since = static_cast<double>(report_.steps - *all_arrived_) * scenario_.time_step;
    return since < kReturn ? After::step : After::nothing;
  }

  /// Of the own ones.
  bool someone_goes_on() const {
    for (std::size_t i = own_begin(); i < own_end(); ++i)
      if (!ways_[i].arrived && !ways_[i].stays && !(rests_beside(i) && ends_here(i))) return true;
    return false;
  }

  /// The same of those that were pushed off their goals.
  bool someone_returns() const {
    for (std::size_t i = own_begin(); reservations_ && i < own_end(); ++i)
      if (ways_[i].arrived && !is_at_goal(i) && !is_taken(i)) return true;
    return false;
  }

  /// Whether no step changes anything any more. What a step does follows from places, velocities, aims, claims and
  /// reservations, and from whose turn it is to look along its route. In as many steps as there are turns none of these
  /// has changed, from velocities of 0 on: so the next ones do what they have done.
  bool repeats_itself() const {
    const auto is_long_ago = [this](std::size_t step) { return step + 1 + kLookAgain <= report_.steps; };
    if (!is_long_ago(std::max({moved_, claimed_, reserved_}))) return false;
    if (reservations_ && std::max(moved_, reserved_) + reservations_->patience() > report_.steps) return false;
    bool is_so = true;
    for (std::size_t i = own_begin(); i < own_end(); ++i) is_so = is_so && is_long_ago(ways_[i].turned);
    return (ranks_ ? ranks_->least(is_so) : is_so) != 0;
  }

  // --- The end ---

  std::string why_not_there(std::size_t i) const {
    const CrowdWay& way = ways_[i];
    if (!way.nearest) return way.why_not;
    if (!way.stays && rests_beside(i)) return way.why_not + "; it stays, since " + claims_->words(i);
    return way.why_not + "; it " + (way.stays ? "went" : "was on its way") + " as near as it can, " +
           words_of(*way.nearest);
  }

  void finish() {
    report_.digest = crowd_.digest();
    for (std::size_t i = own_begin(); i < own_end(); ++i) look(i);
    if (claims_) look_at_claims();
    if (!gather_ways()) return;
    std::vector<double> times;
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      report_.pushed_off += ways_[i].arrived && norm(at_[i] - goal_of(i)) > scenario_.arrival_tolerance;
      if (ways_[i].stays || ways_[i].nearest)
        report_.without_route.push_back({i, why_not_there(i)});
      else if (!ways_[i].arrived && is_taken(i))
        report_.goal_taken.push_back({i, claims_->words(i)});
      if (ways_[i].arrived) times.push_back(*ways_[i].arrived);
    }
    report_.staying = report_.without_route.size();
    std::sort(times.begin(), times.end());
    if (2 * times.size() > ways_.size()) report_.median_arrival = times[ways_.size() / 2];
    if (!times.empty()) report_.last_arrival = times.back();
    count_arrived();
  }

  const Scenario& scenario_;
  const CrowdRunOptions& options_;
  Ranks* ranks_;
  CrowdSink* sink_;
  Crowd crowd_;
  std::vector<std::size_t> ends_;  ///< of the shares of the robots, by rank
  std::optional<Guide> guide_;
  std::vector<CrowdWay> ways_;
  std::vector<ObstacleId> moving_;
  std::vector<Vec2> at_, before_, velocity_, preferred_;
  std::vector<Vec2> last_places_;  ///< empty: their last goals
  std::optional<GoalClaims> claims_;
  std::vector<EndNow> now_;             ///< with claims
  std::optional<ObstacleSpace> space_;  ///< with reservations
  std::optional<Reservations> reservations_;
  std::vector<RobotUnderWay> under_way_;
  std::optional<std::size_t> all_arrived_;  ///< step after which some have only to return to their goals
  std::size_t reserved_ = 0;                ///< step at which a reservation changed last
  double moving_until_ = 0.0;               ///< s, the obstacles
  std::size_t moved_ = 0;                   ///< the last step in which something moved
  std::size_t claimed_ = 0;                 ///< step at which a claim changed last
  CrowdRunReport report_;
};

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
  require(s.speed_bound == SpeedBoundKind::disc, "/speed_bound", "box", "disc, for a crowd");
  const double step = position_step_for(s);
  const auto [tolerance, least] = geometry::told_apart(s.arrival_tolerance, step, 6);
  require(s.arrival_tolerance >= step, "/arrival_tolerance", tolerance + " m",
          "at least " + least + " m, the lattice of positions of a crowd of this extent and speed");
  for (std::size_t i = 0; i < s.robots.size() && problems.empty(); ++i)
    require(s.robots[i].cooperates, "/robots/" + std::to_string(i) + "/cooperates", "false", "true, for a crowd");
  return problems;
}

CrowdRunReport run_crowd(const Scenario& scenario, const CrowdRunOptions& options, CrowdSink* sink) {
  const std::vector<ScenarioProblem> problems = crowd_problems(scenario);
  EXACTVO_REQUIRE(problems.empty(), problems.front().pointer + ": " + problems.front().found);
  return CrowdRun(scenario, options, sink).run();
}

}  // namespace exactvo::formation
