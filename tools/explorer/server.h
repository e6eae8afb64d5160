// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The page of `exactvo serve` over HTTP, for the person at this computer alone: on 127.0.0.1 only, below a random
/// token of 128 bits. A request is answered only if its Host is this server's own (a page of another origin that has
/// its name resolve to 127.0.0.1 does not get in), its Origin, where it has one, too, and its token the right one.
/// Requests are bounded in size and time, connections in number. Nothing is read from disk: the page is in memory, and
/// what is asked for is computed from the request.
///
/// What the page of `exactvo serve` asks while things are dragged in it: a scenario as it stands at a moment, and what
/// a robot decides then. A question holds everything it needs; nothing is kept from one to the next. An answer is a
/// packed run (packed_run.h) of two rows, so that the page draws and checks it as it does a recorded one.
///
/// The decision is that of a run that begins at that moment: the same half-planes and the same proof. A mode with a
/// memory (following, a joint plan, a side committed to) begins anew.
///
/// See also: support/run.h runs on from a moment.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "exactvo/formation/scenario.h"
#include "exactvo/formation/simulation.h"
#include "explorer/http.h"

namespace exactvo::tools {

struct LiveQuestion {
  formation::Scenario scenario;  ///< at the moment: robots, leader and moving obstacles where they are then
  formation::SimulationOptions options;
  std::size_t robot = 0;                    ///< of which all half-planes are wanted
  std::optional<geometry::Vec2> preferred;  ///< m/s, in place of what the method prefers
  std::size_t preferred_robot = 0;          ///< whose preferred velocity `preferred` replaces
};

/// Robots that a question may have.
inline constexpr std::size_t kMostLiveRobots = 1000;

/// Gives the options of a run by its key; nothing for an unknown one.
using OptionsOfRun = std::function<std::optional<formation::SimulationOptions>(const std::string& key)>;

/// From JSON: `run` (the key of a run of the page), `scenario` (as the schema has it, robots and obstacles in it one by
/// one), `time` (s: how far its leader and moving obstacles have come), `robot` (index), `preferred` ([x, y] or null),
/// `preferred_robot` (index; by default `robot`), `method` (in place of the run's). Reads no file whatever the question
/// names. Throws datasets::DataError.
LiveQuestion parse_live_question(const std::string& json, const OptionsOfRun& options_of);

/// Packed: what every robot decides at the moment, with every half-plane of `robot`, and of the others those that hold
/// them and their halves of pairs with it.
std::string live_decision(const LiveQuestion& question);

/// JSON: the robot's free velocities and what its half-planes give away of them, between certified bounds.
std::string live_free_velocities(const LiveQuestion& question);

/// Packed, with its scenario: the run on from the moment, with every half-plane. `goes_on` is asked about ten times a
/// second; an exception that it throws is passed on. The preferred velocity is the method's.
std::string live_run(const LiveQuestion& question, const std::function<void()>& goes_on);

/// The page of cmake/EmbedExplorer.cmake with requests to its own server allowed, and to nothing else.
std::string page_for_server(std::string page);

/// Until the user interrupts it. Of `site` the port, the page and `ready` are the caller's; `options_of` is of the runs
/// in the page. Throws UsageError where the port cannot be had, DataError where the module that speaks HTTP is missing.
void serve(HttpSite site, const OptionsOfRun& options_of);

}  // namespace exactvo::tools
