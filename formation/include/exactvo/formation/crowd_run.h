// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Runs a scenario of many robots on the certified crowd (crowd.h), for robots with goals among obstacles: the rule is
/// ORCA's, as of Method::orca, with the promises of the crowd. What differs from Method::orca: half-planes
/// against obstacles are never relaxed, neighbours are the nearest 10 (and all that can be met within a step), motions
/// are whole steps of a lattice.
///
/// Along routes (Guidance::route) a robot heads for the farthest point of its route that it sees, looked for at every
/// eighth step; a moving obstacle is the convex hull of its shape, and goes straight and evenly from where it is at the
/// beginning of a step to where it is at the end, up to half a lattice step; a robot whose goal is proven out of reach
/// stays. Where two last goals are too near to each other for both robots (and `Scenario::liveness` is not off), these
/// stand aside within their tolerance; where that is not enough, the robot that is there first keeps its goal, and the
/// other stays beside it. With `Liveness::plan` robots that have stalled, are pushed or rest at their goals reserve
/// places (liveness/reservations.h). A run ends when all robots are at their goals or stay, or when nothing changes any
/// more. Deterministic, with any number of threads and of ranks.
///
/// Over ranks (ranks.h) every rank calls `run_crowd` with the same scenario and options. Each plans and looks for a
/// share of the robots, by their numbers, and decides for a share, by their places. The sink, the snapshots and the
/// whole report are those of rank 0. Whatever `run_crowd` throws is followed by `Ranks::fail`.
///
/// See also: simulation.h runs everything else; datasets/crowd_recording.h records.

#include <functional>
#include <iosfwd>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "exactvo/formation/crowd.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation {

/// How a scenario is run on a crowd.
struct CrowdRunOptions {
  std::optional<Guidance> guidance;                        ///< instead of the scenario's
  CrowdPrecision precision = CrowdPrecision::float_lines;  ///< of half-planes and linear programs
  int threads = 1;                                         ///< as CrowdOptions::threads
  Ranks* ranks = nullptr;                                  ///< as CrowdOptions::ranks
  /// Called after every step with the simulated time, s; returning false stops the run, in any rank that of all.
  std::function<bool(double)> progress;
  std::size_t snapshot_every = 0;  ///< steps, where snapshots are kept; 0: only one, where `progress` stops the run
  /// Takes a snapshot of the whole run, its sink included, in a binary form of this version. None: none is made. Of
  /// several ranks all have one or none; it is called in rank 0. The number of ranks is not in it.
  std::function<void(const std::string&)> keep_snapshot;
  /// A snapshot of a run of the same scenario and options: it goes on from there, with the same bits. Empty: the run
  /// begins at the beginning. The number of threads, and of ranks, may be another. The same in every rank.
  std::string resume_from;
};

/// Why a scenario cannot be run on a crowd: the pointer of the field, what it has and what it may have.
std::vector<ScenarioProblem> crowd_problems(const Scenario& scenario);

/// Why a robot does not come to its goal.
struct RobotNotThere {
  std::size_t robot = 0;  ///< in the order of the scenario
  std::string why;        ///< in words, for people
};

/// What a run came to. Times in s, lengths in m.
struct CrowdRunReport {
  std::size_t robots = 0;   ///< of the scenario
  std::size_t arrived = 0;  ///< are within the arrival tolerance of their last goals at the end
  std::size_t staying = 0;  ///< have no route to a goal
  /// These, in the order of the scenario: each stays, or goes as near as it can (`Scenario::unreachable`).
  std::vector<RobotNotThere> without_route;
  /// Others that did not arrive, each of which stays beside its goal or was on its way there: another robot is there,
  /// or at a goal so near that the two cannot both be at theirs.
  std::vector<RobotNotThere> goal_taken;
  /// Others that did not arrive: a moving obstacle stands on the route of each, and none leads round it.
  std::vector<RobotNotThere> route_cut;
  std::size_t steps = 0;  ///< time steps that were taken
  double time = 0.0;      ///< simulated
  /// s: over all robots, those that did not arrive counted as later than the others; none where it is one of these.
  std::optional<double> median_arrival;
  std::optional<double> last_arrival;  ///< s: of those that arrived. A robot arrives when it comes to its goal for good
  double path_length = 0.0;            ///< of all robots together
  std::size_t relaxed = 0;             ///< decisions in which half-planes against others are relaxed
  std::size_t cut_short = 0;           ///< decisions that do not get their wish, since another would be met in the step
  std::size_t reserved = 0;            ///< decisions of robots that drive to a reserved place, or stand there
  std::size_t overlapping = 0;         ///< decisions of robots that overlapped another: 0 after a legal start
  std::size_t touching = 0;            ///< decisions of robots that touched another
  std::size_t widened = 0;             ///< decisions with more than 10 neighbours
  std::size_t stopped = 0;             ///< decisions to stay, for lack of anything else that meets no edge
  std::size_t half_planes = 0;         ///< against robots
  std::size_t edges = 0;               ///< half-planes against edges of obstacles
  std::size_t bodies = 0;              ///< half-planes against bodies: discs at rest and moving obstacles
  std::uint64_t digest = 0;            ///< Crowd::digest at the end
  bool stands_still = false;           ///< it ended early: no step changes anything any more (exact)
  bool interrupted = false;            ///< progress stopped it
  double wall_time = 0.0;              ///< s, of the whole call
};

/// Ranks have come to other states than each other: at a snapshot, or at the end. Their machines' C libraries round the
/// elementary functions differently, or one of them is broken.
class RanksDiffer : public std::runtime_error {
 public:
  RanksDiffer() : std::runtime_error("ranks have come to different states of the same run") {}  ///< Says just that.
};

/// Takes the states of a run: robot i of the scenario has id i.
class CrowdSink {
 public:
  virtual ~CrowdSink() = default;
  /// The start, before the first step.
  virtual void begin(const Crowd& crowd) = 0;
  /// Before a step, when preferred velocities are set: `Crowd::explain` says what it will decide. `steps`: taken so
  /// far.
  virtual void before_step(const Crowd& /*crowd*/, std::size_t /*steps*/) {}
  /// After every step; `steps` counts them from 1.
  virtual void add_step(const Crowd& crowd, std::size_t steps) = 0;
  /// For a snapshot, after a step: what it needs to go on from here. What it has taken so far must be safe then.
  virtual void save(std::ostream& /*to*/) {}
  /// In the place of `begin` in a run that goes on: what `save` wrote.
  virtual void restore(const Crowd& /*crowd*/, std::istream& /*from*/) {}
};

/// REQUIRES: a valid scenario (`validate`) without `crowd_problems`. Throws CrowdError, which names a robot by number,
/// where one leaves the lattice or two start in one place, and `bad_snapshot` where the run cannot go on from
/// `CrowdRunOptions::resume_from`; RanksDiffer; AnotherRankFailed. What ranks other than the first return of arrivals
/// and routes is not known there.
CrowdRunReport run_crowd(const Scenario& scenario, const CrowdRunOptions& options, CrowdSink* sink = nullptr);

}  // namespace exactvo::formation
