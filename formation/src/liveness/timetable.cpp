// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/timetable.h"

#include <algorithm>
#include <numeric>

#include "exactvo/geometry/box.h"

namespace exactvo::formation::detail {
namespace {

constexpr WayNumber kNotAsked = std::numeric_limits<WayNumber>::max();

geometry::Box box_of(const Segment& s) {
  geometry::Box box;
  box.add(s.a);
  box.add(s.b);
  return box;
}

}  // namespace

Ways::Ways(const Roadmap& map, double most_radii)
    : map_(map), reach_((1.0 + kPlannedGap) * most_radii), from_(map.size()), cells_(2.0 * reach_) {}

WayNumber Ways::number(PlaceNumber from, PlaceNumber to) {
  const auto [entry, is_new] =
      numbers_.try_emplace((static_cast<std::uint64_t>(from) << 32) | to, static_cast<WayNumber>(ways_.size()));
  if (is_new) {
    ways_.push_back({map_.place(from), map_.place(to)});
    near_places_.emplace_back();
    near_ways_.emplace_back();
    has_near_ways_.push_back(0);
    add_near_places(entry->second);
  }
  return entry->second;
}

WayNumber Ways::number_of_kth(PlaceNumber from, std::size_t k) {
  std::vector<WayNumber>& known = from_[from];
  if (known.empty()) known.assign(map_.ways(from).size(), kNotAsked);
  if (known[k] == kNotAsked) known[k] = number(from, map_.ways(from)[k]);
  return known[k];
}

void Ways::add_near_places(WayNumber w) {
  const Segment s = ways_[w];
  const double radii = reach_ / (1.0 + kPlannedGap);
  map_.for_each_near(0.5 * (s.a + s.b), reach_ + 0.5 * length(w), [&](PlaceNumber p) {
    const double squared = squared_distance(map_.place(p), s.a, s.b);
    // A disc may get away from a place however near to it it was.
    if (squared < squared_keep(radii, squared_norm(map_.place(p) - s.a)))
      near_places_[w].push_back({p, static_cast<float>(squared)});
  });
  // Where the way ends comes first: mostly that is what is taken.
  std::stable_sort(near_places_[w].begin(), near_places_[w].end(),
                   [](const NearPlace& a, const NearPlace& b) { return a.squared < b.squared; });
}

const std::vector<Ways::NearWay>& Ways::near_ways(WayNumber w) {
  if (!has_near_ways_[w]) add_near_ways(w);
  return near_ways_[w];
}

void Ways::add_near_ways(WayNumber w) {
  has_near_ways_[w] = 1;
  const geometry::Box box = box_of(ways_[w]);
  cells_.add(box, w);
  const Vec2 corner{reach_, reach_};
  std::vector<WayNumber> about;
  cells_.for_each_in({box.low - corner, box.high + corner}, [&](WayNumber v) { about.push_back(v); });
  std::sort(about.begin(), about.end());
  about.erase(std::unique(about.begin(), about.end()), about.end());
  for (const WayNumber v : about) {
    const double squared = squared_distance(ways_[v], ways_[w]);
    if (!(squared < kSingleRounding * reach_ * reach_)) continue;
    near_ways_[w].push_back({v, static_cast<float>(squared), static_cast<float>(lead(v, w))});
    if (v != w) near_ways_[v].push_back({w, static_cast<float>(squared), static_cast<float>(lead(w, v))});
  }
}

/// m: in quarters of the first way. With it the second keeps clear of what the first has still to sweep, at the same
/// speed.
double Ways::lead(WayNumber first, WayNumber second) const {
  constexpr int kParts = 4;
  const Segment f = ways_[first], s = ways_[second];
  const double whole = length(first), other = length(second);
  const auto is_clear = [&](double ahead, double gone) {
    const double share = std::min(1.0, (ahead + gone) / whole);
    return squared_distance(s.a + gone / other * (s.b - s.a), f.a + share * (f.b - f.a), f.b) >= reach_ * reach_;
  };
  for (int quarters = 0; quarters < kParts; ++quarters) {
    const double ahead = quarters * whole / kParts;
    bool all = true;
    for (int k = 0; k <= kParts && all; ++k) all = is_clear(ahead, k * other / kParts);
    if (all) return ahead;
  }
  return whole;
}

namespace {

/// Moves near to each other keep their order: the later never starts before the earlier.
void sort_by_start(Timetable& table) {
  std::vector<std::size_t> order(table.moves.size()), rank(table.moves.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return table.moves[a].start < table.moves[b].start; });
  std::vector<TimedMove> sorted;
  sorted.reserve(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    rank[order[k]] = k;
    sorted.push_back(table.moves[order[k]]);
  }
  for (TimedMove& m : sorted)
    if (m.waits_for != kNoMove) m.waits_for = rank[m.waits_for];
  if (table.last_move != kNoMove) table.last_move = rank[table.last_move];
  table.moves = std::move(sorted);
}

}  // namespace

Timetable timetable_of(const std::vector<JointMove>& moves, const std::vector<double>& radii, Ways& ways) {
  Timetable table;
  table.moves.reserve(moves.size());
  std::vector<double> end(radii.size(), 0.0);
  std::vector<std::size_t> own(radii.size(), kNoMove), latest_on;
  for (const JointMove& m : moves) {
    TimedMove timed{m, ways.number(m.from, m.to), end[m.robot], own[m.robot]};
    const std::vector<Ways::NearWay>& near = ways.near_ways(timed.way);
    latest_on.resize(ways.size(), kNoMove);
    for (const Ways::NearWay& n : near) {
      const std::size_t earlier = latest_on[n.way];
      if (earlier == kNoMove || !(table.moves[earlier].start + n.lead > timed.start)) continue;
      const std::size_t other = table.moves[earlier].move.robot;
      const double wanted = (1.0 + kPlannedGap) * (radii[m.robot] + radii[other]);
      if (other == m.robot || !(n.squared < kSingleRounding * wanted * wanted)) continue;
      timed.start = table.moves[earlier].start + n.lead;
      timed.waits_for = earlier;
    }
    latest_on[timed.way] = own[m.robot] = table.moves.size();
    end[m.robot] = timed.start + ways.length(timed.way);
    table.moves.push_back(timed);
  }
  for (std::size_t i = 0; i < end.size(); ++i) {
    table.mean += end[i] / static_cast<double>(end.size());
    if (!(end[i] > table.last)) continue;
    table.last = end[i];
    table.last_move = own[i];
  }
  sort_by_start(table);
  return table;
}

}  // namespace exactvo::formation::detail
