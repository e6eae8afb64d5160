// SPDX-License-Identifier: GPL-3.0-or-later
// How one plan of a group is made: its region and map, where its robots are to go, and what is recorded of it.
#include "liveness/groups.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "exactvo/geometry/infinity.h"
#include "scene/goals.h"
#include "steering/steering.h"

namespace exactvo::formation::detail {
namespace {

using geometry::kInfinity;

// In diameters.
constexpr double kOpenMargin = 3.0;  ///< of a region round its robots and goals
constexpr double kSceneMargin = 2.0;

/// Calls of the generator.
constexpr std::size_t kCalls = 75000, kCallsGoingBack = 175000, kCallsFromTheStart = 1000000;
/// A map of the whole scene or of all goals has at most this many places, which take 0.1 s to a second, and this many
/// distances from places to goals.
constexpr double kMostPlaces = 6e4;
constexpr double kMostDistances = 4e6;
/// A plan is made for fewer robots where its map would have more distances than that: they take 40 MB and a second.
constexpr double kLargestMap = 1e7;

}  // namespace

/// Whether a map for these is of a size that can be searched.
bool Groups::fits(const Members& who, const std::vector<Vec2>& from, int replans) const {
  if (uses_whole_map(who)) return true;
  return Roadmap::lattice_places(region_for(who, from, replans), largest_radius(robots_, who)) *
             static_cast<double>(who.size()) <=
         kLargestMap;
}

geometry::Box Groups::region_for(const Members& who, const std::vector<Vec2>& from, int replans) const {
  const double diameter = 2.0 * largest_radius(robots_, who);
  geometry::Box here, both;
  for (const std::size_t i : who) {
    here.add(from[i]);
    both.add(now_[i].goal);
  }
  both.add(here);
  const geometry::Box all = both.grown(kOpenMargin * diameter);
  const double places = Roadmap::lattice_places(all, 0.5 * diameter);
  if (places <= kMostPlaces && places * static_cast<double>(who.size()) <= kMostDistances) return all;
  return here.grown((4.0 + 0.5 * std::sqrt(static_cast<double>(who.size())) + 3.0 * replans) * diameter);
}

geometry::Box Groups::whole_scene(double radius) const {
  return scene_.grown(2.0 * kSceneMargin * radius);
}

bool Groups::uses_whole_map(const Members& who) const {
  if (space_->is_open()) return false;
  const double radius = largest_radius(robots_, who);
  const double places = Roadmap::lattice_places(whole_scene(radius), radius);
  return places <= kMostPlaces && places * static_cast<double>(who.size()) <= kLargestMap;
}

/// For the largest of the members: a larger robot that is not among them needs no room.
Roadmap Groups::map_for(const Members& who, const std::vector<Vec2>& from, int replans, Detail detail) const {
  const double radius = largest_radius(robots_, who);
  if (!uses_whole_map(who)) return Roadmap(*space_, region_for(who, from, replans), radius, detail);
  const std::pair key{radius, detail};
  const auto known = whole_maps_.find(key);
  if (known != whole_maps_.end()) return known->second;
  return whole_maps_.emplace(key, Roadmap(*space_, whole_scene(radius), radius, detail)).first->second;
}

/// Each member's goal, or, where that is outside the map or taken, the nearest place that is free. Robots that
/// only pass their goal choose before those that stay there; robots that yield come last.
std::vector<PlaceNumber> Groups::targets_for(const Members& who, const std::vector<Vec2>& from, bool with_margin,
                                             Roadmap& map) const {
  const std::size_t places = map.size();
  std::vector<std::tuple<int, double, std::size_t>> nearest_first;
  for (std::size_t k = 0; k < who.size(); ++k) {
    const RobotNow& r = now_[who[k]];
    const bool passes = r.goal_number + 1 < robots_[who[k]].goals.size();
    nearest_first.emplace_back(r.yields ? 2 : passes ? 0 : 1, norm(r.goal - from[who[k]]), k);
  }
  std::sort(nearest_first.begin(), nearest_first.end());
  std::vector<geometry::Disc> taken;
  for (std::size_t j = 0; j < now_.size(); ++j)
    if (!contains(who, j) && (now_[j].has_arrived || !now_[j].may_join))
      taken.push_back({now_[j].position, radius_of(j, with_margin)});
  std::vector<PlaceNumber> targets(who.size());
  for (const auto& [rank, from_goal, k] : nearest_first) {
    const std::size_t i = who[k];
    const double radius = robots_[i].radius, kept = radius_of(i, with_margin);
    const auto is_free = [&](Vec2 place) {
      return std::all_of(taken.begin(), taken.end(), [&](const geometry::Disc& t) {
        const double wanted = (1.0 + kPlannedGap) * (kept + t.radius);
        return squared_norm(place - t.center) >= wanted * wanted;
      });
    };
    const Vec2 goal = now_[i].goal;
    std::optional<PlaceNumber> target;
    if (is_free(goal) && space_->clearance(goal, radius) >= radius) target = map.attach_where_joined(goal, radius);
    double least = kInfinity;
    for (PlaceNumber p = 0; !target && p < places; ++p) {
      const double distance = squared_norm(map.place(p) - goal);
      if (distance < least && !map.is_blocked(p) && is_free(map.place(p))) {
        least = distance;
        targets[k] = p;
      }
    }
    if (target)
      targets[k] = *target;
    else if (least == kInfinity)
      targets[k] = map.attach(from[i], radius);
    taken.push_back({map.place(targets[k]), kept});
  }
  return targets;
}

/// Whether the plan would bring one of the seeds to its goal, or nearer to it than it stands.
bool Groups::serves_any(const Members& seeds, const Members& who, const Roadmap& map,
                        const std::vector<PlaceNumber>& targets) const {
  constexpr double kThere = 1e-6;  // of the radius
  return std::any_of(seeds.begin(), seeds.end(), [&](std::size_t i) {
    const RobotNow& r = now_[i];
    const double radius = robots_[i].radius;
    const auto k = std::lower_bound(who.begin(), who.end(), i) - who.begin();
    const double left = norm(r.goal - map.place(targets[static_cast<std::size_t>(k)]));
    return !r.has_arrived && (left <= kThere * radius || left < norm(r.goal - r.position) - kNearer * 2.0 * radius);
  });
}

/// Calls of the generator at most, for a plan from where the robots were in that row.
std::size_t Groups::most_calls(std::size_t row) const {
  if (row == history_.last()) return kCalls;
  return row == history_.first() ? kCallsFromTheStart : kCallsGoingBack;
}

/// m: its own, or so much more that the gap of plans is the margin between robots.
double Groups::radius_of(std::size_t robot, bool with_margin) const {
  const double radius = robots_[robot].radius;
  return with_margin ? std::max(radius, (radius + 0.5 * margin_) / (1.0 + kPlannedGap)) : radius;
}

/// Whether plans of these keep less than the margin where they are not asked for it.
bool Groups::has_wide_margin(const Members& who) const {
  constexpr double kRounding = 1.0 + 1e-9;
  return std::any_of(who.begin(), who.end(),
                     [&](std::size_t i) { return radius_of(i, true) > kRounding * robots_[i].radius; });
}

/// From where they are to their targets, on that map, where those who are not of these and stay are blocked.
JointProblem Groups::problem_for(const Members& who, const std::vector<Vec2>& from, bool with_margin,
                                 Roadmap& map) const {
  JointProblem problem;
  problem.map = &map;
  problem.is_stopped = is_stopped_;
  double largest = 0.0;
  for (const std::size_t i : who) {
    problem.radii.push_back(radius_of(i, with_margin));
    largest = std::max(largest, problem.radii.back());
    if (with_margin) problem.bodies.push_back(robots_[i].radius);
  }
  for (std::size_t j = 0; j < now_.size(); ++j)
    if (!contains(who, j) && (now_[j].has_arrived || !now_[j].may_join))
      map.block(now_[j].position, (1.0 + kPlannedGap) * (largest + radius_of(j, with_margin)));
  problem.goals = targets_for(who, from, with_margin, map);
  for (const std::size_t i : who) problem.starts.push_back(map.attach(from[i], robots_[i].radius));
  return problem;
}

/// With the margin between robots where there is a plan that leads as far; else without.
PlanEnd Groups::plan_from(const Members& members, const Members& seeds, int replans, std::size_t row, Detail detail) {
  const Members who = with_groups_of(members);
  const std::vector<Vec2>& from = history_[row];
  if (!fits(who, from, replans)) return PlanEnd::too_large;
  dissolve_those_of(seeds);
  if (tries_.are_in_vain(time_, now_, who)) return PlanEnd::in_vain;
  Roadmap map = map_for(who, from, replans, detail);
  const bool is_wide = has_wide_margin(who), asks_for_margin = is_wide && replans == 0;
  std::optional<Roadmap> roomy;
  if (asks_for_margin) roomy = map;  // before what stays is blocked
  const JointProblem problem = problem_for(who, from, false, map);
  if (!serves_any(seeds, who, map, problem.goals)) return PlanEnd::no_use;
  const bool has_lanes = static_cast<double>(map.size() * who.size()) <= kMostDistances;
  PlanFound found;
  bool keeps_margin = false;
  if (asks_for_margin) {
    const JointProblem wider = problem_for(who, from, true, *roomy);
    const auto leads_as_far = [&](std::size_t k) {
      return roomy->place(wider.goals[k]) == map.place(problem.goals[k]);
    };
    bool lead_as_far = true;
    for (std::size_t k = 0; k < who.size(); ++k) lead_as_far = lead_as_far && leads_as_far(k);
    if (lead_as_far) found = search_.best_plan(wider, most_calls(row), has_lanes);
    course_.search_nodes += found.nodes;
    keeps_margin = found.end == PlanEnd::planned;
    if (keeps_margin) start(who, Following(std::move(found.plan), wider.radii), replans, row);
  }
  if (!keeps_margin) {
    found = search_.best_plan(problem, most_calls(row), has_lanes);
    course_.search_nodes += found.nodes;
    if (found.end != PlanEnd::planned) return found.end;
    start(who, Following(std::move(found.plan), problem.radii), replans, row);
  }
  Group& g = groups_.back();
  if (keeps_margin) g.gap = margin_;
  add_note(notes_[who.front()], plan_words(g) + (is_wide && !keeps_margin ? "; it does not keep margins.robot" : ""));
  return PlanEnd::planned;
}

void Groups::start(const Members& who, Following following, int replans, std::size_t row) {
  dissolve_those_of(who);
  Group& g = groups_.emplace_back(Group{who, std::move(following)});
  g.back_at = history_.last();
  g.back_to = row;
  g.progress = time_;
  g.replans = replans;
  for (const std::size_t i : who) {
    group_of_[i] = groups_.size() - 1;
    of_robot_[i].failures = 0;
    of_robot_[i].planned_goal = now_[i].goal_number;
  }
  tries_.count(time_, now_, who);
  ++course_.groups;
  course_.largest = std::max(course_.largest, who.size());
  made_.push_back(recorded(g));
  forget_without_plan(who);
}

JointPlan Groups::recorded(const Group& g) const {
  JointPlan plan{g.back_at, g.back_to, g.who, {}, {}};
  for (const std::size_t i : g.who) plan.starts.push_back(history_[g.back_to][i]);
  for (const PlannedMove& m : g.following.plan()) plan.moves.push_back({g.who[m.robot], m.to});
  return plan;
}

}  // namespace exactvo::formation::detail
