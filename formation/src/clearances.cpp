// SPDX-License-Identifier: GPL-3.0-or-later
#include "clearances.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "exactvo/geometry/distance.h"
#include "motion.h"
#include "moving_way.h"

namespace exactvo::formation::detail {
namespace {

using geometry::norm;
using geometry::Segment;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double largest(Vec2 v) {
  return std::max(std::fabs(v.x), std::fabs(v.y));
}
double largest(const Segment& s) {
  return std::max(largest(s.a), largest(s.b));
}
double largest(const geometry::Obstacle& shape) {
  double most = 0.0;
  for (Vec2 p : geometry::vertices_of(shape)) most = std::max(most, largest(p));
  return most;
}

/// m: what a swept clearance may be off by. The distance's own bound, and as much again for the chords' ends, the
/// displacement, the stray and the radii: fewer than 64 roundings of at most the coordinates between them, and the
/// bound is 128 units of them.
double rounding(double shape, const Segment& chord, double others) {
  return 2.0 * geometry::rounding_of_distance(std::max(shape, largest(chord)) + others);
}

/// Who may not be touched: an obstacle, a moving obstacle or another robot, by its number.
using Other = std::pair<CollisionKind, std::size_t>;

/// Contacts of one pair in consecutive steps are one collision.
class Contacts {
 public:
  void note(std::size_t robot, Other other, std::size_t step, double clearance) {
    std::vector<Contact>& all = contacts_[{robot, other}];
    if (all.empty() || all.back().last + 1 < step) all.push_back({step, step, step, clearance});
    Contact& now = all.back();
    now.last = step;
    if (clearance < now.clearance) {
      now.clearance = clearance;
      now.deepest = step;
    }
  }

  struct Contact {
    std::size_t first, last, deepest;  ///< steps
    double clearance;                  ///< m, the least
  };
  const std::map<std::pair<std::size_t, Other>, std::vector<Contact>>& all() const { return contacts_; }

 private:
  std::map<std::pair<std::size_t, Other>, std::vector<Contact>> contacts_;
};

class Sweep {
 public:
  Sweep(const Scenario& scenario, const Recording& recording) : scenario_(scenario), recording_(recording) {
    for (const SceneObstacle& o : scenario.obstacles) largest_.push_back(largest(o.shape));
    for (const MovingObstacle& o : scenario.moving_obstacles) {
      ways_.push_back(way_of(o.motion, recording.steps.back().time + recording.time_step));
      moving_largest_.push_back(largest(o.shape));
    }
  }

  Clearances operator()() {
    std::vector<double> least(scenario_.robots.size(), kInfinity);
    double between = kInfinity;
    for (std::size_t k = 0; k + 1 < recording_.steps.size(); ++k) {
      std::vector<Motion> motions;
      for (std::size_t i = 0; i < least.size(); ++i) {
        motions.push_back(motion_of(k, i));
        lower_to_obstacles(k, i, motions.back(), least[i]);
      }
      lower_between(k, motions, between);
    }
    Clearances out;
    for (double x : least) out.to_obstacles.push_back(std::isfinite(x) ? std::optional<double>(x) : std::nullopt);
    if (std::isfinite(between)) out.between_robots = between;
    out.collisions = collisions();
    return out;
  }

 private:
  Motion motion_of(std::size_t step, std::size_t robot) const {
    const RobotStep& from = recording_.steps[step].robots[robot];
    const RobotStep& to = recording_.steps[step + 1].robots[robot];
    return {recording_.motion, recording_.time_step, recording_.tracking_gain, from.position, from.velocity,
            to.position,       to.velocity};
  }

  /// What is not touched need not be known beyond the least so far.
  static double enough(double least) { return std::max(least, 0.0); }

