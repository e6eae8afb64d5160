// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/clearances.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>
#include <variant>

#include "exactvo/formation/disc_obstacle.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/distance.h"
#include "exactvo/geometry/infinity.h"
#include "exactvo/geometry/obstacle_index.h"
#include "exactvo/geometry/twist.h"
#include "motion/motion.h"
#include "motion/moving_way.h"
#include "scene/near_pairs.h"
#include "scene/number_text.h"

namespace exactvo::formation::detail {
namespace {

using geometry::Segment;

using geometry::kInfinity;

/// Covers the roundings of a few operations.
constexpr double kWider = 1.0 + 1e-9;

double largest_coordinate(const Segment& s) {
  return std::max(largest_coordinate(s.a), largest_coordinate(s.b));
}
double largest_coordinate(const geometry::Obstacle& shape) {
  double most = 0.0;
  for (Vec2 p : geometry::vertices_of(shape)) most = std::max(most, geometry::largest_coordinate(p));
  return most;
}

/// m: what a swept clearance may be off by. The distance's own bound, and as much again for the chords' ends, the
/// displacement, the stray and the radii: fewer than 64 roundings of at most the coordinates between them, and the
/// bound is 128 units of them.
double rounding(double shape, const Segment& chord, double others) {
  return 2.0 * geometry::rounding_of_distance(std::max(shape, largest_coordinate(chord)) + others);
}

/// What may not be touched: an obstacle, a moving obstacle or another robot, by its number.
using Other = std::pair<CollisionKind, std::size_t>;

/// What is known round a place where a robot was: no static obstacle is nearer.
struct Quiet {
  Vec2 place;
  double room = 0.0;    ///< m
  int steps_until = 0;  ///< before it is looked at again
  int patience = 1;     ///< how many steps to wait if it is worth nothing again
};

/// How the chain of a footprint moves during a step.
struct Swing {
  Vec2 from;              ///< m, the reference point at the step's start
  Vec2 heading;           ///< at the step's start
  geometry::Twist twist;  ///< of the reference point, in the axes of the world

  /// m: the centre of a disc that is `ahead` of the reference point, `time` s after the step's start.
  Vec2 at(double ahead, double time) const {
    return from + geometry::displacement_after(twist, time).moved(ahead * heading);
  }
};

/// Where a robot and what it touches were between two rows.
struct Moment {
  double time = 0.0;  ///< s, of the first row
  Motion robot, other;
  std::optional<Swing> swing = {};  ///< of a robot with a chain
};

/// Consecutive steps in which a pair touches: one collision.
struct Contact {
  std::size_t last = 0;  ///< step
  double from = 0.0, until = 0.0;
  double clearance = kInfinity;  ///< m, the least
  Moment deepest;
  bool relaxed = false;  ///< a decision of one of the two could not keep every half-plane before or meanwhile
  bool standing = true;  ///< the robot did not move, and the other is of bounded speed
};

}  // namespace

class ClearanceSweep::Sweep {
 public:
  Sweep(const Scenario& scenario, const Recording& run)
      : scenario_(scenario), run_(run), least_(scenario.robots.size(), kInfinity) {
    std::vector<geometry::Box> boxes;
    for (const SceneObstacle& o : scenario.obstacles) {
      largest_.push_back(largest_coordinate(o.shape));
      cores_.push_back(core_of(o));
      geometry::Box& box = boxes.emplace_back();
      for (const Vec2 p : geometry::vertices_of(o.shape)) box.add(p);
    }
    obstacles_.resize(scenario.obstacles.size());
    quiet_.resize(scenario.robots.size());
    by_place_ = geometry::BoxGrid(std::move(boxes));
    for (const double x : largest_) largest_of_all_ = std::max(largest_of_all_, x);
    constexpr double kToTheEnd = std::numeric_limits<double>::max();
    for (const MovingObstacle& o : scenario.moving_obstacles) {
      ways_.push_back(way_of(o.motion, kToTheEnd));
      moving_largest_.push_back(largest_coordinate(o.shape));
      moving_cores_.push_back(core_of(o));
    }
  }

