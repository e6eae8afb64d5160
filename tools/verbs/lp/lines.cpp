// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/lp/lines.h"

#include "support/unsigned_zero.h"

namespace exactvo::tools {
namespace {

nlohmann::ordered_json name_of(const lp::Binding& binding) {
  return is_speed_bound(binding) ? nlohmann::ordered_json(name(binding.kind)) : nlohmann::ordered_json(binding.index);
}

nlohmann::ordered_json terms_json(const std::vector<lp::Term>& terms) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const lp::Term& term : terms)
    list.push_back({{"constraint", name_of(term.binding)}, {"multiplier", term.multiplier}});
  return list;
}

nlohmann::ordered_json certificate_json(const lp::Certificate& c) {
  nlohmann::ordered_json out = {
      {"bound", terms_json(c.bound)}, {"contradiction", terms_json(c.contradiction)}, {"gap", c.gap}};
  if (c.status != lp::Status::no_interior) return out;
  out["vertex"] = nlohmann::ordered_json::array();
  for (const lp::Binding& binding : c.vertex) out["vertex"].push_back(name_of(binding));
  return out;
}

}  // namespace

nlohmann::ordered_json result_line(std::size_t index, const lp::Proven& answer) {
  const lp::Solution& s = answer.solution;
  nlohmann::ordered_json out = {{"index", index},
                                {"status", name(s.status)},
                                {"velocity", {unsigned_zero(s.velocity.x), unsigned_zero(s.velocity.y)}},
                                {"violation", s.violation},
                                {"active", nlohmann::ordered_json::array()}};
  for (std::size_t k = 0; k < s.active_count; ++k) out["active"].push_back(name_of(s.active[k].binding));
  out["multipliers"] = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < s.active_count; ++k) out["multipliers"].push_back(s.active[k].multiplier);
  out["certificate"] = answer.certificate ? certificate_json(*answer.certificate) : nlohmann::ordered_json();
  return out;
}

}  // namespace exactvo::tools
