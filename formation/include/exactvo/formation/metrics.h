// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Figures of a run, from its recording alone. SI units. Nothing where a value does not apply.
///
/// Clearances are swept and certified: lower bounds over the continuous motion between rows (of the cubic through both
/// ends, where the integrator has no closed form), with all roundings taken off. Where a robot overlaps an obstacle
/// they are at most 0, and not its depth.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/formation/lyapunov.h"
#include "exactvo/formation/recording.h"

namespace exactvo::formation {

struct RobotMetrics {
  std::string id;
  bool arrived = false;
  std::optional<double> arrival_time;            ///< s
  double path_length = 0.0;                      ///< m
  std::optional<double> min_obstacle_clearance;  ///< m, swept: to the robot's rim, negative is penetration
};

struct Metrics {
  bool all_arrived = false;
  std::optional<double> last_arrival_time;         ///< s
  std::optional<double> min_obstacle_clearance;    ///< m, swept
  std::optional<double> min_robot_clearance;       ///< m, swept
  std::optional<double> formation_position_error;  ///< m, at the end: max over robots of |x_i - x_L - Delta_i|
  std::optional<double> formation_velocity_error;  ///< m/s, at the end
  std::optional<double> leader_arrival_time;       ///< s
  double jitter = 0.0;                             ///< m/s^2: sum over steps and robots of |a_{k+1} - a_k|
  double velocity_variation = 0.0;                 ///< m/s: sum over steps and robots of |v_{k+1} - v_k|
  double peak_acceleration = 0.0;                  ///< m/s^2: the greatest |v_{k+1} - v_k| over the time step
  std::size_t heading_reversals = 0;    ///< turns whose sign changes from one step to the next, beyond 1e-3 rad
  std::size_t active_set_switches = 0;  ///< steps whose active constraints differ from the step before
  std::size_t relaxed_steps = 0;  ///< decisions that were not `optimal`: soft half-planes gave, or no answer held all
  std::size_t uncertified_half_planes = 0;
  std::size_t steps = 0;
  double wall_time = 0.0;  ///< s
  std::vector<RobotMetrics> robots;
  std::optional<LyapunovSummary> lyapunov;  ///< of a formation
  std::string outcome;                      ///< the recording's
  std::vector<std::string> warnings;        ///< the recording's
  std::vector<std::string> stuck;           ///< a sentence for each robot that stopped elsewhere (stuck.h)
};

Metrics measure(const Scenario& scenario, const Recording& recording);

/// m: contact is spoken of from this depth on. Certified clearances lie below the true ones by less than it up to 10 km
/// from the origin (four times 2^-46 of the coordinates), so two robots that keep exactly their distance do not touch.
inline constexpr double kContactDepth = 1e-9;

/// Whether a clearance is a contact; nothing is what there was nothing to touch for.
bool touched(const std::optional<double>& clearance);
/// An obstacle or another robot was touched, by the swept clearances.
bool touched(const Metrics& metrics);

/// m and m/s: a formation that ends nearer to its slots, or to the leader's velocity, has formed.
inline constexpr double kFormed = 1e-6;

/// Proven: every swept clearance is above 0 and every half-plane was certified. More than not to have touched, which
/// leaves out what rounding alone could explain.
bool is_safe(const Metrics& metrics);

/// One series a robot or pair, sampled at the recording's rows: for figures.
std::vector<double> obstacle_distance_series(const Scenario& scenario, const Recording& recording, std::size_t robot);
std::vector<double> robot_distance_series(const Scenario& scenario, const Recording& recording, std::size_t robot_a,
                                          std::size_t robot_b);
std::vector<double> formation_error_series(const Scenario& scenario, const Recording& recording, std::size_t robot);

}  // namespace exactvo::formation
