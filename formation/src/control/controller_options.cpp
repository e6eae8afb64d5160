// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/controller_options.h"

#include "control/consensus.h"
#include "exactvo/formation/simulation.h"
#include "exactvo/formation/stability.h"

namespace exactvo::formation {
namespace {

ControllerOptions none() {
  ControllerOptions r;
  r.signs = r.recentred = r.absolute_frame = r.saturation = r.horizon_clamp = false;
  r.filter_last = r.brake_point = r.side_commitment = false;
  return r;
}

NamedControllerOptions flipped(const std::string& name, ControllerOptions from, bool ControllerOptions::*on) {
  from.*on = !(from.*on);
  return {name, from};
}

}  // namespace

ControllerOptions controller_options_of(Controller controller) {
  ControllerOptions r;
  switch (controller) {
    case Controller::paper_literal:
      return none();
    case Controller::paper_signs:
      r = none();
      r.signs = true;
      return r;
    case Controller::corrected:
      r.filter_last = r.brake_point = r.side_commitment = false;
      return r;
    case Controller::standard:
      return r;
  }
  return r;
}

std::vector<NamedControllerOptions> incremental_controller_options() {
  using R = ControllerOptions;
  std::vector<NamedControllerOptions> sets{{"signs", controller_options_of(Controller::paper_signs)}};
  sets.front().options.margins = false;
  const auto add = [&sets](const std::string& name, bool R::*on) {
    sets.push_back(flipped("+ " + name, sets.back().options, on));
  };
  add("absolute frame", &R::absolute_frame);
  add("recentred offsets", &R::recentred);
  add("saturation", &R::saturation);
  add("horizon clamp", &R::horizon_clamp);
  add("filter last", &R::filter_last);
  add("brake point", &R::brake_point);
  add("margins", &R::margins);
  add("side commitment", &R::side_commitment);
  return sets;
}

std::vector<NamedControllerOptions> ablated_controller_options() {
  using R = ControllerOptions;
  const R all;
  return {{"default", all},
          flipped("relative frame", all, &R::absolute_frame),
          flipped("constant |v_pref|", all, &R::saturation),
          flipped("literal horizon", all, &R::horizon_clamp),
          flipped("filter first", all, &R::filter_last),
          flipped("no brake point", all, &R::brake_point),
          flipped("no margins", all, &R::margins),
          flipped("no side commitment", all, &R::side_commitment),
          flipped("with smoothing", all, &R::smoothing)};
}

const std::vector<ControllerSwitch>& controller_switches() {
  using R = ControllerOptions;
  using A = AskedControllerOptions;
  static const std::vector<ControllerSwitch> all{{"signs", &R::signs, &A::signs},
                                                 {"recentred", &R::recentred, &A::recentred},
                                                 {"absolute_frame", &R::absolute_frame, &A::absolute_frame},
                                                 {"saturation", &R::saturation, &A::saturation},
                                                 {"horizon_clamp", &R::horizon_clamp, &A::horizon_clamp},
                                                 {"filter_last", &R::filter_last, &A::filter_last},
                                                 {"brake_point", &R::brake_point, &A::brake_point},
                                                 {"margins", &R::margins, &A::margins},
                                                 {"side_commitment", &R::side_commitment, &A::side_commitment},
                                                 {"smoothing", &R::smoothing, &A::smoothing}};
  return all;
}

ControllerOptions switched(ControllerOptions base, const AskedControllerOptions& asked) {
  for (const ControllerSwitch& s : controller_switches()) base.*s.on = (asked.*s.asked).value_or(base.*s.on);
  base.acceleration_bound = asked.acceleration_bound.value_or(base.acceleration_bound);
  return base;
}

std::optional<ControllerOptions> controller_options_named(const std::string& name) {
  for (const auto& list : {incremental_controller_options(), ablated_controller_options()})
    for (const NamedControllerOptions& n : list)
      if (n.name == name) return n.options;
  return std::nullopt;
}

std::vector<std::string> controller_option_set_names() {
  std::vector<std::string> names;
  for (const auto& list : {incremental_controller_options(), ablated_controller_options()})
    for (const NamedControllerOptions& n : list) names.push_back(n.name);
  return names;
}

namespace detail {

ControllerOptions controller_options_in_use(const Scenario& scenario, const SimulationOptions& options) {
  ControllerOptions used = options.controller_options.value_or(controller_options_of(options.controller));
  if (!scenario.formation) return used;
  if (!options.controller_options) used = switched(used, scenario.formation->controller_options);
  used.brake_point = used.brake_point && tracks_choices(scenario);
  return used;
}

}  // namespace detail
}  // namespace exactvo::formation
