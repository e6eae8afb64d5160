// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/groups.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <utility>

#include "exactvo/formation/constraint_name.h"
#include "steering/steering.h"

namespace exactvo::formation::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// In the time that the slowest robot needs for its diameter.
constexpr double kStalledAfter = 5.0;  ///< without having come nearer to the goal
constexpr double kActsAnyway = 15.0;   ///< where it is not dead
constexpr double kForEachRobot = 0.5;  ///< more, of those near it: large crowds take longer to get apart
constexpr double kBetweenPlans = 5.0;
constexpr double kNoProgress = 3.0;  ///< of a plan: others are in the way
constexpr double kFirstBack = 3.0;   ///< going back; then twice as long again and again

// In diameters.
constexpr double kNearer = 0.4;    ///< counts as coming nearer
constexpr double kTogether = 1.0;  ///< a smaller gap joins two robots in a group
constexpr double kBesideTheWayBack = 0.3;
constexpr double kOpenMargin = 3.0;  ///< of a region round its robots and goals
constexpr double kSceneMargin = 2.0;

/// Searches are restarted with growing limits, since their lengths are heavy-tailed; of some plans the best is taken.
constexpr std::size_t kFirstNodes = 200;
constexpr double kMoreNodes = 1.15;
constexpr int kPlansToChooseFrom = 4;
constexpr std::size_t kChoosesUpTo = 100;  ///< robots
constexpr std::size_t kCalls = 75000, kCallsGoingBack = 175000, kCallsFromTheStart = 1000000;
/// The whole scene is planned for at most that many robots.
constexpr std::size_t kEveryoneUpTo = 200;
/// Places times robots that distances are kept of.
constexpr double kMostDistances = 4e6;
/// Points of the fine grid of a map of the whole scene.
constexpr double kMostPoints = 1.5e6;
constexpr double kFinePoints = 64.0;  ///< a squared diameter

std::vector<std::size_t> merged(std::vector<std::size_t> a, const std::vector<std::size_t>& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::sort(a.begin(), a.end());
  a.erase(std::unique(a.begin(), a.end()), a.end());
  return a;
}

bool has(const std::vector<std::size_t>& sorted, std::size_t x) {
  return std::binary_search(sorted.begin(), sorted.end(), x);
}

std::string seconds(double t) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f s", t);
  return text;
}

}  // namespace

Groups::Groups(const Scenario& scenario, const FreeSpace& space, bool plans)
    : scenario_(scenario),
      space_(&space),
      plans_(plans),
      of_robot_(scenario.robots.size()),
      group_of_(scenario.robots.size(), kNone),
      wanted_(scenario.robots.size()),
      notes_(scenario.robots.size()) {
  for (const Robot& r : scenario.robots) patience_ = std::max(patience_, 2.0 * r.radius / r.max_speed);
  for (OfRobot& r : of_robot_) {
    r.shortest = kInfinity;
    r.planned_at = -kInfinity;
  }
}

void Groups::begin_step(double time, std::vector<RobotNow> now, const std::function<double(std::size_t)>& way_left) {
  time_ = time;
  now_ = std::move(now);
  if (plans_) {
    std::vector<Vec2>& here = history_.emplace_back();
    for (const RobotNow& r : now_) here.push_back(r.position);
    advance();
  }
  watch(way_left);
  if (plans_) make_due_plans();
  want();
  ++row_;
}

// --- Stalls ---

void Groups::restart_watch(std::size_t robot) {
  OfRobot& r = of_robot_[robot];
  r.since = time_;
  r.shortest = kInfinity;
  r.is_named = false;
}

void Groups::watch(const std::function<double(std::size_t)>& way_left) {
  constexpr std::size_t kEvery = 5;  // rows: ways take time to measure
  for (std::size_t i = 0; i < now_.size(); ++i) {
    if (is_member(i) || now_[i].has_arrived) {
      restart_watch(i);
    } else if ((row_ + i) % kEvery == 0) {
      OfRobot& r = of_robot_[i];
      const double left = way_left(i);
      if (!(left < r.shortest - kNearer * 2.0 * scenario_.robots[i].radius)) continue;
      r.shortest = left;
      r.since = time_;
      r.attempts = 0;
      r.is_named = false;
    }
  }
}

