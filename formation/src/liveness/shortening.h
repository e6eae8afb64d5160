// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Joint plans that take less time (liveness, rule R3): one robot after the other gets another path among the moves of
/// all others. A change that takes longer is undone.
///
/// Large neighbourhood search (Li, Chen, Harabor, Stuckey and Koenig, "Anytime Multi-Agent Path Finding via Large
/// Neighborhood Search", IJCAI 2021). Heuristic: how long a sequence takes is what its timetable says.

#include <cstdint>
#include <optional>
#include <vector>

#include "liveness/timetable.h"

namespace exactvo::formation::detail {

/// Between which moves of the others a robot can stand on a place, and when it can go along an edge. Intervals of all
/// places are numbered together.
class SafeIntervals {
 public:
  /// Keeps a reference to the problem.
  explicit SafeIntervals(const JointProblem& problem);

  void set(std::size_t robot, const Timetable& others, const RoadmapEdges& edges);

  std::size_t last_position() const { return count_; }
  std::size_t size() const { return size_; }
  /// The interval of the place that holds a position.
  std::size_t at(PlaceNumber place, std::size_t position) const;
  /// The last position of an interval of the place.
  std::size_t last(PlaceNumber place, std::size_t interval) const;
  /// The first position from `first` to `last` at which no other robot stands too near to an edge, whose near places
  /// these are; more than `last` where there is none.
  std::size_t first_clear(const std::vector<RoadmapEdges::NearPlace>& near, std::size_t first, std::size_t last) const;

 private:
  /// Positions at which another robot stands on a place.
  struct Stay {
    std::size_t first, last;
    double reach;  ///< m2: edges at a smaller squared distance are too near
  };

  double squared_reach(std::size_t other) const;

  const JointProblem& problem_;
  std::size_t robot_ = 0, count_ = 0, size_ = 0;
  std::vector<std::vector<std::uint32_t>> passed_;  ///< by place: the moves that come near it
  std::vector<std::vector<Stay>> stays_;            ///< by place, one after the other
  std::vector<std::size_t> first_;                  ///< by place: its first interval
};

/// A path of one robot to its goal among the moves of all others (liveness, rule R3).
///
/// Safe-interval path planning (Phillips and Likhachev, "SIPP: Safe Interval Path Planning for Dynamic Environments",
/// ICRA 2011), with positions in the sequence of the others' moves instead of times: position k is before their k-th
/// move. What comes out is a sequence of single moves again, in which the robot keeps (1 + kPlannedGap) times the sum
/// of the radii from all others, or gets away from them. Heuristic: it takes the path that seems to be at its goal
/// first.
class PathAmongOthers {
 public:
  /// Keeps references to both.
  PathAmongOthers(const JointProblem& problem, RoadmapEdges& edges)
      : problem_(problem), edges_(edges), safe_(problem) {}

  /// The moves of all, with those of the robot among them; nothing where it finds no path that is over before `bound`,
  /// m at speed 1. `to_goal`: m, from each place to the robot's goal.
  std::optional<std::vector<JointMove>> moves_with(std::size_t robot, const Timetable& others,
                                                   const std::vector<float>& to_goal, double bound);
  /// Counted, of all so far.
  std::size_t work() const { return work_; }

 private:
  struct Query {
    std::size_t robot;
    const Timetable* others;
    const std::vector<float>* to_goal;
    double bound;
  };
  /// At a place, in one of its intervals.
  struct Arrival {
    PlaceNumber place = 0;
    std::size_t interval = 0;
    std::size_t position = 0;  ///< of the move that led here
    double time = 0.0;         ///< as the distance that is driven in it at full speed, m
    std::size_t parent = 0;    ///< arrival; the start is its own
  };

  void offer(const Query& query, const Arrival& arrival);
  void expand(const Query& query, std::size_t arrival);
  void expand_to(const Query& query, std::size_t arrival, std::size_t now, PlaceNumber to, EdgeNumber edge);
  std::vector<JointMove> moves_to(const Query& query, std::size_t arrival) const;

  const JointProblem& problem_;
  RoadmapEdges& edges_;
  SafeIntervals safe_;
  std::vector<Arrival> arrivals_;
  std::vector<std::pair<double, std::size_t>> open_;  ///< heap of arrivals by when they lead to the goal
  std::vector<double> soonest_;                       ///< by interval
  std::size_t work_ = 0;
};

/// A sequence of moves of the same robots with properties (1) to (3) of joint_search.h, if that given has them; (1) is
/// checked, else the sequence given comes back, as it does where it has more than 20,000 moves. Deterministic: what is
/// tried is counted, about two seconds of one core at most. Where `problem.is_stopped` says so, what was found until
/// then.
std::vector<JointMove> shortened(const JointProblem& problem, const std::vector<JointMove>& moves, std::uint64_t seed);

}  // namespace exactvo::formation::detail