  void add(RowState row) {
    if (!rows_.empty()) {
      const std::size_t step = count_++;
      motions_.clear();
      for (std::size_t i = 0; i < least_.size(); ++i) motions_.push_back(motion_to(row, i));
      arrived_ = &row;
      for (std::size_t i = 0; i < least_.size(); ++i) lower_to_obstacles(step, row.time, i);
      lower_between(step, row.time);
    }
    if (rows_.size() == 2) {
      std::swap(rows_.front(), rows_.back());
      rows_.pop_back();
    }
    rows_.push_back(std::move(row));
  }

  Clearances result() const {
    Clearances out;
    for (double x : least_) out.to_obstacles.push_back(std::isfinite(x) ? std::optional<double>(x) : std::nullopt);
    if (std::isfinite(between_)) out.between_robots = between_;
    out.collisions = collisions();
    return out;
  }

  /// What is known round a place is found again.
  void put(crowd::SnapshotWriter& to) const {
    to.fields(least_, between_, count_, rows_.size(), contacts_.size());
    for (const RowState& row : rows_) {
      to.put(row.time);
      for (const RowState::Robot& r : row.robots) to.fields(r.position, r.velocity, r.relaxed);
    }
    for (const auto& [pair, contacts] : contacts_) {
      to.fields(pair.first, static_cast<int>(pair.second.first), pair.second.second, contacts.size());
      for (const Contact& c : contacts) {
        to.fields(c.last, c.from, c.until, c.clearance, c.relaxed, c.standing, c.deepest.time);
        for (const Motion& m : {c.deepest.robot, c.deepest.other})
          to.fields(m.from, m.from_velocity, m.to, m.to_velocity);
      }
    }
  }

  void get(crowd::SnapshotReader& from) {
    from.fields(least_, between_, count_);
    const auto rows = from.get<std::size_t>(), pairs = from.get<std::size_t>();
    require(least_.size() == quiet_.size() && rows <= 2);
    rows_.assign(rows, {});
    for (RowState& row : rows_) {
      from.get(row.time);
      row.robots.resize(quiet_.size());
      for (RowState::Robot& r : row.robots) from.fields(r.position, r.velocity, r.relaxed);
    }
    for (std::size_t k = 0; k < pairs; ++k) {
      const auto robot = from.get<std::size_t>();
      const int kind = from.get<int>();
      const auto with = from.get<std::size_t>(), contacts = from.get<std::size_t>();
      require(robot < quiet_.size() && exists(kind, with));
      std::vector<Contact>& all = contacts_[{robot, {static_cast<CollisionKind>(kind), with}}];
      for (std::size_t c = 0; c < contacts; ++c) all.push_back(get_contact(from));
    }
  }

 private:
  static void require(bool holds) {
    if (!holds) crowd::refuse_snapshot("other bytes", "those of a run of this scenario");
  }

  bool exists(int kind, std::size_t index) const {
    const std::size_t all[] = {scenario_.obstacles.size(), scenario_.moving_obstacles.size(), scenario_.robots.size()};
    return kind >= 0 && kind < 3 && index < all[kind];
  }

  Contact get_contact(crowd::SnapshotReader& from) const {
    Contact c;
    from.fields(c.last, c.from, c.until, c.clearance, c.relaxed, c.standing, c.deepest.time);
    for (Motion* m : {&c.deepest.robot, &c.deepest.other}) {
      Vec2 start, start_velocity, end, end_velocity;
      from.fields(start, start_velocity, end, end_velocity);
      *m = {run_.motion, decay_, start, start_velocity, end, end_velocity};
    }
    return c;
  }

