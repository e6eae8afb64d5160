// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A monitor for a control loop: how much of a command is proven clear, if the robot keeps it until the next command
/// takes effect and then brakes to rest.
///
///     Monitor monitor(setup);
///     for (;;) drive(monitor.judge(pose, command).share * command);
///
/// The way. A command (a constant twist) that is scaled by a share s is held for `period + latency`, the time until
/// another one takes effect. Then speed and turn rate fall together and evenly to 0, within the braking limits,
/// so that the robot stops on the arc on which it was. A trajectory is followed for a share of its duration and for
/// `latency`, then the robot brakes along the rest of it. The pose is where the robot is as the command takes effect.
///
/// What the way is checked against: the obstacles, which stand still, and movers, which may go anywhere at no more than
/// their greatest speed from within their position error. Against movers the promise is passive safety (Macek et al.
/// 2009; Mitsch et al. 2017): no collision while the robot moves. Nothing is promised to a robot that stands.
///
/// Leaving a contact. Where the footprint, grown by the margin, overlaps an obstacle at the start or is less than
/// kMonitorSlack from it, what is proven is that it does not go deeper than at the start by more than kMonitorSlack:
/// depth is the length of the shortest shift that parts a convex part of the footprint and a convex piece of the
/// obstacle; a gap is a depth below 0. So a share above 0 may end in an overlap of up to kMonitorSlack where less than
/// that was left, and again at each decision: a loop that must never touch has a margin. Once the contact is seen to be
/// left, the rest must be clear; for that each arc is checked at kMonitorLooks moments or more. A mover that may
/// already touch, from anywhere within its position error, is taken as standing, and the footprint does not go deeper
/// into all of where it may be.
///
/// Certified: `share` (continuous time, no sampling; all roundings are bounded, geometry/turning.h). Certified too:
/// `not_above`. Against obstacles and the share of a command the two enclose the largest clear share. With movers a
/// larger share may be clear, since a faster robot can be past a place before a mover is there: the search is
/// heuristic. Rounded: the witness. Assumed: that the drive follows the command at once, up to `margin`.
///
/// See also: navigator.h makes decisions, geometry/turning.h, docs/guide/monitor.md.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/box_grid.h"
#include "exactvo/geometry/motions.h"
#include "exactvo/geometry/turning.h"
#include "exactvo/geometry/turning_motions.h"
#include "exactvo/geometry/twist.h"

