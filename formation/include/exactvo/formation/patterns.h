// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Formation patterns by name, and topologies for any number of robots. Offsets are in metres, in the frame whose x
/// axis is `heading`, with their mean at the origin.

#include <string>
#include <vector>

#include "exactvo/formation/scenario.h"

namespace exactvo::formation {

/// How the slots are laid out.
enum class Pattern {
  line,    ///< side by side, across the heading
  wedge,   ///< a V whose point leads
  circle,  ///< neighbours `spacing` apart
  grid     ///< rows of ceil(sqrt n), the last one centred
};

/// By "line", "wedge", "circle" or "grid". False for an unknown name; `out` is then unchanged.
bool parse(const std::string& text, Pattern& out);

/// `n` slots, neighbours `spacing` (m, > 0) apart, in a fixed order. REQUIRES: n >= 1.
std::vector<Vec2> pattern_offsets(Pattern pattern, std::size_t n, double spacing, Vec2 heading = {1.0, 0.0});

/// Every robot hears every other robot and the leader.
Topology complete_topology(std::size_t n);

/// Each robot hears the robots whose slots are within `reach` (m) of its own; `pinned` lists the robots that hear the
/// leader (empty: all do).
Topology neighbour_topology(const std::vector<Vec2>& offsets, double reach,
                            const std::vector<std::size_t>& pinned = {});

}  // namespace exactvo::formation