  /// From the last row to this one.
  Motion motion_to(const RowState& row, std::size_t robot) const {
    const RowState::Robot &from = rows_.back().robots[robot], &to = row.robots[robot];
    return {run_.motion, decay_, from.position, from.velocity, to.position, to.velocity};
  }

  /// What is not touched need not be known beyond the least so far.
  static double enough(double least) { return std::max(least, 0.0); }

  void lower_to_obstacles(std::size_t step, double end, std::size_t robot) {
    double& least = least_[robot];
    if (!scenario_.obstacles.empty() && !stays_quiet(robot, enough(least))) {
      for (const std::size_t o : near_obstacles(robot, reach_that_matters(robot, enough(least)))) {
        const double disc = obstacle_clearance(o, robot, motions_[robot], enough(least));
        note(robot, {CollisionKind::obstacle, o}, step, end, std::min(disc, links_clearance(o, robot, enough(least))),
             least);
      }
      look_round(robot, enough(least));
    }
    for (std::size_t o = 0; o < scenario_.moving_obstacles.size(); ++o)
      note(robot, {CollisionKind::moving_obstacle, o}, step, end,
           moving_clearance(o, robot, motions_[robot], enough(least)), least);
  }

  /// m: nothing farther from the motion's chord can bring its clearance below `enough`.
  double reach_that_matters(std::size_t robot, double enough) const {
    const Motion& motion = motions_[robot];
    return kWider * (enough + most_off(robot, motion, motion.chord(0.0, 1.0)) + motion.stray(1.0));
  }

  /// Obstacles whose boxes are that near to the motion's chord, by number.
  const std::vector<std::size_t>& near_obstacles(std::size_t robot, double reach) {
    near_.clear();
    const Segment chord = motions_[robot].chord(0.0, 1.0);
    geometry::Box box;
    box.add(chord.a);
    box.add(chord.b);
    by_place_.for_each_meeting({box.low - Vec2{reach, reach}, box.high + Vec2{reach, reach}},
                               [&](std::size_t o) { near_.push_back(o); });
    std::sort(near_.begin(), near_.end());
    return near_;
  }

  /// Whether what is known round a place says that no obstacle matters to this step.
  bool stays_quiet(std::size_t robot, double enough) const {
    const Quiet& quiet = quiet_[robot];
    if (!(quiet.room > 0.0)) return false;
    const Segment chord = motions_[robot].chord(0.0, 1.0);
    const double away = std::max(norm(chord.a - quiet.place), norm(chord.b - quiet.place));
    return quiet.room > kWider * (away + reach_that_matters(robot, enough));
  }

  /// Looks as far round the end of the step as pays for some steps to come. Where obstacles are too near for that it is
  /// tried again after 1, 2, 4, ... steps.
  void look_round(std::size_t robot, double enough) {
    constexpr double kSteps = 10.0;
    constexpr int kMostPatience = 16;
    Quiet& quiet = quiet_[robot];
    quiet.room = 0.0;
    if (--quiet.steps_until > 0 || !std::isfinite(enough)) return;
    const double step = strays(motions_[robot]), reach = reach_that_matters(robot, enough);
    const double worth = reach + 3.0 * step, most = reach + kSteps * step + obstacle_reach(scenario_.robots[robot]);
    quiet.place = motions_[robot].chord(0.0, 1.0).b;
    double room = most;
    for (const std::size_t o : near_obstacles(robot, most)) {
      const double rounding =
          2.0 * geometry::rounding_of_distance(std::max(largest_[o], largest_coordinate(quiet.place)));
      const double off = rounding + cores_[o].grown;
      room = std::min(room, index_of(o).swept_distance({quiet.place, quiet.place}, most + off) - off);
      if (room < worth) break;
    }
    if (room >= worth) {
      quiet.room = room;
      quiet.patience = 1;
    } else {
      quiet.steps_until = quiet.patience;
      quiet.patience = std::min(2 * quiet.patience, kMostPatience);
    }
  }

