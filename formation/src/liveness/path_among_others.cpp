// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/path_among_others.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "exactvo/geometry/infinity.h"
#include "liveness/distances.h"

namespace exactvo::formation::detail {
namespace {

constexpr std::size_t kBits = 64;
constexpr std::uint64_t kAll = ~std::uint64_t{0};

/// Squared, m2: what is nearer is too near for robots with that sum of radii.
double squared_reach(double radii) {
  const double wanted = (1.0 + kPlannedGap) * radii;
  return kSingleRounding * wanted * wanted;
}

}  // namespace

StandingRobots::StandingRobots(const JointProblem& problem, std::size_t most_words)
    : problem_(problem), most_words_(most_words) {
  constexpr std::size_t kMostLayers = 4;
  std::vector<double> radii = problem.radii;
  std::sort(radii.begin(), radii.end());
  radii.erase(std::unique(radii.begin(), radii.end()), radii.end());
  const std::size_t count = std::min(radii.size(), kMostLayers);
  for (std::size_t k = 1; k <= count; ++k) layers_.push_back({radii[k * radii.size() / count - 1]});
  for (const double radius : problem.radii) {
    const auto found = std::find_if(layers_.begin(), layers_.end(), [&](const Layer& l) { return l.radius >= radius; });
    layer_of_.push_back(static_cast<std::size_t>(found - layers_.begin()));
  }
}

void StandingRobots::clear(std::size_t count) {
  const std::size_t places = problem_.map->size(), words = (count / kBits + 1) * places;
  has_bits_ = layers_.size() * words <= most_words_;
  for (Layer& layer : layers_) {
    if (has_bits_) {
      layer.taken.assign(words, 0);
      layer.until.assign(words, 0);
      continue;
    }
    layer = {layer.radius};
    layer.stays.resize(places);
  }
}

void StandingRobots::add(std::size_t robot, PlaceNumber place, std::size_t first, std::size_t last) {
  Layer& layer = layers_[layer_of_[robot]];
  if (has_bits_) return add_bits(layer, problem_.map->size(), place, first, last);
  add_stay(layer.stays[place], first, last);
}

/// Merged with those that it meets or follows on: of a sequence of moves mostly the last one, or none.
void StandingRobots::add_stay(std::vector<Stay>& stays, std::size_t first, std::size_t last) {
  Stay stay{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)};
  const auto begin = std::partition_point(stays.begin(), stays.end(), [&](Stay s) { return s.last + 1 < stay.first; });
  const auto end = std::partition_point(begin, stays.end(), [&](Stay s) { return s.first <= stay.last + 1; });
  if (begin != end) stay = {std::min(stay.first, begin->first), std::max(stay.last, (end - 1)->last)};
  stays.insert(stays.erase(begin, end), stay);
}

void StandingRobots::add_bits(Layer& layer, std::size_t places, PlaceNumber place, std::size_t first,
                              std::size_t last) {
  for (std::size_t w = first / kBits; w <= last / kBits; ++w) {
    const std::uint64_t from = w == first / kBits ? kAll << first % kBits : kAll;
    const std::uint64_t to = w == last / kBits ? kAll >> (kBits - 1 - last % kBits) : kAll;
    const std::size_t word = w * places + place;
    layer.taken[word] |= from & to;
    layer.until[word] = std::max(layer.until[word], static_cast<std::uint32_t>(last + 1));
  }
}

std::size_t StandingRobots::first_clear(double radius, const std::vector<RoadmapEdges::NearPlace>& near,
                                        std::size_t first, std::size_t last) const {
  while (!has_bits_ && first <= last) {
    const std::size_t next = after_stays(radius, near, first);
    if (next == first) return first;
    first = next;
  }
  while (first <= last) {
    std::uint64_t taken = (std::uint64_t{1} << first % kBits) - 1;
    const std::size_t next = add_taken(radius, near, first / kBits, taken);
    if (taken != kAll) return first / kBits * kBits + static_cast<std::size_t>(__builtin_ctzll(~taken));
    first = next;
  }
  return first;
}

