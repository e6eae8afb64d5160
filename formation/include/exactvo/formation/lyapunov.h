// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Both Lyapunov functions along a run, term by term: the paper's (18), whose integral term is defined so that its
/// derivative cancels whatever V_IVO does, and the one that holds (docs/guide/formation.md):
///
///   V = 1/2 |v^|^2 + (k1/2) x^T (L+B) x^ + k3 sum Phi(x^_i),   Phi the Huber potential of the saturated preference.
///   In free space V' = -k2 v^T (L+B) v^ - k3 |v^|^2; near obstacles V' <= -(k3/2)|v^|^2 + (k3/2)|e|^2, e = w - v_pref.
///
/// Rounded; the integral of (18) by the trapezoid of the recorded rows. Under a moving leader x^ and v^ are relative to
/// it; the derivative holds while its velocity is constant.

#include <vector>

#include "exactvo/formation/recording.h"

namespace exactvo::formation {

/// Terms of equation (18), summed over robots.
struct PaperTerms {
  double kinetic = 0.0;    ///< 1/2 sum |v^_i|^2
  double consensus = 0.0;  ///< k1/4 sum a_ij |x^_i - x^_j|^2
  double pinning = 0.0;    ///< k1/2 sum b_i |x^_i|^2
  double integral = 0.0;   ///< k3 sum of the integral of v^_i.(v^_i - V_IVO), V_IVO relative to the leader
  double value() const { return kinetic + consensus + pinning + integral; }
};

/// Terms of the function that holds.
struct SoundTerms {
  double kinetic = 0.0;    ///< 1/2 |v^|^2
  double consensus = 0.0;  ///< (k1/2) x^T (L+B) x^
  double slots = 0.0;      ///< k3 sum Phi(x^_i)
  double value() const { return kinetic + consensus + slots; }
};

struct LyapunovRow {
  double time = 0.0;  ///< s
  PaperTerms paper;
  double paper_rate = 0.0;  ///< (20): what the paper says V' is
  SoundTerms sound;
  double free_rate = 0.0;   ///< -k2 v^T (L+B) v^ - k3 |v^|^2
  double rate_bound = 0.0;  ///< -(k3/2) |v^|^2 + (k3/2) |e|^2
};

/// A row for every row of the recording. REQUIRES: a formation's recording of this scenario.
std::vector<LyapunovRow> lyapunov_along(const Scenario& scenario, const Recording& recording);

}  // namespace exactvo::formation
