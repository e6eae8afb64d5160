// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// How far a robot of a crowd's run (crowd_run.cpp) has come, and how that stands in snapshots.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "snapshot_bytes.h"
#include "exactvo/formation/scenario.h"
#include "steering/goal_claims.h"
#include "steering/guide.h"
#include "steering/keep_right.h"

namespace exactvo::formation {

template <>
inline constexpr std::size_t crowd::doubles_of<detail::Destination> = 3;
template <>
inline constexpr std::size_t crowd::doubles_of<detail::NearestPlace> = 4;

namespace detail {

/// Of snapshots.
inline constexpr const char* kSnapshotOfRun = "those of a run of this scenario and these options";

struct CrowdWay {
  std::size_t goal = 0;
  std::optional<Course> course;
  Vec2 heading;
  std::optional<double> arrived;  ///< s
  bool stays = false;
  std::string why_not;                  ///< it stays, or goes as near as it can
  std::optional<NearestPlace> nearest;  ///< as near as it can get
  KeepRight keep_right;
  std::size_t turned = 0;               ///< step at which one of these changed last, but for `arrived` and `why_not`
};

void put(crowd::SnapshotWriter& to, const CrowdWay& way);
/// `goals`: how many the robot has. Throws CrowdError (bad_snapshot).
CrowdWay get_way(crowd::SnapshotReader& from, std::size_t goals, bool is_guided);

void put(crowd::SnapshotWriter& to, const GoalClaims& claims);
/// Throws CrowdError (bad_snapshot).
void get_claims(crowd::SnapshotReader& from, GoalClaims& claims);

}  // namespace detail
}  // namespace exactvo::formation