  void lower_to_obstacles(std::size_t step, std::size_t robot, const Motion& motion, double& least) {
    for (std::size_t o = 0; o < scenario_.obstacles.size(); ++o)
      note(robot, {CollisionKind::obstacle, o}, step, obstacle_clearance(o, robot, motion, enough(least)), least);
    for (std::size_t o = 0; o < scenario_.moving_obstacles.size(); ++o)
      note(robot, {CollisionKind::moving_obstacle, o}, step, moving_clearance(o, step, robot, motion, enough(least)),
           least);
  }

  void note(std::size_t robot, Other other, std::size_t step, double clearance, double& least) {
    if (touched(clearance)) contacts_.note(robot, other, step, clearance);
    least = std::min(least, clearance);
  }

  double obstacle_clearance(std::size_t obstacle, std::size_t robot, const Motion& motion, double enough) const {
    const double radius = scenario_.robots[robot].radius, reach = radius + motion.reach();
    return least_clearance(
        [&](double start, double end) {
          const Segment chord = motion.chord(start, end);
          const double off = rounding(largest_[obstacle], chord, reach) + radius;
          const double distance = geometry::swept_distance(scenario_.obstacles[obstacle].shape, chord);
          return ChordClearance{distance - off, motion.stray(end - start)};
        },
        0.0, 1.0, enough);
  }

  /// Piece after piece of the obstacle's way.
  double moving_clearance(std::size_t obstacle, std::size_t step, std::size_t robot, const Motion& motion,
                          double enough) const {
    const std::vector<WayPiece>& way = ways_[obstacle];
    const double time = recording_.steps[step].time, end = time + motion.duration;
    double least = kInfinity;
    for (std::size_t p = piece_at(way, time); p < way.size() && way[p].from < end; ++p) {
      const double from = std::clamp((way[p].from - time) / motion.duration, 0.0, 1.0);
      const double to = std::clamp((way[p].to - time) / motion.duration, 0.0, 1.0);
      least = std::min(least, along_piece(obstacle, way[p], time, robot, motion, from, to, std::min(enough, least)));
    }
    return least;
  }

  double along_piece(std::size_t obstacle, const WayPiece& piece, double time, std::size_t robot, const Motion& motion,
                     double from, double to, double enough) const {
    // Shares of the step become times, and times shares: 8 roundings of the time, which both spend moving.
    constexpr double kRoundingOfTime = 8 * 0x1p-53;
    const double end = time + motion.duration;
    const double late =
        kRoundingOfTime * end * (motion.speed_bound() + 2.0 * piece.speed_bound(std::min(end, piece.to)));
    const double radius = scenario_.robots[robot].radius, off = radius + late + piece.error;
    const geometry::Obstacle& shape = scenario_.moving_obstacles[obstacle].shape;
    return least_clearance(
        [&](double start, double stop) {
          const double t0 = time + start * motion.duration, t1 = time + stop * motion.duration;
          const Segment chord = motion.chord(start, stop);
          const Segment seen{chord.a - piece.at(t0), chord.b - piece.at(t1)};
          const double others = radius + motion.reach() + largest(chord);
          const double bend = std::fabs(piece.rate) * (t1 - t0) * (t1 - t0) / 8.0;
          return ChordClearance{
              geometry::swept_distance(shape, seen) - off - rounding(moving_largest_[obstacle], seen, others),
              motion.stray(stop - start) + bend};
        },
        from, to, enough);
  }

  /// How far a robot gets from where it starts, m.
  static double strays(const Motion& m) { return norm(m.to - m.from) + m.stray(1.0); }

  /// Pairs that stay farther apart than the least so far are skipped: twice their ways would not bring them nearer.
  void lower_between(std::size_t step, const std::vector<Motion>& all, double& least) {
    std::vector<double> ways;
    for (const Motion& m : all) ways.push_back(strays(m));
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        const double radii = scenario_.robots[i].radius + scenario_.robots[j].radius;
        const double apart = norm(all[i].from - all[j].from) - radii;
        if (apart > enough(least) + 2.0 * (ways[i] + ways[j])) continue;
        note(i, {CollisionKind::robot, j}, step, pair_clearance(all[i], all[j], radii, enough(least)), least);
      }
    }
  }