void Groups::end_step(const Step& row) {
  due_.clear();
  std::optional<WaitForGraph> graph;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    OfRobot& r = of_robot_[i];
    if (is_member(i) || now_[i].has_arrived || !now_[i].may_join || (!plans_ && r.is_named)) continue;
    const double stalled = stalled_for(i);
    const double pause = kBetweenPlans * patience_ * static_cast<double>(1 << std::min(r.attempts, 6));
    if (stalled < kStalledAfter * patience_ || time_ - r.planned_at < pause) continue;
    if (!graph) graph = waiting_in(scenario_, row);
    const bool dead = is_dead(*graph, row, i);
    if (!r.is_named && dead && !(*graph)[i].empty()) {
      r.is_named = true;
      notes_[i] = waiting_words(scenario_, row, *graph, i);
    }
    if (dead || stalled >= kActsAnyway * patience_) due_.push_back({i, dead});
  }
}

std::string Groups::note(std::size_t robot) {
  return std::exchange(notes_[robot], {});
}

// --- Whom a plan is for ---

Groups::Members Groups::everyone() const {
  Members all;
  for (std::size_t i = 0; i < now_.size(); ++i)
    if (now_[i].may_join) all.push_back(i);
  return all;
}

Groups::Members Groups::with_groups_of(Members who) const {
  Members more;
  for (const std::size_t i : who)
    if (is_member(i)) more.insert(more.end(), group(i).who.begin(), group(i).who.end());
  return merged(std::move(who), more);
}

/// All that are joined to the seeds by gaps under a diameter.
Groups::Members Groups::cluster_of(Members seeds) const {
  std::vector<char> in(now_.size(), 0);
  std::vector<std::size_t> open = with_groups_of(std::move(seeds));
  for (const std::size_t i : open) in[i] = 1;
  while (!open.empty()) {
    const std::size_t i = open.back();
    open.pop_back();
    for (std::size_t j = 0; j < now_.size(); ++j) {
      if (in[j] || !now_[j].may_join) continue;
      const double radii = scenario_.robots[i].radius + scenario_.robots[j].radius;
      if (!(norm(now_[i].position - now_[j].position) < (1.0 + kTogether) * radii)) continue;
      for (const std::size_t k : with_groups_of({j}))
        if (!in[k]) {
          in[k] = 1;
          open.push_back(k);
        }
    }
  }
  Members all;
  for (std::size_t i = 0; i < in.size(); ++i)
    if (in[i]) all.push_back(i);
  return all;
}

/// Who stands now where the members would go back through joins, as do those in its way.
Groups::Members Groups::with_those_in_the_way_back(Members who, std::size_t to) const {
  constexpr std::size_t kStride = 3;  // rows
  for (bool grew = true; grew;) {
    who = with_groups_of(std::move(who));
    Members more;
    for (std::size_t j = 0; j < now_.size(); ++j) {
      if (has(who, j) || !now_[j].may_join) continue;
      const auto is_in_the_way_of = [&](std::size_t i) {
        const double near = (1.0 + kBesideTheWayBack) * (scenario_.robots[i].radius + scenario_.robots[j].radius);
        for (std::size_t x = history_.size() - 1; x > to + kStride; x -= kStride)
          if (squared_norm(history_[x][i] - now_[j].position) < near * near) return true;
        return squared_norm(history_[to][i] - now_[j].position) < near * near;
      };
      if (std::any_of(who.begin(), who.end(), is_in_the_way_of)) more.push_back(j);
    }
    grew = !more.empty();
    who = merged(std::move(who), more);
  }
  return who;
}

// --- Plans ---

void Groups::make_due_plans() {
  const std::vector<Due> due = std::exchange(due_, {});
  for (const Due& d : due) {
    if (is_member(d.robot) || !(time_ - of_robot_[d.robot].planned_at > 0.0)) continue;
    const Members who = cluster_of({d.robot});
    const double anyway = kActsAnyway + kForEachRobot * static_cast<double>(who.size());
    if (d.is_dead || stalled_for(d.robot) >= anyway * patience_) plan_for(who, who, 0);
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (groups_[g].is_over || time_ - groups_[g].progress < kNoProgress * patience_) continue;
    const int tries = groups_[g].tries + 1;
    constexpr int kThenAll = 3;
    const Members who = groups_[g].who;
    plan_for(tries >= kThenAll && now_.size() <= kEveryoneUpTo ? everyone() : cluster_of(who), who, tries);
  }
}

