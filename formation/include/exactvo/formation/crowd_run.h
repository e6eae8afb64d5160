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

#include <stdexcept>
#include <vector>

#include "exactvo/formation/crowd.h"
#include "exactvo/formation/run_report.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation {

/// Why a scenario cannot be run on a crowd: the pointer of the field, what it has and what it may have.
std::vector<ScenarioProblem> crowd_problems(const Scenario& scenario);

/// The liveness of such a run: that of `options` or of the scenario; with a user's steering no robot reserves places.
Liveness crowd_liveness(const Scenario& scenario, const SimulationOptions& options);

/// The ranks computed different states, seen at a snapshot or at the end: the C libraries of their machines round the
/// elementary functions differently, or a machine is broken.
class RanksDiffer : public std::runtime_error {
 public:
  RanksDiffer() : std::runtime_error("the ranks computed different states of the same run") {}  ///< Says just that.
};

/// REQUIRES: a valid scenario (`validate`) without `crowd_problems`. Throws CrowdError, which names a robot by number,
/// where one leaves the lattice or two start in one place, and `bad_snapshot` where the run cannot go on from
/// `SimulationOptions::resume_from`; RanksDiffer; AnotherRankFailed. Only the first rank returns arrivals
/// and routes. The run reads from `options` guidance, liveness, threads, progress, steering and those of a crowd. With
/// a user's steering robots reserve no places and do not turn to the right for each other. REQUIRES: no half-planes of
/// a user, and neither rvo nor hrvo; the other methods are taken for orca.
RunReport run_crowd(const Scenario& scenario, const SimulationOptions& options, RunSink* sink = nullptr);

}  // namespace exactvo::formation
