// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Both Lyapunov functions along a run, term by term: the paper's (18), whose integral term is defined so that its
/// derivative cancels whatever V_IVO does, and the one that holds (docs/guide/formation.md):
///
///   V = 1/2 |v^|^2 + (k1/2) x^T (L+B) x^ + k3 sum Phi(x^_i),   Phi the Huber potential of the saturated preference.
///   In free space V' = -k2 v^T (L+B) v^ - k3 |v^|^2; near obstacles V' <= -(k3/2)|v^|^2 + (k3/2)|e|^2, e = w - v_pref
///   - u_c / k3.
///
/// Rounded. V_IVO is the decision of a row, held over its step: the integral of (18) is exact where the motion is
/// exponential, else the trapezoid between both ends of the step. Under a moving leader x^, v^ and V_IVO are relative
/// to it; the derivative holds while its velocity is constant.

#include <vector>

#include "exactvo/formation/recording.h"

namespace exactvo::formation {

/// Terms of equation (18), summed over robots, or of its derivative (19) with the robots' actual accelerations. For
/// motion laws other than `exponential`, the derivative takes the mean acceleration over the step.
struct PaperTerms {
  double kinetic = 0.0;    ///< 1/2 sum |v^_i|^2; derivative: sum v^_i.u_i
  double consensus = 0.0;  ///< k1/4 sum a_ij |x^_i - x^_j|^2; derivative: k1/2 sum a_ij (x^_i - x^_j).(v^_i - v^_j)
  double pinning = 0.0;    ///< k1/2 sum b_i |x^_i|^2; derivative: k1 sum b_i x^_i.v^_i
  /// k3 sum of the integral of v^_i.(v^_i - V_IVO), V_IVO relative to the leader; derivative: of the integrand.
  double integral = 0.0;
  /// The function, or its derivative: the sum of its terms.
  double value() const { return kinetic + consensus + pinning + integral; }
};

/// Terms of the function that holds.
struct SoundTerms {
  double kinetic = 0.0;    ///< 1/2 |v^|^2
  double consensus = 0.0;  ///< (k1/2) x^T (L+B) x^
  double slots = 0.0;      ///< k3 sum Phi(x^_i)
  /// The function: the sum of its terms.
  double value() const { return kinetic + consensus + slots; }
};

/// The function's derivative, valid near obstacles too and for any controller. e_i is the velocity that v_i follows
/// (v + u / k3) minus the preference of the default law in free space.
struct SoundRates {
  double consensus = 0.0;     ///< -k2 v^T (L+B) v^
  double tracking = 0.0;      ///< -k3 |v^|^2
  double intervention = 0.0;  ///< k3 sum v^_i.e_i: the share of obstacles and other robots
  /// The derivative: the sum of its terms.
  double value() const { return consensus + tracking + intervention; }
};

/// Both functions and their derivatives at one row.
struct LyapunovRow {
  double time = 0.0;        ///< s
  bool has_rates = true;    ///< false in the last row, which has no decision: its derivatives have no meaning
  PaperTerms paper;         ///< of (18)
  PaperTerms paper_rates;   ///< its derivative, by terms
  double paper_rate = 0.0;  ///< (20): what the paper says V' is
  SoundTerms sound;         ///< of the function that holds
  SoundRates sound_rates;   ///< its derivative, by terms
  double rate_bound = 0.0;  ///< -(k3/2) |v^|^2 + (k3/2) |e|^2
};

/// A row for every row of the recording. REQUIRES: a formation's recording of this scenario.
std::vector<LyapunovRow> lyapunov_along(const Scenario& scenario, const Recording& recording);

/// How a function went over a run.
struct LyapunovCourse {
  double first = 0.0;         ///< at the first row
  double last = 0.0;          ///< at the last row
  double least = 0.0;         ///< of all rows
  double largest_rise = 0.0;  ///< from one row to the next, where the leader kept its velocity; 0 where it never rose
};
/// Both functions over a run.
struct LyapunovSummary {
  LyapunovCourse paper;  ///< (18)
  LyapunovCourse sound;  ///< the function that holds
};
/// REQUIRES: a formation's recording of this scenario, with a row.
LyapunovSummary summary_of(const Scenario& scenario, const Recording& recording);

/// The counterexample to Theorem 1 (docs/guide/formation.md): three robots at rest on their slots, equations (14) and
/// (15) with their signs corrected, and an avoidance that asks robot 1 for a constant `push` (m/s) relative to the
/// leader.
struct Counterexample {
  Scenario scenario;    ///< the three robots and their leader
  Recording recording;  ///< of the motion described
};
/// `push` in m/s, `duration` in s.
Counterexample theorem_one_counterexample(double push = 0.1, double duration = 1200.0);

}  // namespace exactvo::formation