std::size_t StandingRobots::add_taken(double radius, const std::vector<RoadmapEdges::NearPlace>& near, std::size_t word,
                                      std::uint64_t& taken) const {
  for (const Layer& layer : layers_) {
    const std::size_t begin = word * problem_.map->size();
    const double reach = squared_reach(radius + layer.radius);
    for (const RoadmapEdges::NearPlace& n : near) {  // the nearest first
      if (!(n.squared < reach)) break;
      const std::uint64_t here = layer.taken[begin + n.place];
      taken |= here;
      if (taken == kAll) return here == kAll ? layer.until[begin + n.place] : (word + 1) * kBits;
    }
  }
  return (word + 1) * kBits;
}

std::size_t StandingRobots::after_stays(double radius, const std::vector<RoadmapEdges::NearPlace>& near,
                                        std::size_t position) const {
  for (const Layer& layer : layers_) {
    const double reach = squared_reach(radius + layer.radius);
    for (const RoadmapEdges::NearPlace& n : near) {  // the nearest first
      if (!(n.squared < reach)) break;
      const std::vector<Stay>& stays = layer.stays[n.place];
      const auto stay = std::partition_point(stays.begin(), stays.end(), [&](Stay s) { return s.last < position; });
      if (stay != stays.end() && stay->first <= position) return stay->last + std::size_t{1};
    }
  }
  return position;
}

SafeIntervals::SafeIntervals(const JointProblem& problem)
    : problem_(problem), standing_(problem), passed_(problem.map->size()), first_(problem.map->size()) {}

void SafeIntervals::set(std::size_t robot, const Timetable& others, const RoadmapEdges& edges) {
  robot_ = robot;
  count_ = others.moves.size();
  for (auto& list : passed_) list.clear();
  standing_.clear(count_);
  std::vector<PlaceNumber> at = problem_.starts;
  std::vector<std::size_t> since(at.size(), 0);
  for (std::size_t k = 0; k < count_; ++k) {
    const JointMove& m = others.moves[k].move;
    const double reach = squared_reach(problem_.radii[robot] + problem_.radii[m.robot]);
    for (const RoadmapEdges::NearPlace& n : edges.near_places(others.moves[k].edge)) {
      if (!(n.squared < reach)) break;
      passed_[n.place].push_back(static_cast<std::uint32_t>(k));
    }
    standing_.add(m.robot, m.from, since[m.robot], k);
    at[m.robot] = m.to;
    since[m.robot] = k + 1;
  }
  for (std::size_t i = 0; i < at.size(); ++i)
    if (i != robot) standing_.add(i, at[i], since[i], count_);
  size_ = 0;
  for (PlaceNumber p = 0; p < passed_.size(); ++p) {
    first_[p] = size_;
    size_ += passed_[p].size() + 1;
  }
}

std::size_t SafeIntervals::at(PlaceNumber place, std::size_t position) const {
  const std::vector<std::uint32_t>& passed = passed_[place];
  return first_[place] +
         static_cast<std::size_t>(std::lower_bound(passed.begin(), passed.end(), position) - passed.begin());
}

std::size_t SafeIntervals::last(PlaceNumber place, std::size_t interval) const {
  const std::size_t k = interval - first_[place];
  return k < passed_[place].size() ? passed_[place][k] : count_;
}