  const geometry::ObstacleIndex& index_of(std::size_t obstacle) const {
    std::optional<geometry::ObstacleIndex>& index = obstacles_[obstacle];
    if (!index) index.emplace(cores_[obstacle].shape);
    return *index;
  }

  /// m: no chord of the motion has more taken off its distance.
  double most_off(std::size_t robot, const Motion& motion, const Segment& chord) const {
    const double radius = obstacle_reach(scenario_.robots[robot]), reach = radius + motion.reach();
    return 2.0 * rounding(largest_of_all_, chord, reach + motion.stray(1.0)) + radius;
  }

  /// m, the least clearance that there can be: the centre at no distance from a line or another centre. The bounds of
  /// roundings and curves may lie below it.
  double least_possible(std::size_t robot, Other other) const {
    const auto [kind, index] = other;
    if (kind == CollisionKind::robot) return -(scenario_.robots[robot].radius + scenario_.robots[index].radius);
    const double radius = obstacle_radius(scenario_.robots[robot]);
    const Core& core = kind == CollisionKind::obstacle ? cores_[index] : moving_cores_[index];
    return std::holds_alternative<geometry::Polyline>(core.shape) ? -(radius + core.grown) : -kInfinity;
  }

  void note(std::size_t robot, Other other, std::size_t step, double end, double bound, double& least) {
    double clearance = std::max(bound, least_possible(robot, other));
    Moment moment{};
    if (touched(clearance)) {
      moment = {rows_.back().time, motions_[robot],
                motions_[other.first == CollisionKind::robot ? other.second : robot], swing_of(robot)};
      // Chords with an end inside a polygon know the depth of their ends only.
      clearance = std::min(clearance, deepest(robot, other, moment).clearance);
    }
    least = std::min(least, clearance);
    if (!touched(clearance)) return;
    std::vector<Contact>& all = contacts_[{robot, other}];
    if (all.empty() || all.back().last + 1 < step) {
      all.emplace_back().from = rows_.back().time;
      all.back().relaxed = was_relaxed(rows_.front(), robot, other);
    }
    Contact& now = all.back();
    now.last = step;
    now.until = end;
    now.relaxed = now.relaxed || was_relaxed(rows_.back(), robot, other);
    now.standing = now.standing && other.first == CollisionKind::moving_obstacle &&
                   scenario_.moving_obstacles[other.second].max_speed &&
                   rows_.back().robots[robot].position == arrived_->robots[robot].position;
    if (!(clearance < now.clearance)) return;
    now.clearance = clearance;
    now.deepest = moment;
  }

  static bool was_relaxed(const RowState& row, std::size_t robot, Other other) {
    return row.robots[robot].relaxed || (other.first == CollisionKind::robot && row.robots[other.second].relaxed);
  }

  /// Beyond `enough` any number that is not less.
  double obstacle_clearance(std::size_t obstacle, std::size_t robot, const Motion& motion, double enough) const {
    const double radius = obstacle_radius(scenario_.robots[robot]);
    return disc_clearance(
        obstacle, radius, motion.reach(), enough, [&](double start, double end) { return motion.chord(start, end); },
        [&](double share) { return motion.stray(share); });
  }

  /// The same for a disc. `chord(start, end)`: of its centre, from one share of the step to another, and `stray(share)`
  /// how far it strays from it in such a share of the step at most.
  template <class ChordOf, class StrayOf>
  double disc_clearance(std::size_t obstacle, double disc, double others, double enough, const ChordOf& chord_of,
                        const StrayOf& stray_of) const {
    constexpr double kRounding = 1e-12;
    const double radius = disc + cores_[obstacle].grown;
    return least_clearance(
        [&](double start, double end) {
          const Segment chord = chord_of(start, end);
          const double off = rounding(largest_[obstacle], chord, radius + others) + radius;
          const double stray = stray_of(end - start);
          const double distance = index_of(obstacle).swept_distance(chord, (1.0 + kRounding) * (enough + off + stray));
          return ChordClearance{distance - off, stray};
        },
        0.0, 1.0, enough);
  }