/// From now, else from where the members were a while ago: they can go back as they came (lemma 4).
bool Groups::plan_for(Members who, const Members& seeds, int tries) {
  const std::size_t now = history_.size() - 1;
  const auto rows_back = [&](double back) { return static_cast<std::size_t>(back / scenario_.time_step); };
  for (double back = 0.0;; back = back == 0.0 ? kFirstBack * patience_ : 2.0 * back) {
    const std::size_t to = now - std::min(now, rows_back(back));
    if (back > 0.0) who = with_those_in_the_way_back(std::move(who), to);
    Attempt got = attempt(who, seeds, tries, to);
    if (got == Attempt::none_on_map && who.size() < everyone().size() && now_.size() <= kEveryoneUpTo) {
      who = everyone();
      got = attempt(who, seeds, tries, to);
    }
    if (got == Attempt::planned) return true;
    if (to == 0) break;
  }
  for (const std::size_t i : seeds) ++of_robot_[i].attempts;
  without_plan_ = seeds;
  return false;
}

geometry::Box Groups::region_for(const Members& who, const std::vector<Vec2>& from, int tries) const {
  const double diameter = 2.0 * largest_radius(who);
  geometry::Box here, both;
  for (const std::size_t i : who) {
    here.add(from[i]);
    both.add(now_[i].goal);
  }
  both.add(here);
  const auto grown = [](const geometry::Box& b, double by) {
    return geometry::Box{b.low - Vec2{by, by}, b.high + Vec2{by, by}};
  };
  const geometry::Box all = grown(both, kOpenMargin * diameter);
  const double places = (all.high.x - all.low.x) * (all.high.y - all.low.y) / (diameter * diameter);
  if (places * static_cast<double>(who.size()) <= kMostDistances) return all;
  return grown(here, (4.0 + 0.5 * std::sqrt(static_cast<double>(who.size())) + 3.0 * tries) * diameter);
}

double Groups::largest_radius(const Members& who) const {
  double largest = 0.0;
  for (const std::size_t i : who) largest = std::max(largest, scenario_.robots[i].radius);
  return largest;
}

/// For the largest of the members: who is larger and not among them needs no room.
Roadmap Groups::map_for(const Members& who, const std::vector<Vec2>& from, int tries) const {
  const double radius = largest_radius(who), diameter = 2.0 * radius;
  if (space_->is_open()) return Roadmap(*space_, region_for(who, from, tries), radius);
  geometry::Box scene;
  for (const SceneObstacle& o : scenario_.obstacles)
    for (const Segment& edge : geometry::edges_of(o.shape)) {
      scene.add(edge.a);
      scene.add(edge.b);
    }
  for (const Robot& r : scenario_.robots) {
    scene.add(r.position);
    for (const Vec2 goal : r.goals) scene.add(goal);
  }
  const Vec2 margin{kSceneMargin * diameter, kSceneMargin * diameter};
  scene = {scene.low - margin, scene.high + margin};
  const Vec2 size = (scene.high - scene.low) / diameter;
  if (kFinePoints * size.x * size.y > kMostPoints) return Roadmap(*space_, region_for(who, from, tries), radius);
  const auto known = whole_maps_.find(radius);
  return known != whole_maps_.end() ? known->second
                                    : whole_maps_.emplace(radius, Roadmap(*space_, scene, radius)).first->second;
}