std::optional<std::vector<JointMove>> PathAmongOthers::moves_with(std::size_t robot, const Timetable& others,
                                                                  const std::vector<float>& to_goal, double bound) {
  const Query query{robot, &others, &to_goal, bound};
  safe_.set(robot, others, edges_);
  work_ += safe_.size() + safe_.words() / 8;
  arrivals_.clear();
  open_.clear();
  soonest_.assign(safe_.size(), geometry::kInfinity);
  const PlaceNumber start = problem_.starts[robot], goal = problem_.goals[robot];
  offer(query, {start, safe_.at(start, 0)});
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    const std::size_t number = open_.back().second;
    open_.pop_back();
    const Arrival& here = arrivals_[number];
    if (here.time > soonest_[here.interval]) continue;
    if (here.place == goal && safe_.last(goal, here.interval) == safe_.last_position()) return moves_to(query, number);
    expand(query, number);
  }
  return std::nullopt;
}

void PathAmongOthers::offer(const Query& query, const Arrival& arrival) {
  const double until_goal = arrival.time + (*query.to_goal)[arrival.place];
  if (!(arrival.time < soonest_[arrival.interval]) || !(until_goal < query.bound)) return;
  soonest_[arrival.interval] = arrival.time;
  open_.emplace_back(until_goal, arrivals_.size());
  std::push_heap(open_.begin(), open_.end(), std::greater<>());
  arrivals_.push_back(arrival);
}

void PathAmongOthers::expand(const Query& query, std::size_t arrival) {
  const PlaceNumber from = arrivals_[arrival].place;
  const std::size_t now = position_at(*query.others, arrivals_[arrival].time);
  const std::vector<PlaceNumber>& next = problem_.map->ways(from);
  for (std::size_t k = 0; k < next.size(); ++k)
    if (problem_.map->room(next[k]) >= problem_.body(query.robot) && (*query.to_goal)[next[k]] != kFarAway)
      expand_to(query, arrival, now, next[k], edges_.kth_from(from, k));
}

/// In each of the intervals of the next place that can be reached.
void PathAmongOthers::expand_to(const Query& query, std::size_t arrival, std::size_t now, PlaceNumber to,
                                EdgeNumber edge) {
  const Arrival here = arrivals_[arrival];
  const std::size_t until = safe_.last(here.place, here.interval);
  // Who waits until a later position than it would be ready for leaves once the move before that is under way.
  const auto arrives = [&](std::size_t position) {
    const double free = position > now ? query.others->moves[position - 1].start + problem_.radii[query.robot] : 0.0;
    return std::max(here.time, free) + edges_.length(edge);
  };
  std::size_t interval = safe_.at(to, here.position);
  for (std::size_t first = here.position; first <= until; first = safe_.last(to, interval++) + 1) {
    const std::size_t last = std::min(until, safe_.last(to, interval)), wanted = std::clamp(now, first, last);
    const double soonest = arrives(wanted);
    if (!(soonest + (*query.to_goal)[to] < query.bound)) break;
    if (!(soonest < soonest_[interval])) continue;
    const std::vector<RoadmapEdges::NearPlace>& near = edges_.near_places(edge);
    std::size_t position = safe_.first_clear(near, wanted, last);
    if (position > last && first < wanted) position = safe_.first_clear(near, first, last);
    work_ += near.size();
    if (position <= last) offer(query, {to, interval, position, arrives(position), arrival});
  }
}

std::vector<JointMove> PathAmongOthers::moves_to(const Query& query, std::size_t arrival) const {
  std::vector<const Arrival*> way;
  for (; arrival != 0; arrival = arrivals_[arrival].parent) way.push_back(&arrivals_[arrival]);
  std::reverse(way.begin(), way.end());
  const std::vector<TimedMove>& others = query.others->moves;
  std::vector<JointMove> moves;
  moves.reserve(others.size() + way.size());
  PlaceNumber at = problem_.starts[query.robot];
  std::size_t k = 0;
  for (const Arrival* next : way) {
    for (; k < next->position; ++k) moves.push_back(others[k].move);
    moves.push_back({query.robot, at, next->place});
    at = next->place;
  }
  for (; k < others.size(); ++k) moves.push_back(others[k].move);
  return moves;
}

}  // namespace exactvo::formation::detail
