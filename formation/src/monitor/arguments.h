// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a monitor may be given. All of these throw MonitorError.

#include <string>
#include <vector>

#include "exactvo/formation/monitor.h"

namespace exactvo::formation::monitored {

/// m, m/s, rad/s, s: products of two are far inside the range of doubles, and a difference keeps a micrometre.
inline constexpr double kMostSize = 0x1p30;
/// m/s^2, rad/s^2: with it the time to brake stays as far inside the range.
inline constexpr double kLeastDeceleration = 0x1p-30;

/// "turn", or in a list "movers/1/radius". Its text is made where it is needed, since judging allocates nothing.
struct ArgumentPlace {
  const char* field = "";
  const char* list = "";
  std::size_t index = 0;
  std::string text() const;
};

[[noreturn]] void refuse(MonitorProblem problem, const ArgumentPlace& place, const std::string& found,
                         const std::string& expected);

/// All digits of a number.
std::string digits_of(double x);

/// A finite number of at least `least` and less than kMostSize.
void require_within(double x, double least, const ArgumentPlace& place);

/// Two finite numbers of less than kMostSize.
void require_place(geometry::Vec2 v, const ArgumentPlace& place);

void require_setup(const MonitorSetup& setup);
void require_command(const geometry::Pose& pose, const Command& command);
/// Two poses at least, at times that rise.
void require_trajectory(const std::vector<TimedPose>& trajectory);
void require_movers(const std::vector<Mover>& movers);

/// The corners of the hull, once round it.
std::vector<geometry::Vec2> hull_of_part(const geometry::RoundedPolygon& part, std::size_t index);

/// The convex pieces of an obstacle that is no disc; the corners of each once round it.
std::vector<std::vector<geometry::Vec2>> convex_pieces(const SceneObstacle& obstacle, std::size_t index);

}  // namespace exactvo::formation::monitored
