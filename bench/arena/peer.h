// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Other people's programs in the arena. A peer is a program that reads a scene from stdin and writes where its robots
/// are to stdout; `arena_rvo2.cpp` is one.
///
/// The scene, lengths in metres and times in seconds, one item per line:
///
///     arena 1
///     time_step 0.05
///     time_limit 300
///     arrival_tolerance 0.1
///     neighbour_distance 15
///     margin 0                                          that robots are to keep between each other
///     robot RADIUS MAX_SPEED X Y GOALS x1 y1 ...        every robot, in order
///     way ROBOT GOAL POINTS x1 y1 ...                   the shortest way to that goal, counted from 0; no line: none
///     wall X1 Y1 X2 Y2                                  every edge of an obstacle
///     end
///
/// The answer has one line per time step, from the start on: X1 Y1 X2 Y2 ... of all robots. It may end when all have
/// arrived, and must where the time limit is reached.

#include <string>

#include "exactvo/formation/recording.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::bench {

struct PeerRun {
  formation::Recording run;        ///< without rows
  double processor_seconds = 0.0;  ///< of the program, all of it
};

/// `rows` takes positions, and the velocities between them. Throws std::runtime_error, which names the program and what
/// was expected, where it cannot be run, fails, takes longer than ten minutes or answers anything else.
PeerRun run_peer(const std::string& program, const formation::Scenario& scenario, formation::RunSink& rows);

/// m: between robots, where the scene asks for it; the default is not the scene's but our method's.
double margin_of_scene(const formation::Scenario& scenario);

/// What a peer reads.
std::string scene_text(const formation::Scenario& scenario);

}  // namespace exactvo::bench