namespace exactvo::formation {

/// m: the footprint is grown by this much and may go this much deeper where it is in contact.
inline constexpr double kMonitorSlack = 1e-9;

/// The monitor checks at this many moments of an arc, evenly spaced or closer, whether the robot has left a contact.
inline constexpr int kMonitorLooks = 64;

/// The robot and what stands still.
struct MonitorSetup {
  /// In the body's axes (x ahead, y left), with `Pose::at` at the origin. Parts are convex hulls with a radius.
  geometry::RigidBody footprint = geometry::disc_body(0.3);
  double max_deceleration = 1.0;         ///< m/s^2, >= 2^-30: deceleration that the robot always reaches
  double max_turn_deceleration = 2.0;    ///< rad/s^2, >= 2^-30: angular deceleration that it always reaches
  double latency = 0.1;                  ///< s, >= 0: from a decision to its effect
  double period = 0.1;                   ///< s, >= 0: from a decision to the next
  double margin = 0.0;                   ///< m, >= 0: localisation, map and drive are off by no more than this together
  std::vector<SceneObstacle> obstacles;  ///< what stands still
};

/// Something that moves: the convex hull of its corners, grown by its radius.
struct Mover {
  geometry::RoundedPolygon shape;  ///< m, in the world, where it was seen
  double max_speed = 0.0;          ///< m/s, >= 0
  double position_error = 0.0;     ///< m, >= 0: it is no farther than this from where it was seen
};

/// A constant twist in the body's axes, or a velocity in the world's with a heading that stays.
struct Command {
  geometry::Twist twist;       ///< m/s, rad/s
  bool in_world_axes = false;  ///< the velocity is in world axes; then turn must be 0
};

/// A piece of a trajectory.
struct TimedPose {
  double time = 0.0;    ///< s, from now, rising
  geometry::Pose pose;  ///< between two of them the twist is constant (geometry::twist_between), less than 2^30
};

/// What ends the clear share.
struct MonitorWitness {
  bool is_mover = false;  ///< a mover, not an obstacle
  std::size_t index = 0;  ///< of the obstacle in the setup, or of the mover in the list
  double time =
      0.0;  ///< s, from the effect of the command: when it gets too near, at full share; by a mover at the share tried
  geometry::Vec2 place;  ///< m, rounded: where
};

/// The answer.
struct MonitorVerdict {
  double share = 0.0;       ///< [0, 1], certified, if `proven`: clear up to rest; 0: brake now
  double not_above = 1.0;   ///< [share, 1], certified for obstacles alone: a larger share is not clear; 1 if unknown
  bool proven = true;       ///< false only where not even braking along a trajectory at once is proven clear
  bool in_contact = false;  ///< at the start something touches or overlaps, or may do so
  std::optional<MonitorWitness> witness;  ///< where share < 1
};

/// An arc of a way. Times are seconds of the way at full share: where the robot brakes, more time passes.
struct MonitorArc {
  geometry::TurningMotion motion;  ///< of the reference point, and how the footprint turns from `heading` on
  double heading = 0.0;            ///< rad, as it begins
};

/// What is wrong with an argument.
enum class MonitorProblem {
  not_finite,    ///< a number is NaN or infinite
  out_of_range,  ///< a number is outside the range that its field states, or a shape is not valid
  no_trajectory  ///< fewer than two poses, or times that do not rise
};

/// "not-finite", "out-of-range", "no-trajectory".
const char* name(MonitorProblem problem);

/// A caller's mistake; the monitor is as it was before the call. `what()` is "PLACE: found FOUND, expected EXPECTED".
class MonitorError : public std::invalid_argument {
 public:
  /// The place is a field of the arguments: "velocity", "movers/1/radius", "trajectory/3".
  MonitorError(MonitorProblem problem, const std::string& place, const std::string& found, const std::string& expected)
      : std::invalid_argument(place + ": found " + found + ", expected " + expected),
        problem_(problem),
        place_(place),
        found_(found),
        expected_(expected) {}
  /// What is wrong.
  MonitorProblem problem() const { return problem_; }
  /// Where it is.
  const std::string& place() const { return place_; }
  /// What is there.
  const std::string& found() const { return found_; }
  /// What should be.
  const std::string& expected() const { return expected_; }

 private:
  MonitorProblem problem_;
  std::string place_, found_, expected_;
};

/// Judges one command after the other. Deterministic. Not to be called from two threads at once; several monitors share
/// nothing. Memory is that of the setup; once the lists have been as long as they get, `judge` allocates none, but for
/// the hulls of movers with several corners.
class Monitor {
 public:
  /// Throws MonitorError.
  explicit Monitor(const MonitorSetup& setup);

  /// The largest share of a command that is found to be clear. Throws MonitorError.
  MonitorVerdict judge(const geometry::Pose& pose, const Command& command, const std::vector<Mover>& movers = {});

  /// The same for a trajectory: its first pose is the robot's place. Throws MonitorError.
  MonitorVerdict judge(const std::vector<TimedPose>& trajectory, const std::vector<Mover>& movers = {});

  /// The way of the last command or trajectory at a share of it, braking included; none before. Allocates.
  std::vector<MonitorArc> way(double share) const;

