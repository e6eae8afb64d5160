// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/remedies.h"

#include "control/consensus.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation {
namespace {

Remedies none() {
  Remedies r;
  r.signs = r.recentred = r.absolute_frame = r.saturation = r.horizon_clamp = false;
  r.filter_last = r.brake_point = r.side_commitment = false;
  return r;
}

NamedRemedies flipped(const std::string& name, Remedies from, bool Remedies::*on) {
  from.*on = !(from.*on);
  return {name, from};
}

}  // namespace

Remedies remedies_of(Controller controller) {
  Remedies r;
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

std::vector<NamedRemedies> remedy_ladder() {
  using R = Remedies;
  std::vector<NamedRemedies> rungs{{"signs", remedies_of(Controller::paper_signs)}};
  rungs.front().remedies.margins = false;
  const auto add = [&rungs](const std::string& name, bool R::*on) {
    rungs.push_back(flipped("+ " + name, rungs.back().remedies, on));
  };
  add("absolute frame", &R::absolute_frame);
  add("recentred offsets", &R::recentred);
  add("saturation", &R::saturation);
  add("horizon clamp", &R::horizon_clamp);
  add("filter last", &R::filter_last);
  add("brake point", &R::brake_point);
  add("margins", &R::margins);
  add("side commitment", &R::side_commitment);
  return rungs;
}

std::vector<NamedRemedies> remedy_ablations() {
  using R = Remedies;
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

const std::vector<RemedySwitch>& remedy_switches() {
  using R = Remedies;
  using A = RemedySwitches;
  static const std::vector<RemedySwitch> all{{"signs", &R::signs, &A::signs},
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

Remedies switched(Remedies base, const RemedySwitches& asked) {
  for (const RemedySwitch& s : remedy_switches()) base.*s.on = (asked.*s.asked).value_or(base.*s.on);
  base.acceleration_bound = asked.acceleration_bound.value_or(base.acceleration_bound);
  return base;
}

std::optional<Remedies> remedies_named(const std::string& name) {
  for (const auto& list : {remedy_ladder(), remedy_ablations()})
    for (const NamedRemedies& n : list)
      if (n.name == name) return n.remedies;
  return std::nullopt;
}

std::vector<std::string> remedy_set_names() {
  std::vector<std::string> names;
  for (const auto& list : {remedy_ladder(), remedy_ablations()})
    for (const NamedRemedies& n : list) names.push_back(n.name);
  return names;
}

namespace detail {

Remedies remedies_in_use(const Scenario& scenario, const SimulationOptions& options) {
  if (options.remedies) return *options.remedies;
  const Remedies of_controller = remedies_of(options.controller);
  return scenario.formation ? switched(of_controller, scenario.formation->remedies) : of_controller;
}

}  // namespace detail
}  // namespace exactvo::formation
