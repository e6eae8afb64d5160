// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What is expected of Section V's runs: the report prints it beside what was seen and says where it differs, and
/// tests/formation/{paper,formation}_table_test.cpp hold the runs to it.

#include <limits>

namespace exactvo::tools {

/// A row of Section V.A: when the last robot arrives by ORCA, and which of the others arrive at all. Their times are
/// not promised.
struct Expected {
  const char* scenario;
  double orca;         ///< s; kStuck
  bool edge_thin;      ///< one ellipse per facade, b = 0.1 m: arrives
  bool edge_half;      ///< b = a / 2: arrives
  bool cluster;        ///< pure equation (12)
  bool has_obstacles;  ///< A0 has none
};
inline constexpr double kStuck = -1.0;

inline constexpr Expected kExpected[] = {
    {"A0", 9.4, true, true, true, false},       {"A1", kStuck, false, true, true, true},
    {"A2", kStuck, false, true, true, true},    {"A3", kStuck, false, false, true, true},
    {"A4", kStuck, false, false, true, true},   {"A5", kStuck, false, false, true, true},
    {"A6", 11.1, false, true, true, true},      {"A7", kStuck, false, true, true, true},
    {"A8", kStuck, false, false, true, true},   {"A9", kStuck, false, false, true, true},
    {"A10", 9.4, false, true, true, true},      {"A11", kStuck, false, true, true, true},
    {"A12", kStuck, false, true, true, true},   {"A13", 11.5, true, true, true, true},
    {"A14", kStuck, false, false, false, true}, {"A15", kStuck, false, false, false, true}};

inline constexpr double kLatest = 18.0;        ///< s: the default method arrives everywhere before it
inline constexpr double kOrcaTolerance = 0.5;  ///< s: between two implementations of the same rule

/// A controller of Section V.B: the worst position error of a robot at the end, m, from `least` to `most`.
struct ExpectedFormation {
  const char* controller;
  double least, most;  ///< m
  const char* words;
  double most_velocity_error;  ///< m/s; infinite where nothing is expected
  bool untouched;              ///< nothing is touched
};
inline constexpr double kAnything = std::numeric_limits<double>::infinity();
inline constexpr double kFormationLost = 100.0;  ///< m
inline constexpr double kFormationKept = 1e-9;   ///< m and m/s

inline constexpr ExpectedFormation kExpectedFormations[] = {
    {"paper-literal", kFormationLost, kAnything, "above 100 (diverges)", kAnything, false},
    {"paper-signs", 0.1, 0.4, "0.1 to 0.4", kAnything, false},
    {"default", 0.0, kFormationKept, "below 1e-9", kFormationKept, true}};

}  // namespace exactvo::tools