/// Each member's goal, or, where that is outside the map or taken, the nearest place that is free.
std::vector<PlaceNumber> Groups::targets_for(const Members& who, const std::vector<Vec2>& from, Roadmap& map) const {
  const std::size_t places = map.size();
  std::vector<std::pair<double, std::size_t>> nearest_first;
  for (std::size_t k = 0; k < who.size(); ++k) nearest_first.emplace_back(norm(now_[who[k]].goal - from[who[k]]), k);
  std::sort(nearest_first.begin(), nearest_first.end());
  std::vector<std::pair<Vec2, double>> taken;  // with radii
  for (std::size_t j = 0; j < now_.size(); ++j)
    if (!has(who, j) && (now_[j].has_arrived || !now_[j].may_join))
      taken.emplace_back(now_[j].position, scenario_.robots[j].radius);
  std::vector<PlaceNumber> targets(who.size());
  for (const auto& entry : nearest_first) {
    const std::size_t k = entry.second, i = who[k];
    const double radius = scenario_.robots[i].radius;
    const auto is_free = [&](Vec2 place) {
      return std::all_of(taken.begin(), taken.end(), [&](const auto& t) {
        const double wanted = (1.0 + kPlannedGap) * (radius + t.second);
        return squared_norm(place - t.first) >= wanted * wanted;
      });
    };
    const Vec2 goal = now_[i].goal;
    std::optional<PlaceNumber> target;
    if (is_free(goal) && space_->clearance(goal, radius) >= radius) {
      const PlaceNumber own = map.attach(goal);
      if (!map.ways(own).empty()) target = own;
    }
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
      targets[k] = map.attach(from[i]);
    taken.emplace_back(map.place(targets[k]), radius);
  }
  return targets;
}

std::optional<std::vector<PlannedMove>> Groups::search(JointProblem problem, std::size_t to, Attempt& end) {
  const std::vector<double> radii = problem.radii;
  const Roadmap& map = *problem.map;
  JointSearch joint(std::move(problem));
  const std::size_t most = to == 0 ? kCallsFromTheStart : to + 1 == history_.size() ? kCalls : kCallsGoingBack;
  std::optional<std::vector<PlannedMove>> best;
  double shortest = kInfinity, nodes = kFirstNodes;
  int found = 0;
  end = Attempt::out_of_budget;
  for (std::size_t calls = 0; calls < most && found < (radii.size() <= kChoosesUpTo ? kPlansToChooseFrom : 1);) {
    const JointAnswer answer = joint.run(++seed_, {most - calls, static_cast<std::size_t>(nodes)});
    calls += answer.calls + 1;
    course_.search_nodes += answer.nodes;
    if (answer.end == SearchEnd::none_on_map) {
      end = Attempt::none_on_map;
      break;
    }
    if (answer.end == SearchEnd::out_of_budget) {
      if (best) break;
      nodes *= kMoreNodes;
      continue;
    }
    ++found;
    std::vector<PlannedMove> plan = plan_of(map, answer.moves, radii);
    const double length = critical_length(plan);
    if (!(length < shortest)) continue;
    shortest = length;
    best = std::move(plan);
  }
  if (best) end = Attempt::planned;
  return best;
}

void Groups::dissolve_those_of(const Members& who) {
  for (const std::size_t i : who) {
    if (is_member(i)) dissolve(group_of_[i]);
    of_robot_[i].planned_at = time_;
  }
}

Groups::Attempt Groups::attempt(const Members& members, const Members& seeds, int tries, std::size_t to) {
  const Members who = with_groups_of(members);
  const std::vector<Vec2>& from = history_[to];
  dissolve_those_of(seeds);
  Roadmap map = map_for(who, from, tries);
  for (std::size_t j = 0; j < now_.size(); ++j)
    if (!has(who, j) && (now_[j].has_arrived || !now_[j].may_join))
      map.block(now_[j].position, (1.0 + kPlannedGap) * (largest_radius(who) + scenario_.robots[j].radius));
  JointProblem problem;
  problem.map = &map;
  problem.goals = targets_for(who, from, map);
  for (const std::size_t i : who) {
    problem.radii.push_back(scenario_.robots[i].radius);
    problem.starts.push_back(map.attach(from[i]));
  }
  const std::vector<double> radii = problem.radii;
  Attempt end;
  std::optional<std::vector<PlannedMove>> plan = search(std::move(problem), to, end);
  if (!plan) return end;
  dissolve_those_of(who);
  Group& g = groups_.emplace_back(Group{who, Following(std::move(*plan), radii)});
  g.back_at = history_.size() - 1;
  g.back_to = to;
  g.progress = time_;
  g.tries = tries;
  for (const std::size_t i : who) {
    group_of_[i] = groups_.size() - 1;
    of_robot_[i].attempts = 0;
  }
  ++course_.groups;
  course_.largest = std::max(course_.largest, who.size());
  without_plan_.clear();
  notes_[who.front()] = joined_notes(notes_[who.front()], plan_words(g));
  return Attempt::planned;
}