  /// The twist of a robot with a chain that leads to the row that comes; nothing where the rows have no wheels.
  std::optional<Swing> swing_of(std::size_t robot) const {
    const std::optional<DifferentialDrive>& drive = scenario_.robots[robot].drive;
    const RowState::Robot &from = rows_.back().robots[robot], &to = arrived_->robots[robot];
    if (!drive || drive->chain.empty() || !from.wheels || !to.wheels) return std::nullopt;
    const double turn = (to.wheels->speeds.right - to.wheels->speeds.left) / drive->wheel_separation;
    const Vec2 e = from.wheels->heading, left{-e.y, e.x};
    const double ahead = 0.5 * (to.wheels->speeds.left + to.wheels->speeds.right);
    return Swing{from.position, e, {ahead * e + drive->reference * turn * left, turn}};
  }

  /// The clearance of the chain of a footprint without its first disc, on the twist that leads to the row. (Its discs
  /// have room for more than roundings: the stray of the reference point, which is on this twist.)
  double links_clearance(std::size_t obstacle, std::size_t robot, double enough) const {
    double least = kInfinity;
    const std::optional<Swing> swing = swing_of(robot);
    if (!swing) return least;
    const DifferentialDrive& drive = *scenario_.robots[robot].drive;
    const double step = run_.time_step;
    for (std::size_t k = 1; k < drive.chain.size(); ++k) {
      const double ahead = drive.chain[k].center.x - drive.reference;
      const Vec2 q = ahead * swing->heading;
      least = std::min(least, disc_clearance(
                                  obstacle, drive.chain[k].radius, norm(q), std::min(enough, least),
                                  [&](double start, double end) {
                                    return Segment{swing->at(ahead, start * step), swing->at(ahead, end * step)};
                                  },
                                  [&](double share) { return geometry::stray_of(swing->twist, q, share * step); }));
    }
    return least;
  }

  /// Piece after piece of the obstacle's way.
  double moving_clearance(std::size_t obstacle, std::size_t robot, const Motion& motion, double enough) const {
    const std::vector<WayPiece>& way = ways_[obstacle];
    const double time = rows_.back().time, end = time + motion.decay.duration;
    double least = kInfinity;
    for (std::size_t p = piece_at(way, time); p < way.size() && way[p].from < end; ++p) {
      const double from = std::clamp((way[p].from - time) / motion.decay.duration, 0.0, 1.0);
      const double to = std::clamp((way[p].to - time) / motion.decay.duration, 0.0, 1.0);
      least = std::min(least, along_piece(obstacle, way[p], time, robot, motion, from, to, std::min(enough, least)));
    }
    return least;
  }

  double along_piece(std::size_t obstacle, const WayPiece& piece, double time, std::size_t robot, const Motion& motion,
                     double from, double to, double enough) const {
    // Shares of the step become times, and times shares: 8 roundings of the time, which both spend moving.
    constexpr double kRoundingOfTime = 8 * 0x1p-53;
    const double end = time + motion.decay.duration;
    const double late =
        kRoundingOfTime * end * (motion.speed_bound() + 2.0 * piece.speed_bound(std::min(end, piece.to)));
    const Core& core = moving_cores_[obstacle];
    const double radius = scenario_.robots[robot].radius + core.grown, off = radius + late + piece.error;
    return least_clearance(
        [&](double start, double stop) {
          const double t0 = time + start * motion.decay.duration, t1 = time + stop * motion.decay.duration;
          const Segment chord = motion.chord(start, stop);
          const Segment seen{chord.a - piece.at(t0), chord.b - piece.at(t1)};
          const double others = radius + motion.reach() + largest_coordinate(chord);
          const double bend = std::fabs(piece.rate) * (t1 - t0) * (t1 - t0) / 8.0;
          return ChordClearance{
              geometry::swept_distance(core.shape, seen) - off - rounding(moving_largest_[obstacle], seen, others),
              motion.stray(stop - start) + bend};
        },
        from, to, enough);
  }