 private:
  /// A convex set that stands still, from its first corner: relative to it, places far from the origin lose no digits.
  struct Standing {
    geometry::Vec2 at;                  ///< m, the first corner
    std::uint32_t first = 0, size = 0;  ///< in `corners_` or `mover_corners_`, which are seen from there
    double radius = 0.0;                ///< m
  };
  /// A convex piece of an obstacle.
  struct Piece : Standing {
    std::uint32_t obstacle = 0;
  };
  /// A mover as it was seen, by the hull of its corners.
  struct SeenMover : Standing {
    double max_speed = 0.0;       ///< m/s
    double position_error = 0.0;  ///< m
  };
  /// A part of the footprint, in the body's axes.
  struct Part {
    std::uint32_t first = 0, size = 0;  ///< in `part_corners_` and `turned_`
    double radius = 0.0;                ///< m
  };
  /// A part of the way at full share: a twist, for a time.
  struct Stretch {
    geometry::Pose start;
    geometry::Twist twist;  ///< in the world's axes as it begins
    double duration = 0.0;  ///< s of the way
  };
  /// How the way is gone: evenly with `pace` for `held` s of the way, then slower and slower, `braked` s of the way.
  struct Pace {
    double pace = 1.0, held = 0.0, braked = 0.0;
    double length() const { return held + braked; }
    double moment(double way) const;
    double next_cut(double way) const;
  };
  /// A pair that is in contact as the way begins.
  struct Contact {
    std::size_t piece = 0, part = 0;
    double gap = 0.0;        ///< m, less than 0: as the way begins
    std::size_t looked = 0;  ///< stretches that have been looked at
    double left_at = 0.0;    ///< s of the way: when it is seen to be left; infinite where it is not
  };
  /// Where the search for something too near ended.
  struct Clear {
    double until = 0.0;    ///< s of the way
    double lost_by = 0.0;  ///< s of the way; infinite if not known
    geometry::GapToKeep lost;
    geometry::KeptGap kept;
    std::size_t stretch = 0;  ///< of `lost`
    double began = 0.0;       ///< s of the stretch, at which `lost` begins
    std::optional<MonitorWitness> witness;
  };

  // monitor.cpp
  void see(const std::vector<Mover>& movers);
  double braking_time(const geometry::Twist& twist) const;
  void set_way_of(const std::vector<TimedPose>& trajectory);
  MonitorVerdict judged();
  MonitorVerdict judged_beside_obstacles();
  bool is_clear_of_movers(double share, MonitorVerdict& verdict);
  MonitorVerdict halved(MonitorVerdict verdict);
  Pace pace_at(double share) const;
  double share_within(double length) const;
  // clearance.cpp
  void turn_footprint(const Stretch& stretch, double time);
  geometry::GapToKeep question(const Part& part, const Stretch& stretch, double time, const Standing& other,
                               const std::vector<geometry::Vec2>& corners, double duration, double reach) const;
  double gap_as_it_begins(const Stretch& stretch, const Part& part, const Standing& other,
                          const std::vector<geometry::Vec2>& corners, double reach);
  double left_within(const Stretch& stretch, const Part& part, const Standing& other,
                     const std::vector<geometry::Vec2>& corners, double reach);
  Contact* contact_of(std::size_t piece, std::size_t part, double reach);
  double left_by(Contact& contact, std::size_t stretch, double reach);
  void meet(std::size_t piece, std::size_t stretch, double offset, Clear& clear, bool& in_contact);
  Clear clear_of_obstacles(double length, bool& in_contact);
  bool is_far_from(const SeenMover& mover, const Pace& pace) const;
  bool clear_of_mover(std::size_t index, const Pace& pace, MonitorVerdict& verdict);
  bool part_clear_of_mover(const Part& part, std::size_t index, const Pace& pace, MonitorVerdict& verdict);

  MonitorSetup setup_;
  std::vector<geometry::Vec2> corners_;  ///< of pieces
  std::vector<Piece> pieces_;
  geometry::BoxGrid grid_;  ///< of pieces
  std::vector<geometry::Vec2> part_corners_, turned_;
  std::vector<Part> parts_;
  double body_reach_ = 0.0;  ///< m: a disc about the reference point that holds the footprint
  double part_reach_ = 0.0;  ///< m: the largest radius of a part, with the margin
  double held_ = 0.0;        ///< s, at share 1
  bool is_trajectory_ = false;
  double brake_time_ = 0.0;              ///< s, at share 1
  std::vector<Stretch> way_, next_way_;  ///< the second: while a trajectory is looked at
  std::vector<geometry::Vec2> mover_corners_;
  std::vector<SeenMover> movers_;
  std::size_t first_mover_ = 0;  ///< that is asked first: the one that was met last
  std::vector<Contact> contacts_;
  geometry::GapKeeper keeper_;
};

}  // namespace exactvo::formation
