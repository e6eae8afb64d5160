// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Where the robots of a run are going: which of its goals a robot heads for, along which course and round what, and
/// why it waits or stays. Every run of robots with goals uses it. Routes, and that there are none, are exact (guide.h);
/// all else is decided in doubles, and safety is up to the half-planes.
///
/// The states of a journey with guidance:
///
///   has no room ---- pushed out ---> on a course ---- its goal is reached ----> on a course to the next goal
///                                      |     ^  \---- its last goal is reached -> at its goal
///     a moving obstacle stands on the  |     |
///     course, and none leads round it  v     |  it has moved, or another course leads round it
///                                     waits -+
///                                      |  the obstacle rests for good
///                                      v
///                                    stays         (and after `nearest`, or where the robot has no course at all)
///
/// At any time a journey may also *rest*: another robot has taken the place where its way ends (goal_claims.h).

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "exactvo/formation/recording.h"
#include "exactvo/formation/scenario.h"
#include "snapshot_bytes.h"
#include "steering/goal_claims.h"
#include "steering/guide.h"
#include "steering/keep_right.h"
#include "steering/last_places.h"
#include "steering/standing.h"

namespace exactvo::formation {

template <>
inline constexpr std::size_t crowd::doubles_of<detail::Destination> = 3;
template <>
inline constexpr std::size_t crowd::doubles_of<detail::NearestPlace> = 4;

namespace detail {

/// What a snapshot of a run has to be, in words.
inline constexpr const char* kSnapshotOfRun = "those of a run of this scenario and these options";

/// One robot's way to its goals.
struct Journey {
  std::size_t goal = 0;                 ///< the goal that the robot heads for, from 0
  Vec2 heading;                         ///< m: where the robot heads; where it is if it stays
  std::optional<double> margin;         ///< m, to be kept from obstacles on the way there besides the radius
  std::optional<Course> course;         ///< to its present goal, with guidance
  std::optional<NearestPlace> nearest;  ///< the end of a course that does not lead to the goal
  std::string no_way;                   ///< why no course leads to its goal
  bool has_come_nearest = false;        ///< the robot is at `nearest`
  bool waits_for_room = false;          ///< the robot must be pushed out before its course can be planned
  std::optional<Detour> detour;         ///< whose course this is: round obstacles that move and stand for now
  bool has_new_course = false;          ///< standing obstacles were not compared with the course yet
  std::optional<std::size_t> cut_by;    ///< the moving obstacle that stands on the course, without a way round it
  double looks_again = 0.0;             ///< s: then the robot looks for a way round it again
  double waits_since = 0.0;             ///< s: since then the robot has stood before an obstacle that rests for good
  bool waits_for_good = false;          ///< so long that it stays there
  bool has_passed_goal = false;         ///< since the last look at claims, which are of the goal before
  KeepRight keep_right;                 ///< liveness, rule R1
  std::string note;                     ///< what has changed, for the next row of a recording
};

/// What a robot does about a goal on its way that is taken.
enum class TakenOnTheWay {
  passed_beside,  ///< the robot comes beside it and goes on to its next goal
  reached         ///< the robot presses for it: an audit of decisions proves of each goal that it was reached
};

class Journeys {
 public:
  /// All must outlive it. `guide`: null where robots head straight for their goals. `at`: the positions of the robots,
  /// kept up to date by the run. `room`: what robots leave each other where they end. `horizon`: s, for which
  /// half-planes between robots look ahead.
  Journeys(const Scenario& scenario, Guide* guide, Liveness liveness, const std::vector<Vec2>& at,
           const RoomAtEnds& room, double horizon, TakenOnTheWay taken);

  std::size_t size() const { return journeys_.size(); }
  const Journey& operator[](std::size_t i) const { return journeys_[i]; }
  const RoutesCourse& routes() const { return routes_; }

  /// Robot i sets out for its present goal: to be called for each before the first step.
  void set_out(std::size_t i);

  // --- In each step, in this order ---

  /// Moving obstacles are at these places; `moving` has an entry for each. Every rank calls it for every step.
  void look_at_moving_obstacles(double time, const std::vector<MovedObstacle>& moving);
  /// Robot i plans round what stands on its course, unless it goes by a joint plan; and takes up its route again where
  /// that has moved.
  void go_round(std::size_t i, bool goes_by_plan = false);
  /// Whether robot i waits for good. `may_wait`: the robot is at rest, and goes by no joint plan.
  void look_whether_it_waits(std::size_t i, bool may_wait);
  /// Sets out for the next goal where robot i has reached one on its way, or rests beside it and may pass it; returns
  /// whether it did.
  bool pass_goal(std::size_t i);
  /// Where robot i heads from here.
  void look_along(std::size_t i);
  /// What of robot i concerns claims; `may_rest`: the robot goes by no joint plan.
  EndNow end_now(std::size_t i, bool may_rest) const;
  /// Ends that are taken, by the present ends of all robots. Whether something has changed.
  bool look_at_claims(std::vector<EndNow> ends);
  bool has_claims() const { return claims_.has_value(); }