  /// How far a robot gets from where it starts, m.
  static double strays(const Motion& m) { return norm(m.to - m.from) + m.stray(1.0); }

  /// Pairs that surely stay farther apart than the least so far are skipped.
  void lower_between(std::size_t step, double end) {
    constexpr double kStepsOfRoom = 16.0;  // found by measuring
    ways_of_step_.clear();
    starts_.clear();
    double longest = 0.0, largest_radius = 0.0, farthest = 0.0, most_reach = 0.0;
    for (const Motion& m : motions_) {
      starts_.push_back(m.from);
      const double way = ways_of_step_.emplace_back(strays(m));
      longest = std::isnan(way) ? kInfinity : std::max(longest, way);
      farthest = std::max({farthest, largest_coordinate(m.from), largest_coordinate(m.to)});
      most_reach = std::max(most_reach, m.reach());
    }
    for (const Robot& r : scenario_.robots) largest_radius = std::max(largest_radius, r.radius);
    const double terms =
        2.0 * (farthest + longest + largest_radius + most_reach);  // of `rounding` of any pair, or more
    const double most_off = std::isfinite(terms) ? 2.0 * geometry::rounding_of_distance(terms) : kInfinity;
    const bool are_straight = run_.motion == MotionLaw::straight;
    // The least clearance falls meanwhile: what is too far for it now is too far then.
    const double reach = kWider * (enough(between_) + 4.0 * longest + 2.0 * largest_radius);
    near_pairs_.for_each(starts_, reach, kStepsOfRoom * longest, [&](std::size_t i, std::size_t j) {
      const double radii = scenario_.robots[i].radius + scenario_.robots[j].radius, kept = radii + enough(between_);
      const double ways = ways_of_step_[i] + ways_of_step_[j];
      const Vec2 apart = starts_[i] - starts_[j];
      const double far = kWider * (kept + std::min(2.0 * ways, ways + 2.0 * most_off));
      if (squared_norm(apart) > far * far || norm(apart) - radii > enough(between_) + 2.0 * ways) return;
      if (are_straight && stays_apart(apart, motions_[i].to - motions_[j].to, kWider * (kept + 2.0 * most_off))) return;
      note(i, {CollisionKind::robot, j}, step, end, pair_clearance(motions_[i], motions_[j], radii, enough(between_)),
           between_);
    });
  }

  /// Whether a point on its straight way stays farther than `keep` from 0, by more than `most_off`.
  static bool stays_apart(Vec2 from, Vec2 to, double keep) {
    const Vec2 way = to - from;
    const double along = -dot(from, way), length2 = squared_norm(way);
    if (!(along > 0.0)) return squared_norm(from) > keep * keep;
    if (along >= length2) return squared_norm(to) > keep * keep;
    const double across = cross(from, way);
    return across * across > keep * keep * length2;
  }

  static double pair_clearance(const Motion& a, const Motion& b, double radii, double enough) {
    const Motion motion = relative(a, b);
    const double coordinates = std::max(
        {largest_coordinate(a.from), largest_coordinate(a.to), largest_coordinate(b.from), largest_coordinate(b.to)});
    const Segment still{{0.0, 0.0}, {0.0, 0.0}};
    return least_clearance(
        [&](double start, double end) {
          const Segment chord = motion.chord(start, end);
          const double off = rounding(coordinates, chord, radii + a.reach() + b.reach());
          return ChordClearance{geometry::swept_distance(chord, still) - off - radii, motion.stray(end - start)};
        },
        0.0, 1.0, enough);
  }

  // --- Collisions ---

