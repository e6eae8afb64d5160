// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a recorded half-plane stands for, in words for people: "enclosure 4 of obstacle U", "robot R2".

#include <string>
#include <vector>

#include "exactvo/formation/recording.h"
#include "exactvo/formation/scenario.h"

namespace exactvo::formation {

/// "enclosure 1 of obstacle wall", "enclosure 1, piece 2, of obstacles wall and desk", "robot R2", "the edge
/// (1, 2)-(3, 4) of obstacle wall", "moving obstacle cart"; of more than three obstacles "a, b, c and 2 more".
/// `bodies`: those of the recording.
std::string name_of(const DecisionConstraint& constraint, const Scenario& scenario,
                    const std::vector<vo::Body>& bodies);

/// The same for several; those of one kind and obstacle are joined: "enclosures 4 and 5 of obstacle U and robot R2".
std::string name_of(const std::vector<DecisionConstraint>& constraints, const Scenario& scenario,
                    const std::vector<vo::Body>& bodies);

/// "obstacle wall", "obstacles wall and desk"; empty for no obstacle.
std::string names_of_obstacles(const Scenario& scenario, const std::vector<std::size_t>& which);

/// "a", "a and b", "a, b and c".
std::string enumerated(const std::vector<std::string>& words);

/// The same, and "a, b, c and 2 more" of more than three.
std::string abridged(std::vector<std::string> words);

}  // namespace exactvo::formation
