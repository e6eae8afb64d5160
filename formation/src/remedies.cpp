// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/remedies.h"

#include "exactvo/formation/simulation.h"
#include "remedies.h"

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

namespace detail {

Remedies remedies_in_use(const SimulationOptions& options) {
  return options.remedies ? *options.remedies : remedies_of(options.controller);
}

}  // namespace detail
}  // namespace exactvo::formation
