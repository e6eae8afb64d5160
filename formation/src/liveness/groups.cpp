// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/groups.h"

#include <cmath>
#include <cstdio>

#include "exactvo/formation/constraint_name.h"
#include "exactvo/formation/speed_profile.h"
#include "exactvo/geometry/infinity.h"
#include "scene/goals.h"
#include "scene/near_pairs.h"
#include "steering/steering.h"

namespace exactvo::formation::detail {
namespace {

using geometry::kInfinity;

// In the time that the slowest robot needs for its diameter.
constexpr double kStalledAfter = 5.0;  ///< without having come nearer to the goal
constexpr double kActsAnyway = 15.0;   ///< where it is not dead
constexpr double kForEachRobot = 0.5;  ///< more, of those near it: large crowds take longer to get apart
constexpr double kBetweenPlans = 5.0;
constexpr double kNoProgress = 3.0;  ///< of a plan: others are in the way
constexpr double kFirstBack = 3.0;   ///< going back; then twice as long again and again

// In diameters.
constexpr double kTogether = 1.0;  ///< a smaller gap joins two robots in a group
constexpr double kBesideTheWayBack = 0.3;

/// The whole scene is planned for at most that many robots.
constexpr std::size_t kEveryoneUpTo = 200;

std::vector<std::size_t> merged(std::vector<std::size_t> a, const std::vector<std::size_t>& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::sort(a.begin(), a.end());
  a.erase(std::unique(a.begin(), a.end()), a.end());
  return a;
}

/// Why there is no plan; the names of the robots that wait for one follow.
std::string words_of(PlanEnd why) {
  switch (why) {
    case PlanEnd::none_on_map:
      return "there is no plan on the roadmap for ";
    case PlanEnd::too_large:
      return "too many robots stand together to plan for ";
    case PlanEnd::no_use:
      return "the roadmap has no place nearer to its goal that others leave free for ";
    case PlanEnd::in_vain:
      return "joint plans were made " + std::to_string(PlanTries::kMost) + " times or more, in vain, for ";
    default:
      return "no plan was found on the roadmap for ";
  }
}

std::string seconds(double t) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f s", t);
  return text;
}

}  // namespace

Vec2 velocity_along(const DecisionRules& rules, double max_speed, Vec2 way) {
  const double length =
      rules.speed_bound == SpeedBoundKind::box ? std::max(std::fabs(way.x), std::fabs(way.y)) : norm(way);
  return length > max_speed * rules.time_step ? max_speed / length * way : way / rules.time_step;
}

Groups::Groups(const Scenario& scenario, const DecisionRules& rules, const std::vector<Robot>& robots,
               const FreeSpace& space, bool plans, std::function<bool()> is_stopped)
    : scenario_(scenario),
      rules_(rules),
      robots_(robots),
      space_(&space),
      plans_(plans),
      is_stopped_(std::move(is_stopped)),
      patience_(patience_of(robots)),
      margin_(scenario.formation || takes_edges(rules.method) ? 0.0 : rules.margins.robot),
      of_robot_(robots.size()),
      group_of_(robots.size(), kNone),
      wanted_(robots.size()),
      notes_(robots.size()),
      tries_(robots, scenario.moving_obstacles) {
  for (const SceneObstacle& o : scenario.obstacles)
    for (const Vec2 p : geometry::vertices_of(o.shape)) scene_.add(p);
  for (const Robot& r : robots) {
    scene_.add(r.position);
    for (const Vec2 goal : r.goals) scene_.add(goal);
  }
  for (OfRobot& r : of_robot_) {
    r.shortest = kInfinity;
    r.planned_at = -kInfinity;
  }
}

void Groups::begin_step(double time, std::vector<RobotNow> now, const std::function<double(std::size_t)>& way_left) {
  time_ = time;
  now_ = std::move(now);
  if (plans_) {
    std::vector<Vec2> here;
    here.reserve(now_.size());
    for (const RobotNow& r : now_) here.push_back(r.position);
    history_.add(std::move(here));
    advance();
    std::size_t needed = history_.last();
    for (const Group& g : groups_)
      if (!g.is_over && g.back_at > g.back_to) needed = std::min(needed, g.back_to);
    history_.forget_before(needed);
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
    if (is_member(i) || now_[i].has_arrived || now_[i].goal_number != of_robot_[i].goal_number) {
      of_robot_[i].goal_number = now_[i].goal_number;
      restart_watch(i);
    } else if ((row_ + i) % kEvery == 0) {
      OfRobot& r = of_robot_[i];
      const double left = way_left(i);
      if (!(left < r.shortest - kNearer * 2.0 * robots_[i].radius)) continue;
      r.shortest = left;
      r.since = time_;
      r.failures = 0;
      r.is_named = false;
    }
  }
}