  static double pair_clearance(const Motion& a, const Motion& b, double radii, double enough) {
    const Motion motion = relative(a, b);
    const double coordinates = std::max({largest(a.from), largest(a.to), largest(b.from), largest(b.to)});
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

  /// m: the clearance at one moment, a share of the way through the step.
  double clearance_at(std::size_t robot, Other other, std::size_t step, double share) const {
    const Vec2 place = motion_of(step, robot).at(share);
    const double radius = scenario_.robots[robot].radius;
    const double time = recording_.steps[step].time + share * recording_.time_step;
    const auto [kind, index] = other;
    if (kind == CollisionKind::robot)
      return norm(place - motion_of(step, index).at(share)) - radius - scenario_.robots[index].radius;
    if (kind == CollisionKind::obstacle)
      return geometry::signed_distance(scenario_.obstacles[index].shape, place) - radius;
    const std::vector<WayPiece>& way = ways_[index];
    const Vec2 moved = way[std::min(piece_at(way, time), way.size() - 1)].at(time);
    return geometry::signed_distance(scenario_.moving_obstacles[index].shape, place - moved) - radius;
  }

  std::string name_of(Other other) const {
    const auto [kind, index] = other;
    if (kind == CollisionKind::robot) return scenario_.robots[index].id;
    return kind == CollisionKind::obstacle ? scenario_.obstacles[index].id : scenario_.moving_obstacles[index].id;
  }

  Collision collision(std::size_t robot, Other other, const Contacts::Contact& contact) const {
    constexpr int kMoments = 64;  // of the deepest step
    Collision c;
    c.robot = scenario_.robots[robot].id;
    c.kind = other.first;
    c.with = name_of(other);
    c.from = recording_.steps[contact.first].time;
    c.until = recording_.steps[contact.last + 1].time;
    double least = kInfinity;
    for (int m = 0; m <= kMoments; ++m) {
      const double share = static_cast<double>(m) / kMoments;
      const double clearance = clearance_at(robot, other, contact.deepest, share);
      if (!(clearance < least)) continue;
      least = clearance;
      c.deepest_at = recording_.steps[contact.deepest].time + share * recording_.time_step;
      c.place = motion_of(contact.deepest, robot).at(share);
    }
    c.depth = -std::min(least, contact.clearance);
    c.relaxed = was_relaxed(robot, other, contact);
    return c;
  }

  /// Whether a decision of one of the two could not keep every half-plane on the way into it.
  bool was_relaxed(std::size_t robot, Other other, const Contacts::Contact& contact) const {
    const std::size_t before = contact.first > 0 ? contact.first - 1 : 0;
    for (std::size_t k = before; k <= contact.last; ++k) {
      const std::vector<RobotStep>& row = recording_.steps[k].robots;
      if (row[robot].status != lp::Status::optimal) return true;
      if (other.first == CollisionKind::robot && row[other.second].status != lp::Status::optimal) return true;
    }
    return false;
  }

  std::vector<Collision> collisions() const {
    std::vector<Collision> out;
    for (const auto& [pair, contacts] : contacts_.all())
      for (const Contacts::Contact& contact : contacts) out.push_back(collision(pair.first, pair.second, contact));
    std::stable_sort(out.begin(), out.end(), [](const Collision& a, const Collision& b) { return a.from < b.from; });
    return out;
  }

  const Scenario& scenario_;
  const Recording& recording_;
  std::vector<double> largest_, moving_largest_;
  std::vector<std::vector<WayPiece>> ways_;
  Contacts contacts_;
};

}  // namespace

Clearances swept_clearances(const Scenario& scenario, const Recording& recording) {
  return Sweep(scenario, recording)();
}

}  // namespace exactvo::formation::detail
