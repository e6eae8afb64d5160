// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The loop over time of robots with goals, for one robot or a million, and when it ends. What decides and moves them
/// is a Stepper: half-planes and joint plans with every decision on record (kinematic_run.cpp), or a crowd
/// (crowd_run.cpp). Where robots are going is in journeys.h.

#include <cstddef>
#include <string>
#include <vector>

#include "exactvo/formation/ranks.h"
#include "exactvo/formation/run_report.h"
#include "exactvo/formation/run_sink.h"
#include "runs/journeys.h"
#include "runs/run_schedule.h"

namespace exactvo::formation::detail {

/// Robots of a run, for the loop and for the stepper.
struct RobotsOfRun {
  /// As Journeys, whose arguments they are. All must outlive it.
  RobotsOfRun(const Scenario& s, Guide* guide, Liveness liveness, const RoomAtEnds& room, double horizon,
              TakenOnTheWay taken)
      : scenario(s), journeys(s, guide, liveness, at, room, horizon, taken) {}
  RobotsOfRun(const RobotsOfRun&) = delete;
  RobotsOfRun& operator=(const RobotsOfRun&) = delete;

  std::size_t size() const { return journeys.size(); }

  const Scenario& scenario;
  std::vector<Vec2> at;        ///< m
  std::vector<Vec2> before;    ///< m: before the last step
  std::vector<Vec2> velocity;  ///< m/s, of the last step
  Journeys journeys;
  RunReport report;  ///< of the steps so far
};

/// Decides for all robots and moves them, one step after the other.
class Stepper {
 public:
  virtual ~Stepper() = default;

  /// What every robot does in the step that follows.
  virtual void decide() = 0;
  /// Carries it out: places and velocities of the robots are those after the step.
  virtual void move() = 0;
  /// Whether one of the robots that this process looks after has neither arrived nor stays.
  virtual bool goes_on() const = 0;
  /// Whether every further step would repeat the last (exact); the same in every rank.
  virtual bool repeats_itself() const { return false; }
  /// Keeps a snapshot, if one is wanted after this step. `is_stopped`: it was the last one.
  virtual void end_step(bool /*is_stopped*/) {}
  /// After the last step. Whether this process knows where all robots are going.
  virtual bool finish() = 0;

  // Words for the outcome.

  /// Why robot i is not at its goal, without its name; empty where nothing is known but that it is under way.
  virtual std::string why_not_there(std::size_t i) const = 0;
  /// How many robots are named with reasons.
  virtual std::size_t most_named() const = 0;
  /// Adds what is to be said of all, where some did not arrive.
  virtual void add_words(std::string& /*outcome*/) const {}

  virtual const Crowd* crowd() const { return nullptr; }
};

class RobotRun {
 public:
  /// All must outlive it. `sink`, `ranks`: null where there are none.
  RobotRun(RobotsOfRun& robots, Stepper& stepper, RunSchedule& schedule, RunSink* sink, Ranks* ranks = nullptr)
      : robots_(robots), stepper_(stepper), schedule_(schedule), sink_(sink), ranks_(ranks) {}

  /// To the end, from where the robots are. The sink has their state already. The wall time is left to the caller.
  RunReport run();

 private:
  /// The least of what the ranks want.
  enum class After { stop, step, nothing };

  void take_step();
  After what_follows(bool is_stopped);
  void add_reasons();

  RobotsOfRun& robots_;
  Stepper& stepper_;
  RunSchedule& schedule_;
  RunSink* sink_;
  Ranks* ranks_;
  bool is_under_way_ = false;  ///< some robot, in any rank
};

/// As a sink takes it.
inline RunState state_of(const RobotsOfRun& robots, const Crowd* crowd) {
  return {robots.report.steps, robots.report.time, robots.at, robots.velocity, crowd};
}

/// Asks the user for preferred velocities. REQUIRES: finite ones.
void steer_by(const RunSteering& steering, const RobotSlice& robots, std::vector<Vec2>& preferred);

}  // namespace exactvo::formation::detail
