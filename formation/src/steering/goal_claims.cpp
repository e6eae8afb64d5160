// SPDX-License-Identifier: GPL-3.0-or-later
#include "steering/goal_claims.h"

#include <algorithm>
#include <utility>

#include "scene/goals.h"
#include "scene/near_pairs.h"
#include "scene/number_text.h"

namespace exactvo::formation::detail {

GoalClaims::GoalClaims(const Scenario& scenario, const RoomAtEnds& room, double horizon)
    : scenario_(scenario),
      room_(room),
      horizon_(horizon),
      largest_(largest_radius(scenario.robots)),
      claimed_(4.0 * largest_),
      robots_(scenario.robots.size()) {}

/// The nearest of those in `others` that leave robot i no room in `place`; the first of several as near.
template <class PlaceOf>
std::optional<std::size_t> GoalClaims::nearest_in(const Cells<std::size_t>& others, const PlaceOf& place_of,
                                                  std::size_t i, Vec2 place) const {
  std::optional<std::size_t> nearest;
  const auto distance_of = [&](std::size_t j) { return norm(place_of(j) - place); };
  const double reach = scenario_.robots[i].radius + largest_ + room_.margin;
  others.for_each_about(place, reach, [&](std::size_t j) {
    if (j != i && leave_no_room(scenario_, i, j, distance_of(j), room_) &&
        (!nearest || std::pair(distance_of(j), j) < std::pair(distance_of(*nearest), *nearest)))
      nearest = j;
  });
  return nearest;
}

/// The robots that rest beside a taken place.
struct GoalClaims::Resting {
  explicit Resting(double side) : robots(side) {}
  void add(Vec2 place, std::size_t i) {
    robots.add(place, i);
    box.add(place);
  }
  Cells<std::size_t> robots;
  geometry::Box box;
};

void GoalClaims::claim(std::size_t i) {
  claimed_.add(robots_[i].place, i);
  ++claims_;
}

bool GoalClaims::look(std::vector<EndNow> now) {
  const std::size_t claims_before = claims_;
  bool has_changed = false;
  now_ = std::move(now);
  Resting resting(4.0 * largest_);
  const auto place_of = [&](std::size_t j) { return robots_[j].place; };
  for (std::size_t i = 0; i < now_.size(); ++i) {
    OfRobot& r = robots_[i];
    if (r.rests) resting.add(now_[i].position, i);
    if (r.has_claim || !now_[i].counts) continue;
    if (r.seen != claims_ || r.end != now_[i].end) {
      r.taken_by = nearest_in(claimed_, place_of, i, now_[i].end);
      r.seen = claims_;
      r.end = now_[i].end;
    }
    if (r.taken_by || !now_[i].is_last || !now_[i].is_there) continue;
    r.has_claim = true;
    r.place = now_[i].end;
    r.is_goal = now_[i].is_goal;
    claim(i);
  }
  for (std::size_t i = 0; i < now_.size(); ++i) {
    OfRobot& r = robots_[i];
    const bool rests = r.taken_by && now_[i].may_rest && !now_[i].is_there && is_beside(i, resting);
    has_changed = has_changed || rests != r.rests;
    r.has_come_to_rest = rests && !r.rests;
    r.rests = rests;
  }
  return has_changed || claims_ > claims_before;
}

void GoalClaims::remember(std::vector<OfRobot> robots) {
  robots_ = std::move(robots);
  for (std::size_t i = 0; i < robots_.size(); ++i)
    if (robots_[i].has_claim) claim(i);
}

/// m: what half-planes leave between the rims of two robots that come as near as they can, about.
double GoalClaims::gap_beside(double radii) const {
  constexpr double kOfRadii = 0.25;
  return kOfRadii * radii + kNearMargins * room_.margin;
}

/// m, between the rims of a robot and of the one that has taken its place, were that there.
double GoalClaims::gap_to_taken(std::size_t i) const {
  const std::size_t taker = *robots_[i].taken_by;
  return norm(now_[i].position - robots_[taker].place) - scenario_.robots[taker].radius - scenario_.robots[i].radius;
}

/// Beside the taken place, or beside one that stays there for the same reason.
bool GoalClaims::is_beside(std::size_t i, const Resting& resting) const {
  const OfRobot& r = robots_[i];
  const double radius = scenario_.robots[i].radius, most = radius + largest_;
  bool is_beside = gap_to_taken(i) <= gap_beside(radius + scenario_.robots[*r.taken_by].radius);
  const double reach = most + gap_beside(most);
  if (is_beside || distance_below(resting.box, now_[i].position) > reach) return is_beside;
  resting.robots.for_each_about(now_[i].position, reach, [&](std::size_t j) {
    const double radii = radius + scenario_.robots[j].radius;
    is_beside = is_beside || (j != i && robots_[j].taken_by == r.taken_by &&
                              norm(now_[j].position - now_[i].position) - radii <= gap_beside(radii));
  });
  return is_beside;
}

/// Where it goes to leave the taken place to who has it; nothing where it does.
std::optional<Vec2> GoalClaims::way_out(std::size_t i) const {
  const double gap = gap_to_taken(i) - room_.margin;
  const Vec2 from_place = now_[i].position - robots_[*robots_[i].taken_by].place;
  if (!(gap < 0.0) || !(norm(from_place) > 0.0)) return std::nullopt;
  return now_[i].position - gap / norm(from_place) * from_place;
}

Vec2 GoalClaims::beside_taken_place(std::size_t i, Vec2 preferred) const {
  const double max_speed = scenario_.robots[i].max_speed;
  if (const std::optional<Vec2> out = way_out(i))
    return straight_for(now_[i].position, max_speed, *out, scenario_.time_step, acceleration_of(scenario_, i));
  if (rests(i)) return {};
  const double gap = gap_to_taken(i) - room_.margin;
  // The half-planes of the next step look ahead for this velocity, from one step nearer.
  const double most = std::max(gap, 0.0) / (horizon_ + scenario_.time_step), speed = norm(preferred);
  return speed > most ? most / speed * preferred : preferred;
}

std::string GoalClaims::words(std::size_t i) const {
  const std::size_t first = *robots_[i].taken_by;
  const std::string room = ", which leaves no room for both";
  if (now_[i].is_goal && robots_[first].is_goal)
    return first_at_goal_words(scenario_.robots[first], scenario_.robots[i]) + room;
  const double apart = norm(robots_[first].place - now_[i].end);
  const std::string& id = scenario_.robots[first].id;
  if (apart == 0.0) return id + " was first at the nearest place that both can reach" + room;
  return id + " was first where it stays, " + metres(apart) + " from where " + scenario_.robots[i].id + " was to come" +
         room;
}

}  // namespace exactvo::formation::detail
