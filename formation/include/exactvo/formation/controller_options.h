// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What separates the paper's formation controller from one that keeps its promises, each on a switch of its own, so
/// that causes can be told apart (docs/guide/formation.md). The controllers of simulation.h are sets of these.

#include <optional>
#include <string>
#include <vector>

namespace exactvo::formation {

/// The options of a formation's controller. The initial values are those of the default controller: all on, except
/// `smoothing`, and no acceleration bound.
struct ControllerOptions {
  bool signs = true;           ///< (15) and (17) with their signs corrected; without it they are as printed
  bool recentred = true;       ///< offsets as equation (4) needs them, where the scenario asks for it
  bool absolute_frame = true;  ///< V_IVO is an absolute velocity; the paper adds the leader's to it
  bool saturation = true;      ///< v_pref slows towards the slot; the paper's keeps its magnitude
  bool horizon_clamp = true;   ///< horizons within their bounds; the paper's tau = dist / |v|
  bool filter_last = true;  ///< consensus enters v_pref, so that what is tracked is safe; the paper adds it afterwards
  bool brake_point = true;  ///< velocity obstacles at x + v / k3, which moves as tracked; off on wheels
  bool margins = true;      ///< the scenario's margins; without it the robots' is 0
  bool side_commitment = true;      ///< a side is chosen once and kept while blocked
  bool smoothing = false;           ///< v_pref averaged with the last tracked velocity, 1 to 4, before the projection
  double acceleration_bound = 0.0;  ///< m/s^2, > 0: |u| is held below it; heuristic, see docs/guide/formation.md
};

/// Some of them, set one way or the other: what a scenario sets in addition to its controller.
struct AskedControllerOptions {
  ///@{
  /// The member of ControllerOptions of that name; none: as the controller has it.
  std::optional<bool> signs;
  std::optional<bool> recentred;
  std::optional<bool> absolute_frame;
  std::optional<bool> saturation;
  std::optional<bool> horizon_clamp;
  std::optional<bool> filter_last;
  std::optional<bool> brake_point;
  std::optional<bool> margins;
  std::optional<bool> side_commitment;
  std::optional<bool> smoothing;
  ///@}
  std::optional<double> acceleration_bound;  ///< m/s^2, >= 0; 0 for none
};

/// One of the switches by its name, which is that of the member: "horizon_clamp".
struct ControllerSwitch {
  const char* name;                                    ///< the member's
  bool ControllerOptions::*on;                         ///< the switch
  std::optional<bool> AskedControllerOptions::*asked;  ///< the same switch among those asked for
};
/// All of them but the bound, in the order of the struct.
const std::vector<ControllerSwitch>& controller_switches();

/// `base` with the options of `asked` switched on or off.
ControllerOptions switched(ControllerOptions base, const AskedControllerOptions& asked);

/// A set of controller options with the name under which it is reported.
struct NamedControllerOptions {
  std::string name;           ///< "horizon_clamp" and so on
  ControllerOptions options;  ///< the whole set
};

/// From the corrected signs without margins to the default, adding one option per step. (The paper's controllers
/// themselves keep the scenario's margins.)
std::vector<NamedControllerOptions> incremental_controller_options();

/// The default with one option taken away (or smoothing added) at a time.
std::vector<NamedControllerOptions> ablated_controller_options();

/// The set of that name; nothing where there is none.
std::optional<ControllerOptions> controller_options_named(const std::string& name);
/// The names that `controller_options_named` knows.
std::vector<std::string> controller_option_set_names();

}  // namespace exactvo::formation