  /// m: the clearance at one moment, a share of the way through the step. Every disc of a chain counts against an
  /// obstacle at rest; beside moving obstacles there are no chains (scenario.h).
  double clearance_at(std::size_t robot, Other other, const Moment& moment, double share) const {
    const Vec2 place = moment.robot.at(share);
    const double radius = obstacle_radius(scenario_.robots[robot]);
    const double time = moment.time + share * run_.time_step;
    const auto [kind, index] = other;
    if (kind == CollisionKind::robot)
      return norm(place - moment.other.at(share)) - scenario_.robots[robot].radius - scenario_.robots[index].radius;
    if (kind == CollisionKind::obstacle) {
      const SceneObstacle& obstacle = scenario_.obstacles[index];
      double least = signed_distance(obstacle, place) - radius;
      if (!moment.swing) return least;
      const DifferentialDrive& drive = *scenario_.robots[robot].drive;
      for (std::size_t k = 1; k < drive.chain.size(); ++k) {
        const double ahead = drive.chain[k].center.x - drive.reference;
        const Vec2 center = moment.swing->at(ahead, share * run_.time_step);
        least = std::min(least, signed_distance(obstacle, center) - drive.chain[k].radius);
      }
      return least;
    }
    const std::vector<WayPiece>& way = ways_[index];
    const Vec2 moved = way[std::min(piece_at(way, time), way.size() - 1)].at(time);
    return signed_distance(scenario_.moving_obstacles[index], place - moved) - radius;
  }

  std::string name_of(Other other) const {
    const auto [kind, index] = other;
    if (kind == CollisionKind::robot) return scenario_.robots[index].id;
    return kind == CollisionKind::obstacle ? scenario_.obstacles[index].id : scenario_.moving_obstacles[index].id;
  }

  struct Depth {
    double clearance, share;  ///< m, and how far through the step
  };

  /// The least clearance of 65 moments of a step.
  Depth deepest(std::size_t robot, Other other, const Moment& moment) const {
    constexpr int kMoments = 64;
    Depth least{kInfinity, 0.0};
    for (int m = 0; m <= kMoments; ++m) {
      const double share = static_cast<double>(m) / kMoments;
      const double clearance = clearance_at(robot, other, moment, share);
      if (clearance < least.clearance) least = {clearance, share};
    }
    return least;
  }

  Collision collision(std::size_t robot, Other other, const Contact& contact) const {
    Collision c;
    c.robot = scenario_.robots[robot].id;
    c.kind = other.first;
    c.with = name_of(other);
    c.from = contact.from;
    c.until = contact.until;
    const double share = deepest(robot, other, contact.deepest).share;
    c.deepest_at = contact.deepest.time + share * run_.time_step;
    c.place = contact.deepest.robot.at(share);
    c.depth = -contact.clearance;
    c.relaxed = contact.relaxed;
    c.standing = contact.standing;
    return c;
  }

  std::vector<Collision> collisions() const {
    std::vector<Collision> out;
    for (const auto& [pair, contacts] : contacts_)
      for (const Contact& contact : contacts) out.push_back(collision(pair.first, pair.second, contact));
    std::stable_sort(out.begin(), out.end(), [](const Collision& a, const Collision& b) { return a.from < b.from; });
    return out;
  }