/// In a formation every robot that stands counts as waiting: robots that creep up to their slots wait for none.
bool Groups::is_dead_in(const WaitForGraph& graph, const Step& row, std::size_t robot) const {
  if (!scenario_.formation) return is_dead(scenario_, graph, row, robot);
  const RobotStep& r = row.robots[robot];
  return r.mode == Mode::arrived || stands(robots_[robot], r.chosen);
}

void Groups::end_step(const Step& row) {
  due_.clear();
  std::optional<WaitForGraph> graph;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    OfRobot& r = of_robot_[i];
    if (is_member(i) || now_[i].has_arrived || !now_[i].may_join || (!plans_ && r.is_named)) continue;
    const double stalled = stalled_for(i);
    const double pause = kBetweenPlans * patience_ * static_cast<double>(1 << std::min(r.failures, 6));
    if (stalled < kStalledAfter * patience_ || time_ - r.planned_at < pause) continue;
    if (!graph) graph = scenario_.formation ? WaitForGraph(now_.size()) : waiting_in(scenario_, row);
    const bool dead = is_dead_in(*graph, row, i);
    if (!r.is_named && dead && !(*graph)[i].empty()) {
      r.is_named = true;
      notes_[i] = waiting_words(scenario_, row, *graph, i);
    }
    if (dead || stalled >= kActsAnyway * patience_) due_.push_back({i, dead});
  }
}

// --- Whom a plan is for ---

Groups::Members Groups::everyone() const {
  Members all;
  for (std::size_t i = 0; i < now_.size(); ++i)
    if (now_[i].may_join) all.push_back(i);
  return all;
}

Groups::Members Groups::members_of(const Group& g) const {
  Members all;
  for (const std::size_t i : g.who)
    if (is_member(i) && &group(i) == &g) all.push_back(i);
  return all;
}

Groups::Members Groups::with_groups_of(Members who) const {
  std::vector<std::size_t> numbers;
  for (const std::size_t i : who)
    if (is_member(i)) numbers.push_back(group_of_[i]);
  for (const std::size_t g : merged(std::move(numbers), {})) who = merged(std::move(who), members_of(groups_[g]));
  return who;
}

/// The robots that gaps under a diameter join to the seeds, those joined by the fewest gaps first. Robots that keep a
/// wide margin are joined across it.
std::vector<std::size_t> Groups::by_nearness_to(const Members& seeds) const {
  const auto reach = [&](double radii) {
    return radii + std::max(kTogether * radii, kNearMargins * rules_.margins.robot);
  };
  const double farthest = reach(2.0 * largest_radius(robots_));
  Cells<std::size_t> by_place(farthest);
  for (std::size_t j = 0; j < now_.size(); ++j)
    if (now_[j].may_join) by_place.add(now_[j].position, j);
  std::vector<char> in(now_.size(), 0);
  std::vector<std::size_t> found;
  const auto take = [&](const Members& some) {
    for (const std::size_t k : with_groups_of(some))
      if (!in[k]) {
        in[k] = 1;
        found.push_back(k);
      }
  };
  take(seeds);
  for (std::size_t next = 0; next < found.size(); ++next) {
    const std::size_t i = found[next];
    Members near;
    by_place.for_each_about(now_[i].position, farthest, [&](std::size_t j) {
      const double radii = robots_[i].radius + robots_[j].radius;
      if (!in[j] && norm(now_[i].position - now_[j].position) < reach(radii)) near.push_back(j);
    });
    std::sort(near.begin(), near.end());
    take(near);
  }
  return found;
}

/// The nearest of a very large cluster.
Groups::Members Groups::as_many_as_fit(std::vector<std::size_t> nearest_first, int replans) const {
  for (;;) {
    Members who = nearest_first;
    std::sort(who.begin(), who.end());
    if (who.size() < 2 || fits(who, history_.back(), replans)) return who;
    nearest_first.resize((nearest_first.size() + 1) / 2);
  }
}