std::string Groups::plan_words(const Group& g) const {
  std::string text = std::to_string(g.who.size()) + (g.who.size() == 1 ? " robot goes" : " robots go") +
                     " by plan: " + std::to_string(g.following.plan().size()) + " moves";
  if (g.back_at > g.back_to)
    text += "; they first go back " + seconds(static_cast<double>(g.back_at - g.back_to) * scenario_.time_step);
  return text;
}

void Groups::dissolve(std::size_t number) {
  Group& g = groups_[number];
  for (const std::size_t i : g.who) {
    group_of_[i] = kNone;
    restart_watch(i);
  }
  g.is_over = true;
}

std::string Groups::no_plan_words() const {
  std::vector<std::string> names;
  for (const std::size_t i : without_plan_) names.push_back(scenario_.robots[i].id);
  return names.empty() ? "" : "no plan was found on the roadmap for " + abridged(std::move(names));
}

// --- Following ---

void Groups::advance() {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (groups_[g].is_over) continue;
    advance(groups_[g]);
    if (groups_[g].following.moves_left() == 0 && groups_[g].back_at <= groups_[g].back_to) dissolve(g);
  }
  while (!groups_.empty() && groups_.back().is_over) groups_.pop_back();
}

void Groups::advance(Group& g) {
  const std::vector<Vec2>& here = history_.back();
  if (g.back_at > g.back_to) {
    if (g.stands_still) return;
    // Rows in which nobody moved need not be gone through again.
    const auto nobody_moved_to = [&](std::size_t row) {
      return std::all_of(g.who.begin(), g.who.end(),
                         [&](std::size_t i) { return history_[row][i] == history_[row - 1][i]; });
    };
    g.progress = time_;
    --g.back_at;
    while (g.back_at > g.back_to && nobody_moved_to(g.back_at)) --g.back_at;
    return;
  }
  const std::size_t before = g.following.moves_left();
  std::vector<Vec2> at;
  for (const std::size_t i : g.who) at.push_back(here[i]);
  g.following.advance(at);
  if (g.following.moves_left() < before) g.progress = time_;
}

void Groups::want() {
  for (Group& g : groups_) g.stands_still = false;
  for (std::size_t i = 0; i < now_.size(); ++i)
    if (is_member(i)) wanted_[i] = wanted_by(i);
}

Vec2 Groups::wanted_by(std::size_t robot) const {
  const Group& g = group(robot);
  const std::vector<Vec2>& here = history_.back();
  const double dt = scenario_.time_step, fastest = scenario_.robots[robot].max_speed;
  Vec2 to;
  if (g.back_at > g.back_to) {
    to = history_[g.back_at - 1][robot];
  } else {
    std::vector<Vec2> at;
    for (const std::size_t i : g.who) at.push_back(here[i]);
    const auto k = std::lower_bound(g.who.begin(), g.who.end(), robot) - g.who.begin();
    to = g.following.within_reach(static_cast<std::size_t>(k), at);
  }
  const Vec2 way = to - here[robot];
  const double length = norm(way);
  return length > fastest * dt ? fastest / length * way : way / dt;
}

bool Groups::halt_those_held_back(const Step& row) {
  constexpr double kAsWanted = 1e-9;  // m/s
  bool any = false;
  for (Group& g : groups_) {
    if (g.is_over || g.stands_still || g.back_at <= g.back_to) continue;
    const bool as_wanted = std::all_of(g.who.begin(), g.who.end(), [&](std::size_t i) {
      return norm(row.robots[i].chosen - wanted_[i]) <= kAsWanted;
    });
    if (as_wanted) continue;
    g.stands_still = any = true;
    for (const std::size_t i : g.who) wanted_[i] = {};
  }
  return any;
}

}  // namespace exactvo::formation::detail