  const Scenario& scenario_;
  const Recording& run_;
  Decay decay_{run_.tracking_gain, run_.time_step};
  std::vector<double> largest_, moving_largest_;
  std::vector<Core> cores_, moving_cores_;
  double largest_of_all_ = 0.0;
  mutable std::vector<std::optional<geometry::ObstacleIndex>> obstacles_;  ///< of those that were near
  geometry::BoxGrid by_place_;
  std::vector<std::vector<WayPiece>> ways_;
  std::vector<double> least_;  ///< m, of each robot to obstacles
  double between_ = kInfinity;
  std::map<std::pair<std::size_t, Other>, std::vector<Contact>> contacts_;
  std::vector<RowState> rows_;         ///< the last two
  const RowState* arrived_ = nullptr;  ///< the one that comes
  std::size_t count_ = 0;              ///< steps
  // Memory that a step leaves to the next.
  std::vector<Motion> motions_;
  std::vector<double> ways_of_step_;  ///< m
  std::vector<Vec2> starts_;          ///< m
  NearPairsOfMoving near_pairs_;
  std::vector<std::size_t> near_;
  std::vector<Quiet> quiet_;  ///< of each robot
};

ClearanceSweep::ClearanceSweep(const Scenario& scenario, const Recording& run)
    : sweep_(std::make_unique<Sweep>(scenario, run)) {}
ClearanceSweep::~ClearanceSweep() = default;

void ClearanceSweep::add(const Step& row) {
  RowState state;
  state.time = row.time;
  state.robots.reserve(row.robots.size());
  for (const RobotStep& r : row.robots) state.robots.push_back({r.position, r.velocity, bodies_gave(r), r.wheels});
  sweep_->add(std::move(state));
}

void ClearanceSweep::add(RowState row) {
  sweep_->add(std::move(row));
}

Clearances ClearanceSweep::result() const {
  return sweep_->result();
}

void ClearanceSweep::put(crowd::SnapshotWriter& to) const {
  sweep_->put(to);
}

void ClearanceSweep::get(crowd::SnapshotReader& from) {
  sweep_->get(from);
}

namespace {

/// Lower bounds are a little too low, so that of two in contact, which is proven to be no more than that or which
/// rounding alone could explain, they lie just below 0: that is 0.
std::optional<double> contact_is_zero(std::optional<double> clearance) {
  if (clearance && *clearance < 0.0 && !touched(clearance)) clearance = 0.0;
  return clearance;
}

/// "R1 overlapped moving obstacle 'cart' by 1.4 m at 2.5 s".
std::string sentence(const Collision& c) {
  return c.robot + " overlapped " + name(c.kind) + " '" + c.with + "' by " + number_text(c.depth, 3) + " m at " +
         number_text(c.deepest_at, 3) + " s";
}

}  // namespace

void write_clearances(Clearances clearances, Metrics& m) {
  for (std::size_t i = 0; i < m.robots.size(); ++i) {
    const std::optional<double> mine = contact_is_zero(clearances.to_obstacles[i]);
    m.robots[i].min_obstacle_clearance = mine;
    if (mine) m.min_obstacle_clearance = std::min(*mine, m.min_obstacle_clearance.value_or(kInfinity));
  }
  m.min_robot_clearance = contact_is_zero(clearances.between_robots);
  m.collisions = std::move(clearances.collisions);
}

std::string collision_words(const Metrics& m) {
  std::vector<Collision> all;
  std::copy_if(m.collisions.begin(), m.collisions.end(), std::back_inserter(all),
               [](const Collision& c) { return !c.standing; });
  const std::size_t hits = m.collisions.size() - all.size();
  const std::string of_standing =
      hits == 0 ? "" : "robots that stood were hit by moving obstacles " + geometry::counted(hits, "time") + "; ";
  if (all.empty()) return of_standing;
  const auto deepest = std::max_element(all.begin(), all.end(),
                                        [](const Collision& a, const Collision& b) { return a.depth < b.depth; });
  std::string text = "COLLISION: " + sentence(*deepest);
  const auto relaxed =
      static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [](const Collision& c) { return c.relaxed; }));
  if (all.size() > 1) text += ", the deepest of " + std::to_string(all.size()) + " collisions";
  if (relaxed > 0) {
    text +=
        all.size() == 1 ? ", in a relaxed decision" : ", " + std::to_string(relaxed) + " of them in relaxed decisions";
    text += " (no velocity kept every half-plane)";
  }
  return text + "; " + of_standing;
}

}  // namespace exactvo::formation::detail