bool Groups::is_in_the_way_back(std::size_t robot, const Members& who, std::size_t to, double beside) const {
  constexpr std::size_t kStride = 3;  // rows
  const Vec2 here = now_[robot].position;
  return std::any_of(who.begin(), who.end(), [&](std::size_t i) {
    const double near = (1.0 + beside) * (robots_[i].radius + robots_[robot].radius);
    for (std::size_t x = history_.last(); x > to + kStride; x -= kStride)
      if (squared_norm(history_[x][i] - here) < near * near) return true;
    return squared_norm(history_[to][i] - here) < near * near;
  });
}

/// Adds the robots that stand now where the members would go back through, and those in their way.
Groups::Members Groups::with_those_in_the_way_back(Members who, std::size_t to) const {
  for (bool grew = true; grew;) {
    who = with_groups_of(std::move(who));
    Members more;
    for (std::size_t j = 0; j < now_.size(); ++j)
      if (!contains(who, j) && now_[j].may_join && is_in_the_way_back(j, who, to, kBesideTheWayBack)) more.push_back(j);
    grew = !more.empty();
    who = merged(std::move(who), more);
  }
  return who;
}

/// Unless a robot that makes no plan stands in the way.
bool Groups::can_go_back(const Members& who, std::size_t to) const {
  for (std::size_t j = 0; j < now_.size(); ++j)
    if (!now_[j].may_join && !contains(who, j) && is_in_the_way_back(j, who, to, 0.0)) return false;
  return true;
}

// --- Plans ---

void Groups::make_due_plans() {
  const std::vector<Due> due = std::exchange(due_, {});
  std::vector<std::size_t> size_of_cluster(now_.size(), 0);  // since the last plan
  for (const Due& d : due) {
    if (is_member(d.robot) || !(time_ - of_robot_[d.robot].planned_at > 0.0) || is_stopped_()) continue;
    std::vector<std::size_t> cluster;
    if (d.is_dead || size_of_cluster[d.robot] == 0) {
      cluster = by_nearness_to({d.robot});
      for (const std::size_t i : cluster) size_of_cluster[i] = cluster.size();
    }
    const double anyway = kActsAnyway + kForEachRobot * static_cast<double>(size_of_cluster[d.robot]);
    if (!d.is_dead && stalled_for(d.robot) < anyway * patience_) continue;
    if (cluster.empty()) cluster = by_nearness_to({d.robot});
    const Members who = as_many_as_fit(std::move(cluster), 0);
    if (plan_for(who, who, 0)) size_of_cluster.assign(now_.size(), 0);
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (groups_[g].is_over || time_ - groups_[g].progress < kNoProgress * patience_ || is_stopped_()) continue;
    const int replans = groups_[g].replans + 1;
    constexpr int kThenAll = 3;
    const Members who = members_of(groups_[g]);
    const bool all = replans >= kThenAll && now_.size() <= kEveryoneUpTo && fits(everyone(), history_.back(), replans);
    plan_for(all ? everyone() : as_many_as_fit(by_nearness_to(who), replans), who, replans);
  }
}

/// From now, else from where the members were a while ago: they can go back as they came (lemma 4).
bool Groups::plan_for(Members who, const Members& seeds, int replans) {
  const std::size_t now = history_.last();
  const auto rows_back = [&](double back) { return static_cast<std::size_t>(back / rules_.time_step); };
  PlanEnd end = PlanEnd::too_large;
  for (double back = 0.0; !is_stopped_(); back = back == 0.0 ? kFirstBack * patience_ : 2.0 * back) {
    const std::size_t to = now - std::min(now - history_.first(), rows_back(back));
    if (back > 0.0) who = with_those_in_the_way_back(std::move(who), to);
    if (back > 0.0 && !can_go_back(who, to)) break;
    end = plan_from(who, seeds, replans, to);
    if (end == PlanEnd::none_on_map && who.size() < everyone().size() && now_.size() <= kEveryoneUpTo) {
      who = everyone();
      end = plan_from(who, seeds, replans, to);
    }
    if (end == PlanEnd::planned) return true;
    if (to == history_.first() || end == PlanEnd::no_use || end == PlanEnd::in_vain) break;
  }
  // A map that has no plan may lack a place: that far in a niche, say. Then from now and from the first row again.
  for (const Detail detail : {Detail::dense, Detail::walls})
    for (const std::size_t to : {now, history_.first()})
      if (end == PlanEnd::none_on_map && !is_stopped_() && can_go_back(who, to) &&
          plan_from(who, seeds, replans, to, detail) == PlanEnd::planned)
        return true;
  for (const std::size_t i : seeds) ++of_robot_[i].failures;
  forget_without_plan(seeds);
  without_plan_.push_back({seeds, end});
  return false;
}

