// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/formation/constraint_name.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace exactvo::formation {
namespace {

using geometry::Segment;

constexpr std::size_t kMostNames = 3;

std::string ends_of(const Segment& s) {
  char text[160];
  std::snprintf(text, sizeof text, "(%.3g, %.3g)-(%.3g, %.3g)", s.a.x, s.a.y, s.b.x, s.b.y);
  return text;
}

/// "enclosures", "4" and "5" of "obstacle U".
struct Named {
  std::string kind, kinds;  ///< one of them, several
  std::vector<std::string> which;
  std::string owner;  ///< empty where there is none
};

template <typename Items>
std::string id_at(const Items& items, std::size_t index) {
  return index < items.size() ? items[index].id : std::to_string(index);
}

Named named(const DecisionConstraint& c, const Scenario& scenario, const std::vector<vo::Body>& bodies) {
  if (is_own_limit(c) && c.index < scenario.robots.size() && scenario.robots[c.index].drive)
    return {"wheels of robot", "wheels of robots", {id_at(scenario.robots, c.index)}, ""};
  if (is_own_limit(c))
    return {"acceleration of robot", "acceleration of robots", {id_at(scenario.robots, c.index)}, ""};
  if (c.source == ConstraintSource::robot) return {"robot", "robots", {id_at(scenario.robots, c.index)}, ""};
  if (c.source == ConstraintSource::moving_obstacle)
    return {"moving obstacle", "moving obstacles", {id_at(scenario.moving_obstacles, c.index)}, ""};
  const std::string owner = c.body < bodies.size() ? names_of_obstacles(scenario, bodies[c.body].owners) : "";
  if (c.source == ConstraintSource::enclosure) {
    const std::string piece = c.piece > 0 ? ", piece " + std::to_string(c.piece) + "," : "";
    return {"enclosure", "enclosures", {std::to_string(c.index) + piece}, owner};
  }
  const auto* edge = c.body < bodies.size() ? std::get_if<Segment>(&bodies[c.body].shape) : nullptr;
  return {"the edge", "the edges", {edge ? ends_of(*edge) : std::to_string(c.index)}, owner};
}

}  // namespace

std::string name_of(const std::vector<DecisionConstraint>& constraints, const Scenario& scenario,
                    const std::vector<vo::Body>& bodies) {
  std::vector<Named> groups;  // of one kind and owner each
  for (const DecisionConstraint& c : constraints) {
    Named item = named(c, scenario, bodies);
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&](const Named& g) { return g.kind == item.kind && g.owner == item.owner; });
    if (same == groups.end())
      groups.push_back(std::move(item));
    else if (std::find(same->which.begin(), same->which.end(), item.which.front()) == same->which.end())
      same->which.push_back(item.which.front());
  }
  std::vector<std::string> words;
  for (const Named& g : groups)
    words.push_back((g.which.size() > 1 ? g.kinds : g.kind) + " " + enumerated(g.which) +
                    (g.owner.empty() ? "" : " of " + g.owner));
  return enumerated(words);
}

std::string name_of(const DecisionConstraint& constraint, const Scenario& scenario,
                    const std::vector<vo::Body>& bodies) {
  return name_of(std::vector<DecisionConstraint>{constraint}, scenario, bodies);
}

std::string names_of_obstacles(const Scenario& scenario, const std::vector<std::size_t>& which) {
  std::vector<std::string> ids;
  for (const std::size_t k : which) ids.push_back(id_at(scenario.obstacles, k));
  if (ids.empty()) return "";
  return (ids.size() > 1 ? "obstacles " : "obstacle ") + abridged(ids);
}

std::string enumerated(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k)
    text += (k == 0 ? "" : k + 1 == words.size() ? " and " : ", ") + words[k];
  return text;
}

std::string abridged(std::vector<std::string> words) {
  if (words.size() > kMostNames) {
    const std::size_t more = words.size() - kMostNames;
    words.resize(kMostNames);
    words.push_back(std::to_string(more) + " more");
  }
  return enumerated(words);
}

}  // namespace exactvo::formation
