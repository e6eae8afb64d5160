// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/remedies.h"

#include "exactvo/formation/simulation.h"
#include "steering/remedies.h"

namespace exactvo::formation {
namespace {

Remedies none() {
  Remedies r;
  r.signs = r.recentred = r.absolute_frame = r.saturation = r.tau_clamp = false;
  r.filter_last = r.brake_point = r.side_commitment = false;
  return r;
}

template <typename Change>
NamedRemedies changed(const std::string& name, Remedies from, const Change& change) {
  change(from);
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
  std::vector<NamedRemedies> rungs{{"signs", remedies_of(Controller::paper_signs)}};
  rungs.front().remedies.margins = false;
  const auto add = [&rungs](const std::string& name, const auto& change) {
    rungs.push_back(changed("+ " + name, rungs.back().remedies, change));
  };
  add("absolute frame", [](Remedies& r) { r.absolute_frame = true; });
  add("recentred offsets", [](Remedies& r) { r.recentred = true; });
  add("saturation", [](Remedies& r) { r.saturation = true; });
  add("tau clamp", [](Remedies& r) { r.tau_clamp = true; });
  add("filter last", [](Remedies& r) { r.filter_last = true; });
  add("brake point", [](Remedies& r) { r.brake_point = true; });
  add("margins", [](Remedies& r) { r.margins = true; });
  add("side commitment", [](Remedies& r) { r.side_commitment = true; });
  return rungs;
}

std::vector<NamedRemedies> remedy_ablations() {
  const Remedies all;
  return {{"default", all},
          changed("relative frame", all, [](Remedies& r) { r.absolute_frame = false; }),
          changed("constant |v_pref|", all, [](Remedies& r) { r.saturation = false; }),
          changed("literal tau", all, [](Remedies& r) { r.tau_clamp = false; }),
          changed("filter first", all, [](Remedies& r) { r.filter_last = false; }),
          changed("no brake point", all, [](Remedies& r) { r.brake_point = false; }),
          changed("no margins", all, [](Remedies& r) { r.margins = false; }),
          changed("no side commitment", all, [](Remedies& r) { r.side_commitment = false; }),
          changed("with smoothing", all, [](Remedies& r) { r.smoothing = true; })};
}

const std::vector<RemedySwitch>& remedy_switches() {
  using R = Remedies;
  using A = RemedySwitches;
  static const std::vector<RemedySwitch> all{{"signs", &R::signs, &A::signs},
                                             {"recentred", &R::recentred, &A::recentred},
                                             {"absolute_frame", &R::absolute_frame, &A::absolute_frame},
                                             {"saturation", &R::saturation, &A::saturation},
                                             {"tau_clamp", &R::tau_clamp, &A::tau_clamp},
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