void Groups::dissolve_those_of(const Members& who) {
  for (const std::size_t i : who) {
    if (is_member(i)) dissolve(group_of_[i]);
    of_robot_[i].planned_at = time_;
  }
}

std::string Groups::plan_words(const Group& g) const {
  std::string text = std::to_string(g.who.size()) + (g.who.size() == 1 ? " robot goes" : " robots go") +
                     " by plan: " + std::to_string(g.following.plan().size()) + " moves";
  if (g.back_at > g.back_to)
    text += "; they first go back " + seconds(static_cast<double>(g.back_at - g.back_to) * rules_.time_step);
  return text;
}

void Groups::dissolve(std::size_t number) {
  Group& g = groups_[number];
  for (const std::size_t i : members_of(g)) {
    group_of_[i] = kNone;
    restart_watch(i);
  }
  g.is_over = true;
}

/// They were planned for again.
void Groups::forget_without_plan(const Members& who) {
  const auto is_of_these = [&](const WithoutPlan& w) {
    return std::any_of(w.who.begin(), w.who.end(), [&](std::size_t i) { return contains(who, i); });
  };
  without_plan_.erase(std::remove_if(without_plan_.begin(), without_plan_.end(), is_of_these), without_plan_.end());
}

std::string Groups::no_plan_words(const Members& robots) const {
  std::string text;
  for (const WithoutPlan& w : without_plan_) {
    std::vector<std::string> names;
    for (const std::size_t i : w.who)
      if (contains(robots, i)) names.push_back(robots_[i].id);
    if (!names.empty()) add_note(text, words_of(w.why) + abridged(std::move(names)));
  }
  return text;
}

std::string Groups::still_going_words() const {
  std::size_t robots = 0, left = 0, all = 0;
  for (const Group& g : groups_) {
    if (g.is_over || (g.replans > 0 && g.following.moves_left() == g.following.plan().size())) continue;
    robots += members_of(g).size();
    left += g.following.moves_left();
    all += g.following.plan().size();
  }
  if (robots == 0) return "";
  return std::to_string(robots) + (robots == 1 ? " robot was" : " robots were") +
         " still going by a joint plan, with " + std::to_string(left) + " of " + std::to_string(all) +
         " moves to go: more time may be all that is missing";
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
  let_go_on(g);
}

/// A robot that has gone its way and heads for its next goal does not wait until the others are there: no move of
/// theirs depends on it any more.
void Groups::let_go_on(const Group& g) {
  for (std::size_t k = 0; k < g.who.size(); ++k) {
    const std::size_t i = g.who[k];
    const bool is_on = is_member(i) && &group(i) == &g;
    if (!is_on || !g.following.is_there(k) || now_[i].goal_number == of_robot_[i].planned_goal) continue;
    group_of_[i] = kNone;
    restart_watch(i);
  }
}

void Groups::want() {
  for (Group& g : groups_) g.stands_still = false;
  for (std::size_t i = 0; i < now_.size(); ++i)
    if (is_member(i)) wanted_[i] = wanted_by(i);
}

Vec2 Groups::wanted_by(std::size_t robot) const {
  const Group& g = group(robot);
  const std::vector<Vec2>& here = history_.back();
  Vec2 to;
  if (g.back_at > g.back_to) {
    to = history_[g.back_at - 1][robot];
  } else {
    std::vector<Vec2> at;
    for (const std::size_t i : g.who) at.push_back(here[i]);
    const auto k = std::lower_bound(g.who.begin(), g.who.end(), robot) - g.who.begin();
    to = g.following.within_reach(static_cast<std::size_t>(k), at);
  }
  return velocity_along(rules_, robots_[robot].max_speed, to - here[robot]);
}

bool Groups::halt_those_held_back(const Step& row) {
  constexpr double kAsWanted = 1e-9;  // of the speed
  bool any = false;
  for (Group& g : groups_) {
    if (g.is_over || g.stands_still || g.back_at <= g.back_to) continue;
    const bool as_wanted = std::all_of(g.who.begin(), g.who.end(), [&](std::size_t i) {
      return norm(row.robots[i].chosen - wanted_[i]) <= kAsWanted * robots_[i].max_speed;
    });
    if (as_wanted) continue;
    g.stands_still = any = true;
    for (const std::size_t i : g.who) wanted_[i] = {};
  }
  return any;
}

}  // namespace exactvo::formation::detail