  /// m/s: straight for `Journey::heading`, or beside a place that is taken.
  Vec2 preferred(std::size_t i) const;
  /// The same for another preferred velocity of robot i.
  Vec2 beside_taken(std::size_t i, Vec2 preferred) const;
  /// Turned by rule R1. `least`, `patience`, `meets_others`: as KeepRight::turned. `velocity`: m/s, of the last step.
  Vec2 kept_right(std::size_t i, Vec2 preferred, Vec2 velocity, double least, double patience,
                  bool meets_others = true);
  /// The journey has it no longer afterwards.
  std::string take_note(std::size_t i) { return std::exchange(journeys_[i].note, {}); }
  std::optional<double> take_margin(std::size_t i) { return std::exchange(journeys_[i].margin, std::nullopt); }

  // --- Questions ---

  /// s: how long robot i drives before it turns at the place that it heads for; infinite without a course.
  double turns_after(std::size_t i) const;

  Vec2 goal_of(std::size_t i) const { return scenario_.robots[i].goals[journeys_[i].goal]; }
  bool has_last_goal(std::size_t i) const { return journeys_[i].goal + 1 == scenario_.robots[i].goals.size(); }
  /// Within reach of the goal: where robots stand aside for each other, another place.
  Vec2 aim_of(std::size_t i) const { return has_last_goal(i) && !last_places_.empty() ? last_places_[i] : goal_of(i); }
  /// Where the way to the present goal ends.
  Vec2 end_of(std::size_t i) const { return journeys_[i].nearest ? journeys_[i].nearest->place : aim_of(i); }
  bool ends_here(std::size_t i) const { return has_last_goal(i) || journeys_[i].nearest; }
  bool is_within_reach(std::size_t i) const;
  /// Robot i has arrived: it is within the arrival tolerance of its last goal.
  bool at_goal(std::size_t i) const { return has_last_goal(i) && is_within_reach(i); }
  bool is_at_end(std::size_t i) const { return at_goal(i) || journeys_[i].has_come_nearest; }
  /// Another robot has taken the place where its way ends.
  bool is_taken(std::size_t i) const { return has_claim_news(i) && claims_->taken_by(i); }
  bool rests_beside(std::size_t i) const { return has_claim_news(i) && claims_->rests(i); }
  /// Since this step.
  bool has_come_to_rest(std::size_t i) const { return has_claim_news(i) && claims_->has_come_to_rest(i); }
  /// Robot i makes no more way, unless it is pushed. `rests_beside` is another question.
  bool stays(std::size_t i) const;
  /// m, to the end of the way.
  double way_left(std::size_t i) const;
  /// s: from then on all moving obstacles rest for good.
  double moving_until() const { return moving_until_; }
  /// s: if no robot and no obstacle moves for so long, no journey changes any more because of moving obstacles.
  double longest_pause() const;

  /// Why robot i is not at its goal, in words without its name; empty where nothing is known but that it is under way.
  std::string why_not_there(std::size_t i) const;
  std::string words_of_claim(std::size_t i) const { return claims_->words(i); }

  // --- Snapshots ---

  /// Robot i, without its note.
  void put(std::size_t i, crowd::SnapshotWriter& to) const;
  /// Throws CrowdError (bad_snapshot).
  void get(std::size_t i, crowd::SnapshotReader& from);
  /// What robots share: claims, and the moving obstacles that stand.
  void put_shared(crowd::SnapshotWriter& to) const;
  /// REQUIRES: before `get`. Throws CrowdError (bad_snapshot).
  void get_shared(crowd::SnapshotReader& from);

 private:
  bool has_claim_news(std::size_t i) const { return claims_ && !journeys_[i].has_passed_goal; }
  Destination destination(std::size_t i) const;
  double reach_of_goal(std::size_t i) const;
  void plan_course(std::size_t i);
  void take_up_route(std::size_t i);
  std::string name_of_goal(std::size_t i) const;
  void choose_last_places(const RoomAtEnds& room, double horizon);

  const Scenario& scenario_;
  Guide* guide_;
  TakenOnTheWay taken_;
  const std::vector<Vec2>& at_;
  std::vector<Journey> journeys_;
  std::vector<Vec2> last_places_;              ///< empty: the last goals
  std::optional<GoalClaims> claims_;           ///< where ends are too near to each other
  std::optional<StandingObstacles> standing_;  ///< with guidance, where there are moving obstacles
  bool standing_changed_ = false;              ///< in this step
  double now_ = 0.0;                           ///< s
  double moving_until_ = 0.0;                  ///< s: from then on all moving obstacles rest for good
  RoutesCourse routes_;
};

}  // namespace detail
}  // namespace exactvo::formation
